// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/compare_results.hpp"

#include "base/counted.hpp"
#include "base/math.hpp"
#include "runs/campaigns/sweeps/run_manifest.hpp"
#include "runs/campaigns/sweeps/run_series.hpp"
#include "runs/support/csv_cell.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace grouser::sweeps {

namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

/// Figures of the text table; the files contain all figures.
constexpr const char* kShown[] = {"speed [m/s]",           "slip [-]",           "sinkage mean [m]",
                                  "sinkage max [m]",       "drive torque [N m]", "drive power [W]",
                                  "tension mean [N]",      "gross traction [N]", "drawbar pull [N]",
                                  "motion resistance [N]", "pitch mean [deg]"};
constexpr const char *kSpeed = "speed [m/s]", *kPitch = "pitch mean [deg]"; // speed: of every vehicle
constexpr const char* kInconclusive = "inconclusive";

bool isShown(const std::string& column) {
  return std::find(std::begin(kShown), std::end(kShown), column) != std::end(kShown) ||
         column.find(" force ") != std::string::npos;
}

/// Mean pitch over the steady part, nose up positive [deg].
double steadyPitch(const fs::path& folder, double from) {
  const RunSeries series = readSeries(folder);
  const std::vector<double>* pitch = series.of("vehicle.pitch_angle [rad]");
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; pitch && i < series.time.size(); ++i)
    if (series.time[i] >= from && std::isfinite((*pitch)[i])) sum += (*pitch)[i], ++count;
  return count > 0 ? sum / count * 180 / base::kPi : base::kNaN;
}

/// Figures of a sweep, plus the mean pitch.
SweepFigures figuresOf(const SweepPlan& plan, const std::vector<SweepOutcome>& outcomes, const fs::path& folder) {
  SweepFigures figures = sweepFigures(plan, outcomes, folder);
  const auto hasVehicle = [](const SweepRun& run) { return run.scene.vehicle.has_value(); };
  if (!std::any_of(plan.runs.begin(), plan.runs.end(), hasVehicle)) return figures;
  figures.columns.emplace_back(kPitch);
  for (std::size_t i = 0; i < plan.runs.size(); ++i)
    figures.values[i].push_back(
        output::hasEnded(outcomes[i].status) ? steadyPitch(folder / plan.runs[i].name, figures.from[i]) : base::kNaN);
  return figures;
}

VariantResult resultOf(const std::string& variant, bool random, const SweepPlan& plan,
                       const std::vector<SweepOutcome>& outcomes, SweepFigures& figures, const fs::path& folder) {
  VariantResult result;
  result.variant = variant, result.random = random;
  std::vector<std::size_t> runs;
  for (std::size_t i = 0; i < plan.runs.size(); ++i)
    if (plan.runs[i].values.front() == variant) runs.push_back(i);
  result.runs = static_cast<int>(runs.size());
  figures.dropInconclusive(runs), result.doubt = figures.doubtOf(runs);
  for (const std::size_t i : runs) {
    if (!output::hasEnded(outcomes[i].status)) continue;
    const RunManifest manifest(folder / plan.runs[i].name);
    result.preparation += manifest.figure("wall_preparation_s"), result.cpuTime += manifest.ofAllSteps("cpu_steps_s");
    const double wall = manifest.ofAllSteps("wall_steps_s");
    result.wallTime += wall, result.perSecond += wall / manifest.number("simulated_time_s");
    ++result.ended;
  }
  const double ended = result.ended > 0 ? result.ended : base::kNaN;
  result.preparation /= ended, result.cpuTime /= ended;
  result.wallTime /= ended, result.perSecond /= ended;
  for (std::size_t c = 0; c < figures.columns.size(); ++c) {
    std::vector<double>& values = result.values.emplace_back();
    for (const std::size_t i : runs)
      if (std::isfinite(figures.values[i][c])) values.push_back(figures.values[i][c]);
    result.figures.push_back(values.empty()  ? support::Estimate{base::kNaN, base::kNaN}
                             : result.random ? jobs::interval95(values)
                                             : support::Estimate{values.front(), 0});
  }
  return result;
}

VariantDifference differenceOf(const Comparison& all, std::size_t from, std::size_t to, double percent) {
  const VariantResult &a = all.variants[from], &b = all.variants[to];
  VariantDifference difference{from, to, {}, {}};
  for (std::size_t c = 0; c < all.columns.size(); ++c) {
    const support::Estimate change = variantDifference(a, b, c);
    difference.changes.push_back(change);
    const bool doubtful = !a.doubt.empty() || !b.doubt.empty();
    difference.verdicts.push_back(!std::isfinite(change.value) ? ""
                                  : doubtful                   ? kInconclusive
                                             : variantVerdict(change, a.figures[c].value, b.figures[c].value, percent));
  }
  return difference;
}

/// Reason why a variant has no valid figures; else empty.
std::string reasonWithoutFigures(const Comparison& all, const VariantResult& result) {
  if (!result.doubt.empty()) return result.doubt;
  for (std::size_t c = 0; c < all.columns.size(); ++c)
    if (isShown(all.columns[c]) && std::isfinite(result.figures[c].value)) return {};
  if (result.ended == 0) return "no run has finished";
  const bool hasVehicle = std::find(all.columns.begin(), all.columns.end(), kSpeed) != all.columns.end();
  return hasVehicle ? "its runs end before the vehicle reaches full speed; raise run.duration"
                    : "compare has figures of vehicles, surfaces and meshes only; the time series of each run is in "
                      "its folder";
}

/// Difference of a variant from the first one, in percent of the latter's mean.
std::string percentText(const Comparison& all, const VariantResult& variant, std::size_t column) {
  const VariantResult& first = all.variants.front();
  if (!std::isfinite(first.figures[column].value)) return "-";
  if (&variant == &first) return "reference";
  const support::Estimate change = variantDifference(first, variant, column);
  const double scale = 100 / std::fabs(first.figures[column].value);
  const bool doubtful = !first.doubt.empty() || !variant.doubt.empty();
  return (doubtful ? "? " : "") + figureText({scale * change.value, scale * change.halfWidth});
}

} // namespace

std::string figureText(const support::Estimate& e) {
  if (!std::isfinite(e.value)) return "-";
  return e.halfWidth == 0 || !std::isfinite(e.halfWidth) ? fmt::format("{:.4g}", e.value) : jobs::valueText(e);
}

support::Estimate variantDifference(const VariantResult& a, const VariantResult& b, std::size_t column) {
  const support::Estimate &x = a.figures[column], &y = b.figures[column];
  if (!std::isfinite(x.value) || !std::isfinite(y.value)) return {base::kNaN, base::kNaN};
  if (a.random && b.random) return jobs::unpairedChange(a.values[column], b.values[column]);
  return {y.value - x.value, a.random ? x.halfWidth : b.random ? y.halfWidth : 0};
}

std::string variantVerdict(const support::Estimate& difference, double a, double b, double percent) {
  const double bar = percent / 100 * std::max(std::fabs(a), std::fabs(b));
  const jobs::Verdict verdict = jobs::judge(difference, bar);
  return verdict == jobs::Verdict::inconclusive ? kInconclusive : jobs::verdictText(verdict);
}

Comparison comparisonOf(const SweepPlan& plan, const std::vector<SweepOutcome>& outcomes,
                        const std::vector<std::string>& random, double percent, const fs::path& folder) {
  SweepFigures figures = figuresOf(plan, outcomes, folder);
  Comparison all;
  all.columns = figures.columns;
  std::vector<std::string> variants;
  for (const SweepRun& run : plan.runs)
    if (variants.empty() || variants.back() != run.values.front()) variants.push_back(run.values.front());
  for (const std::string& v : variants) {
    const bool hasSeeds = std::find(random.begin(), random.end(), v) != random.end();
    all.variants.push_back(resultOf(v, hasSeeds, plan, outcomes, figures, folder));
  }
  for (std::size_t a = 0; a < all.variants.size(); ++a)
    for (std::size_t b = a + 1; b < all.variants.size(); ++b)
      all.differences.push_back(differenceOf(all, a, b, percent));
  return all;
}

std::string comparisonText(const Comparison& all, double percent, bool fromFirst) {
  const auto word = [&](std::size_t g) { return all.variants[g].variant; };
  std::string text =
      "means over the steady part; +- is the half width of the 95 % interval over seeds, where available\n";
  text += fmt::format("{:<28}", "figure");
  for (std::size_t g = 0; g < all.variants.size(); ++g) text += fmt::format("{:>22}", word(g));
  text += "\n";
  const auto isKnown = [&](std::size_t c) {
    return std::any_of(all.variants.begin(), all.variants.end(),
                       [c](const VariantResult& g) { return std::isfinite(g.figures[c].value); });
  };
  const auto line = [&](const std::string& name, const auto& cell) {
    text += fmt::format("{:<28}", name);
    for (const VariantResult& g : all.variants) text += fmt::format("{:>22}", cell(g));
    text += "\n";
  };
  for (std::size_t c = 0; c < all.columns.size(); ++c)
    if (isShown(all.columns[c]) && isKnown(c))
      line(all.columns[c], [c](const VariantResult& g) { return figureText(g.figures[c]); });
  line("runs", [](const VariantResult& g) { return fmt::format("{} of {}", g.ended, g.runs); });
  const auto seconds = [&](const std::string& name, double VariantResult::*value) {
    line(name, [value](const VariantResult& g) { return g.ended > 0 ? fmt::format("{:.3g}", g.*value) : "-"; });
  };
  seconds("preparation per run [s]", &VariantResult::preparation);
  seconds("wall time of the steps [s]", &VariantResult::wallTime);
  seconds("CPU time of the steps [s]", &VariantResult::cpuTime);
  seconds("wall time per second [s]", &VariantResult::perSecond);
  for (const VariantResult& g : all.variants)
    if (const std::string why = reasonWithoutFigures(all, g); !why.empty())
      text += fmt::format("WARNING: {} is inconclusive: {}\n", g.variant, why);
  if (fromFirst) {
    text += fmt::format("\ndifference from {} [% of its mean]\n", word(0));
    for (std::size_t c = 0; c < all.columns.size(); ++c)
      if (isShown(all.columns[c]) && isKnown(c))
        line(all.columns[c], [&](const VariantResult& g) { return percentText(all, g, c); });
    return text;
  }
  for (const VariantDifference& d : all.differences) {
    if (std::all_of(d.verdicts.begin(), d.verdicts.end(), [](const std::string& v) { return v.empty(); })) continue;
    text += fmt::format("\n{} - {}; equal means within {:g} % of the larger mean\n", word(d.to), word(d.from), percent);
    for (std::size_t c = 0; c < all.columns.size(); ++c)
      if (isShown(all.columns[c]) && !d.verdicts[c].empty())
        text += fmt::format("{:<28}{:>22}  {}\n", all.columns[c], figureText(d.changes[c]), d.verdicts[c]);
  }
  return text;
}

std::string comparisonCsv(const Comparison& all) {
  std::string text = "figure,variant,runs,mean,half width,inconclusive,compared with,difference,half width of the "
                     "difference,verdict\n";
  for (std::size_t c = 0; c < all.columns.size(); ++c)
    for (std::size_t g = 0; g < all.variants.size(); ++g) {
      const VariantResult& result = all.variants[g];
      const std::string head =
          fmt::format("{},{},{},{},{},{}", support::csvCell(all.columns[c]), result.variant, result.values[c].size(),
                      support::csvCell(result.figures[c].value), support::csvCell(result.figures[c].halfWidth),
                      support::csvCell(result.doubt));
      if (g == 0) text += head + ",,,,\n";
      for (const VariantDifference& d : all.differences)
        if (d.to == g)
          text +=
              fmt::format("{},{},{},{},{}\n", head, all.variants[d.from].variant, support::csvCell(d.changes[c].value),
                          support::csvCell(d.changes[c].halfWidth), d.verdicts[c]);
    }
  return text;
}

nlohmann::ordered_json comparisonJson(const Comparison& all) {
  const auto number = [](double v) { return std::isfinite(v) ? Json(v) : Json(); };
  const auto words = [&](std::size_t g) { return all.variants[g].variant; };
  Json json;
  for (const VariantResult& g : all.variants)
    json["variants"].push_back({{"variant", g.variant},
                                {"runs", g.runs},
                                {"ended", g.ended},
                                {"inconclusive", g.doubt},
                                {"wall_time_s", number(g.wallTime)},
                                {"preparation_s", number(g.preparation)},
                                {"cpu_time_s", number(g.cpuTime)},
                                {"wall_time_per_second", number(g.perSecond)}});
  for (std::size_t c = 0; c < all.columns.size(); ++c) {
    Json row = {{"figure", all.columns[c]}, {"means", Json::array()}, {"differences", Json::array()}};
    for (const VariantResult& g : all.variants)
      row["means"].push_back({{"variant", g.variant},
                              {"mean", number(g.figures[c].value)},
                              {"half_width", number(g.figures[c].halfWidth)},
                              {"values", g.values[c]}});
    for (const VariantDifference& d : all.differences)
      if (!d.verdicts[c].empty())
        row["differences"].push_back({{"from", words(d.from)},
                                      {"to", words(d.to)},
                                      {"change", number(d.changes[c].value)},
                                      {"half_width", number(d.changes[c].halfWidth)},
                                      {"verdict", d.verdicts[c]}});
    json["rows"].push_back(row);
  }
  return json;
}

} // namespace grouser::sweeps
