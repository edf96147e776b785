// SPDX-License-Identifier: BSD-3-Clause
// `grouser study impact`: collisions, steps, and files.
#include "contact/restitution.hpp"
#include "runs/output/plots.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/text_file.hpp"
#include "runs/validation/studies/impact_report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cmath>

namespace grouser::studies {

using terrain::Precision;

namespace {

/// Steps per contact over three decades, with a ratio of 1.8. They are not integers, so that the phase of separation
/// varies.
std::vector<double> stepCounts(bool quick) {
  std::vector<double> steps;
  for (int k = 0; k <= (quick ? 6 : 12); ++k) steps.push_back(4.7 * std::pow(1.8, k));
  return steps;
}

std::vector<ImpactCase> impactCases(bool quick) {
  // Damping ratios in the table of closed forms; four of them with --quick.
  const std::vector<double> zetas =
      quick ? std::vector<double>{0, 0.2, 1, 2}
            : std::vector<double>{0, 0.05, 0.1, 0.2, 0.3, 0.5, std::sqrt(0.5), 0.9, 1, 1.5, 2};
  std::vector<ImpactCase> cases;
  for (const bool binary : {false, true}) {
    for (const ImpactLaw law : {ImpactLaw::linearFree, ImpactLaw::linearClamped})
      for (const double zeta : zetas) {
        if (binary && zeta != 0 && zeta != 0.2 && zeta != 0.5) continue;
        cases.push_back({law, binary, zeta, 1});
      }
    cases.push_back({ImpactLaw::hertzFree, binary, 0, 1});
    cases.push_back({ImpactLaw::hertzFree, binary, contact::hertzDampingRatioFor(0.5, true), 1});
    cases.push_back({ImpactLaw::hertzClamped, binary, contact::hertzDampingRatioFor(0.5, false), 1});
  }
  return cases;
}

std::vector<ImpactSeries> overSpeeds(const ImpactCommand& command) {
  constexpr double kSteps = 49.35; // 4.7 x 1.8^4
  std::vector<ImpactSeries> all;
  for (const ImpactLaw law : {ImpactLaw::linearFree, ImpactLaw::linearClamped, ImpactLaw::hertzClamped})
    for (const double speed : {1e-3, 1e-2, 1e-1, 1.0, 10.0})
      for (const Precision precision : {Precision::single, Precision::double_}) {
        ImpactCase c{law, false, 0.2, speed};
        all.push_back({c, precision, {measureImpact(c, precision, kSteps, command.phases)}});
      }
  return all;
}

} // namespace

void studyImpactCommand(const ImpactCommand& command) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const auto folder = jobs::beginStudy("impact", command.place);
  const support::StopSignals signals;
  const bool quick = command.place.quick;
  const std::vector<double> steps = stepCounts(quick);
  const std::vector<ImpactCase> cases = impactCases(quick);
  fmt::print(
      "          radius 5 mm, 2600 kg/m3; linear 1e5 N/m, Hertz E_eff 1 GPa; 1 m/s; one thread; steps: number per "
      "undamped contact; {} phases of first contact, {} phases of separation\n          CPU time: {} "
      "simultaneous collisions, median of {} repetitions\n",
      command.phases.touching, command.phases.leaving, command.collisions, command.repeats);
  support::Progress progress("studying");
  std::vector<ImpactSeries> all;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (const Precision precision : {Precision::single, Precision::double_}) {
      progress.update(static_cast<double>(i) / static_cast<double>(cases.size()), cases[i].name());
      ImpactSeries series{cases[i], precision, {}};
      for (const double n : steps) {
        series.points.push_back(measureImpact(cases[i], precision, n, command.phases));
        timeImpact(cases[i], precision, command.collisions, command.repeats, series.points.back());
        jobs::stopStudyOnRequest();
      }
      all.push_back(std::move(series));
    }
    // Prints the most informative collisions; the file contains all collisions.
    if (cases[i].damping == 0 || cases[i].damping == 0.2 || !cases[i].isLinear())
      progress.note(impactTable(all[all.size() - 2], all.back()));
  }
  progress.finish(fmt::format("{} collisions", cases.size()));
  const std::vector<ConvergenceRow> convergence =
      convergenceRows(quick ? command.phases.touching : 5 * command.phases.touching);
  const std::vector<ImpactSeries> speeds = overSpeeds(command);
  fmt::print("{}{}{}{}{}{}", orderTable(all), cheapestImpactTable(all), convergenceTable(convergence),
             coarseTable(coarseRows(quick ? command.phases.touching : 5 * command.phases.touching)), speedTable(speeds),
             closedFormTable(all, steps.size() - (quick ? 1 : 5)));

  support::writeTextFile(folder / "impact.csv", impactCsv(all), "--out");
  support::writeTextFile(folder / "orders.csv", orderCsv(all), "--out");
  support::writeTextFile(folder / "cheapest.csv", cheapestImpactCsv(all), "--out");
  support::writeTextFile(folder / "convergence.csv", convergenceCsv(convergence), "--out");
  support::writeTextFile(folder / "speeds.csv", impactCsv(speeds), "--out");
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  jobs::writeStudyOrigin(folder, "impact", seconds,
                         {{"phases_of_first_touch", command.phases.touching},
                          {"phases_of_leaving", command.phases.leaving},
                          {"collisions_timed", command.collisions},
                          {"repeats", command.repeats},
                          {"threads", 1},
                          {"quick", quick}});
  output::drawPicture("study_impact.py", {folder / "impact.csv"}, folder / "impact.png");
  fmt::print("tables    {}\n", folder.string());
}

} // namespace grouser::studies
