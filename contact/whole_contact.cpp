// SPDX-License-Identifier: BSD-3-Clause
#include "contact/whole_contact.hpp"

#include "base/math.hpp"

#include <cmath>

namespace grouser::contact {

using base::Vec3d;

bool isRound(const SurfaceGeometry& g) {
  return g.shape == SurfaceShape::cylinder || g.shape == SurfaceShape::cone || g.shape == SurfaceShape::capsule;
}
bool isBall(const SurfaceGeometry& g) { return g.shape == SurfaceShape::capsule && g.half.z == 0; }

PartMotion withoutOwnTurn(const SurfaceGeometry& g, const PartMotion& motion) {
  PartMotion m = motion;
  if (!isRound(g)) return m;
  m.rotation = base::Mat3d::identity();
  if (isBall(g)) return m;
  constexpr double kNear = 0.8; // cosine between the axis and the reference direction
  const base::Mat3d& r = motion.rotation;
  const Vec3d z{r.m[0][2], r.m[1][2], r.m[2][2]};
  const Vec3d reference = std::fabs(z.z) < kNear ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
  const Vec3d x = base::normalized(reference - z * dot(z, reference)), y = cross(z, x);
  m.rotation = {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
  return m;
}

Vec3d shapeSpin(const SurfaceGeometry& g, const Vec3d& spin) {
  if (isBall(g)) return {};
  return isRound(g) ? Vec3d{spin.x, spin.y, 0} : spin;
}

void removeOwnMoments(const SurfaceGeometry& g, FoundationSums& s) {
  if (!isRound(g)) return;
  s.torque.z = s.turns.z = s.ratedTurns.z = 0;
  if (isBall(g)) s.torque = s.turns = s.ratedTurns = {};
}

Vec3d rollingPoint(const SurfaceGeometry& g, const Vec3d& p) {
  if (!isRound(g)) return p;
  constexpr double kOfRadius = 0.9; // pressure centres on an end are closer to the axis
  double radius = g.half.x, z = p.z;
  if (g.shape == SurfaceShape::capsule) z = std::fmin(std::fmax(z, -g.half.z), g.half.z);
  if (g.shape == SurfaceShape::cone) radius += (g.half.y - g.half.x) * 0.5 * (1 + z / g.half.z);
  const Vec3d out{p.x, p.y, p.z - z};
  const double size = norm(out);
  if (!(size > kOfRadius * radius) || !(size > 0)) return p;
  return Vec3d{0, 0, z} + out * (radius / size);
}

namespace {

/// Wrench on two bodies: force on A, torque on A and on B about their own centres of mass.
struct Wrench {
  Vec3d force, onA, onB;
  void add(const Vec3d& f, const Vec3d& torque, const Vec3d& fromBToA, double scale) {
    force += f * scale, onA += torque * scale, onB -= (torque + cross(fromBToA, f)) * scale;
  }
};

/// T^T I^-1 T of a torque in world axes.
double turned(const PartBody& body, const PartMotion& motion, const Vec3d& torque) {
  const Vec3d local = transposedTimes(motion.rotation, torque);
  return dot(local, body.inverseInertia * local);
}

/// One contact: patches of two bodies with one normal and one damping ratio.
class Contact {
public:
  Contact(const std::vector<PartBody>& bodies, const PartMotion* motion, const WholePatch& first)
      : motion_(motion), a_(first.a), b_(first.b), bodyA_(first.bodyA), bodyB_(first.bodyB),
        ratio_(first.law->dampingRatio), normal_(normalOf(first)) {
    const auto known = [&](int m) { return m >= 0 && static_cast<std::size_t>(m) < bodies.size(); };
    bodyOfA_ = known(a_) ? bodies[static_cast<std::size_t>(a_)] : PartBody{};
    if (known(b_) && bodyB_ >= 0) bodyOfB_ = bodies[static_cast<std::size_t>(b_)];
  }

  /// True if the patch belongs to the contact.
  bool has(const WholePatch& p) const {
    constexpr double kParallel = 0.98; // cosine of the angle between two normals
    const bool same = p.bodyA == bodyA_ && p.bodyB == bodyB_, swapped = p.bodyA == bodyB_ && p.bodyB == bodyA_;
    return (same || swapped) && p.law->dampingRatio == ratio_ &&
           dot(normalOf(p), normal_) * (same ? 1 : -1) > kParallel;
  }

  void add(const WholePatch& p) {
    const double modulus = p.law->modulus;
    stored_ += modulus * p.sums.squared, power_ += modulus * p.power, force_ += modulus * p.sums.pressed;
    area_ += modulus * p.sums.area;
    rocking_ += modulus * p.sums.rocking, spread_ += modulus * p.spread, rated_ += modulus * p.rated;
    addTo(elastic_, p, p.sums.force, p.sums.torque, modulus);
    addTo(mean_, p, p.sums.normals, p.sums.turns, modulus);
    addTo(opening_, p, p.sums.rated, p.sums.ratedTurns, modulus);
  }

  void solve(double timeStep) {
    if (!(ratio_ > 0) || !(stored_ > 0)) return;
    const double square = mobility(elastic_) / stored_;
    if (!(square > 0)) return;
    tangential_ = relaxation(remaining(square, timeStep, 1), square, timeStep);
    // The first step of an impact lasts from the touch, 2 U / -U' before it, to half a step after it.
    const double since = power_ < 0 ? stored_ / (-power_ * timeStep) : 1;
    const double kept = remaining(square, timeStep, since < 1 ? 0.5 + since : 1);
    scale_ = 1 - relaxation(kept, square, timeStep) * power_ / stored_, meanSpeed_ = 0.5 * (1 + kept);
    if (!(scale_ > 0)) scale_ = 0;
    if (!(rocking_ > 0)) return;
    meanRate_ = spread_ / rocking_;
    const double spread = rated_ - meanRate_ * spread_; // modulus x area x (o - mean o)^2
    Wrench couple = opening_;
    couple.force -= mean_.force * meanRate_, couple.onA -= mean_.onA * meanRate_, couple.onB -= mean_.onB * meanRate_;
    const double moved = mobility(couple);
    if (!(spread > kRounding * rated_) || !(moved > 0)) return;
    const double keptRocking = remaining(moved / spread, timeStep, 1);
    rocks_ = relaxation(keptRocking, moved / spread, timeStep), meanRocking_ = 0.5 * (1 + keptRocking);
    // Tension at the edge of a face is not possible: its pressure is at most sqrt(3) times the mean square.
    const double most = scale_ * force_ / std::sqrt(3 * spread * area_);
    if (rocks_ > most) rocks_ = most;
  }

  DampedPatch damped(const WholePatch& p, double timeStep) const {
    const double modulus = p.law->modulus, pressed = scale_ * modulus, rocked = rocks_ * modulus;
    const FoundationSums& s = p.sums;
    DampedPatch d{};
    PatchPressure& out = d.pressure;
    out.area = s.area, out.weight = pressed * s.pressed, out.place = s.place * pressed;
    out.force = s.force * pressed - (s.rated - s.normals * meanRate_) * rocked;
    out.torque = s.torque * pressed - (s.ratedTurns - s.turns * meanRate_) * rocked;
    out.elastic = 0.5 * modulus * s.squared;
    // Forces act at the mean of the velocities before and after the step.
    out.dissipated =
        ((modulus - pressed) * meanSpeed_ * p.power + rocked * meanRocking_ * (p.rated - meanRate_ * p.spread)) *
        timeStep;
    d.relaxation = tangential_;
    return d;
  }

private:
  static constexpr double kRounding = 1e-12;

  static Vec3d normalOf(const WholePatch& p) {
    const double size = norm(p.sums.force);
    return size > 0 ? p.sums.force * (1 / size) : Vec3d{};
  }

  /// Fraction of the velocity that remains after a step, for a mode of squared frequency omega^2: exp(-2 zeta omega
  /// dt), stable at any damping. The dashpot acts at the velocity half a step before the overlap, which is higher by
  /// omega^2 x dt / 2, and thus adds (1 - remaining) / 2 of the stiffness; zeta is raised to match.
  double remaining(double square, double timeStep, double steps) const {
    const double decay = 2 * ratio_ * std::sqrt(square) * timeStep;
    return base::exp(-decay * std::sqrt(1 + decay / (2 + decay)) * steps);
  }
  /// Relaxation time of the dashpot with that effect.
  static double relaxation(double remaining, double square, double timeStep) {
    return (1 - remaining) / (square * timeStep);
  }

  void addTo(Wrench& sum, const WholePatch& p, const Vec3d& force, const Vec3d& torque, double scale) const {
    const Vec3d& ofA = motion_[a_].centre;
    const Vec3d ofB = b_ >= 0 ? motion_[b_].centre : ofA;
    if (p.bodyA == bodyA_) return sum.add(force, torque, ofA - ofB, scale);
    // The patch's part belongs to B: the force on A is its opposite.
    sum.add(-force, -(torque + cross(ofB - ofA, force)), ofA - ofB, scale);
  }

  /// Squared norm of a wrench in the inverse mass matrix.
  double mobility(const Wrench& w) const {
    double sum = (bodyOfA_.inverseMass + bodyOfB_.inverseMass) * norm2(w.force);
    if (bodyOfA_.body >= 0) sum += turned(bodyOfA_, motion_[a_], w.onA);
    if (bodyOfB_.body >= 0) sum += turned(bodyOfB_, motion_[b_], w.onB);
    return sum;
  }

  const PartMotion* motion_;
  int a_, b_, bodyA_, bodyB_;
  double ratio_;
  Vec3d normal_;
  PartBody bodyOfA_, bodyOfB_;
  Wrench elastic_{}, mean_{}, opening_{};
  double stored_{}, power_{}, force_{}, area_{}; ///< 2 U, -U', sum of forces, modulus x area
  double rocking_{}, spread_{}, rated_{};
  double scale_{1}, meanRate_{}, rocks_{}, tangential_{}; ///< results
  double meanSpeed_{1}, meanRocking_{1};                  ///< mean speed / speed before the step
};

} // namespace

void dampWholeContacts(const std::vector<WholePatch>& patches, const std::vector<PartBody>& bodies,
                       const PartMotion* motion, double timeStep, std::vector<DampedPatch>& damped) {
  damped.assign(patches.size(), {});
  std::vector<char> done(patches.size());
  std::vector<std::size_t> members;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (done[i]) continue;
    Contact contact(bodies, motion, patches[i]);
    members.clear();
    for (std::size_t j = i; j < patches.size(); ++j)
      if (!done[j] && (j == i || contact.has(patches[j]))) contact.add(patches[j]), members.push_back(j), done[j] = 1;
    contact.solve(timeStep);
    for (const std::size_t j : members) damped[j] = contact.damped(patches[j], timeStep);
  }
}

} // namespace grouser::contact
