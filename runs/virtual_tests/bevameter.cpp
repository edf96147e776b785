// SPDX-License-Identifier: BSD-3-Clause
// `grouser soil`: runs the tests, in sequence or in parallel, and writes the results.
#include "runs/virtual_tests/bevameter.hpp"

#include "base/counted.hpp"
#include "base/error.hpp"
#include "runs/jobs/shared_work.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/not_written.hpp"
#include "runs/support/print_stderr.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
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

constexpr double kPorosityNoted = 0.01; // a larger deviation of the bed from the soil's porosity causes a warning

/// The computing device; each process chooses its own when it first needs one.
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

/// Finds the settling friction for the soil's porosity, or reads it if it is stored, and adds it to the plan. `part`:
/// the --part of this call; it names a folder of its own, because concurrent parts all search for the friction.
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
        if (!pieces.has(name)) throw; // else another part has already stored the same result
      }
      std::filesystem::remove_all(folder);
    };
    // Runs in a child process if more child processes follow: no process may fork after it has started threads.
    jobs::shareWork(jobs > 1 ? 2 : 1, 1, work, [] {});
    progress.finish("found the settling friction");
  }
  const std::vector<double> trial = nearestTrial(pieces.read(name).rows, *plan.soil.porosity);
  plan.grains.preparationFriction = trial[0];
  if (std::fabs(trial[1] - *plan.soil.porosity) > kPorosityNoted)
    support::printStderr(
        "WARNING: the closest porosity that beds of these grains reach is {:.4f}, but the soil file requires "
        "{:g}; change bed.porosity or bed.radius_spread\n",
        trial[1], *plan.soil.porosity);
  fmt::print("          settling friction {:.4g}, resulting porosity {:.4f}\n", trial[0], trial[1]);
}

void printHead(const TestPlan& plan) {
  const TestedSoil& s = plan.soil;
  fmt::print("          {}{}\n", s.title.empty() ? s.name : s.title,
             plan.options.coarse ? "; coarse settings (--quick): plates only a few grains wide, pushed fast" : "");
  fmt::print("          grain diameter d = {:g} mm +- {:g} %; plate widths {:g} and {:g} d ({:.3g} and {:.3g} m); "
             "{} shear loads; {}, {} for the large plate\n",
             2e3 * s.grainRadius, 100 * s.spread, plan.small.strip.breadth, plan.large.strip.breadth,
             plan.breadth(TestKind::small), plan.breadth(TestKind::large), plan.options.loads.size(),
             base::counted(plan.options.seeds, "seed"), plan.options.largeSeeds);
  if (!s.isCalibrated())
    fmt::print("          note: contact parameters are scaled from a grain diameter of {:g} mm; they are calibrated "
               "for radii of {:g} to {:g} mm\n",
               2e3 * s.fileRadius, 1e3 * s.calibratedFrom, 1e3 * s.calibratedTo);
  std::fflush(stdout);
}

constexpr auto kAgain = "_shorter_steps"; // folder suffix of a repeated test

/// Performs a test, and repeats it with shorter steps if it fails, e.g. because one contact becomes unstable. Empty if
/// the time limit is reached before the repetition; the next call then starts with the shorter steps.
std::optional<jobs::Table> soundTest(const TestPlan& plan, const PlannedTest& test, jobs::Pieces& pieces,
                                     const base::Exec& exec,
                                     const std::function<void(double, const std::string&)>& report) {
  const std::filesystem::path shorter = noteFile(pieces, test, TestNote::shorterSteps);
  if (!std::filesystem::exists(shorter)) {
    const std::filesystem::path folder = pieces.begin(test.name);
    try {
      return doTest(plan, test, folder, folder.parent_path(), exec, report);
    } catch (const base::SimulationError& e) {
      support::replaceTextFile(shorter, e.what());
    }
    if (!pieces.inTime(test.name)) return {};
  }
  TestPlan again = plan;
  again.grains.stepsPerContact *= kShorterSteps;
  const std::filesystem::path folder = pieces.begin(test.name + kAgain);
  return doTest(again, test, folder, folder.parent_path(), exec, report);
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
  if (jobs > 1 && options.seconds <= 0) longestFirst(due); // not with a time limit, which short tests may still meet
  support::Progress progress("testing");
  const auto there = [&] {
    double sum = 0;
    for (const PlannedTest& test : plan.tests) sum += pieces.has(test.name) ? test.cost : 0;
    return sum / all;
  };
  const double before = there();
  // Completed share of the work of this call, from which the remaining time is estimated.
  const auto share = [&](double now) { return before < 1 ? (now - before) / (1 - before) : 1; };
  const auto work = [&](std::size_t i) {
    const PlannedTest& test = *due[i];
    if (!pieces.inTime(test.name)) return;
    const std::filesystem::path unsound = noteFile(pieces, test, TestNote::unsound);
    const double now = there();
    const auto report = [&](double done, const std::string& phase) {
      if (jobs == 1) progress.update(share(now + done * test.cost / all), test.name + ", " + phase);
    };
    try {
      const std::optional<jobs::Table> done = soundTest(plan, test, pieces, device.exec(), report);
      if (!done) return;
      pieces.keep(test.name, *done);
    } catch (const base::SimulationError& e) {
      support::replaceTextFile(unsound, e.what()); // the other tests continue
      return;
    }
    const std::filesystem::path runs = pieces.folder() / "runs";
    std::filesystem::remove_all(runs / test.name), std::filesystem::remove_all(runs / (test.name + kAgain));
    std::filesystem::remove(unsound);
  };
  // With --jobs, even a single test runs in a child process, because no process can fork after it has started CUDA.
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
