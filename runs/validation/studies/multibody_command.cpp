// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/multibody_command.hpp"

#include "base/counted.hpp"
#include "base/error.hpp"
#include "runs/output/plots.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/text_file.hpp"
#include "runs/validation/studies/option_parts.hpp"
#include "runs/validation/studies/report.hpp"
#include "runs/validation/studies/stability.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

namespace grouser::studies {

namespace fs = std::filesystem;

namespace {

constexpr int kQuickSteps = 3; ///< number of step sizes with --quick
constexpr int kFullSteps = 7;  ///< number of step sizes; the first one is 4096 times the last one

} // namespace

void studyMultibodyCommand(const StudyCommand& command) {
  std::vector<StudyCase> cases = chosenCases(studyCases(), command.cases);
  if (command.cases.empty() && command.place.quick) std::erase_if(cases, [](const StudyCase& c) { return c.isLong; });
  const fs::path folder = jobs::beginStudy("multibody", command.place);
  fmt::print("          one thread; the CPU time includes the steps, but not set-up and output\n");

  const support::StopSignals signals;
  const int count = command.place.quick ? kQuickSteps : kFullSteps;
  const std::vector<IntegratorChoice> integrators = studyIntegrators();
  if (command.stability) {
    const std::vector<StabilityPoint> points = studyStability();
    fmt::print("{}", stabilityTable(points));
    support::writeTextFile(folder / "stability.csv", stabilityCsv(points), "--out");
    fmt::print("table     {}\n", (folder / "stability.csv").string());
    return;
  }
  support::Progress progress("studying");
  std::vector<StudyResult> results;
  double done = 0;
  for (const StudyCase& c : cases) {
    StudyResult result{c, {}};
    for (const IntegratorChoice& integrator : integrators) {
      progress.update(done / static_cast<double>(cases.size() * integrators.size()), c.name + ", " + integrator.name);
      for (const StudyPoint& p : studyOne(c, integrator, count, command.budget)) result.points.push_back(p);
      done += 1;
    }
    progress.note(caseTable(result));
    results.push_back(std::move(result));
  }
  progress.finish(base::counted(cases.size(), "case"));

  std::vector<ReactionResult> reactions;
  for (const ReactionCase& r : reactionCases()) {
    if (std::none_of(cases.begin(), cases.end(), [&](const StudyCase& c) { return c.name == r.name; }) &&
        !command.cases.empty())
      continue;
    for (const IntegratorChoice& integrator : integrators)
      if (integrator.order <= 2) reactions.push_back(measureReaction(r, integrator));
  }
  fmt::print("{}\n{}", cheapestTable(results), reactionTable(reactions));
  support::writeTextFile(folder / "multibody.csv", pointsCsv(results), "--out");
  support::writeTextFile(folder / "cheapest.csv", cheapestCsv(results), "--out");
  support::writeTextFile(folder / "reactions.csv", reactionsCsv(reactions), "--out");
  output::drawPicture("study.py", {folder / "multibody.csv"}, folder / "multibody.png");
  fmt::print("tables    {}\n", folder.string());
}

} // namespace grouser::studies
