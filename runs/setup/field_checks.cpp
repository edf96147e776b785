// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/field_checks.hpp"

#include "runs/scene/scene.hpp"
#include "terrain/soil_fields.hpp"

#include <fmt/format.h>

namespace grouser::setup {

void checkFields(const scene::Scene& scene, const coupling::GroundSetup& ground) {
  const scene::Output& o = scene.output;
  if (!o.fieldsCell) return;
  const auto fail = [&](const std::string& message) { scene.fail("output", "fields_cell", message); };
  if (!ground.grains) fail("has no effect without grains; remove it");
  const coupling::GrainsSetup& grains = *ground.grains;
  const double diameter = 2 * grains.model.radius;
  if (*o.fieldsCell < diameter)
    fail(fmt::format("[m] is smaller than the largest grain diameter, {:.4g} m; use at least three diameters",
                     diameter));
  if (!o.fieldsLow && !grains.bed && grains.start.empty())
    fail("has no default box, since the scene has no grains at the start; set fields_low and fields_high");
  if (!o.fieldsLow) return;
  const auto cellsOf = [&](double edge) {
    const auto n = terrain::fieldGrid(*o.fieldsLow, *o.fieldsHigh, edge, {}).cells;
    return static_cast<double>(n[0]) * n[1] * n[2];
  };
  double larger = *o.fieldsCell;
  while (cellsOf(larger) > kMaxFieldCells) larger *= 1.1;
  if (larger > *o.fieldsCell)
    fail(fmt::format(
        "[m] divides the box into {:.3g} cells, but at most {:g} are supported; use {:.2g} m or more, or a smaller box",
        cellsOf(*o.fieldsCell), kMaxFieldCells, 1.05 * larger));
}

} // namespace grouser::setup
