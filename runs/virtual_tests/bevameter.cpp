// SPDX-License-Identifier: BSD-3-Clause
// `grouser soil`: runs the tests, in sequence or in parallel, and writes the results.
#include "runs/virtual_tests/bevameter.hpp"

#include "base/counted.hpp"
#include "base/error.hpp"
#include "runs/jobs/shared_work.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/not_written.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/tell.hpp"
#include "runs/support/text_file.hpp"
#include "runs/virtual_tests/preparation.hpp"
#include "runs/virtual_tests/scm_fit.hpp"
#include "runs/virtual_tests/soil_report.hpp"
#include "runs/virtual_tests/test_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>

namespace grouser::virtual_tests {

namespace {

constexpr double kPorosityNoted = 0.01; // larger deviations cause a warning

/// The device, chosen by the process that uses it.
class Device {
public:
  explicit Device(const jobs::PieceOptions& options, int jobs) : options_(options), threads_(options.threads) {
    if (jobs > 1) threads_ = std::max(1, options.threads / jobs);
  }
  const base::Exec& exec() {
    if (!exec_) exec_ = support::chooseDevice(support::deviceChoice(options_.device), threads_, nullptr);
    return *exec_;
  }

private:
  jobs::PieceOptions options_;
  int threads_;
  std::optional<base::Exec> exec_;
};

/// Finds the preparation unless it is stored, and applies it. `part`: of this call, as concurrent parts all search for
/// it.
void prepare(TestPlan& plan, jobs::Pieces& pieces, Device& device, int jobs, std::string part) {
  if (!plan.soil.porosity) return;
  const std::string name = plan.preparationName();
  std::replace(part.begin(), part.end(), '/', '_');
  if (!pieces.has(name)) {
    support::Progress progress("preparing");
    const auto work = [&](std::size_t) {
      const auto folder = pieces.begin(part.empty() ? name : name + "_of_part_" + part);
      const jobs::Table trials = findPreparation(plan, folder, device.exec(), [&](const std::string& what) {
        progress.update(0, what); // only one process works, this one or a child
      });
      try {
        pieces.keep(name, trials);
      } catch (const support::NotWritten&) {
        if (!pieces.has(name)) throw; // else another part was faster, with the same result
      }
      std::filesystem::remove_all(folder);
    };
    // In a child process if others follow: no process may be forked after threads have started.
    jobs::shareWork(jobs > 1 ? 2 : 1, 1, work, [] {});
    progress.finish("friction for the porosity found");
  }
  const std::vector<double> trial = nearestTrial(pieces.read(name).rows, *plan.soil.porosity);
  plan.grains.preparationFriction = trial[0];
  if (std::fabs(trial[1] - *plan.soil.porosity) > kPorosityNoted)
    support::tell("WARNING: the beds have a porosity of {:.4f}, the closest value to that of the soil ({:g}) which "
                  "these grains can reach; change bed.porosity or bed.radius_spread of the soil\n",
                  trial[1], *plan.soil.porosity);
  fmt::print("          settling friction {:.4g}, resulting porosity {:.4f}\n", trial[0], trial[1]);
}

void printHead(const TestPlan& plan) {
  const TestedSoil& s = plan.soil;
  fmt::print("          {}{}\n", s.title.empty() ? s.name : s.title,
             plan.options.coarse ? "; coarse settings (--quick): small plates of few grains, pushed fast" : "");
  fmt::print("          grains of {:g} mm +- {:g} %, plates of {:g} and {:g} d ({:.3g} and {:.3g} m), shear under {} "
             "loads; {}, {} for the large plate\n",
             2e3 * s.grainRadius, 100 * s.spread, plan.small.strip.breadth, plan.large.strip.breadth,
             plan.breadth(TestKind::small), plan.breadth(TestKind::large), plan.options.loads.size(),
             base::counted(plan.options.seeds, "seed"), plan.options.largeSeeds);
  if (!s.isCalibrated())
    fmt::print("          note: parameters are scaled from grains of {:g} mm; they are calibrated for radii of {:g} to "
               "{:g} mm\n",
               2e3 * s.fileRadius, 1e3 * s.calibratedFrom, 1e3 * s.calibratedTo);
  std::fflush(stdout);
}

constexpr auto kAgain = "_shorter_steps"; // folder suffix of a repeated test

/// Performs a test, and repeats it with shorter steps if it fails, e.g. by an unstable contact in one of many samples.
/// Empty at the time limit; the next call then starts with shorter steps.
std::optional<jobs::Table> soundTest(const TestPlan& plan, const PlannedTest& test, jobs::Pieces& pieces,
                                     const base::Exec& exec,
                                     const std::function<void(double, const std::string&)>& tell) {
  const std::filesystem::path shorter = noteFile(pieces, test, TestNote::shorterSteps);
  if (!std::filesystem::exists(shorter)) {
    const std::filesystem::path folder = pieces.begin(test.name);
    try {
      return doTest(plan, test, folder, folder.parent_path(), exec, tell);
    } catch (const base::SimulationError& e) {
      support::replaceTextFile(shorter, e.what());
    }
    if (!pieces.inTime(test.name)) return {};
  }
  TestPlan again = plan;
  again.grains.stepsPerContact *= kShorterSteps;
  const std::filesystem::path folder = pieces.begin(test.name + kAgain);
  return doTest(again, test, folder, folder.parent_path(), exec, tell);
}

} // namespace

int doTests(TestPlan& plan, jobs::Pieces& pieces, const jobs::PieceOptions& options, int jobs) {
  Device device(options, jobs);
  prepare(plan, pieces, device, jobs, options.part);
  std::vector<const PlannedTest*> due;
  double all = 0;
  for (const PlannedTest& test : plan.tests) {
    if (pieces.due(test.name)) due.push_back(&test);
    all += test.cost;
  }
  if (jobs > 1 && options.seconds <= 0) longestFirst(due); // with a time limit short ones may still fit
  support::Progress progress("testing");
  const auto there = [&] {
    double sum = 0;
    for (const PlannedTest& test : plan.tests) sum += pieces.has(test.name) ? test.cost : 0;
    return sum / all;
  };
  const double before = there();
  // Relative to the work of this call, for the remaining time.
  const auto share = [&](double now) { return before < 1 ? (now - before) / (1 - before) : 1; };
  const auto work = [&](std::size_t i) {
    const PlannedTest& test = *due[i];
    if (!pieces.inTime(test.name)) return;
    const std::filesystem::path unsound = noteFile(pieces, test, TestNote::unsound);
    const double now = there();
    const auto tell = [&](double done, const std::string& phase) {
      if (jobs == 1) progress.update(share(now + done * test.cost / all), test.name + ", " + phase);
    };
    try {
      const std::optional<jobs::Table> done = soundTest(plan, test, pieces, device.exec(), tell);
      if (!done) return;
      pieces.keep(test.name, *done);
    } catch (const base::SimulationError& e) {
      support::replaceTextFile(unsound, e.what()); // the others continue
      return;
    }
    const std::filesystem::path runs = pieces.folder() / "runs";
    std::filesystem::remove_all(runs / test.name), std::filesystem::remove_all(runs / (test.name + kAgain));
    std::filesystem::remove(unsound);
  };
  // A single test also runs in a child process: no process can be forked after CUDA has started in this one.
  jobs::shareWork(jobs > 1 ? std::clamp(static_cast<int>(due.size()), 2, jobs) : 1, due.size(), work,
                  [&] { progress.update(share(there()), jobs > 1 ? "several tests in parallel" : "test finished"); });
  int missing = 0;
  for (const PlannedTest& test : plan.tests) missing += !pieces.has(test.name);
  const bool isSheared = std::all_of(plan.tests.begin(), plan.tests.end(), [&](const PlannedTest& test) {
    return test.kind != TestKind::shear || pieces.has(test.name) ||
           std::filesystem::exists(noteFile(pieces, test, TestNote::unsound));
  });
  if (isSheared) removePoured(pieces.folder() / "runs");
  progress.finish(
      fmt::format("{} of {} tests finished", plan.tests.size() - static_cast<std::size_t>(missing), plan.tests.size()));
  return missing;
}

void soilCommand(const SoilCommand& command) {
  PlanOptions options = command.plan;
  options.coarse = command.place.quick;
  TestPlan plan = planOf(readTestedSoil(command.soil, command.grainRadius), options);
  jobs::StudyPlace place = command.place;
  if (place.folder.empty()) place.folder = "out/soil_" + plan.soil.name;
  jobs::Pieces pieces("soil " + plan.soil.name, place, command.pieces, plan.recipe());
  const support::StopSignals signals;
  printHead(plan);
  const int missing = doTests(plan, pieces, command.pieces, command.jobs);
  if (!pieces.whole()) return;
  reportSoil(plan, pieces, missing);
  if (command.fitScm) reportScmFit(plan, pieces);
  if (const auto unsound = notedTests(plan, pieces, TestNote::unsound); !unsound.empty())
    throw base::SimulationError("the tables are incomplete: " + failedTestsText(unsound));
}

} // namespace grouser::virtual_tests
