// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/check.hpp"

#include "base/error.hpp"
#include "runs/campaigns/sweeps/check_beds.hpp"
#include "runs/campaigns/sweeps/check_choice.hpp"
#include "runs/campaigns/sweeps/check_report.hpp"
#include "runs/campaigns/sweeps/check_series.hpp"
#include "runs/campaigns/sweeps/kept_checks.hpp"
#include "runs/campaigns/sweeps/overrides.hpp"
#include "runs/campaigns/sweeps/run_manifest.hpp"
#include "runs/campaigns/sweeps/scene_check.hpp"
#include "runs/output/plots.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/support/file_hash.hpp"
#include "runs/support/hdf5_file.hpp"
#include "runs/support/json_text.hpp"
#include "runs/support/output_place.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stopwatch.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <utility>

namespace grouser::sweeps {

namespace {

namespace fs = std::filesystem;
using output::RunStatus;

/// With nothing drawn that nobody will look at; what is asked for stays.
std::vector<std::string> quiet(std::vector<std::string> overrides) {
  for (const std::string set : {"output.frames=false", "output.picture=false", "output.plots=false"})
    if (std::none_of(overrides.begin(), overrides.end(),
                     [&](const std::string& given) { return keyOf(given) == keyOf(set); }))
      overrides.push_back(set);
  return overrides;
}

/// One check, from its options to its files.
class Check {
public:
  Check(const fs::path& file, const CheckOptions& options)
      : options_(options), fixed_(quiet(options.fixed)), scene_(setup::loadScene(file, fixed_)) {
    checkScene(scene_);
    origin_ = checkOrigin(scene_, setup::inputsOf(scene_));
    if (scene_.run.seed > std::numeric_limits<std::int64_t>::max() - options.seeds)
      throw base::InputError(
          fmt::format("run.seed = {}: has no {} seeds after it; choose a smaller one", scene_.run.seed, options.seeds));
    record_.folder = options.sweep.folder, record_.scene = file.string(), record_.origin = support::hashOfText(origin_);
    record_.cases = checkCases(file, fixed_, scene_);
    keepAxes();
    record_.runs.plan.scene = file, record_.runs.plan.keys = {kCaseKey, kSeedKey};
  }

  void run() {
    const CheckChoice choice = choose();
    for (std::size_t c = 0; c < record_.cases.cases.size(); ++c)
      for (int s = 0; s < choice.seeds[c]; ++s) addRun(c, s);
    record_.beyondBudget = choice.beyondBudget;
    make("check");
    report();
  }

private:
  void keepAxes() {
    if (options_.axes.empty()) return;
    const auto unwanted = [this](CheckAxis axis) {
      return axis != CheckAxis::base &&
             std::find(options_.axes.begin(), options_.axes.end(), axis) == options_.axes.end();
    };
    std::erase_if(record_.cases.cases, [&](const CheckCase& c) { return unwanted(c.axis); });
    std::erase_if(record_.cases.omitted, [&](const CheckOmission& o) { return unwanted(o.axis); });
    for (const CheckAxis axis : kCheckAxes)
      if (unwanted(axis)) record_.cases.omitted.push_back({axis, "not among --axes"});
  }

  /// Which runs are to be made: as this very check chose before, or by what the first run takes.
  CheckChoice choose() {
    if (options_.budget.empty()) return chooseRuns(record_.cases, options_.seeds, std::nullopt, {}, 1);
    const nlohmann::json asked = {{"origin", record_.origin},
                                  {"budget", options_.budget},
                                  {"seeds", options_.seeds},
                                  {"cases", record_.cases.cases.size()},
                                  {"jobs", options_.sweep.jobs}};
    const fs::path file = record_.folder / kCheckChoice;
    std::ifstream former(file);
    const nlohmann::json kept = nlohmann::json::parse(former, nullptr, false);
    std::optional<CheckChoice> choice;
    if (kept.is_object() && kept.value("asked", nlohmann::json()) == asked && !options_.sweep.force)
      choice = keptChoice(kept.value("choice", nlohmann::json()), record_.cases, std::max(options_.seeds, kFewSeeds));
    if (!choice) {
      CheckBeds beds(record_.runs.plan.scene, fixed_, record_.cases);
      const RunCosts costs = pilot(beds);
      choice = chooseRuns(record_.cases, options_.seeds, budgetSeconds(options_.budget), costs, options_.sweep.jobs);
      const nlohmann::json made = {
          {"asked", asked}, {"run_s", costs.run}, {"settling_s", costs.settling}, {"choice", choiceJson(*choice)}};
      support::replaceTextFile(file, support::jsonText(made, 1) + "\n");
    }
    fmt::print("budget    {}: the runs chosen take about {}{}\n", options_.budget,
               support::Progress::duration(choice->seconds), leftOutText(*choice));
    return *choice;
  }

  std::string leftOutText(const CheckChoice& choice) const {
    std::string names;
    for (const std::size_t c : choice.beyondBudget)
      names += (names.empty() ? "; left out: " : ", ") + record_.cases.cases[c].name;
    return names;
  }

  /// Makes a run of the base, and returns what runs cost by it. Of the seeds that are run in any case it takes one
  /// whose bed no run has kept, so that it settles its bed as other cases will theirs.
  RunCosts pilot(CheckBeds& beds) {
    const int few = record_.cases.seeded ? std::min(options_.seeds, kFewSeeds) : 1;
    int seed = 0;
    while (seed < few && beds.keptSteps(0, seed)) ++seed;
    const bool settles = seed < few;
    if (!settles) seed = 0;
    addRun(0, seed);
    make("check, first run");
    const fs::path folder = record_.folder / record_.runs.plan.runs[0].name;
    const RunManifest manifest(folder);
    const double wall = manifest.wallTime();
    if (!output::hasEnded(record_.outcomes[0].status) || !std::isfinite(wall)) throwBaseFailed();
    made_.push_back(record_.runs.plan.runs[0].name);
    record_.runs = {{record_.runs.plan.scene, record_.runs.plan.keys, {}}, {}, {}, {}};

    const auto part = [&](const char* name) {
      return std::max(0.0, std::isfinite(manifest.figure(name)) ? manifest.figure(name) : 0);
    };
    RunCosts costs;
    costs.settling = part("wall_settling_s");
    costs.run = std::max(1e-3, wall - costs.settling - part("wall_cutting_s")); // spheres are cut once for all runs
    // Of a kept bed only its steps are known.
    if (!settles) costs.settling = 1e-6 * part("microseconds_a_step") * static_cast<double>(*beds.keptSteps(0, 0));
    costs.beds = beds.numbers();
    costs.isKept = [&beds, seed, settles](int bed, int of) {
      const bool justMade = settles && bed == 0 && of == seed; // no gift
      return !justMade && beds.keptSteps(bed, of).has_value();
    };
    return costs;
  }

  void addRun(std::size_t c, int seedIndex) {
    SweepRun run;
    const std::int64_t seed = scene_.run.seed + seedIndex;
    const CheckCase& one = record_.cases.cases[c];
    run.name = record_.cases.seeded ? fmt::format("{},seed={}", one.name, seed) : one.name;
    run.values = {one.name, fmt::format("{}", seed)};
    run.overrides = fixed_;
    for (const std::string& o : one.overrides) putOverride(run.overrides, o);
    putOverride(run.overrides, fmt::format("run.seed={}", seed));
    run.scene = setup::loadScene(record_.runs.plan.scene, run.overrides);
    record_.runs.plan.runs.push_back(std::move(run));
    record_.runs.caseOf.push_back(c), record_.runs.seedOf.push_back(seed);
  }

  void make(const std::string& what) {
    SweepOptions sweep = options_.sweep;
    sweep.made = made_;
    if (!options_.budget.empty()) { // what the first run did not tell must not cost more than was asked
      const double left = std::max(1e-3, budgetSeconds(options_.budget) - clock_.seconds());
      sweep.seconds = sweep.seconds > 0 ? std::min(sweep.seconds, left) : left;
    }
    record_.outcomes = runMissing(record_.runs.plan, sweep, what, [](const std::vector<SweepOutcome>&) {});
    record_.runs.series.assign(record_.outcomes.size(), {});
    for (std::size_t r = 0; r < record_.outcomes.size(); ++r)
      if (output::hasEnded(record_.outcomes[r].status)) read(r);
  }

  /// What a run wrote over time. One whose files are damaged has failed, and is made again by a call that finds it so.
  void read(std::size_t r) {
    const fs::path folder = record_.folder / record_.runs.plan.runs[r].name;
    try {
      RunSeries series = readSeries(folder);
      if (!hasPartInSeries(record_.cases.cases[record_.runs.caseOf[r]])) series.keepEnd();
      support::Hdf5File::open(folder / "results.h5");
      record_.runs.series[r] = std::move(series);
    } catch (const std::exception& error) {
      record_.outcomes[r] = {RunStatus::failed, fmt::format("its results are damaged: {}; the same call again makes "
                                                            "them anew",
                                                            error.what())};
      std::error_code none;
      fs::remove(folder / "manifest.json", none);
    }
  }

  /// True where the base has a run that ended.
  bool hasBase() const {
    for (std::size_t r = 0; r < record_.outcomes.size(); ++r)
      if (record_.runs.caseOf[r] == 0 && output::hasEnded(record_.outcomes[r].status)) return true;
    return false;
  }

  [[noreturn]] void throwBaseFailed() const {
    std::string why;
    for (std::size_t r = 0; r < record_.outcomes.size(); ++r)
      if (record_.runs.caseOf[r] == 0) why = record_.outcomes[r].message;
    throw base::SimulationError(fmt::format("no run of the scene as it is has ended: {}", why));
  }

  void report() {
    if (!hasBase()) {
      const bool failed = std::any_of(record_.outcomes.begin(), record_.outcomes.end(),
                                      [](const SweepOutcome& o) { return o.status == RunStatus::failed; });
      if (failed) throwBaseFailed();
      return fmt::print("check     no run of the scene as it is has ended yet; the same call again goes on\n");
    }
    const CheckResults results =
        checkResults(record_.cases, record_.runs, record_.outcomes, record_.folder, options_.percent);
    record_.costs = costsOf(record_);
    const auto write = [&](const char* name, const std::string& text) {
      support::replaceTextFile(record_.folder / name, text);
    };
    if (!results.doubt.empty()) fmt::print("WARNING: all figures are inconclusive: {}\n", results.doubt);
    const std::string json = checkJson(record_, results);
    write(kCheckFile, json), write(kCheckCosts, costsJson(record_, results));
    write(kCheckSeries, seriesCsv(checkSeries(record_.cases, record_.runs, record_.outcomes)));
    fmt::print("{}\n", checkText(record_, results));
    if (options_.sweep.plot)
      output::drawPicture("check.py", {record_.folder / kCheckFile, record_.folder / kCheckCosts},
                          record_.folder / kCheckPlot);
    for (const char* name : {kCheckFile, kCheckSeries, kCheckCosts})
      fmt::print("{:<9} {}\n", "check", (record_.folder / name).string());
    fmt::print("{:<9} `grouser report {}` makes one page of it\n", "report", record_.folder.string());
    const auto finished = std::count_if(record_.outcomes.begin(), record_.outcomes.end(),
                                        [](const SweepOutcome& o) { return output::hasEnded(o.status); });
    keepCheck(origin_, json, static_cast<int>(finished), record_.folder);
    if (results.skin == SameBits::no)
      throw base::SimulationError(
          "another run.skin gave other bits: this is a fault of the program; please report it with the scene");
  }

  const CheckOptions& options_;
  const support::Stopwatch clock_;
  const std::vector<std::string> fixed_;
  const scene::Scene scene_;
  std::string origin_;            ///< checkOrigin()
  std::vector<std::string> made_; ///< names of runs that this call has made
  CheckRecord record_;
};

} // namespace

void runCheck(const fs::path& scene, const CheckOptions& options) {
  if (!options.budget.empty()) budgetSeconds(options.budget);
  support::requireFolder(options.sweep.folder);
  if (!options.sweep.force) checkFolderOfCheck(options.sweep.folder);
  Check(scene, options).run();
}

} // namespace grouser::sweeps
