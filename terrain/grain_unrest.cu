// SPDX-License-Identifier: BSD-3-Clause
// How far the forces on the grains are from balance.
#include "base/fixed_point.hpp"
#include "base/for_each.cuh"
#include "terrain/grains.hpp"

#include <algorithm>
#include <vector>

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

double Grains::forceRatio() const {
  const double weightChange = norm(model_.gravity) * model_.timeStep;
  if (!(weightChange > 0)) return 0;
  // A grain that hits at many thousand g still fits, and a million million of them.
  const base::FixedPoint scale = base::fixedPointFor(weightChange, 24);
  base::Array<std::int64_t> sum(exec_, std::vector<std::int64_t>{0});
  base::forEach(exec_, "measure unrest", static_cast<std::int64_t>(slots_),
                AddVelocityChange{velocity_[0].data(), velocity_[1].data(), ghosts(), scale, sum.data()});
  std::int64_t total = sum.toHost().front();
  comm_.sum(&total, 1);
  return scale.checked(total, "changes of velocity") / weightChange /
         static_cast<double>(std::max<std::size_t>(1, count_));
}

} // namespace grouser::terrain
