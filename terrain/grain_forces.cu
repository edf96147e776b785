// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grain_forces.hpp"

#include "base/for_each.cuh"

#include <algorithm>

namespace grouser::terrain {

namespace {

/// Adds up the change of velocity that each grain had in the last step.
struct AddVelocityChange {
  const Vec4f *now, *before;
  const std::uint32_t* ghost; ///< null where there are none
  base::FixedPoint scale;     ///< of one grain's [m/s]
  std::int64_t* sum;
  GROUSER_HD void operator()(int i) const {
    if (ghost && ghost[i]) return;
    base::atomicAdd64(sum, scale.quantise(norm(now[i].xyz().as<double>() - before[i].xyz().as<double>())));
  }
};

} // namespace

double forceRatio(const GrainSystem& system) {
  const GrainModel& model = system.constants.model;
  const double weightChange = norm(model.gravity) * model.timeStep;
  if (!(weightChange > 0)) return 0;
  // A grain that hits at many thousand g still fits, and a million million of them.
  const base::FixedPoint scale = base::fixedPointFor(weightChange, 24);
  base::Array<std::int64_t> sum(system.exec, std::vector<std::int64_t>{0});
  const GrainField<Vec4f>& velocity = system.arrays.fields().velocity;
  base::forEach(system.exec, "measure unrest", static_cast<std::int64_t>(system.arrays.slots()),
                AddVelocityChange{velocity.now.data(), velocity.next.data(), system.ghosts(), scale, sum.data()});
  std::int64_t total = sum.toHost().front();
  system.comm.sum(&total, 1);
  return scale.checked(total, "changes of velocity") / weightChange /
         static_cast<double>(std::max<std::size_t>(1, system.count));
}

} // namespace grouser::terrain
