// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/record_setup.hpp"

#include "runs/scene/scene.hpp"

#include <utility>

namespace grouser::setup {

RecordSetup recordSetup(const scene::Scene& scene, Provenance provenance) {
  const scene::Output& o = scene.output;
  return {std::move(provenance),
          {scene.run.duration, scene.run.outputInterval, scene.run.frameInterval, scene.run.checkpointInterval},
          {o.record, o.frames, o.contactForces, o.grainsCsv, o.shoeForces, o.gearContacts, o.finalSurface, o.picture,
           o.pictureWidth, o.fieldsCell, o.fieldsLow, o.fieldsHigh},
          drawnPlanes(scene)};
}

} // namespace grouser::setup
