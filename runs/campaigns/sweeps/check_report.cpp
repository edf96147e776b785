// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/check_report.hpp"

#include "base/counted.hpp"
#include "base/math.hpp"
#include "runs/campaigns/sweeps/check_goals_text.hpp"
#include "runs/campaigns/sweeps/run_manifest.hpp"
#include "runs/campaigns/sweeps/run_notices.hpp"
#include "runs/jobs/study_place.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/json_text.hpp"
#include "runs/support/progress.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grouser::sweeps {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kPercents[] = {10, 5, 1};
constexpr int kMaxPrinted = 24; // maximum number of figures printed in the terminal

Json numberOf(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string bitsText(SameBits bits) {
  return bits == SameBits::yes ? "bitwise identical" : bits == SameBits::no ? "NOT IDENTICAL" : "not run";
}

Json errorJson(const AxisError& e, const CheckFigure& f) {
  const double value = f.value.value;
  Json json{{"axis", base::wordOf(e.axis)},
            {"change", numberOf(e.change.value)},
            {"half_width", numberOf(e.change.halfWidth)},
            {"share_of_value", numberOf(value != 0 ? e.change.value / std::fabs(value) : base::kNaN)},
            {"seeds", e.seeds},
            {"verdict", jobs::verdictText(e.verdict)}};
  if (e.axis == CheckAxis::precision && f.value.halfWidth > 0)
    json["inside_the_seeds_interval"] = std::fabs(e.change.value) <= f.value.halfWidth;
  json["bar"] = numberOf(e.bar);
  if (e.axis == CheckAxis::step) json["order"] = e.order ? numberOf(*e.order) : Json(nullptr);
  return json;
}

bool isInconclusive(const CheckResults& results, const CheckFigure& f) {
  const bool isNothing = f.value.value == 0 && f.bar == 0; // zero in all runs
  return (!results.doubt.empty() && !isNothing) || jobs::isInconclusive({f.value.value, f.bar});
}

Json figureJson(const CheckFigure& f, const CheckResults& results) {
  Json json{{"name", f.name},         {"value", numberOf(f.value.value)},
            {"bar", numberOf(f.bar)}, {"inconclusive", isInconclusive(results, f)},
            {"seeds", f.seeds},       {"seeds_half_width", numberOf(f.value.halfWidth)}};
  if (results.seeded) {
    const double wanted = 0.01 * results.percent * std::fabs(f.value.value);
    json["seeds_for_the_bar"] = seedsFor(wanted, f.value.halfWidth, f.seeds, results.levels.value);
  }
  json["errors"] = Json::array();
  for (const AxisError& e : f.errors) json["errors"].push_back(errorJson(e, f));
  json["bar_of_step"] = Json::array();
  for (const double bar : f.barOfStep) json["bar_of_step"].push_back(numberOf(bar));
  return json;
}

/// Message with paths relative to the folder.
std::string placeless(std::string message, const CheckRecord& record) {
  const std::string folder = (record.folder / "").string();
  for (std::size_t at = message.find(folder); at != std::string::npos; at = message.find(folder, at))
    message.erase(at, folder.size());
  return message;
}

Json caseJson(const CheckRecord& record, std::size_t c) {
  const CheckCase& one = record.cases.cases[c];
  const CaseStatus status = statusOf(record, c);
  Json json{{"name", one.name},
            {"axis", base::wordOf(one.axis)},
            {"what", one.what},
            {"overrides", one.overrides},
            {"status", status.word}};
  if (!status.message.empty()) json["message"] = placeless(status.message, record);
  json["runs"] = Json::array();
  for (std::size_t r = 0; r < record.runs.caseOf.size(); ++r) {
    if (record.runs.caseOf[r] != c) continue;
    Json run{{"seed", record.runs.seedOf[r]}, {"status", std::string(base::wordOf(record.outcomes[r].status))}};
    if (!record.outcomes[r].message.empty()) run["message"] = placeless(record.outcomes[r].message, record);
    json["runs"].push_back(run);
  }
  return json;
}

/// "-0.0004 +- 0.0031", with a sign.
std::string changeText(const support::Estimate& change) {
  return fmt::format("{}{}", change.value < 0 ? "" : "+", jobs::valueText(change));
}

/// "-0.5 +- 4.2 %"; empty if the value does not differ significantly from zero.
std::string shareText(const CheckFigure& f, const support::Estimate& change) {
  const double value = std::fabs(f.value.value);
  if (value == 0 || value <= f.value.halfWidth) return "";
  const support::Estimate percents{100 * change.value / value, 100 * change.halfWidth / value};
  if (!std::isfinite(percents.halfWidth)) return fmt::format("{:+.3g} %", percents.value);
  return changeText(percents) + " %";
}

std::string remark(const CheckResults& results, const CheckFigure& f, const AxisError& e) {
  if (e.axis == CheckAxis::precision && results.seeded)
    return std::fabs(e.change.value) <= f.value.halfWidth ? "within the interval over seeds"
                                                          : "OUTSIDE the interval over seeds";
  if (e.axis == CheckAxis::parameter) return base::counted(e.seeds, "sample");
  if (e.axis != CheckAxis::step) return "";
  return e.order ? fmt::format("order {:.1f}", *e.order) : "order not observable";
}

std::string cheapestText(const CheckRecord& record, const CheckResults& results, const CheckFigure& f) {
  std::vector<std::string> parts;
  for (const double percent : kPercents) {
    const Cheapest c = cheapest(record, results, f, percent);
    const std::string seeds = results.seeded ? ", " + base::counted(c.seeds, "seed") : "";
    parts.push_back(fmt::format("{:g} %: {}", percent,
                                c.name.empty()
                                    ? "none of the tested settings"
                                    : fmt::format("{}{}, {}", c.name, seeds, support::Progress::duration(c.wall))));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

/// Returns true if the figure has error axes of deformable soil besides the step.
bool hasSoilAxes(const CheckFigure& f) {
  return std::any_of(f.errors.begin(), f.errors.end(), [](const AxisError& e) {
    return e.axis == CheckAxis::nodeSpacing || e.axis == CheckAxis::parameter;
  });
}

/// "depth, width  left out: no bed of grains": one line per reason.
std::string omittedText(const std::vector<CheckOmission>& omitted) {
  std::vector<std::pair<std::string, std::string>> lines; // reason, axes
  for (const CheckOmission& o : omitted) {
    const std::string axis(base::wordOf(o.axis));
    const auto same = std::find_if(lines.begin(), lines.end(), [&](const auto& line) { return line.first == o.why; });
    if (same == lines.end())
      lines.emplace_back(o.why, axis);
    else
      same->second += ", " + axis;
  }
  std::string text;
  for (const auto& [why, axes] : lines) text += fmt::format("  {:<14} skipped: {}\n", axes, why);
  return text;
}

/// Whether the runs have shown the error of any time step.
bool isStepVaried(const CheckFigure& f) {
  return std::any_of(f.barOfStep.begin(), f.barOfStep.end(), [](double bar) { return std::isfinite(bar); });
}

/// States that the error bars exclude the time step, or why there are none; empty if they include it.
std::string barsNote(const CheckRecord& record, const CheckResults& results) {
  if (results.figures.empty()) return "";
  const auto fewer = [](const CheckFigure& a, const CheckFigure& b) { return a.errors.size() < b.errors.size(); };
  const std::vector<AxisError>& errors =
      std::max_element(results.figures.begin(), results.figures.end(), fewer)->errors;
  const auto isStep = [](const auto& one) { return one.axis == CheckAxis::step; };
  if (std::any_of(errors.begin(), errors.end(), isStep)) return "";
  const std::vector<CheckCase>& cases = record.cases.cases;
  const bool isAsked = std::any_of(cases.begin(), cases.end(), isStep);
  const std::string remedy = isAsked ? "no run with a smaller time step has finished, see the list of runs below"
                                     : "add step to --axes to include it";
  std::vector<std::string> parts;
  if (results.seeded) parts.emplace_back("seeds");
  for (const AxisError& e : errors)
    if (e.axis != CheckAxis::precision || !results.seeded) parts.emplace_back(base::wordOf(e.axis));
  if (parts.empty() || (isAsked && !results.seeded))
    return fmt::format("no error bars, because they require the error of the time step: {}\n", remedy);
  return fmt::format("error bars include {}, but not the time step: {}\n", fmt::join(parts, ", "), remedy);
}

/// All axes of a figure.
std::string linesOf(const CheckRecord& record, const CheckResults& results, const CheckFigure& f) {
  std::string text = fmt::format("{}  {}{}\n", f.name, jobs::valueText({f.value.value, f.bar}),
                                 isInconclusive(results, f) ? "  inconclusive" : "");
  if (results.seeded)
    text += fmt::format("  {:<12} {:>26}  {:>18}  {}\n", "seeds", jobs::valueText(f.value),
                        shareText(f, {0, f.value.halfWidth}), base::counted(f.seeds, "seed"));
  for (const AxisError& e : f.errors)
    text += fmt::format("  {:<12} {:>26}  {:>18}  {:<9}  {}\n", base::wordOf(e.axis), changeText(e.change),
                        shareText(f, e.change), jobs::verdictText(e.verdict), remark(results, f, e));
  return isStepVaried(f) ? text + fmt::format("  {:<12} {}\n", "cheapest", cheapestText(record, results, f)) : text;
}

/// One line per figure of reproducible runs: error bar, order of the step, and cheapest step with an error within 1 %.
std::string lineOf(const CheckRecord& record, const CheckResults& results, const CheckFigure& f) {
  std::string order;
  for (const AxisError& e : f.errors)
    if (e.axis == CheckAxis::step) order = remark(results, f, e);
  const Cheapest c = cheapest(record, results, f, kPercents[2]);
  const double share = f.value.value != 0 ? 100 * f.bar / std::fabs(f.value.value) : base::kNaN;
  return fmt::format("{:<44} {:>28}  {:>9}  {:<13}  {}\n", f.name, jobs::valueText({f.value.value, f.bar}),
                     std::isfinite(share) ? fmt::format("{:.2g} %", share) : "", order,
                     isInconclusive(results, f) ? "inconclusive"
                     : c.name.empty()           ? ""
                                                : "1 %: " + c.name);
}

bool hasSinkage(const CheckResults& results) {
  return std::any_of(results.figures.begin(), results.figures.end(), [](const CheckFigure& f) {
    return f.name.starts_with("sinkage") && std::isfinite(f.value.value);
  });
}

} // namespace

Cheapest cheapest(const CheckRecord& record, const CheckResults& results, const CheckFigure& figure, double percent) {
  Cheapest best;
  const double value = std::fabs(figure.value.value), most = 0.01 * percent * value;
  best.wall = HUGE_VAL;
  if (value == 0 || value <= figure.value.halfWidth) return best;
  for (std::size_t i = 0; i < results.stepCases.size(); ++i) {
    const double bar = figure.barOfStep[i];
    if (!(bar < most)) continue;
    // The scatter of the seeds may use the rest of the error bar.
    const int seeds = results.seeded ? seedsFor(std::sqrt(most * most - bar * bar), figure.value.halfWidth,
                                                figure.seeds, results.levels.value)
                                     : 1;
    const double wall = record.costs[results.stepCases[i]].wall * seeds;
    if (seeds > 0 && wall < best.wall) best = {record.cases.cases[results.stepCases[i]].name, bar / value, seeds, wall};
  }
  return best;
}

std::string checkJson(const CheckRecord& record, const CheckResults& results) {
  Json json{{"scene", record.scene},
            {"origin", record.origin},
            {"program", {{"version", support::buildInfo().version}, {"commit", support::buildInfo().commit}}},
            {"seeds_matter", results.seeded},
            {"bar_percent", results.percent},
            {"skin", bitsText(results.skin)}};
  if (!results.doubt.empty()) json["inconclusive"] = results.doubt;
  std::vector<RunNotice> notices = runNotices(record.runs.plan, record.folder, hasSinkage(results));
  for (RunNotice& n : notices) n.text = placeless(n.text, record);
  json["notices"] = noticesJson(notices);
  if (!record.looks.seeds.empty()) json["looks"] = record.looks.seeds, json["of"] = goalsJson(record);
  json["cases"] = Json::array();
  for (std::size_t c = 0; c < record.cases.cases.size(); ++c) json["cases"].push_back(caseJson(record, c));
  json["not_asked"] = Json::array();
  for (const CheckOmission& o : record.cases.omitted)
    json["not_asked"].push_back({{"axis", base::wordOf(o.axis)}, {"why", o.why}});
  json["step_cases"] = Json::array();
  for (const std::size_t c : results.stepCases) json["step_cases"].push_back(record.cases.cases[c].name);
  json["figures"] = Json::array();
  for (const CheckFigure& f : results.figures) {
    json["figures"].push_back(figureJson(f, results));
    json["figures"].back()["headline"] = isHeadline(results, f) && isAboveRounding(f);
  }
  return support::jsonText(json, 1) + "\n";
}

std::string costsJson(const CheckRecord& record, const CheckResults& results) {
  Json json{{"scene", record.scene}, {"machine", support::machineText()}};
  json["cases"] = Json::array();
  for (std::size_t c = 0; c < record.cases.cases.size(); ++c) {
    const CaseCost& cost = record.costs[c];
    json["cases"].push_back({{"name", record.cases.cases[c].name},
                             {"wall_s", numberOf(cost.wall)},
                             {"cpu_s", numberOf(cost.cpu)},
                             {"steps", numberOf(cost.steps)},
                             {"expected_over_base", record.cases.cases[c].cost}});
  }
  json["cheapest"] = Json::array();
  for (const CheckFigure& f : results.figures) {
    if (!isHeadline(results, f)) continue;
    Json row{{"figure", f.name}};
    for (const double percent : kPercents) {
      const Cheapest c = cheapest(record, results, f, percent);
      Json& cell = row[fmt::format("{:g} %", percent)];
      if (!c.name.empty()) cell = {{"case", c.name}, {"error_by_step", c.step}, {"seeds", c.seeds}, {"wall_s", c.wall}};
    }
    json["cheapest"].push_back(row);
  }
  return support::jsonText(json, 1) + "\n";
}

bool isAboveRounding(const CheckFigure& figure) {
  constexpr double kRounding = 1e-12;
  const double rounding = kRounding * figure.scale;
  return std::isfinite(figure.value.value) && (std::fabs(figure.value.value) > rounding || figure.bar > rounding);
}

bool isHeadline(const CheckResults& results, const CheckFigure& figure) {
  static const std::vector<std::string> kOfVehicle = {
      "speed [m/s]",        "slip [-]",         "sinkage mean [m]", "sinkage max [m]",
      "drive torque [N m]", "tension mean [N]", "tension peak [N]", "motion resistance [N]"};
  if (results.hitched && figure.name == "drawbar pull [N]") return true;
  const auto has = [&](const auto& test) { return std::any_of(results.figures.begin(), results.figures.end(), test); };
  const auto ofVehicle = [](const CheckFigure& f) {
    return std::find(kOfVehicle.begin(), kOfVehicle.end(), f.name) != kOfVehicle.end();
  };
  const auto isForce = [](const CheckFigure& f) { return f.name.find(" force ") != std::string::npos; };
  const auto isEnd = [](const CheckFigure& f) {
    return f.name.ends_with(" at the end") && !f.name.starts_with("ledger.");
  };
  if (has(ofVehicle)) return ofVehicle(figure);
  // In scenes of few grains, each grain has figures.
  if (has(isForce)) return isForce(figure) || (isEnd(figure) && figure.name.starts_with("grain."));
  return !has(isEnd) || isEnd(figure);
}

std::string checkText(const CheckRecord& record, const CheckResults& results) {
  std::string text =
      noticesText(runNotices(record.runs.plan, record.folder, hasSinkage(results)), record.runs.plan.runs.size());
  text += fmt::format("\n{}: values with error bars; changes relative to the unchanged scene, with verdicts for a "
                      "tolerance of {:g} %\n{}",
                      record.scene, results.percent, barsNote(record, results));
  int printed = 0, more = 0;
  for (const CheckFigure& f : results.figures) {
    if (!isHeadline(results, f) || !isAboveRounding(f)) continue;
    if (++printed > kMaxPrinted) ++more;
    if (printed > kMaxPrinted) continue;
    text += results.seeded || hasSoilAxes(f) ? linesOf(record, results, f) : lineOf(record, results, f);
  }
  if (more > 0) text += fmt::format("and {} more in {}\n", more, kCheckFile);
  text += goalsText(record, results.percent) + "\nruns\n";
  for (std::size_t c = 0; c < record.cases.cases.size(); ++c) {
    const CaseCost& cost = record.costs[c];
    const CaseStatus status = statusOf(record, c);
    text += fmt::format("  {:<14} {:<44} {}{}\n", record.cases.cases[c].name, record.cases.cases[c].what,
                        std::isfinite(cost.wall) ? fmt::format("{:.3g} s each, {:.3g} s of CPU", cost.wall, cost.cpu)
                                                 : status.word,
                        status.message.empty() ? "" : ": " + status.message);
  }
  text += omittedText(record.cases.omitted);
  if (results.skin != SameBits::notRun) text += fmt::format("  {:<14} {}\n", "skin", bitsText(results.skin));
  return text;
}

} // namespace grouser::sweeps
