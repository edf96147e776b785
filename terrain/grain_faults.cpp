// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grain_faults.hpp"

#include "terrain/grain_system.hpp"

#include <fmt/format.h>

namespace grouser::terrain {

void stopFor(std::uint64_t key, const GrainSystem& system) {
  const auto fault = static_cast<Fault>(key >> 56);
  const auto id = static_cast<std::uint32_t>(key & 0xFFFFFFFFFFFFFFull);
  const GrainConstants& c = system.constants;
  const GrainFields& f = system.arrays.fields();
  // Only the owner of the grain sets its position; the maximum over the ranks distributes it.
  const std::vector<std::uint32_t> ids = f.id.now.toHost(), ghost = system.ghostsOnHost();
  double found[4] = {-1e300, -1e300, -1e300, -1e300}; // position and speed
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] != id || ghost[i]) continue;
    const base::Vec3d x = c.scale.toMetres(f.position.now.at(i));
    found[0] = x.x, found[1] = x.y, found[2] = x.z, found[3] = norm(f.motion.now.at(i).velocity.xyz().as<double>());
  }
  system.comm.maximum(found, 4);
  const std::string where =
      fmt::format("step {}, time {:.6g} s: grain {} at ({:.6g}, {:.6g}, {:.6g}) m", system.steps,
                  static_cast<double>(system.steps) * c.model.timeStep, id, found[0], found[1], found[2]);
  switch (fault) {
  case Fault::overlap:
    throw GrainFault(
        fault, id,
        fmt::format("{} overlaps another grain by more than {:.3g} of its radius", where, c.model.maxOverlap),
        "use stiffer contacts (material stiffness) or a smaller time_step");
  case Fault::through:
    throw GrainFault(fault, id, where + " is about to pass through a rigid surface",
                     "use stiffer contacts (material stiffness) or a smaller time_step");
  case Fault::range:
    throw GrainFault(fault, id,
                     fmt::format("{} leaves the range of positions, {:.6g} m from the origin", where, c.scale.limit()),
                     "add a floor or walls that hold it");
  case Fault::speed:
    throw GrainFault(
        fault, id,
        fmt::format("{} moves at {:.4g} m/s, more than {} in one step", where, found[3],
                    c.model.complementarity ? "0.4 of the smallest radius" : "half the neighbour list's skin"),
        c.model.complementarity ? "use a smaller time_step" : "use a smaller time_step or a larger skin");
  default:
    throw GrainFault(fault, id, where + " has a velocity that is not a number", "use a smaller time_step");
  }
}

base::Cause GrainFault::causeOf(Fault fault) {
  switch (fault) {
  case Fault::overlap:
  case Fault::through:
    return base::Cause::excessiveOverlap;
  case Fault::range:
    return base::Cause::lostGrain;
  case Fault::speed:
    return base::Cause::fastGrain;
  default:
    return base::Cause::noNumber;
  }
}

} // namespace grouser::terrain
