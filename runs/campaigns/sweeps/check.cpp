// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/check.hpp"

#include "base/error.hpp"
#include "runs/campaigns/sweeps/check_beds.hpp"
#include "runs/campaigns/sweeps/check_choice.hpp"
#include "runs/campaigns/sweeps/check_goals.hpp"
#include "runs/campaigns/sweeps/check_report.hpp"
#include "runs/campaigns/sweeps/check_series.hpp"
#include "runs/campaigns/sweeps/check_work.hpp"
#include "runs/campaigns/sweeps/kept_checks.hpp"
#include "runs/campaigns/sweeps/overrides.hpp"
#include "runs/campaigns/sweeps/scene_check.hpp"
#include "runs/output/plots.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/support/json_text.hpp"
#include "runs/support/output_place.hpp"
#include "runs/support/progress.hpp"
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

/// Turns frames, pictures and plots off unless the overrides set them.
std::vector<std::string> quiet(std::vector<std::string> overrides) {
  for (const std::string set : {"output.frames=false", "output.picture=false", "output.plots=false"})
    if (std::none_of(overrides.begin(), overrides.end(),
                     [&](const std::string& given) { return keyOf(given) == keyOf(set); }))
      overrides.push_back(set);
  return overrides;
}

/// Runs of a check with --of at each look; stored in choice.json if there is a budget.
class GoalChoice {
public:
  RunCosts costs;
  std::vector<std::vector<int>> looks; ///< [looks][cases] seeds

  /// Restores the choice of an earlier call with the same options; false if it does not match these cases.
  bool restore(const nlohmann::json& kept, std::size_t cases, int most) {
    try {
      kept.at("run_s").get_to(costs.run), kept.at("settling_s").get_to(costs.settling);
      kept.at("looks").get_to(looks);
    } catch (const nlohmann::json::exception&) {
      looks.clear();
      return false;
    }
    const bool fit = std::all_of(looks.begin(), looks.end(), [&](const std::vector<int>& seeds) {
      return seeds.size() == cases &&
             std::all_of(seeds.begin(), seeds.end(), [&](int s) { return s >= 0 && s <= most; });
    });
    return fit && std::isfinite(costs.run) && costs.run > 0 && costs.settling >= 0;
  }
};

/// A check: runs, results and files.
class Check {
public:
  Check(const fs::path& file, const CheckOptions& options)
      : options_(options), fixed_(quiet(options.fixed)), scene_(setup::loadScene(file, fixed_)),
        work_(options_, fixed_, scene_.run.seed, record_) {
    checkScene(scene_);
    origin_ = checkOrigin(scene_, setup::inputsOf(scene_));
    if (scene_.run.seed > std::numeric_limits<std::int64_t>::max() - options.maxSeeds())
      throw base::InputError(fmt::format("run.seed = {}: too large, because {} more seeds follow; set a smaller seed",
                                         scene_.run.seed, options.maxSeeds()));
    record_.folder = options.sweep.folder, record_.scene = file.string(), record_.origin = originHash(origin_);
    record_.jobs = options.sweep.jobs;
    record_.cases = checkCases(file, fixed_, scene_, options.draws);
    keepAxes();
    record_.runs.plan.scene = file, record_.runs.plan.keys = {kCaseKey, kSeedKey};
    if (options.figures.empty()) return;
    keepGoalCases(record_.cases, options.axes);
    record_.looks = looksUpTo(options.maxSeeds(), record_.cases.seeded);
    if (scene_.vehicle) nameFigures(sweepFigures(planOf(scene_), {{}}, record_.folder).columns);
  }

  void run() {
    scene::printNotes(scene_);
    if (!options_.figures.empty()) return runToGoals();
    const CheckChoice choice = choose();
    record_.beyondBudget = choice.beyondBudget;
    work_.make(choice.seeds, "check");
    report();
  }

private:
  /// A plan of one run that is not performed; provides the names of the figures.
  static SweepPlan planOf(const scene::Scene& scene) {
    SweepPlan plan;
    plan.runs.emplace_back().scene = scene;
    return plan;
  }

  /// Translates the words of --of to the figure names of the runs.
  void nameFigures(const std::vector<std::string>& columns) {
    for (const std::string& word : options_.figures)
      if (const std::string name = goalFigure(word, columns);
          std::find(figures_.begin(), figures_.end(), name) == figures_.end())
        figures_.push_back(name);
  }

  void keepAxes() {
    if (options_.axes.empty()) return;
    if (options_.draws == 0 && std::count(options_.axes.begin(), options_.axes.end(), CheckAxis::parameter) > 0)
      throw base::InputError("--axes parameter: requires samples of the soil constants; add --draws 8");
    const auto unwanted = [this](CheckAxis axis) {
      return axis != CheckAxis::base && axis != CheckAxis::parameter && // requested by --draws
             std::find(options_.axes.begin(), options_.axes.end(), axis) == options_.axes.end();
    };
    std::erase_if(record_.cases.cases, [&](const CheckCase& c) { return unwanted(c.axis); });
    std::erase_if(record_.cases.omitted, [&](const CheckOmission& o) { return unwanted(o.axis); });
    for (const CheckAxis axis : kCheckAxes)
      if (unwanted(axis) && (axis != CheckAxis::nodeSpacing || scene_.deformable()))
        record_.cases.omitted.push_back({axis, "not among --axes"});
  }

  /// Settings on which the choice in choice.json depends.
  nlohmann::json asked() const {
    nlohmann::json asked = {{"origin", record_.origin},
                            {"budget", options_.budget},
                            {"seeds", options_.maxSeeds()},
                            {"cases", record_.cases.cases.size()},
                            {"jobs", options_.sweep.jobs}};
    if (!options_.figures.empty()) asked["of"] = options_.figures, asked["bar_percent"] = options_.percent;
    return asked;
  }

  /// choice.json of an earlier call with the same settings; not an object if missing.
  nlohmann::json keptFile() const {
    std::ifstream former(record_.folder / kCheckChoice);
    const nlohmann::json kept = nlohmann::json::parse(former, nullptr, false);
    const bool same = kept.is_object() && kept.value("asked", nlohmann::json()) == asked();
    return same && !options_.sweep.force ? kept : nlohmann::json();
  }
  void keepFile(const nlohmann::json& made) const {
    support::replaceTextFile(record_.folder / kCheckChoice, support::jsonText(made, 1) + "\n");
  }

  /// Selects the runs: the stored choice of this check, or one from the cost of the first run.
  CheckChoice choose() {
    const int seeds = options_.maxSeeds();
    if (options_.budget.empty()) return chooseRuns(record_.cases, seeds, std::nullopt, {}, 1);
    const nlohmann::json kept = keptFile();
    std::optional<CheckChoice> choice;
    if (kept.is_object())
      choice = keptChoice(kept.value("choice", nlohmann::json()), record_.cases, std::max(seeds, kFewSeeds));
    if (!choice) {
      CheckBeds beds(record_.runs.plan.scene, fixed_, record_.cases);
      const RunCosts costs = work_.pilot(beds);
      choice = chooseRuns(record_.cases, seeds, budgetSeconds(options_.budget), costs, options_.sweep.jobs);
      keepFile(
          {{"asked", asked()}, {"run_s", costs.run}, {"settling_s", costs.settling}, {"choice", choiceJson(*choice)}});
    }
    printBudget(choice->seconds, choice->beyondBudget);
    return *choice;
  }

  void printBudget(double seconds, const std::vector<std::size_t>& beyondBudget) const {
    std::string names;
    for (const std::size_t c : beyondBudget)
      names += (names.empty() ? "; skipped: " : ", ") + record_.cases.cases[c].name;
    fmt::print("budget    {}: selected runs take about {}{}\n", options_.budget, support::Progress::duration(seconds),
               names);
  }

  /// Performs the runs of each look until the error bars of --of are met or no permitted run can reduce them enough.
  void runToGoals() {
    GoalChoice choice;
    const nlohmann::json kept = keptFile();
    const bool continues = kept.is_object() && choice.restore(kept, record_.cases.cases.size(), record_.looks.most());
    if (options_.budget.empty()) {
      choice = {}, choice.costs.run = 1; // relative costs, so that the choice is the same on every machine
    } else {
      CheckBeds beds(record_.runs.plan.scene, fixed_, record_.cases);
      if (!continues) choice = {}, choice.costs = work_.pilot(beds), choice.costs.isKept = nullptr;
      choice.costs.beds = beds.numbers();
    }
    for (std::size_t look = 0;; ++look) {
      if (look == choice.looks.size()) choice.looks.push_back(seedsOf(look, choice.costs));
      if (look > 0 && choice.looks[look] == taken_) break;
      taken_ = choice.looks[look];
      keepLooks(choice);
      record_.isWhole = work_.make(taken_, fmt::format("check, stage {}", look + 1));
      if (!record_.isWhole || !work_.hasBase()) break;
      findGoals();
    }
    if (!options_.budget.empty() && anyReachable(record_.goals))
      for (std::size_t c = 0; c < taken_.size(); ++c)
        if (taken_[c] == 0 && record_.cases.cases[c].refused.empty()) record_.beyondBudget.push_back(c);
    report();
  }

  /// [cases] number of seeds at a look.
  std::vector<int> seedsOf(std::size_t look, const RunCosts& costs) const {
    const SeedsFit fits = [&](const std::vector<int>& seeds) {
      return options_.budget.empty() ||
             secondsOf(record_.cases, costs, seeds) <= budgetSeconds(options_.budget) * options_.sweep.jobs;
    };
    if (look == 0) return firstLook(record_.cases, record_.looks, fits);
    if (look == 1) {
      std::vector<int> all = secondLook(record_.cases, record_.goals, taken_, record_.looks, fits);
      if (all != taken_) return all;
    }
    return nextLook(record_.cases, record_.goals, taken_, record_.looks, costs, fits);
  }

  /// Stores the choice before the runs of a look, so that a resumed call makes the same choice.
  void keepLooks(const GoalChoice& choice) const {
    if (options_.budget.empty()) return;
    keepFile({{"asked", asked()},
              {"run_s", choice.costs.run},
              {"settling_s", choice.costs.settling},
              {"looks", choice.looks}});
    printBudget(secondsOf(record_.cases, choice.costs, taken_) / options_.sweep.jobs, {});
  }

  CheckResults results() const {
    return checkResults(record_.cases, record_.runs, record_.outcomes, record_.folder, options_.percent,
                        record_.looks.levels);
  }

  void findGoals() {
    const CheckResults found = results();
    if (figures_.empty()) { // without a vehicle, only the runs provide the names
      std::vector<std::string> names;
      for (const CheckFigure& f : found.figures) names.push_back(f.name);
      nameFigures(names);
    }
    record_.goals = goalsOf(record_.cases, found, figures_, record_.looks);
    record_.toReach.clear();
    for (const Goal& goal : record_.goals)
      record_.toReach.push_back(goal.state == GoalState::open || goal.state == GoalState::beyond
                                    ? seedsToReach(record_.cases, goal, taken_, record_.looks)
                                    : std::vector<int>{});
  }

  void report() {
    if (!work_.hasBase()) {
      const bool failed = std::any_of(record_.outcomes.begin(), record_.outcomes.end(),
                                      [](const SweepOutcome& o) { return o.status == RunStatus::failed; });
      if (failed) work_.throwBaseFailed();
      return fmt::print("check     the base case has no finished run yet; repeat the command to continue\n");
    }
    const CheckResults found = results();
    record_.costs = costsOf(record_);
    const auto write = [&](const char* name, const std::string& text) {
      support::replaceTextFile(record_.folder / name, text);
    };
    if (!found.doubt.empty()) fmt::print("WARNING: all figures are inconclusive: {}\n", found.doubt);
    const std::string json = checkJson(record_, found);
    write(kCheckFile, json), write(kCheckCosts, costsJson(record_, found));
    write(kCheckSeries, seriesCsv(checkSeries(record_.cases, record_.runs, record_.outcomes, found.levels)));
    fmt::print("{}\n", checkText(record_, found));
    if (options_.sweep.plot)
      output::drawPicture("check.py", {record_.folder / kCheckFile, record_.folder / kCheckCosts},
                          record_.folder / kCheckPlot);
    for (const char* name : {kCheckFile, kCheckSeries, kCheckCosts})
      fmt::print("{:<9} {}\n", "check", (record_.folder / name).string());
    fmt::print("{:<9} for an HTML report run: grouser report {}\n", "report", record_.folder.string());
    const auto finished = std::count_if(record_.outcomes.begin(), record_.outcomes.end(),
                                        [](const SweepOutcome& o) { return output::hasEnded(o.status); });
    keepCheck(origin_, json, static_cast<int>(finished), !options_.figures.empty(), record_.folder);
    if (found.skin == SameBits::no)
      throw base::SimulationError(
          "run.skin changes the results, which is a bug in grouser; please report it together with the scene");
  }

  const CheckOptions& options_;
  const std::vector<std::string> fixed_;
  const scene::Scene scene_;
  std::string origin_;               ///< checkOrigin()
  std::vector<std::string> figures_; ///< figures of --of
  std::vector<int> taken_;           ///< [cases] seeds of the last look
  CheckRecord record_;
  CheckWork work_;
};

} // namespace

void runCheck(const fs::path& scene, const CheckOptions& options) {
  if (!options.budget.empty()) budgetSeconds(options.budget);
  support::requireFolder(options.sweep.folder);
  const Claim claim(options.sweep);
  if (!options.sweep.force) checkFolderOfCheck(options.sweep.folder);
  Check(scene, options).run();
}

} // namespace grouser::sweeps
