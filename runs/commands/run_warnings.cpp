// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/run_warnings.hpp"

#include "runs/scene/scene.hpp"
#include "runs/setup/drive_length.hpp"
#include "runs/setup/free_surface_notes.hpp"
#include "runs/setup/mechanism_setup.hpp"
#include "runs/setup/vehicle_surroundings.hpp"
#include "runs/support/tell.hpp"

namespace grouser::commands {

void warnOf(const scene::Scene& scene, const coupling::Simulation& simulation) {
  if (const std::string warning = setup::shortDriveWarning(scene); !warning.empty())
    support::tell("WARNING: {}\n", warning);
  for (const std::string& warning : setup::vehicleWarnings(scene)) support::tell("grouser: warning: {}\n", warning);
  for (const spheredecomp::CutReport& cut : coupling::cutReports(simulation))
    if (const std::string warning = spheredecomp::protrusionWarning(cut); !warning.empty())
      support::tell("WARNING: {}\n", warning);
  for (const std::string& note : setup::meshNotes(scene)) support::tell("grouser: note: {}\n", note);
  for (const std::string& note : setup::freeSurfaceNotes(scene)) support::tell("grouser: note: {}\n", note);
  if (!simulation.mechanism()) return;
  if (const std::string warning = setup::tensionStepWarningAtStart(scene, simulation.timeStep()); !warning.empty())
    support::tell("grouser: warning: {}\n", warning);
  if (const std::string note = setup::springStepNote(scene); !note.empty()) support::tell("grouser: note: {}\n", note);
}

} // namespace grouser::commands
