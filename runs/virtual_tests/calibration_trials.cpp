// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/calibration_trials.hpp"

#include "base/error.hpp"
#include "runs/virtual_tests/test_notes.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::virtual_tests {

TestPlan CalibrationTrials::tested(const TestedSoil& soil, const std::string& name, const PlanOptions& options,
                                   const Wanted& wanted, SoilResults& results, const WhenDone& whenDone) {
  TestPlan plan = planOf(soil, options);
  plan.tests.erase(std::remove_if(plan.tests.begin(), plan.tests.end(), [&](const auto& t) { return !wanted(t); }),
                   plan.tests.end());
  jobs::PieceOptions pieceOptions = command_.pieces;
  pieceOptions.resume = true;
  if (command_.pieces.seconds > 0) {
    pieceOptions.seconds = command_.pieces.seconds - spent();
    if (pieceOptions.seconds <= 0) throw Unfinished{name, static_cast<int>(plan.tests.size())};
  }
  jobs::StudyPlace place = command_.place;
  place.folder = folder_ / name;
  jobs::Pieces pieces("soil " + soil.name + ", " + name, place, pieceOptions, plan.recipe());
  record_.begun();
  takeOver(soil, plan, pieces);
  if (const int missing = doTests(plan, pieces, pieceOptions, command_.jobs)) {
    if (const auto unsound = notedTests(plan, pieces, TestNote::unsound); !unsound.empty()) {
      record_.stopped(name, missing);
      throw base::SimulationError(fmt::format("trial {} produced no result: {}", name, failedTestsText(unsound)));
    }
    throw Unfinished{name, missing};
  }
  results = resultsOf(plan, pieces);
  if (whenDone) whenDone(plan, pieces);
  done_.push_back({soil.keys, plan.recipe(), pieces});
  return plan;
}

void CalibrationTrials::takeOver(const TestedSoil& soil, const TestPlan& plan, jobs::Pieces& pieces) const {
  for (const Done& trial : done_) {
    if (trial.keys != soil.keys || trial.recipe != plan.recipe()) continue;
    const auto take = [&](const std::string& name) {
      if (!pieces.has(name) && trial.pieces.has(name)) pieces.keep(name, trial.pieces.read(name));
    };
    take(plan.preparationName());
    for (const PlannedTest& test : plan.tests) {
      take(test.name);
      const std::filesystem::path note = noteFile(trial.pieces, test, TestNote::shorterSteps);
      if (std::filesystem::exists(note))
        std::filesystem::copy_file(note, noteFile(pieces, test, TestNote::shorterSteps),
                                   std::filesystem::copy_options::overwrite_existing);
    }
  }
}

double CalibrationTrials::spent() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

} // namespace grouser::virtual_tests
