// SPDX-License-Identifier: BSD-3-Clause
#include "fluid/fluid_faults.hpp"

#include "base/error.hpp"
#include "base/position.hpp"
#include "fluid/fluid_view.hpp"

#include <fmt/format.h>

#include <cmath>

namespace grouser::fluid {

const FluidModel& checkedModel(const FluidSetup& setup) {
  const FluidModel& m = setup.model;
  const auto need = [](bool holds, const char* what) {
    if (!holds) throw base::InputError(std::string("fluid: ") + what);
  };
  need(m.dimensions == 2 || m.dimensions == 3, "dimensions must be 2 or 3");
  need(m.spacing > 0 && m.density > 0 && m.soundSpeed > 0 && m.timeStep > 0,
       "spacing, density, sound speed and time step must be above 0");
  need(m.smoothing >= 1 && m.smoothing <= 3, "the smoothing length must be 1 to 3 spacings");
  need(m.viscosity >= 0 && m.artificialViscosity >= 0 && m.diffusion >= 0 && m.shifting >= 0,
       "viscosity, artificial viscosity, diffusion and shifting must not be negative");
  need(std::isfinite(base::norm(m.gravity)) && std::isfinite(m.attraction) && std::isfinite(m.timeStep) &&
           std::isfinite(setup.surfaceDivergence),
       "gravity, attraction, time step and surface divergence must be finite");
  need(!setup.particles.empty(), "there are no particles");
  const double reach = m.kernel().support() + m.skin(), limit = base::positionScale(m.kernel().support()).limit();
  need(!(setup.periodHigh.z > setup.periodLow.z), "boundaries along z cannot be periodic");
  for (int a = 0; a < 2; ++a) {
    const double period = setup.periodHigh[a] - setup.periodLow[a];
    need(!(period > 0) || period >= 3 * reach, "periodic boundaries must be at least three times the reach of the "
                                               "neighbour lists apart (support plus 0.3 spacings)");
  }
  const auto inRange = [&setup, limit](const base::Vec3d& p) {
    for (int a = 0; a < 3; ++a) {
      const double low = setup.periodLow[a], high = setup.periodHigh[a];
      if (!(std::abs(p[a]) < limit) || (high > low && !(p[a] >= low && p[a] <= high))) return false;
    }
    return true;
  };
  std::size_t bodyMarkers = 0;
  for (const FluidBody& b : setup.bodies) {
    bodyMarkers += b.markers.size();
    for (const base::Vec3d& p : b.markers)
      need(inRange(b.start.pose.toWorld(p)), "a body lies outside the periodic boundaries or the range of positions");
  }
  need(setup.particles.size() + setup.markers.size() + bodyMarkers < std::size_t{1} << 31,
       "2^31 or more particles and markers");
  for (const WallMarker& w : setup.markers) {
    need(inRange(w.position), "a marker lies outside the periodic boundaries or the range of positions");
    need(base::norm(w.velocity) < m.greatestSpeed(), "a wall moves faster than sound");
  }
  for (const FluidParticle& p : setup.particles) {
    need(inRange(p.position), "a particle lies outside the periodic boundaries or the range of positions");
    need(std::abs(p.compression) < kMaxCompression && base::norm(p.velocity) < m.greatestSpeed(),
         "a particle starts faster than sound or too compressed");
  }
  return m;
}

std::string faultText(std::uint64_t fault, const FluidModel& model, std::int64_t step, const FluidParticle& particle) {
  const auto text = [&]() -> std::string {
    switch (static_cast<FluidFault>(fault >> 32)) {
    case FluidFault::speed:
      return fmt::format("moves at {:.4g} m/s, faster than sound ({:.4g} m/s)", norm(particle.velocity),
                         model.soundSpeed);
    case FluidFault::compression:
      return fmt::format("is {} by {:.1f} %, more than {:.0f} %", particle.compression > 0 ? "compressed" : "stretched",
                         100 * std::abs(particle.compression), 100 * kMaxCompression);
    case FluidFault::displacement:
      return "moved by more than half the skin of the neighbour lists in one step";
    case FluidFault::range:
      break;
    }
    return "left the walls or the range of positions";
  };
  const bool lost = static_cast<FluidFault>(fault >> 32) == FluidFault::range;
  const base::Vec3d& r = particle.position;
  return fmt::format("step {}, time {:.4g} s: fluid particle {} at ({:.4g}, {:.4g}, {:.4g}) m {}; {}", step,
                     static_cast<double>(step) * model.timeStep, static_cast<std::uint32_t>(fault), r.x, r.y, r.z,
                     text(), lost ? "close the gap in the walls" : "use a smaller time step or a higher sound speed");
}

std::string bodyFaultText(const std::string& name, double way, const FluidModel& model, std::int64_t step) {
  return fmt::format(
      "step {}, time {:.4g} s: {} moves by up to {:.3g} m in one step, more than {:.3g} m, half the skin "
      "of the neighbour lists of the fluid; use a smaller time step, or limit its drive",
      step, static_cast<double>(step) * model.timeStep, name, way, 0.5 * model.skin());
}

} // namespace grouser::fluid
