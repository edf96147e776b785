// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/precision_command.hpp"

#include "base/counted.hpp"
#include "runs/output/plots.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>

namespace grouser::studies {

void studyPrecisionCommand(const PrecisionCommand& command) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const auto folder = jobs::beginStudy("precision", command.place);
  const support::StopSignals signals;
  TouchStudy touch = command.touch;
  DriftStudy drift = command.drift;
  touch.threads = drift.threads = command.threads;
  fmt::print(
      "          radius 27 mm, 2500 kg/m3, 1e6 N/m, step 5e-5 s, 20 steps per contact; a bed dropped into a box, "
      "friction 0.5, restitution 0.5; a gas of elastic grains\n");

  support::Progress judging("deciding contacts");
  int judged = 0;
  const std::vector<TouchConfiguration> touches = studyTouch(touch, [&](const TouchConfiguration& c) {
    judging.update(static_cast<double>(++judged) / touch.configurations, fmt::format("step {}", c.step));
    jobs::stopStudyOnRequest();
  });
  judging.note(touchTable(touches, touch));
  judging.finish(fmt::format("{} configurations", touches.size()));
  support::Progress drifting("drifting");
  const auto update = [&drifting](double fraction, const std::string& what) { drifting.update(fraction, what); };
  const std::vector<Drift> drifts = studyDrift(drift, update);
  drifting.note(driftTable(drifts));
  drifting.finish(fmt::format("{} pairs of runs", drifts.size()));
  support::Progress many("running");
  const std::vector<MacroRow> macro =
      studyMacroscopic(drift, [&many](double fraction, const std::string& what) { many.update(fraction, what); });
  many.note(macroTable(macro, drift.runs));
  many.finish(base::counted(2 * drift.runs, "bed"));

  support::writeTextFile(folder / "touch.csv", touchCsv(touches), "--out");
  support::writeTextFile(folder / "drift.csv", driftCsv(drifts), "--out");
  support::writeTextFile(folder / "macroscopic.csv", macroCsv(macro), "--out");
  jobs::writeStudyOrigin(folder, "precision", std::chrono::duration<double>(Clock::now() - begin).count(),
                         {{"grains", touch.grains},
                          {"configurations", touch.configurations},
                          {"steps_between", touch.every},
                          {"drift_grains", drift.grains},
                          {"runs", drift.runs},
                          {"quick", command.place.quick}});
  output::drawPicture("study_precision.py", {folder / "touch.csv", folder / "drift.csv", folder / "macroscopic.csv"},
                      folder / "precision.png");
  fmt::print("tables    {}\n", folder.string());
}

} // namespace grouser::studies
