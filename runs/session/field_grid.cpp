// SPDX-License-Identifier: BSD-3-Clause
#include "runs/session/field_grid.hpp"

#include "base/error.hpp"
#include "runs/output/field_datasets.hpp"
#include "runs/setup/field_checks.hpp"

#include <fmt/format.h>

namespace grouser::session {

using base::Vec3d;

namespace {

struct Box {
  Vec3d low, high;
};

/// Bounding box of the grains on all ranks.
Box boxAround(const terrain::Grains& grains) {
  const terrain::GrainSnapshot mine = grains.snapshot();
  constexpr double kFar = 1e300;
  Box box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (std::size_t i = 0; i < mine.position.size(); ++i) {
    const double r = mine.radius.empty() ? grains.model().radius : static_cast<double>(mine.radius[i]);
    box.low = base::min(box.low, mine.position[i] - Vec3d{r, r, r});
    box.high = base::max(box.high, mine.position[i] + Vec3d{r, r, r});
  }
  const base::Comm& comm = grains.system().comm;
  for (const Box& other : comm.gatherValue(box))
    box.low = base::min(box.low, other.low), box.high = base::max(box.high, other.high);
  return box;
}

/// Grid of the frames of a resumed run. The first rank reads the file and broadcasts the grid: it opens the file for
/// writing soon after, while a slower rank would still read.
std::optional<terrain::FieldGrid> formerGrid(const std::filesystem::path& folder, const base::Comm& comm) {
  std::vector<terrain::FieldGrid> found;
  if (comm.first())
    if (const std::optional<terrain::FieldGrid> grid = output::formerFieldGrid(folder)) found.push_back(*grid);
  found = base::Comm::valuesOf<terrain::FieldGrid>(comm.broadcast(base::Comm::bytesOf(found)));
  return found.empty() ? std::nullopt : std::optional(found.front());
}

} // namespace

std::optional<terrain::FieldGrid> fieldGridOf(const setup::OutputSetup& output, const terrain::Grains& grains,
                                              const terrain::PeriodicBoundaries& periodic,
                                              const std::optional<std::filesystem::path>& former) {
  if (!output.fieldsCell) return {};
  const double edge = *output.fieldsCell;
  if (output.fieldsLow) return terrain::fieldGrid(*output.fieldsLow, *output.fieldsHigh, edge, periodic);
  Box box;
  const std::optional<terrain::FieldGrid> kept = former ? formerGrid(*former, grains.system().comm) : std::nullopt;
  if (kept) {
    Vec3d size;
    for (int a = 0; a < 3; ++a) size[a] = kept->cell[a] * kept->cells[static_cast<std::size_t>(a)];
    box = {kept->low, kept->low + size};
  } else {
    box = boxAround(grains);
    box.high.z += edge;
  }
  for (std::size_t a = 0; a < 2; ++a)
    if (periodic[a])
      box.low[static_cast<int>(a)] = (*periodic[a])[0], box.high[static_cast<int>(a)] = (*periodic[a])[1];
  terrain::FieldGrid grid = terrain::fieldGrid(box.low, box.high, edge, periodic);
  if (kept && grid.cells == kept->cells) grid.cell = kept->cell; // bitwise identical to the cell of earlier frames
  if (static_cast<double>(grid.count()) > setup::kMaxFieldCells)
    throw base::InputError(fmt::format("output.fields_cell = {} [m] results in {} cells around the grains, but at most "
                                       "{:g} are supported; use larger cells, or a box: fields_low, fields_high",
                                       edge, grid.count(), setup::kMaxFieldCells));
  return grid;
}

} // namespace grouser::session
