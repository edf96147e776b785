// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/impact.hpp"

#include "base/math.hpp"
#include "base/sphere.hpp"
#include "contact/restitution.hpp"
#include "terrain/grains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

namespace grouser::studies {

using base::Vec3d;
using terrain::Grains;

namespace {

constexpr double kBallRadius = 0.005, kBallDensity = 2600;      // [m], [kg/m3]
constexpr double kBallStiffness = 1e5, kEffectiveModulus = 1e9; // [N/m], [Pa]
constexpr double kPairSpacing = 4 * kBallRadius;                // distance between two simultaneous collisions [m]
constexpr double kNever = std::numeric_limits<double>::infinity();

double mass() { return base::sphereMass(kBallDensity, kBallRadius); }
double effectiveMass(const ImpactCase& c) { return c.binary ? 0.5 * mass() : mass(); }
double effectiveRadius(const ImpactCase& c) { return c.binary ? 0.5 * kBallRadius : kBallRadius; }
double omega0(const ImpactCase& c) { return std::sqrt(kBallStiffness / effectiveMass(c)); }

contact::ContactLaw lawOf(const ImpactCase& c) {
  contact::ContactLaw law;
  law.attraction = !c.isClamped();
  law.hertz = !c.isLinear();
  if (c.isLinear()) {
    law.stiffness = kBallStiffness, law.damping = 2 * c.damping * omega0(c);
  } else {
    law.stiffness = 4.0 / 3 * kEffectiveModulus;
    law.rootDamping = 2 * c.damping * std::sqrt(2 * kEffectiveModulus);
  }
  return law;
}

/// Maximum overlap of the linear law [m]. The clamp does not change it, because it acts only during separation.
double deepestLinear(double omega, double zeta, double speed) {
  const double eta = zeta * omega;
  double time = 1 / eta; // zeta = 1
  if (zeta < 1) {
    const double w = omega * std::sqrt(1 - zeta * zeta);
    time = std::atan2(w, eta) / w;
  } else if (zeta > 1) {
    const double w = omega * std::sqrt(zeta * zeta - 1);
    time = std::atanh(w / eta) / w;
  }
  return speed / omega * std::exp(-eta * time);
}

/// CPU time of this thread.
double threadSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Simultaneous collisions. Collision i has the grain i, or the grains 2 i and 2 i + 1.
class Collisions {
public:
  /// `stepsBefore(i)`: number of steps before the first contact in collision i.
  template <class StepsBefore> Collisions(const ImpactCase& c, terrain::Precision precision, double timeStep, int count,
                                          const StepsBefore& stepsBefore)
      : binary_(c.binary), count_(static_cast<std::size_t>(count)) {
    terrain::GrainModel model;
    model.radius = kBallRadius, model.mass = mass(), model.timeStep = timeStep;
    model.law = lawOf(c), model.skin = 0.5, model.maxOverlap = 1, model.precision = precision;
    std::vector<terrain::GrainSpec> start;
    const auto side = static_cast<int>(std::ceil(std::sqrt(count)));
    for (int i = 0; i < count; ++i) {
      const double gap = stepsBefore(i) * timeStep * c.speed, a = (i % side) * kPairSpacing,
                   b = (i / side) * kPairSpacing;
      if (binary_) {
        start.push_back({{a, b, kBallRadius + 0.5 * gap}, {0, 0, -0.5 * c.speed}, {}});
        start.push_back({{a, b, -kBallRadius - 0.5 * gap}, {0, 0, 0.5 * c.speed}, {}});
      } else {
        start.push_back({{a, b, kBallRadius + gap}, {0, 0, -c.speed}, {}});
      }
    }
    terrain::Boundaries boundaries;
    if (!binary_) boundaries.walls = {{{0, 0, 1}, 0.0, model.law}};
    grains_ = std::make_unique<Grains>(base::cpuExec(1), model, boundaries, start);
    grains_->refreshNeighbours();
  }

  void step() {
    grains_->refreshNeighbours();
    grains_->step();
  }

  /// Reads the gap [m] and the approach speed [m/s] of each collision.
  void read(std::vector<double>& gap, std::vector<double>& speed) const {
    gap.resize(count_), speed.resize(count_);
    const std::size_t n = binary_ ? 2 * count_ : count_;
    height_.resize(n), velocity_.resize(n);
    for (std::size_t slot = 0; slot < n; ++slot) {
      const std::size_t id = grains_->view().id[slot];
      height_[id] = grains_->scale().toMetres(grains_->view().position[slot]).z;
      velocity_[id] = static_cast<double>(grains_->view().motion[slot].velocity.z);
    }
    for (std::size_t i = 0; i < count_; ++i) {
      gap[i] = binary_ ? height_[2 * i] - height_[2 * i + 1] - 2 * kBallRadius : height_[i] - kBallRadius;
      speed[i] = binary_ ? velocity_[2 * i + 1] - velocity_[2 * i] : -velocity_[i];
    }
  }

private:
  bool binary_;
  std::size_t count_;
  std::unique_ptr<Grains> grains_;
  mutable std::vector<double> height_, velocity_;
};

/// Observer of one collision.
class Observed {
public:
  bool over() const { return ended_ >= 0; }
  double steps() const { return ended_ - began_; } ///< duration [steps]
  double deepest() const { return deepest_; }      ///< [m]
  double rebound() const { return rebound_; }      ///< [m/s]

  /// Processes step s, in which gap and speed change from (gap0, speed0) to (gap1, speed1).
  void see(std::int64_t s, double gap0, double speed0, double gap1, double speed1, bool clamped) {
    if (over()) return;
    const double at = static_cast<double>(s);
    if (gap0 > 0 && gap1 <= 0) began_ = at + gap0 / (gap0 - gap1);
    deepest_ = std::max(deepest_, -gap1);
    rebound_ = -speed1;
    if (began_ < 0) return;
    if (speed1 != speed0) {
      if (pull_.empty()) firstForce_ = at;
      pull_.push_back(speed0 - speed1);
    }
    if (gap0 <= 0 && gap1 > 0)
      ended_ = clamped && !pull_.empty() ? firstForce_ + static_cast<double>(pull_.size() - 1) + untilNoForce()
                                         : at + gap0 / (gap0 - gap1);
  }

private:
  /// Number of steps, at most 1, from the last force to the zero of a parabola through this force and two earlier ones.
  /// The three forces are sqrt(steps) apart, because differences of neighbouring float velocities are noise.
  double untilNoForce() const {
    const std::size_t n = pull_.size();
    const auto k = std::max<std::size_t>(1, static_cast<std::size_t>(std::sqrt(static_cast<double>(n))));
    if (n < 2 * k + 1) return 1;
    const double apart = static_cast<double>(k), f0 = pull_[n - 1], f1 = pull_[n - 1 - k], f2 = pull_[n - 1 - 2 * k];
    const double c = (f0 - 2 * f1 + f2) / (2 * apart * apart), b = (f0 - f1) / apart + c * apart;
    const double root = b * b - 4 * c * f0;
    return root > 0 && b < 0 ? std::min(1.0, 2 * f0 / (std::sqrt(root) - b)) : 1;
  }

  double began_ = -1, ended_ = -1; ///< [steps]
  double deepest_ = 0, rebound_ = 0;
  std::vector<double> pull_; ///< speed change in each step with a force [m/s]
  double firstForce_ = 0;    ///< number of the first step with a force
};

} // namespace

std::string ImpactCase::name() const {
  const char* const laws[] = {"linear free", "linear clamped", "Hertz free", "Hertz clamped"};
  return fmt::format("{}, {}, {} {:.4g}", binary ? "binary" : "plane", laws[static_cast<int>(law)],
                     isLinear() ? "zeta" : "beta", damping);
}

const char* impactQuantityName(int quantity) {
  const char* const names[] = {"restitution", "duration", "overlap", "all"};
  return names[quantity];
}

const char* precisionName(terrain::Precision precision) {
  return precision == terrain::Precision::single ? "single" : "double";
}

ImpactReference impactReference(const ImpactCase& c) {
  ImpactReference r;
  auto& [restitution, duration, overlap] = r.value;
  if (c.isLinear()) {
    const double omega = omega0(c);
    r.contactTime = base::kPi / omega, r.stableStep = contact::stableStep(omega, c.damping);
    overlap = c.damping == 0 ? c.speed / omega : deepestLinear(omega, c.damping, c.speed);
    if (c.damping >= 1 && !c.isClamped()) return r; // overdamped: the bodies never separate
    restitution = contact::restitutionOf(c.damping, !c.isClamped());
    duration = contact::contactDuration(omega, c.damping, !c.isClamped());
    return r;
  }
  const contact::HertzImpact elastic =
      contact::hertzImpact(kEffectiveModulus, effectiveRadius(c), effectiveMass(c), c.speed);
  r.contactTime = elastic.duration, r.stableStep = kNever;
  restitution = contact::hertzRestitutionOf(c.damping, !c.isClamped());
  if (c.damping == 0) duration = elastic.duration, overlap = elastic.deepest;
  return r;
}

int expectedOrder(const ImpactCase& c, int) { return c.damping == 0 ? 2 : 1; }

namespace {

/// Adds the errors of `phases` collisions at one step size to `point`, weighted with `share`.
void addCollisions(const ImpactCase& c, terrain::Precision precision, const ImpactReference& reference,
                   double stepsPerContact, int phases, double share, ImpactPoint& point) {
  const double timeStep = reference.contactTime / stepsPerContact;
  Collisions collisions(c, precision, timeStep, phases, [&](int i) { return 1 + (i + 0.5) / phases; });
  std::vector<Observed> observed(static_cast<std::size_t>(phases));
  std::vector<double> gap0, speed0, gap1, speed1;
  collisions.read(gap0, speed0);
  const bool ends = reference.value[kRestitution].has_value();
  const bool endsWithForce =
      c.isClamped() && c.damping > 0; // the end of an elastic contact is more accurate from the overlap
  // Contacts that never end are observed past the maximum overlap. Of all others, the slowest takes 2.3 contact times.
  const auto longest = static_cast<std::int64_t>((ends ? 8 : 1) * stepsPerContact) + 8;
  for (std::int64_t s = 0; s < longest; ++s) {
    collisions.step();
    collisions.read(gap1, speed1);
    bool allOver = true;
    for (std::size_t i = 0; i < observed.size(); ++i) {
      observed[i].see(s, gap0[i], speed0[i], gap1[i], speed1[i], endsWithForce);
      allOver = allOver && observed[i].over();
    }
    if (allOver) break;
    std::swap(gap0, gap1), std::swap(speed0, speed1);
  }
  for (int q = 0; q < kImpactQuantities; ++q) {
    const auto k = static_cast<std::size_t>(q);
    if (!reference.value[k]) continue;
    const double exact = *reference.value[k], unit = q == kRestitution ? 1 : exact;
    ImpactError& error = point.error[k];
    for (const Observed& o : observed) {
      const double measured[] = {o.rebound() / c.speed, o.steps() * timeStep, o.deepest()};
      // Contacts longer than eight contact times count as stuck: zero rebound speed, infinite duration.
      const double value = q == kDuration && !o.over() ? kNever : q == kRestitution && !o.over() ? 0 : measured[q];
      error.worst = std::max(error.worst, std::fabs(value - exact) / unit);
      error.mean += (value - exact) / unit * share;
      point.measured[k] += value * share;
    }
  }
}

} // namespace

ImpactPoint measureImpact(const ImpactCase& c, terrain::Precision precision, double stepsPerContact,
                          const ImpactPhases& phases) {
  const ImpactReference reference = impactReference(c);
  ImpactPoint point;
  point.steps = stepsPerContact, point.timeStep = reference.contactTime / stepsPerContact;
  point.stable = point.timeStep < reference.stableStep;
  if (!point.stable) return point;
  for (int k = 0; k < phases.leaving; ++k)
    addCollisions(c, precision, reference, stepsPerContact + static_cast<double>(k) / phases.leaving, phases.touching,
                  1.0 / (phases.touching * phases.leaving), point);
  return point;
}

void timeImpact(const ImpactCase& c, terrain::Precision precision, int collisions, int repeats, ImpactPoint& point) {
  if (!point.stable) return;
  const ImpactReference reference = impactReference(c);
  const double contact = reference.value[kDuration].value_or(reference.contactTime);
  const auto steps = static_cast<std::int64_t>(std::ceil(contact / point.timeStep)) + 1;
  std::vector<double> seconds;
  for (int k = 0; k < repeats; ++k) {
    Collisions batch(c, precision, point.timeStep, collisions, [&](int i) { return (i + 0.5) / collisions; });
    const double begin = threadSeconds();
    for (std::int64_t s = 0; s < steps; ++s) batch.step();
    seconds.push_back((threadSeconds() - begin) / collisions);
  }
  point.microseconds = 1e6 * jobs::medianOf(seconds);
  point.least = 1e6 * *std::min_element(seconds.begin(), seconds.end());
}

support::LineFit measuredOrder(const ImpactSeries& series, int quantity) {
  std::vector<double> step, error;
  for (const ImpactPoint& p : series.points) {
    const double worst = p.error[static_cast<std::size_t>(quantity)].worst;
    if (!p.stable || p.steps < kFitFrom || worst < kRoundOffFloor || !std::isfinite(worst)) continue;
    step.push_back(p.timeStep), error.push_back(worst);
  }
  return support::fitPower(step, error);
}

const ImpactPoint* cheapestImpact(const ImpactSeries& series, int quantity, double tolerance) {
  const ImpactReference reference = impactReference(series.study);
  const ImpactPoint* best = nullptr;
  for (std::size_t left = series.points.size(); left > 0; --left) {
    const ImpactPoint& p = series.points[left - 1];
    if (!p.stable) break;
    for (int q = 0; q < kImpactQuantities; ++q) {
      const auto k = static_cast<std::size_t>(q);
      if ((quantity == q || quantity == kImpactQuantities) && reference.value[k] && !(p.error[k].worst <= tolerance))
        return best;
    }
    best = &p;
  }
  return best;
}

} // namespace grouser::studies
