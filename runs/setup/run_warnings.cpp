// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/run_warnings.hpp"

#include "runs/setup/drive_length.hpp"
#include "runs/setup/free_surface_notes.hpp"
#include "runs/setup/mechanism_setup.hpp"
#include "runs/setup/vehicle_surroundings.hpp"

#include <utility>

namespace grouser::setup {

std::vector<Notice> noticesOf(const scene::Scene& scene, const coupling::Simulation& simulation) {
  using enum Notice::Weight;
  std::vector<Notice> notices;
  const auto add = [&notices](Notice::Weight weight, std::string text) {
    if (!text.empty()) notices.push_back({weight, std::move(text)});
  };
  add(warning, shortDriveWarning(scene));
  for (const std::string& text : vehicleWarnings(scene)) add(warning, text);
  for (const spheredecomp::CutReport& cut : coupling::cutReports(simulation))
    add(warning, spheredecomp::protrusionWarning(cut));
  for (const std::string& text : meshNotes(scene)) add(note, text);
  for (const std::string& text : freeSurfaceNotes(scene)) add(note, text);
  add(warning, movingSurfacesWarning(scene));
  add(note, bedWallsNote(scene));
  if (!simulation.mechanism()) return notices;
  add(warning, tensionStepWarningAtStart(scene, simulation.timeStep()));
  add(note, springStepNote(scene));
  return notices;
}

} // namespace grouser::setup
