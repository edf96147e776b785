// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/events/event_forecast.hpp"

#include "base/counted.hpp"
#include "runs/campaigns/forecast/counted_grains.hpp"
#include "runs/campaigns/forecast/forecast.hpp"
#include "runs/campaigns/sweeps/overrides.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/setup/time_scales.hpp"
#include "runs/support/progress.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::events {

namespace {

constexpr double kStepH200 = 161e-6, kMore = 0.43e-9;              // s per step, s per further grain
constexpr double kGrainsH200 = 285'000, kSettling = 1, kBegin = 5; // -, s, s per process

/// Scene to probe for a run: its scene, or only the bed if obstacles are in the bed, which copied tiles do not support.
scene::Scene probedScene(const EventPlan& plan, const sweeps::SweepRun& run, const std::vector<std::string>& sets) {
  std::vector<std::string> bed;
  for (const std::string& set : sets)
    if (!set.starts_with("box.") && !set.starts_with("cylinder.")) bed.push_back(set);
  const bool alone = plan.course.granular() && bed.size() < sets.size();
  return setup::loadScene(alone ? sceneOf(Event::motionResistance) : run.file, alone ? bed : sets);
}

double h200Time(double grains, double duration, double step) {
  const double each = kStepH200 + kMore * std::max(0.0, grains - kGrainsH200);
  return kBegin + (duration + kSettling) / step * each;
}

std::string timeText(double seconds) {
  return seconds < 5400 ? fmt::format("{:.0f} min", seconds / 60) : fmt::format("{:.1f} h", seconds / 3600);
}

} // namespace

std::vector<EventTime> timesOf(const EventPlan& plan, const std::filesystem::path& folder) {
  std::vector<EventTime> times;
  support::Progress progress("probing");
  double steps = 0, output = 0, preparation = 0; // probed times [s]: per step and grain, per run, per grain of the bed
  for (std::size_t i = 0; i < plan.trials.size(); ++i) {
    const PlannedTrial& planned = plan.trials[i];
    const sweeps::SweepRun& run = plan.sweep.runs[planned.runs.front()];
    std::vector<std::string> sets = run.overrides;
    const double duration = run.expectedEnd;
    sweeps::putOverride(sets, fmt::format("run.duration={:.6g}", duration));
    const scene::Scene scene = setup::loadScene(run.file, sets);
    const double step = setup::chooseTimeStep(scene);
    const forecast::CountedGrains counted = forecast::countGrains(scene, step, 0);
    const double grains = static_cast<double>(counted.grains), work = std::max(1.0, grains);
    if (times.empty() || times.back().event != planned.event) {
      progress.update(static_cast<double>(i) / static_cast<double>(plan.trials.size()),
                      std::string(base::wordOf(planned.event)));
      const scene::Scene probed = probedScene(plan, run, sets);
      const forecast::CountedGrains ofProbe = forecast::countGrains(probed, step, 0);
      const double workOfProbe = std::max(1.0, static_cast<double>(ofProbe.grains));
      const forecast::Forecast predicted = forecast::forecastOf(probed, ofProbe, {folder, 1, true});
      steps = forecast::Forecast::sum(predicted.steps) / (duration / step) / workOfProbe;
      output = forecast::Forecast::sum(predicted.output);
      preparation = forecast::Forecast::sum(predicted.preparation) / workOfProbe;
      times.push_back({planned.event, 0, 0, 0, 0});
    }
    EventTime& time = times.back();
    const auto runs = static_cast<double>(planned.runs.size());
    const double here = steps * work * duration / step + output + preparation * work;
    time.runs += static_cast<int>(planned.runs.size()), time.grains = std::max(time.grains, grains);
    time.here += runs * here;
    time.h200 += runs * (plan.course.granular() ? h200Time(grains, duration, step) : here);
  }
  progress.finish(base::counted(times.size(), "event"));
  return times;
}

std::string timesText(const std::vector<EventTime>& times) {
  std::string text = fmt::format("{:<18}{:>6}{:>12}{:>14}{:>14}\n", "event", "runs", "grains", "here", "one H200");
  EventTime sum;
  for (const EventTime& t : times) {
    text += fmt::format("{:<18}{:>6}{:>12.0f}{:>14}{:>14}\n", base::wordOf(t.event), t.runs, t.grains, timeText(t.here),
                        timeText(t.h200));
    sum.runs += t.runs, sum.here += t.here, sum.h200 += t.h200;
  }
  text += fmt::format("{:<18}{:>6}{:>12}{:>14}{:>14}\n", "all", sum.runs, "", timeText(sum.here), timeText(sum.h200));
  text += "here: runs in sequence on all cores of this machine. H200: estimated from the step times in "
          "docs/evidence/paper.md and docs/evidence/speed.md;\nruns without grains use the CPU in both cases.\n";
  return text;
}

} // namespace grouser::events
