// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grain_removal.hpp"

#include "base/sphere.hpp"

#include <algorithm>
#include <numeric>

namespace grouser::terrain {

namespace {

double massOf(const GrainState& state, std::size_t row, const GrainModel& model) {
  const double radius = state.radius.empty() ? model.radius : static_cast<double>(state.radius[row]);
  if (!state.material.empty()) return base::sphereMass(model.materials.density[state.material[row]], radius);
  const double share = radius / model.radius;
  return model.mass * share * share * share;
}

} // namespace

double removeGrains(Grains& grains, const std::vector<std::uint32_t>& ids) {
  GrainState state = grains.state();
  std::vector<double> mass(ids.size(), 0.0); // each mass is known to one rank only
  for (std::size_t k = 0; k < ids.size(); ++k) {
    const auto row = std::lower_bound(state.id.begin(), state.id.end(), ids[k]);
    if (row != state.id.end() && *row == ids[k])
      mass[k] = massOf(state, static_cast<std::size_t>(row - state.id.begin()), grains.model());
  }
  grains.system().comm.maximum(mass.data(), mass.size());
  state.remove(ids);
  grains.restore(state);
  return std::accumulate(mass.begin(), mass.end(), 0.0);
}

} // namespace grouser::terrain
