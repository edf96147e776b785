// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grain_forces.hpp"

#include "base/for_each.cuh"

#include <algorithm>
#include <stdexcept>

namespace grouser::terrain {

namespace {

/// Computes the velocity change of each grain in the last step.
struct AddVelocityChange {
  const Motion *now, *before;
  const std::uint32_t* ghost; ///< null without ghosts
  base::FixedPoint scale;     ///< quanta of one grain's change [m/s]
  std::int64_t* sum;
  GROUSER_HD void operator()(int i) const {
    if ((ghost && ghost[i]) || isFixed(now[i].velocity)) return;
    base::atomicAdd64(sum,
                      scale.quantise(norm(now[i].velocity.xyz().as<double>() - before[i].velocity.xyz().as<double>())));
  }
};

struct MeasureContactForce {
  static constexpr double kNanoseconds = 200;
  const Motion *now, *before;
  const Remainders* remainders; ///< remainders of `now`
  base::Vec3d gravityStep;      ///< g dt [m/s]
  double timeStep;
  double mass;               ///< mass of every grain [kg], or 0
  const double* massPerCube; ///< if mass is 0: [materials] mass / radius^3
  base::Vec3f* force;
  GROUSER_HD void operator()(int i) const {
    if (isFixed(now[i].velocity)) { // the step does not sum the load of fixed grains
      force[i] = {};
      return;
    }
    const base::Vec3f v = now[i].velocity.xyz(), was = before[i].velocity.xyz();
    base::Vec3d change;
    for (int a = 0; a < 3; ++a) {
      const double remainder = lowRemainder(remainders[i].axis[a]) * remainderQuantum(v[a]);
      change[a] = static_cast<double>(v[a]) + remainder - static_cast<double>(was[a]);
    }
    const double r = static_cast<double>(now[i].velocity.w);
    const double m = mass > 0 ? mass : massPerCube[static_cast<int>(now[i].spin.w)] * r * r * r;
    force[i] = ((change - gravityStep) * (m / timeStep)).as<float>();
  }
};

} // namespace

double forceRatio(const GrainSystem& system) {
  const GrainModel& model = system.constants.model;
  const double weightChange = norm(model.gravity) * model.timeStep;
  if (!(weightChange > 0)) return 0;
  // The range covers impacts of many thousand g, and 1e12 grains.
  const base::FixedPoint scale = base::fixedPointFor(weightChange, 24);
  base::Array<std::int64_t> sum(system.exec, std::vector<std::int64_t>{0});
  const GrainField<Motion>& motion = system.arrays.fields().motion;
  base::forEach(system.exec, "measure unrest", static_cast<std::int64_t>(system.arrays.slots()),
                AddVelocityChange{motion.now.data(), motion.next.data(), system.ghosts(), scale, sum.data()});
  std::int64_t total = sum.toHost().front();
  system.comm.sum(&total, 1);
  return scale.checked(total, "changes of velocity") / weightChange /
         static_cast<double>(std::max<std::size_t>(1, system.present() - system.fixedCount));
}

std::vector<base::Vec3f> contactForces(const GrainSystem& system) {
  if (!system.arrays.knowsFormerMotion())
    throw std::logic_error("contact forces are available only directly after a step");
  const GrainConstants& c = system.constants;
  const GrainFields& f = system.arrays.fields();
  base::Array<base::Vec3f> force(system.exec, system.arrays.slots());
  base::forEach(system.exec, "measure contact forces", static_cast<std::int64_t>(system.arrays.slots()),
                MeasureContactForce{f.motion.now.data(), system.arrays.formerMotion(), f.remainders.now.data(),
                                    c.model.gravity * c.model.timeStep, c.model.timeStep,
                                    c.manyRadii() ? 0 : c.model.mass, system.laws.massPerCube(), force.data()});
  return force.toHost();
}

} // namespace grouser::terrain
