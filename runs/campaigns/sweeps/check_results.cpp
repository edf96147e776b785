// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/check_results.hpp"

#include "base/math.hpp"
#include "runs/campaigns/sweeps/run_manifest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace grouser::sweeps {

namespace {

/// Figures of all runs: figures of a sweep, and in scenes without a vehicle the final values of all columns.
SweepFigures figuresOf(const CheckRuns& runs, const std::vector<SweepOutcome>& outcomes,
                       const std::filesystem::path& folder, bool hasVehicle, std::string& doubt) {
  SweepFigures figures = sweepFigures(runs.plan, outcomes, folder);
  std::vector<std::size_t> all(runs.plan.runs.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  doubt = figures.doubtOf(all);
  figures.dropInconclusive(all);
  if (hasVehicle) return figures;
  std::map<std::string, std::size_t> columnOf; // columns of final values
  for (std::size_t r = 0; r < runs.plan.runs.size(); ++r) {
    if (!output::hasEnded(outcomes[r].status)) continue;
    const RunSeries& series = runs.series[r];
    for (std::size_t c = 0; c < series.columns.size(); ++c) {
      if (series.values[c].empty() || series.columns[c].starts_with("terrain.rebuilds")) continue;
      const std::string name = series.columns[c] + " at the end";
      const auto [at, isNew] = columnOf.try_emplace(name, figures.columns.size());
      if (isNew) figures.columns.push_back(name);
      figures.values[r].resize(std::max(figures.values[r].size(), at->second + 1), base::kNaN);
      figures.values[r][at->second] = series.values[c].back();
    }
  }
  for (std::vector<double>& row : figures.values) row.resize(figures.columns.size(), base::kNaN);
  return figures;
}

/// Values of one figure by case and seed.
class Values {
public:
  Values(const RunsByCase& runs, const SweepFigures& figures, std::size_t column)
      : runs_(runs), figures_(figures), column_(column) {}

  std::vector<double> of(std::size_t aCase) const {
    std::vector<double> values;
    for (const std::size_t run : runs_.of(aCase))
      if (std::isfinite(at(run))) values.push_back(at(run));
    return values;
  }
  /// Differences from case `from` to case `to`, over the seeds that both have in common, and with `third` if given.
  std::vector<double> changes(std::size_t from, std::size_t to, std::optional<std::size_t> third) const {
    std::vector<std::size_t> cases = {from, to};
    if (third) cases.push_back(*third);
    std::vector<double> found;
    for (const std::vector<std::size_t>& same : runs_.sharing(cases))
      if (std::all_of(same.begin(), same.end(), [this](std::size_t run) { return std::isfinite(at(run)); }))
        found.push_back(at(same[1]) - at(same[0]));
    return found;
  }

private:
  double at(std::size_t run) const { return figures_.values[run][column_]; }
  const RunsByCase& runs_;
  const SweepFigures& figures_;
  std::size_t column_;
};

/// Index of the case with this refinement of the step (0: base); empty if missing.
std::optional<std::size_t> stepCase(const CheckCases& cases, int refinement) {
  for (std::size_t c = 0; c < cases.cases.size(); ++c) {
    const CheckAxis axis = cases.cases[c].axis;
    if ((axis == CheckAxis::step || axis == CheckAxis::base) && cases.cases[c].refinement == refinement) return c;
  }
  return std::nullopt;
}

/// Verdict on a change of a figure; inconclusive if the mean is not significant, unless the change is zero.
jobs::Verdict verdictOf(const CheckFigure& figure, const AxisError& error, double bar, bool seeded) {
  const double mean = std::fabs(figure.value.value);
  if (error.change.value == 0 && error.change.halfWidth == 0) return jobs::Verdict::equal;
  if (mean <= figure.value.halfWidth || mean == 0) return jobs::Verdict::inconclusive;
  const support::Estimate share{error.change.value / mean, error.change.halfWidth / mean};
  return seeded ? judgeSeeds(share, bar, error.seeds) : jobs::judge(share, bar);
}

/// Computes one figure from the values of all cases.
class FigureMaker {
public:
  FigureMaker(const CheckCases& cases, const Values& values, const CheckResults& asked)
      : cases_(cases), values_(values), asked_(asked) {}

  CheckFigure make(const std::string& name) {
    figure_.name = name;
    const std::vector<double> base = values_.of(0);
    figure_.seeds = static_cast<int>(base.size());
    figure_.value = cases_.seeded ? jobs::interval(base, asked_.levels.value) : support::Estimate{base.front(), 0};
    cases_.seeded ? addScatteredStep() : addStep();
    for (std::size_t c = 1; c < cases_.cases.size(); ++c) addOther(c);
    addParameter();
    std::vector<double> parts;
    bool hasStep = false;
    for (const AxisError& e : figure_.errors) {
      hasStep = hasStep || e.axis == CheckAxis::step;
      if (e.axis != CheckAxis::precision || !cases_.seeded) parts.push_back(e.bar);
    }
    const bool isStepAsked = stepCase(cases_, 1).has_value();
    const bool known = cases_.seeded || hasStep || (!isStepAsked && !parts.empty());
    figure_.bar = known ? totalBar(figure_.value.halfWidth, parts) : std::numeric_limits<double>::infinity();
    for (const std::size_t c : asked_.stepCases) figure_.barOfStep.push_back(barOfStep(c));
    return figure_;
  }

private:
  void add(AxisError error) {
    error.verdict = verdictOf(figure_, error, 0.01 * asked_.percent, cases_.seeded);
    figure_.errors.push_back(error);
  }

  /// Available values at h, h/2, h/4..., starting at this refinement.
  std::vector<double> refined(int from) const {
    std::vector<double> values;
    for (int refinement = from;; ++refinement) {
      const std::optional<std::size_t> c = stepCase(cases_, refinement);
      const std::vector<double> found = c ? values_.of(*c) : std::vector<double>{};
      if (found.empty()) return values;
      values.push_back(found.front());
    }
  }

  void addStep() {
    const std::vector<double> values = refined(0);
    if (values.size() < 2) return;
    const StepError e = stepError(values);
    // The bar includes the change and its uncertainty.
    const double rest = std::max(0.0, e.bar - std::fabs(e.change));
    add({CheckAxis::step, {e.change, rest}, e.order, 1, std::max(e.bar, std::fabs(e.change)), {}});
  }

  /// Changes from case `from` to case `to`, over the common seeds of all three cases; the third case is optional.
  std::vector<double> changes(std::size_t from, std::size_t to, std::optional<std::size_t> third) const {
    return values_.changes(from, to, third);
  }

  /// Error of the base's step, from the changes from h to h/2 and, if available for the same seeds, from 2 h to h.
  ScatteredStepError scatteredAtBase(std::size_t& seeds) const {
    const auto fine = stepCase(cases_, 1), coarse = stepCase(cases_, -1);
    const std::vector<double> both = coarse ? changes(0, *fine, coarse) : std::vector<double>{};
    seeds = changes(0, *fine, std::nullopt).size();
    if (both.size() < 2) return scatteredStepError(changes(0, *fine, std::nullopt), {}, asked_.levels.change);
    seeds = both.size();
    return scatteredStepError(both, changes(*coarse, 0, fine), asked_.levels.change);
  }

  void addScatteredStep() {
    const auto fine = stepCase(cases_, 1);
    if (!fine || changes(0, *fine, std::nullopt).empty()) return;
    std::size_t seeds = 0;
    const ScatteredStepError e = scatteredAtBase(seeds);
    add({CheckAxis::step, e.change, e.order, static_cast<int>(seeds), e.bar, {}});
  }

  void addOther(std::size_t c) {
    const CheckAxis axis = cases_.cases[c].axis;
    if (axis == CheckAxis::step || axis == CheckAxis::skin || axis == CheckAxis::parameter) return;
    const std::vector<double> change = changes(0, c, std::nullopt);
    if (change.empty()) return;
    const support::Estimate changed = over(change);
    // First order: the error of the finer grid equals its difference from the coarser grid.
    const double unseen = axis == CheckAxis::nodeSpacing ? kStepUnseen : 1;
    add({axis,
         changed,
         std::nullopt,
         static_cast<int>(change.size()),
         unseen * (std::fabs(changed.value) + changed.halfWidth),
         {}});
  }

  /// Scatter of the figure due to the soil constants: prediction interval for one more sample.
  void addParameter() {
    std::vector<double> samples;
    for (std::size_t c = 1; c < cases_.cases.size(); ++c) {
      if (cases_.cases[c].axis != CheckAxis::parameter) continue;
      const std::vector<double> change = changes(0, c, std::nullopt);
      if (!change.empty())
        samples.push_back(std::accumulate(change.begin(), change.end(), 0.0) / static_cast<double>(change.size()));
    }
    if (samples.size() < 2) return;
    const support::Estimate scatter = jobs::predictionInterval(samples, asked_.levels.change);
    add({CheckAxis::parameter,
         scatter,
         std::nullopt,
         static_cast<int>(samples.size()),
         std::fabs(scatter.value) + scatter.halfWidth,
         {}});
  }

  /// A change and its interval over the seeds.
  support::Estimate over(const std::vector<double>& change) const {
    return cases_.seeded ? jobs::interval(change, asked_.levels.change) : support::Estimate{change.front(), 0};
  }

  /// Error bar of the figure at the step of case c, with all other settings as in the base.
  double barOfStep(std::size_t c) const {
    const int refinement = cases_.cases[c].refinement;
    if (!cases_.seeded) {
      const std::vector<double> values = refined(refinement);
      return values.size() < 2 ? base::kNaN : stepError(values).bar;
    }
    const auto fine = stepCase(cases_, 1);
    if (!fine || changes(0, *fine, std::nullopt).empty()) return base::kNaN;
    std::size_t seeds = 0;
    const ScatteredStepError base = scatteredAtBase(seeds);
    if (c == 0) return base.bar;
    // The change from this case to the base is added to the error of the base.
    const std::vector<double> change = changes(c, 0, std::nullopt);
    if (change.empty()) return base::kNaN;
    const support::Estimate apart = over(change);
    if (!base.order) return (refinement > 0 ? 1 : 2) * (std::fabs(apart.value) + apart.halfWidth);
    return std::fabs(base.change.value + apart.value) + base.change.halfWidth + apart.halfWidth;
  }

  const CheckCases& cases_;
  const Values& values_;
  const CheckResults& asked_; // percent, levels and stepCases
  CheckFigure figure_;
};

/// Sets the scale of each figure to the largest value with its unit.
void findScales(std::vector<CheckFigure>& figures) {
  std::map<std::string, double> largest;
  for (const CheckFigure& f : figures) {
    double& of = largest[unitOf(f.name)];
    if (std::isfinite(f.value.value)) of = std::max(of, std::fabs(f.value.value));
  }
  for (CheckFigure& f : figures) f.scale = largest[unitOf(f.name)];
}

/// Whether the runs with another skin end in the same state as those of the base.
SameBits sameBits(const CheckCases& cases, const RunsByCase& byCase, const CheckRuns& runs,
                  const std::vector<SweepOutcome>& outcomes, const std::filesystem::path& folder) {
  SameBits same = SameBits::notRun;
  for (std::size_t c = 0; c < cases.cases.size(); ++c) {
    if (cases.cases[c].axis != CheckAxis::skin) continue;
    for (const std::vector<std::size_t>& pair : byCase.sharing({0, c})) {
      if (!output::hasEnded(outcomes[pair[0]].status) || !output::hasEnded(outcomes[pair[1]].status)) continue;
      const std::string one = RunManifest(folder / runs.plan.runs[pair[1]].name).text("state_hash"),
                        other = RunManifest(folder / runs.plan.runs[pair[0]].name).text("state_hash");
      if (one.empty() || other.empty()) continue;
      if (one != other) return SameBits::no;
      same = SameBits::yes;
    }
  }
  return same;
}

} // namespace

RunsByCase::RunsByCase(const CheckRuns& runs, std::size_t cases) : members_(cases) {
  for (std::size_t r = 0; r < runs.caseOf.size(); ++r) members_[runs.caseOf[r]].push_back({runs.seedOf[r], r});
  for (std::vector<Member>& all : members_)
    std::sort(all.begin(), all.end(), [](const Member& a, const Member& b) { return a.seed < b.seed; });
}

std::vector<std::size_t> RunsByCase::of(std::size_t aCase) const {
  std::vector<std::size_t> all;
  for (const Member& m : members_[aCase]) all.push_back(m.run);
  return all;
}

std::vector<std::vector<std::size_t>> RunsByCase::sharing(const std::vector<std::size_t>& cases) const {
  std::vector<std::vector<std::size_t>> rows;
  std::vector<std::size_t> next(cases.size(), 0);
  for (const Member& first : members_[cases.front()]) {
    std::vector<std::size_t> row = {first.run};
    for (std::size_t k = 1; k < cases.size(); ++k) {
      const std::vector<Member>& other = members_[cases[k]];
      while (next[k] < other.size() && other[next[k]].seed < first.seed) ++next[k];
      if (next[k] < other.size() && other[next[k]].seed == first.seed) row.push_back(other[next[k]].run);
    }
    if (row.size() == cases.size()) rows.push_back(std::move(row));
  }
  return rows;
}

CheckFigure checkFigure(const CheckCases& cases, const RunsByCase& runs, const SweepFigures& figures,
                        std::size_t column, const CheckResults& asked) {
  return FigureMaker(cases, Values(runs, figures, column), asked).make(figures.columns[column]);
}

std::string unitOf(const std::string& name) {
  const std::size_t from = name.rfind('['), to = name.find(']', from);
  return from == std::string::npos || to == std::string::npos ? "" : name.substr(from + 1, to - from - 1);
}

CheckResults checkResults(const CheckCases& cases, const CheckRuns& runs, const std::vector<SweepOutcome>& outcomes,
                          const std::filesystem::path& folder, double percent, const SeedLevels& levels) {
  CheckResults results;
  results.seeded = cases.seeded, results.percent = percent, results.levels = levels;
  const RunsByCase byCase(runs, cases.cases.size());
  results.skin = sameBits(cases, byCase, runs, outcomes, folder);
  results.hitched = !runs.plan.runs.empty() && runs.plan.runs.front().scene.hitch.has_value();
  const bool hasVehicle = !runs.plan.runs.empty() && runs.plan.runs.front().scene.vehicle.has_value();
  const SweepFigures figures = figuresOf(runs, outcomes, folder, hasVehicle, results.doubt);
  for (std::size_t c = 0; c < cases.cases.size(); ++c) {
    const CheckAxis axis = cases.cases[c].axis;
    const std::vector<std::size_t> own = byCase.of(c);
    const bool finished =
        std::any_of(own.begin(), own.end(), [&](std::size_t r) { return output::hasEnded(outcomes[r].status); });
    if (finished && (axis == CheckAxis::step || axis == CheckAxis::base)) results.stepCases.push_back(c);
  }
  for (std::size_t column = 0; column < figures.columns.size(); ++column) {
    if (Values(byCase, figures, column).of(0).empty()) continue;
    results.figures.push_back(checkFigure(cases, byCase, figures, column, results));
  }
  findScales(results.figures);
  return results;
}

} // namespace grouser::sweeps
