// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/stability.hpp"

#include "base/error.hpp"
#include "coupling/mechanism.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/mechanism_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace grouser::studies {

namespace {

constexpr int kSteps = 3000;
constexpr double kAnyStep = std::numeric_limits<double>::infinity();

struct Choice {
  std::string name;
  multibody::Integrator integrator;
  multibody::Springs springs;
};
const std::vector<Choice> kChoices = {
    {"euler", multibody::Integrator::kSymplecticEuler, multibody::Springs::kImplicit},
    {"rattle2, springs implicit", multibody::Integrator::kRattle, multibody::Springs::kImplicit},
    {"rattle2, springs explicit", multibody::Integrator::kRattle, multibody::Springs::kExplicit}};

scene::Scene sceneOf(const scene::MechanismSections& sections, const Choice& choice, const base::Vec3d& gravity) {
  scene::Scene scene;
  scene.file = "study";
  scene.run.gravity = gravity;
  scene.run.integrator = choice.integrator, scene.run.springs = choice.springs;
  scene.mechanism = sections;
  scene.run.stepsPerPeriod = 2; // a low resolution, because only the stability matters
  return scene;
}

/// Runs a mechanism; the run is stable if `size` stays at or below `bound`.
void tryStep(const scene::Scene& scene, StabilityPoint& point,
             const std::function<double(const coupling::Mechanism&)>& size, double bound) {
  point.predicted = point.step < point.limit;
  try {
    coupling::Mechanism mechanism(setup::mechanismSetup(scene), point.step);
    for (int i = 0; i < kSteps && point.stable; ++i) {
      mechanism.advance();
      point.stable = size(mechanism) <= bound; // also false for NaN
    }
  } catch (const base::InputError&) {
    point.stable = false, point.refused = true;
  } catch (const base::SimulationError&) {
    point.stable = false;
  }
}

/// Trial steps: from 1e-6 s on, and around the limit.
std::vector<double> stepsFor(double limit, double longest) {
  std::vector<double> steps;
  for (const double s : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0})
    if (s <= longest) steps.push_back(s);
  if (std::isfinite(limit)) {
    std::erase_if(steps, [&](double s) { return s > 0.9 * limit; });
    for (const double share : {0.95, 1.05, 4.0}) steps.push_back(share * limit);
  }
  return steps;
}

void springs(std::vector<StabilityPoint>& points) {
  constexpr double kMass = 2, kStiffness = 200, kPull = 10;
  for (const double factor : {1e-3, 1.0, 1e3, 1e6}) {
    scene::MechanismSections m;
    scene::BodySection body;
    body.name = "block", body.mass = kMass, body.inertia = {0.1, 0.1, 0.1};
    m.bodies.push_back(body);
    scene::JointSection slide;
    slide.name = "slide", slide.type = multibody::JointType::kPrismatic, slide.bodies = {"world", "block"};
    slide.point = base::Vec3d{}, slide.axis = base::Vec3d{1, 0, 0};
    m.joints.push_back(slide);
    scene::SpringSection spring;
    spring.name = "spring", spring.joint = "slide", spring.stiffness = factor * kStiffness;
    m.springs.push_back(spring);
    const double omega = std::sqrt(spring.stiffness / kMass);
    for (const Choice& choice : kChoices) {
      const bool limited = choice.springs == multibody::Springs::kExplicit;
      const double limit = limited ? 2 / omega : kAnyStep;
      for (const double step : stepsFor(limit, 1)) {
        StabilityPoint p{fmt::format("spring x {:g}", factor), choice.name, limit, step};
        // The free oscillation reaches 2 kPull / k; twice this value is unstable.
        tryStep(
            sceneOf(m, choice, {kPull / kMass, 0, 0}), p,
            [](const coupling::Mechanism& now) { return std::fabs(now.state().pose[0].position.x); },
            4 * kPull / spring.stiffness + kPull / kMass * step * step);
        points.push_back(p);
      }
    }
  }
}

/// Highest frequency of small oscillations of a hanging chain [rad/s], by power iteration on M^-1 K. The links have the
/// mass m, the length l and the moment of inertia I about their centre; the coordinates are angles from the vertical.
double highestSwing(int n, double m, double l, double I, double tip, double g) {
  const auto at = [n](int i, int j) {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(n) + static_cast<std::size_t>(j);
  };
  std::vector<double> M(at(n, 0)), K(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    // Links below link i move with l theta_i; the centre of link i moves with l theta_i / 2.
    K[static_cast<std::size_t>(i)] = g * l * (0.5 * m + (n - 1 - i) * m + tip);
    for (int j = 0; j < n; ++j) {
      const int low = std::max(i, j);
      M[at(i, j)] = l * l * ((n - 1 - low) * m + tip + (i == j ? 0.25 * m : 0.5 * m)) + (i == j ? I : 0);
    }
  }
  // Cholesky factor of M.
  for (int j = 0; j < n; ++j)
    for (int i = j; i < n; ++i) {
      double sum = M[at(i, j)];
      for (int k = 0; k < j; ++k) sum -= M[at(i, k)] * M[at(j, k)];
      M[at(i, j)] = i == j ? std::sqrt(sum) : sum / M[at(j, j)];
    }
  std::vector<double> x(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) x[static_cast<std::size_t>(i)] = i % 2 ? -1 : 1;
  double value = 0;
  for (int iteration = 0; iteration < 500; ++iteration) {
    double norm = 0;
    for (int i = 0; i < n; ++i) x[static_cast<std::size_t>(i)] *= K[static_cast<std::size_t>(i)];
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < i; ++k) x[static_cast<std::size_t>(i)] -= M[at(i, k)] * x[static_cast<std::size_t>(k)];
      x[static_cast<std::size_t>(i)] /= M[at(i, i)];
    }
    for (int i = n - 1; i >= 0; --i) {
      for (int k = i + 1; k < n; ++k) x[static_cast<std::size_t>(i)] -= M[at(k, i)] * x[static_cast<std::size_t>(k)];
      x[static_cast<std::size_t>(i)] /= M[at(i, i)];
      norm = std::max(norm, std::fabs(x[static_cast<std::size_t>(i)]));
    }
    value = norm;
    for (double& entry : x) entry /= norm;
  }
  return std::sqrt(value);
}

void massRatios(std::vector<StabilityPoint>& points) {
  constexpr int kLinks = 10;
  constexpr double kLength = 0.15, kMass = 1, kInertia = 0.002, kGravity = 9.81, kTilt = 1e-3;
  for (const double ratio : {1.0, 1e2, 1e4, 1e6}) {
    scene::MechanismSections m;
    for (int i = 0; i <= kLinks; ++i) {
      const bool isTip = i == kLinks;
      scene::BodySection body;
      body.name = isTip ? "tip" : fmt::format("link {}", i), body.mass = isTip ? ratio * kMass : kMass;
      body.point = isTip;
      if (!isTip) body.inertia = {kInertia, kInertia, 2e-4};
      body.position = {0, 0, -(isTip ? kLinks : i + 0.5) * kLength};
      m.bodies.push_back(body);
      scene::JointSection pin;
      pin.name = fmt::format("pin {}", i),
      pin.type = isTip ? multibody::JointType::kSpherical : multibody::JointType::kRevolute;
      pin.bodies = {i == 0 ? "world" : fmt::format("link {}", i - 1), body.name};
      pin.point = base::Vec3d{0, 0, -i * kLength};
      if (!isTip) pin.axis = base::Vec3d{0, 1, 0};
      m.joints.push_back(pin);
    }
    const double limit = 2 / highestSwing(kLinks, kMass, kLength, kInertia, ratio * kMass, kGravity);
    for (const Choice& choice : {kChoices[0], kChoices[1]})
      for (const double step : stepsFor(limit, 1)) {
        StabilityPoint p{fmt::format("tip mass x {:g}", ratio), choice.name, limit, step};
        // The whole chain oscillates up to twice the tilt; the fastest mode is a zigzag with large pin angles.
        const auto widest = [](const coupling::Mechanism& now) {
          double angle = 0;
          for (const multibody::JointReading& joint : now.state().joint)
            angle = std::max(angle, std::fabs(joint.position));
          return angle;
        };
        tryStep(sceneOf(m, choice, {kTilt * kGravity, 0, -kGravity}), p, widest, 2.5 * kTilt);
        points.push_back(p);
      }
  }
}

void inertiaRatios(std::vector<StabilityPoint>& points) {
  constexpr double kSpin = 10; // [rad/s]
  for (const double ratio : {1.0, 10.0, 1e2, 1e4}) {
    scene::MechanismSections m;
    scene::BodySection body;
    body.name = "top", body.mass = 1, body.inertia = {1, ratio, ratio + 0.5};
    body.spin = base::Vec3d{1, 1, 1} * (kSpin / std::sqrt(3.0));
    m.bodies.push_back(body);
    // Without a theory, this is an empirical limit of the implicit gyroscopic equation: rotation per step.
    const double limit = (ratio <= 10 ? 1.0 : 0.1) / kSpin; // [rad] over [rad/s]
    const double start = 0.5 * kSpin * kSpin / 3 * (1 + 2 * ratio + 0.5);
    for (const Choice& choice : {kChoices[0], kChoices[1]})
      for (const double step : {1e-6, 1e-5, 1e-4, 1e-3, 0.5 * limit, 0.95 * limit}) {
        StabilityPoint p{fmt::format("moments 1 to {:g}", ratio), choice.name, limit, step};
        tryStep(
            sceneOf(m, choice, {}), p,
            [start](const coupling::Mechanism& now) { return std::fabs(now.bodiesBalance().now.kinetic / start - 1); },
            0.5);
        points.push_back(p);
      }
  }
}

std::string limitText(double limit) { return std::isfinite(limit) ? fmt::format("{:.4g}", limit) : "any"; }

} // namespace

std::vector<StabilityPoint> studyStability() {
  std::vector<StabilityPoint> points;
  springs(points);
  massRatios(points);
  inertiaRatios(points);
  return points;
}

std::string stabilityTable(const std::vector<StabilityPoint>& points) {
  std::string text = fmt::format("\nstability over {} steps: trial steps [s]; s: stable, u: unstable, r: rejected, "
                                 "reporting the limit; !: contradicts the prediction\n  {:<16} {:<26} {:>10}  steps\n",
                                 kSteps, "", "", "limit [s]");
  std::string former;
  int wrong = 0;
  for (const StabilityPoint& p : points) {
    const std::string line = fmt::format("  {:<16} {:<26} {:>10} ", p.what, p.integrator, limitText(p.limit));
    if (line != former) text += (former.empty() ? "" : "\n") + line;
    former = line;
    text += fmt::format(" {:.3g} {}{}", p.step, p.refused ? "r" : p.stable ? "s" : "u", p.agrees() ? "" : "!");
    wrong += !p.agrees();
  }
  return text +
         fmt::format("\n  {} of {} as predicted\n", points.size() - static_cast<std::size_t>(wrong), points.size());
}

std::string stabilityCsv(const std::vector<StabilityPoint>& points) {
  std::string text = "what,integrator,limit [s],step [s],predicted,found\n";
  for (const StabilityPoint& p : points)
    text += fmt::format("{},\"{}\",{},{},{},{}\n", p.what, p.integrator, limitText(p.limit), p.step,
                        p.predicted ? "stable" : "unstable",
                        p.refused  ? "refused"
                        : p.stable ? "stable"
                                   : "unstable");
  return text;
}

} // namespace grouser::studies
