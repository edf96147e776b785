// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/record_setup.hpp"

#include "base/table.hpp"
#include "runs/scene/scene.hpp"

#include <fmt/format.h>

#include <utility>

namespace grouser::setup {

namespace {

std::vector<PlottedColumn> plottedColumns(const scene::Scene& scene) {
  std::vector<PlottedColumn> all;
  std::vector<base::Section> sections;
  if (scene.document && scene.document->root().has("output"))
    sections = scene.document->root().section("output").list("plot");
  for (std::size_t k = 0; k < scene.output.panels.size(); ++k) {
    const scene::PlotSection& plot = scene.output.panels[k];
    const std::string place = k < sections.size() ? fmt::format("{}: {}", sections[k].origin(), sections[k].path())
                                                  : fmt::format("{}: output.plot.{}", scene.file.string(), k);
    all.push_back({plot.x, place + ".x"});
    for (const std::string& y : plot.y) all.push_back({y, place + ".y"});
  }
  return all;
}

} // namespace

RecordSetup recordSetup(const scene::Scene& scene, Provenance provenance) {
  const scene::Output& o = scene.output;
  return {std::move(provenance),
          {scene.run.duration, scene.run.outputInterval, scene.run.frameInterval, scene.run.checkpointInterval},
          {o.record, o.frames, o.contactForces, o.grainsCsv, o.shoeForces, o.gearContacts, o.finalSurface, o.picture,
           o.pictureWidth, o.fieldsCell, o.fieldsLow, o.fieldsHigh, plottedColumns(scene)},
          drawnPlanes(scene)};
}

} // namespace grouser::setup
