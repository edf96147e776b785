// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/body_probes.hpp"

#include "base/sphere.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace grouser::coupling {

using base::Vec3d;

std::vector<double> grainMassIn(const std::vector<BodyProbe>& probes, const multibody::State& state,
                                const terrain::Grains& grains, const base::Comm& comm) {
  const terrain::GrainModel& model = grains.model();
  const terrain::GrainState rows = grains.state();
  const base::PositionScale scale = grains.scale();
  std::vector<double> density = model.materials.density;
  if (density.empty()) density = {model.mass / base::sphereVolume(model.radius)};
  const auto massOf = [&](std::size_t k) {
    return base::sphereMass(density[rows.material.empty() ? 0 : rows.material[k]],
                            rows.radius.empty() ? model.radius : double{rows.radius[k]});
  };
  // Integer quanta make the sum order-independent: the largest grain has 2^30 of them.
  const double quantum = std::ldexp(1.0, std::ilogb(model.mass) - 30);
  std::vector<std::int64_t> sums(probes.size());
  for (std::size_t k = 0; k < rows.rows(); ++k) {
    const Vec3d x = scale.toMetres(rows.position[k]);
    for (std::size_t p = 0; p < probes.size(); ++p) {
      const Vec3d d = state.pose[probes[p].body].toBody(x) - probes[p].position_B;
      const Vec3d& half = probes[p].half;
      if (std::fabs(d.x) <= half.x && std::fabs(d.y) <= half.y && std::fabs(d.z) <= half.z)
        sums[p] += std::llround(massOf(k) / quantum);
    }
  }
  comm.sum(sums.data(), sums.size());
  std::vector<double> masses;
  for (const std::int64_t sum : sums) masses.push_back(static_cast<double>(sum) * quantum);
  return masses;
}

} // namespace grouser::coupling
