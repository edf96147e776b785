// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/stability.hpp"

#include "multibody/detail/axis_springs.hpp"
#include "multibody/detail/index.hpp"
#include "multibody/detail/vector6.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace grouser::multibody::detail {

void axisStiffness(const ConstraintSystem& system, const Model& model, const Loads& loads,
                   std::vector<double>& stiffness) {
  for (std::size_t a = 0; a < stiffness.size(); ++a)
    stiffness[a] = ownSpring(system, model, loads, system.axes()[a]).stiffness;
  for (std::size_t s = 0; s < model.axisSprings().size(); ++s) {
    const AxisSpring& spring = model.axisSprings()[s];
    stiffness[at(system.axisOf(spring.joint, spring.axis))] += linearSpring(spring, loads.axisSprings[s]).stiffness;
  }
}

void stopStiffness(const ConstraintSystem& system, const Model& model, std::vector<double>& stiffness) {
  std::fill(stiffness.begin(), stiffness.end(), 0.0);
  for (const AxisSpring& spring : model.axisSprings())
    if (std::isfinite(spring.lowerLimit) || std::isfinite(spring.upperLimit))
      stiffness[at(system.axisOf(spring.joint, spring.axis))] += spring.stopStiffness;
}

void axisDamping(const ConstraintSystem& system, const Model& model, std::vector<double>& damping) {
  for (std::size_t a = 0; a < damping.size(); ++a) damping[a] = ownDamping(system, model, system.axes()[a]);
  for (const AxisSpring& spring : model.axisSprings())
    damping[at(system.axisOf(spring.joint, spring.axis))] += std::max(spring.damping, spring.stopDamping);
}

std::string springName(const ConstraintSystem& system, const Model& model, int axis) {
  const Axis& a = system.axes()[at(axis)];
  const Constraint& c = system.constraints()[at(a.constraint)];
  if (!isJoint(c.kind)) return system.describe(a.constraint, a.row);
  const AxisSpring* stiffest = nullptr;
  for (const AxisSpring& spring : model.axisSprings())
    if (system.axisOf(spring.joint, spring.axis) == axis && (!stiffest || spring.stiffness > stiffest->stiffness))
      stiffest = &spring;
  return stiffest ? "spring '" + stiffest->name + "'" : system.describe(a.constraint, a.row);
}

/// Computes the largest eigenvalue of A K, with K = sum of k j^T j over the rows j of the springs and the mobility A
/// under the constraints, by power iteration on the forces of the springs: f <- K^1/2 J A J^T K^1/2 f. The Rayleigh
/// quotient increases towards the eigenvalue. The initial force of each spring is proportional to its own frequency.
double highestFrequency(const ConstraintSystem& system, const ConstraintSystem::Part& part,
                        const std::vector<double>& stiffness, std::vector<Vector6>& x, int& axis) {
  axis = -1;
  std::vector<int> springs;
  for (const int k : part.constraints)
    for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a)
      if (stiffness[at(a)] > 0) springs.push_back(a);
  if (springs.empty()) return 0;

  std::vector<double> f(springs.size()), g(springs.size());
  const auto apply = [&] {
    for (const int node : part.bodies) x[at(node)] = {};
    for (const int k : part.constraints) x[at(system.movableBodies() + k)] = {};
    for (const int c : part.couplings) x[at(system.couplingNode(c))] = {};
    for (std::size_t i = 0; i < springs.size(); ++i) {
      const Axis& a = system.axes()[at(springs[i])];
      system.addImpulse(a.constraint, a.row, std::sqrt(stiffness[at(springs[i])]) * f[i], x);
    }
    system.solve(part, x);
    for (std::size_t i = 0; i < springs.size(); ++i) {
      const Axis& a = system.axes()[at(springs[i])];
      g[i] = std::sqrt(stiffness[at(springs[i])]) * system.rowTimes(a.constraint, a.row, x);
    }
  };
  // Alternating signs and different magnitudes, so that f is not orthogonal to the highest mode of springs in series.
  for (std::size_t i = 0; i < springs.size(); ++i)
    f[i] = (i % 2 == 0 ? 1.0 : -1.0) * (1 + 0.1 * static_cast<double>(i % 7));
  double highest = 0;
  constexpr int kIterations = 60;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    double size = 0;
    for (const double v : f) size += v * v;
    if (!(size > 0)) return 0;
    size = 1 / std::sqrt(size);
    for (double& v : f) v *= size;
    apply();
    double now = 0;
    for (std::size_t i = 0; i < f.size(); ++i) now += f[i] * g[i];
    const bool settled = std::fabs(now - highest) <= 1e-6 * now;
    highest = std::max(highest, now);
    std::swap(f, g);
    if (settled && iteration > 3) break;
  }
  double greatest = 0;
  for (std::size_t i = 0; i < f.size(); ++i)
    if (f[i] * f[i] > greatest) greatest = f[i] * f[i], axis = springs[i];
  return highest;
}

} // namespace grouser::multibody::detail
