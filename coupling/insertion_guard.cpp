// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/insertion_guard.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

namespace grouser::coupling {

namespace {

/// "at (1, 2, 3) m".
std::string at(const base::Vec3d& p) { return fmt::format("at ({:.6g}, {:.6g}, {:.6g}) m", p.x, p.y, p.z); }

} // namespace

void guardInsertion(terrain::Grains& grains, const Sources& sources, const std::vector<std::string>& surfaces) {
  if (sources.empty()) return;
  grains.onInsertionOverlap([sources, surfaces, all = &grains](const terrain::InsertionOverlap& c) {
    std::size_t before = 0, source = 0;
    terrain::GrainSpec grain;
    for (const Sources::Batch& batch : sources.batchesAt(all->steps())) {
      if (c.entering >= before && c.entering < before + batch.grains.size())
        source = batch.source, grain = batch.grains[c.entering - before];
      before += batch.grains.size();
    }
    const std::string message =
        fmt::format("{} would insert a grain {} at step {}, time {:.6g} s, {:.3g} m deep in {}, more than {:g} of the "
                    "radius (run.max_overlap); insert it elsewhere (low, high) or later (start), or insert fewer, "
                    "less often or faster (number, every, velocity)",
                    sources.source(source).place, at(grain.position), all->steps(),
                    static_cast<double>(all->steps()) * all->model().timeStep, c.overlap,
                    c.grain ? fmt::format("grain {} {}", *c.grain, at(c.position)) : surfaces[c.surface],
                    all->model().maxEntryOverlap);
    if (all->steps() == 0) throw base::InputError(message);
    throw base::SimulationError(message);
  });
}

} // namespace grouser::coupling
