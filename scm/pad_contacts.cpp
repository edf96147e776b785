// SPDX-License-Identifier: BSD-3-Clause
#include "scm/pad_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::scm {

namespace {

constexpr double kNear = 5e-3;    // [m] nodes are listed up to this height of a pad above them
constexpr double kSteepest = 0.2; // minimum cosine between the pad normal and the vertical for contact

/// Share of a node's square within a pad along one axis; `width`: of the square along that axis [m].
double shareOf(double place, double half, double width) {
  return std::clamp((half - std::fabs(place)) / width + 0.5, 0.0, 1.0);
}

} // namespace

PadContacts::PadContacts(const SoilConstants& soil, double deepest, SoilMap& map, std::vector<Pad> pads)
    : soil_(soil), curve_(soil.exponent, deepest), map_(map), pads_(std::move(pads)), last_(pads_.size()),
      now_(pads_.size()), loads_(pads_.size()) {}

void PadContacts::step(const contact::PartMotion* motion, double timeStep) {
  touched_.clear();
  for (std::size_t k = 0; k < pads_.size(); ++k) gather(k, motion[pads_[k].part]);
  advanceNodes();
  energy_.elastic = energy_.elasticShear = 0;
  for (std::size_t k = 0; k < pads_.size(); ++k) press(k, motion[pads_[k].part], timeStep);
  for (const Touched& t : touched_) t.node->touched = -1;
}

void PadContacts::gather(std::size_t pad, const contact::PartMotion& motion) {
  const Pad& p = pads_[pad];
  std::vector<Pair>& pairs = now_[pad];
  pairs.clear();
  const Vec3d centre = motion.toWorld(p.centre), u = motion.rotation * p.along, v = motion.rotation * p.across;
  const Vec3d up = cross(u, v);
  if (up.z < kSteepest) return;
  // Widths of a node's square across the pad's sides.
  const double h = map_.spacing();
  const double widthU = h * (std::fabs(u.x) + std::fabs(u.y)), widthV = h * (std::fabs(v.x) + std::fabs(v.y));
  const double halfU = p.halfLength + 0.5 * widthU, halfV = p.halfWidth + 0.5 * widthV;
  const double reachX = std::fabs(u.x) * halfU + std::fabs(v.x) * halfV;
  const double reachY = std::fabs(u.y) * halfU + std::fabs(v.y) * halfV;
  const double k = soil_.modulusAt(p.breadth), area = h * h / up.z, slopeX = -up.x / up.z, slopeY = -up.y / up.z;
  const auto firstI = static_cast<std::int32_t>(std::ceil((centre.x - reachX) / h));
  const auto lastI = static_cast<std::int32_t>(std::floor((centre.x + reachX) / h));
  const auto firstJ = static_cast<std::int32_t>(std::ceil((centre.y - reachY) / h));
  const auto lastJ = static_cast<std::int32_t>(std::floor((centre.y + reachY) / h));
  for (std::int32_t j = firstJ; j <= lastJ; ++j)
    for (std::int32_t i = firstI; i <= lastI; ++i) {
      const double x = h * i - centre.x, y = h * j - centre.y, plate = slopeX * x + slopeY * y;
      const double placeU = x * u.x + y * u.y + plate * u.z, placeV = x * v.x + y * v.y + plate * v.z;
      const double share = shareOf(placeU, p.halfLength, widthU) * shareOf(placeV, p.halfWidth, widthV);
      if (!(share > 0)) continue;
      Node& node = map_.at(i, j);
      const double gap = node.height - (centre.z + plate);
      if (gap < -kNear) continue;
      const double depth = gap * node.cosine;
      if (node.touched < 0) {
        node.touched = static_cast<int>(touched_.size());
        touched_.push_back({&node, node.state, depth, k});
      } else {
        Touched& t = touched_[static_cast<std::size_t>(node.touched)];
        t.deepest = std::max(t.deepest, depth), t.modulus = std::max(t.modulus, k);
      }
      const int a = std::clamp(static_cast<int>((placeU / p.halfLength + 1) * 0.5 * kAlong), 0, kAlong - 1);
      const int b = std::clamp(static_cast<int>((placeV / p.halfWidth + 1) * 0.5 * kAcross), 0, kAcross - 1);
      pairs.push_back({i, j, &node, node.touched, a * kAcross + b, placeU, placeV, depth, share, area});
    }
}

void PadContacts::advanceNodes() {
  for (const Touched& t : touched_)
    if (t.yields()) compress(t.node->state, soil_, curve_, t.modulus, t.before.rebound(), t.deepest);
}

void PadContacts::press(std::size_t pad, const contact::PartMotion& motion, double timeStep) {
  const Pad& p = pads_[pad];
  Last& last = last_[pad];
  PadLoad& load = loads_[pad];
  load = {};
  const Vec3d u = motion.rotation * p.along, v = motion.rotation * p.across, up = cross(u, v);
  const Vec3d centre = motion.toWorld(p.centre);
  std::array<double, kAlong * kAcross> pressed{}, touching{};
  std::array<Vec3d, kAlong * kAcross> moment{}; // first moments of the normal forces, in the plane of the pad [N m]
  auto former = last.pairs.begin();
  const auto leave = [&](const Pair& f) { // the node is no longer under the pad
    const int touched = f.node->touched;
    const Compaction& state = touched < 0 ? f.node->state : touched_[static_cast<std::size_t>(touched)].before;
    energy_.edges += f.share * f.area * state.elastic(state.pressureAt(f.depth));
  };
  for (const Pair& pair : now_[pad]) {
    while (former != last.pairs.end() && std::pair(former->j, former->i) < std::pair(pair.j, pair.i)) leave(*former++);
    const bool isKnown = former != last.pairs.end() && former->j == pair.j && former->i == pair.i;
    const Touched& t = touched_[static_cast<std::size_t>(pair.touched)];
    const Compaction& state = pair.node->state;
    const double pressure = pair.depth > 0 ? state.pressureAt(pair.depth) : 0;
    const double elastic = state.elastic(pressure);
    const double shareBefore = isKnown ? former->share * former->area : 0;
    if (t.yields() && shareBefore > 0) {
      Compaction path = t.before;
      const Compression c = compress(path, soil_, curve_, t.modulus, former->depth, std::max(0.0, pair.depth));
      energy_.compaction += shareBefore * (c.work - (elastic - t.before.elastic(t.before.pressureAt(former->depth))));
    }
    energy_.edges -= (pair.share * pair.area - shareBefore) * elastic;
    energy_.elastic += pair.share * pair.area * elastic;
    if (isKnown) ++former;
    if (!(pressure > 0)) continue;
    // Damping acts during compression only.
    const Vec3d place = centre + u * pair.u + v * pair.v;
    const double sinking = std::max(0.0, -dot(motion.velocityAt(place), up));
    const double weight = pair.share * pair.area, force = weight * (pressure + soil_.damping * sinking);
    energy_.damping += weight * soil_.damping * sinking * sinking * timeStep;
    const auto k = static_cast<std::size_t>(pair.piece);
    pressed[k] += weight * pressure, touching[k] += weight;
    moment[k] += (u * pair.u + v * pair.v) * (weight * pressure);
    load.force += up * force, load.torque += cross(place - motion.centre, up * force);
    load.pressed += force, load.area += weight, load.sinkage = std::max(load.sinkage, pair.depth);
  }
  while (former != last.pairs.end()) leave(*former++);

  const double K = soil_.shearDisplacement;
  for (std::size_t k = 0; k < pressed.size(); ++k) {
    Shear& s = last.shear[k];
    const double before = last.strength[k], strength = soil_.cohesion * touching[k] + soil_.friction * pressed[k];
    const Vec3d place = pressed[k] > 0 ? moment[k] * (1 / pressed[k]) : Vec3d{};
    if (last.isThere && before > 0 && strength > 0) {
      // Rotate the stress into the present plane of the pad, then add the shear displacement of this step.
      const Vec3d stress = last.u * s.x + last.v * s.y;
      const double size = ::sqrt(s.square()), x = dot(stress, u), y = dot(stress, v), now = ::sqrt(x * x + y * y);
      s = now > 0 ? Shear{x * size / now, y * size / now} : Shear{};
      const double pu = dot(place, u), pv = dot(place, v);
      const Vec3d moved = centre + place - (last.centre + last.u * pu + last.v * pv);
      const ShearWork w = advance(s, dot(moved, u), dot(moved, v), K);
      energy_.shear += before * w.loss;
      energy_.coupling -= 0.5 * K * s.square() * (strength - before);
    } else {
      energy_.edges += 0.5 * K * s.square() * before; // contact lost
      s = {};
    }
    last.strength[k] = strength;
    energy_.elasticShear += 0.5 * K * s.square() * strength;
    const Vec3d force = (u * s.x + v * s.y) * -strength;
    load.force += force, load.torque += cross(centre + place - motion.centre, force);
  }
  last.u = u, last.v = v, last.centre = centre, last.isThere = true;
  std::swap(last.pairs, now_[pad]);
}

namespace {

constexpr std::size_t kPieces = PadContacts::kAlong * PadContacts::kAcross;

/// Writes or reads a sequence of numbers with the same code.
class Stream {
public:
  explicit Stream(std::vector<double>& numbers) : numbers_(numbers), writes_(true) {}
  explicit Stream(const std::vector<double>& numbers) : numbers_(copy_), copy_(numbers), writes_(false) {}

  template <class T> void operator()(T& value) {
    if (writes_)
      numbers_.push_back(static_cast<double>(value));
    else if (at_ < numbers_.size())
      value = static_cast<T>(numbers_[at_++]);
    else
      isShort_ = true;
  }
  void operator()(Vec3d& v) { (*this)(v.x), (*this)(v.y), (*this)(v.z); }
  void operator()(Compaction& c) {
    for (double* number : {&c.sinkage, &c.pressure, &c.stiffness, &c.modulus}) (*this)(*number);
  }
  void operator()(SoilEnergy& e) {
    for (double* number : {&e.elastic, &e.elasticShear, &e.compaction, &e.shear, &e.damping, &e.edges, &e.coupling})
      (*this)(*number);
  }
  bool isShort() const { return isShort_; }
  bool isAtEnd() const { return at_ == numbers_.size(); }

private:
  std::vector<double>& numbers_;
  std::vector<double> copy_;
  std::size_t at_ = 0;
  bool writes_, isShort_ = false;
};

} // namespace

std::vector<double> PadContacts::save() const {
  std::vector<double> numbers;
  Stream stream(numbers);
  SoilEnergy energy = energy_;
  double pads = static_cast<double>(pads_.size()), nodes = 0;
  map_.forEach([&](std::int32_t, std::int32_t, const Node& node) { nodes += node.state.stiffness > 0; });
  stream(energy), stream(pads), stream(nodes);
  map_.forEach([&](std::int32_t i, std::int32_t j, const Node& node) {
    if (!(node.state.stiffness > 0)) return;
    Compaction state = node.state;
    stream(i), stream(j), stream(state);
  });
  for (Last last : last_) {
    stream(last.isThere), stream(last.u), stream(last.v), stream(last.centre);
    for (std::size_t k = 0; k < kPieces; ++k) stream(last.shear[k].x), stream(last.shear[k].y), stream(last.strength[k]);
    auto count = static_cast<double>(last.pairs.size());
    stream(count);
    for (Pair& p : last.pairs) stream(p.i), stream(p.j), stream(p.depth), stream(p.share), stream(p.area);
  }
  return numbers;
}

bool PadContacts::restore(const std::vector<double>& saved) {
  Stream stream(saved);
  double pads = 0, nodes = 0;
  stream(energy_), stream(pads), stream(nodes);
  if (pads != static_cast<double>(pads_.size())) return false;
  for (double n = 0; n < nodes && !stream.isShort(); ++n) {
    std::int32_t i = 0, j = 0;
    Compaction state;
    stream(i), stream(j), stream(state);
    map_.at(i, j).state = state;
  }
  for (Last& last : last_) {
    stream(last.isThere), stream(last.u), stream(last.v), stream(last.centre);
    for (std::size_t k = 0; k < kPieces; ++k) stream(last.shear[k].x), stream(last.shear[k].y), stream(last.strength[k]);
    double count = 0;
    stream(count);
    last.pairs.clear();
    for (double n = 0; n < count && !stream.isShort(); ++n) {
      Pair p{};
      stream(p.i), stream(p.j), stream(p.depth), stream(p.share), stream(p.area);
      p.node = &map_.at(p.i, p.j);
      last.pairs.push_back(p);
    }
  }
  return !stream.isShort() && stream.isAtEnd();
}

} // namespace grouser::scm
