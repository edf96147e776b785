// SPDX-License-Identifier: BSD-3-Clause
#include "base/rounded.hpp"
#include "runs/commands/plan.hpp"
#include "runs/setup/complementarity_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::commands {

namespace {

/// Longest stable steps for the vehicle's own contacts, the shortest first.
std::string boundsText(const setup::StepLimit& limit) {
  std::vector<setup::StepLimit::Bound> bounds = limit.vehicle;
  std::stable_sort(bounds.begin(), bounds.end(), [](const auto& a, const auto& b) { return a.step < b.step; });
  const auto line = [](const std::string& what, const std::string& step) {
    return fmt::format("    {:<42} {}\n", what, step);
  };
  std::string text = "  stable steps of the vehicle\n";
  for (const setup::StepLimit::Bound& b : bounds) text += line(b.what, base::roundedDown(b.step, 3) + " s");
  return text + line("joints, torsion bars, tensioner", "any (implicit)");
}

} // namespace

std::string timeText(const scene::Scene& scene, const setup::StepLimit& limit, double step, double grains) {
  std::string text = "\ntime\n";
  const double contact = setup::shortestContact(scene);
  const double resolved = contact / scene.run.stepsPerContact;
  const bool implicit = setup::hasComplementarity(scene); // its steps do not resolve contacts
  if (contact > 0 && !implicit) {
    text += fmt::format("  {:<24} {:.4g} s\n", "shortest grain contact", contact);
    text += fmt::format("  {:<24} {:.4g} s ({:.0f} steps per contact)\n", "maximum time step", resolved,
                        scene.run.stepsPerContact);
  }
  const double steps = std::round(scene.run.duration / step);
  if (scene.run.tolerance) {
    text +=
        fmt::format("  {:<24} adaptive, error at most {:g} m or rad per second\n", "time step", *scene.run.tolerance);
  } else {
    text += fmt::format("  {:<24} {:.4g} s{}\n", "time step", step,
                        contact > 0 && !implicit ? fmt::format(", {:.1f} steps per contact", contact / step) : "");
    text += fmt::format("  {:<24} {:.0f} for {} s\n", "steps", steps, scene.run.duration);
  }
  if (scene.vehicle) text += boundsText(limit);
  if (grains > 0) text += fmt::format("  {:<24} {:.3g}\n", "grain steps", steps * grains);
  if (contact > 0 && !implicit && step > resolved * 1.0000001)
    text += fmt::format("\nWARNING: only {:.1f} time steps per contact; reduce run.time_step to {} s or less\n",
                        contact / step, base::roundedDown(resolved, 4));
  return text;
}

} // namespace grouser::commands
