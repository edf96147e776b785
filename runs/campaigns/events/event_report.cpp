// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/events/event_report.hpp"

#include "base/counted.hpp"
#include "runs/campaigns/sweeps/run_manifest.hpp"
#include "runs/jobs/estimate.hpp"
#include "runs/support/csv_cell.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace grouser::events {

namespace fs = std::filesystem;

namespace {

/// Sweep figures of the steady part that are reported.
constexpr const char* kSteady[] = {"speed [m/s]",        "slip [-]",        "sinkage mean [m]",     "sinkage max [m]",
                                   "drive torque [N m]", "drive power [W]", "motion resistance [N]"};

bool isOfSteadyPart(const std::string& figure) {
  return std::find(std::begin(kSteady), std::end(kSteady), figure) != std::end(kSteady);
}

/// Whether the vehicle drives steadily, straight or on a circle, in the second half of a run of this event.
bool isSteady(Event event) {
  return event != Event::pivotTurn && event != Event::step && event != Event::gap && event != Event::ditch &&
         event != Event::halfRound;
}

/// Figures of the runs of one level, in order of first occurrence.
class Gathered {
public:
  void add(const std::string& name, double value) {
    if (!std::isfinite(value)) return;
    if (!values_.contains(name)) order_.push_back(name);
    values_[name].push_back(value);
  }
  /// `drawn`: prediction intervals for one more draw instead of confidence intervals of the mean.
  std::vector<FigureOverSeeds> figures(bool drawn) const {
    std::vector<FigureOverSeeds> all;
    for (const std::string& name : order_) {
      const std::vector<double>& v = values_.at(name);
      all.push_back({name, v, drawn ? jobs::predictionInterval(v, 0.05) : jobs::interval95(v)});
    }
    return all;
  }

private:
  std::vector<std::string> order_;
  std::map<std::string, std::vector<double>> values_;
};

/// Verdict of a finished run.
Verdict finishedRun(const PlannedTrial& planned, const Course& course, const fs::path& folder, Gathered& gathered) {
  const sweeps::RunSeries series = sweeps::readSeries(folder);
  const double start = sweeps::RunManifest(folder).figure("drive_start_s");
  if (std::isnan(start)) return {false, "never drove"};
  const Motion motion =
      motionOf(series, start, planned.trial.radius > 0 ? std::optional(course.shape.controlled) : std::nullopt);
  double pull = 0;
  for (const Figure& f : figuresOf(planned.event, motion, series, start, planned.trial, course)) {
    gathered.add(f.name, f.value);
    if (f.name == kPull) pull = f.value;
  }
  // With imposed slip, the carriage always completes the course.
  if (planned.event == Event::drawbar)
    return {pull > 0,
            fmt::format("{} {:.3g} kN", pull > 0 ? "drawbar pull" : "required towing force", std::fabs(pull) / 1000)};
  return judge(motion, planned.trial);
}

} // namespace

std::string EventRow::doubtOfMean(const std::string& figure) const { return isOfSteadyPart(figure) ? doubt : ""; }

std::string EventRow::doubtOf(const FigureOverSeeds& figure) const {
  if (std::string why = doubtOfMean(figure.name); !why.empty()) return why;
  return jobs::isInconclusive(figure.estimate) ? "interval wider than the value" : "";
}

std::string EventRow::why() const {
  if (event == Event::drawbar && gos > 1 && gos == runs)
    for (const FigureOverSeeds& f : figures)
      if (f.name == kPull) return fmt::format("mean pull {:.3g} kN", f.estimate.value / 1000);
  for (const char* verdict : {"no-go", "go", "incomplete", "failed"})
    for (const RunVerdict& r : each)
      if (r.verdict == verdict) return r.why;
  return "";
}

std::string goText(const EventRow& row) {
  if (row.runs == 0) return row.pending > 0 ? "pending" : row.incomplete > 0 ? "incomplete" : "failed";
  if (row.runs == 1) return row.gos ? "go" : "no-go";
  return fmt::format("{} {}/{}", row.gos == row.runs ? "go" : row.gos == 0 ? "no-go" : "partly", row.gos, row.runs);
}

std::string levelCell(Event event, double level) { return levelText(event).empty() ? "" : fmt::format("{:g}", level); }

std::string limitText(const EventLimit& limit) {
  if (limit.go && limit.noGo) return fmt::format("between {:g} and {:g}", *limit.go, *limit.noGo);
  const bool below = isHarderBelow(limit.event);
  if (limit.go) return fmt::format("{} {:g}", below ? "below" : "above", *limit.go);
  if (limit.noGo) return fmt::format("{} {:g}", below ? "above" : "below", *limit.noGo);
  return "unknown";
}

std::string referenceText(const EventLimit& limit) {
  if (!limit.reference) return "";
  return fmt::format("{}: {}", limit.reference->text, *limit.agrees ? "agrees" : "disagrees");
}

std::vector<EventRow> eventRows(const EventPlan& plan, const std::vector<sweeps::SweepOutcome>& outcomes,
                                const fs::path& folder) {
  sweeps::SweepFigures steady = sweeps::sweepFigures(plan.sweep, outcomes, folder);
  std::vector<EventRow> rows;
  for (const PlannedTrial& planned : plan.trials) {
    EventRow row;
    row.event = planned.event, row.level = planned.level;
    Gathered gathered;
    steady.dropInconclusive(planned.runs), row.doubt = steady.doubtOf(planned.runs);
    for (const std::size_t run : planned.runs) {
      const sweeps::SweepOutcome& outcome = outcomes[run];
      const fs::path at = folder / plan.sweep.runs[run].name;
      RunVerdict said{plan.sweep.runs[run].name, "pending", ""};
      if (outcome.status == output::RunStatus::finished) {
        const Verdict verdict = finishedRun(planned, plan.course, at, gathered);
        verdict.isIncomplete ? ++row.incomplete : ++row.runs;
        row.gos += verdict.go;
        said.verdict = verdict.isIncomplete ? "incomplete" : verdict.go ? "go" : "no-go", said.why = verdict.why;
        for (std::size_t c = 0; isSteady(planned.event) && c < steady.columns.size(); ++c)
          if (isOfSteadyPart(steady.columns[c])) gathered.add(steady.columns[c], steady.values[run][c]);
      } else if (outcome.status == output::RunStatus::incomplete) {
        ++row.incomplete;
        said.verdict = "incomplete", said.why = outcome.message;
      } else if (outcome.status == output::RunStatus::failed) {
        const FailureVerdict failure = judgeFailure(outcome);
        failure.known ? ++row.runs : ++row.unknown;
        said.verdict = failure.known ? "no-go" : "failed", said.why = failure.why;
      } else {
        ++row.pending;
      }
      row.each.push_back(said);
      std::error_code error;
      if (row.picture.empty() && fs::exists(at / "picture.png", error))
        row.picture = (fs::path(plan.sweep.runs[run].name) / "picture.png").string();
    }
    row.figures = gathered.figures(plan.draws > 0);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<EventLimit> eventLimits(const std::vector<EventRow>& rows, const Course& course) {
  std::vector<EventLimit> limits;
  for (const Event event : allEvents()) {
    std::vector<const EventRow*> levels;
    for (const EventRow& row : rows)
      if (row.event == event && row.runs > 0 && !levelText(event).empty()) levels.push_back(&row);
    const bool below = isHarderBelow(event);
    const auto isEasier = [below](double a, double b) { return below ? a > b : a < b; };
    std::sort(levels.begin(), levels.end(),
              [&](const EventRow* a, const EventRow* b) { return isEasier(a->level, b->level); });
    if (levels.size() < 2 || event == Event::drawbar) continue;
    EventLimit limit{event, {}, {}, referenceOf(event, course), {}};
    for (const EventRow* row : levels) {
      if (row->gos < row->runs) {
        limit.noGo = row->level;
        break;
      }
      limit.go = row->level;
    }
    if (limit.reference) {
      bool agrees = true;
      for (const EventRow* row : levels) {
        const Reference& r = *limit.reference;
        if (r.blocks && isEasier(*r.blocks, row->level)) agrees = agrees && row->gos == 0;
        if (r.passes && isEasier(row->level, *r.passes)) agrees = agrees && row->gos == row->runs;
      }
      limit.agrees = agrees;
    }
    limits.push_back(limit);
  }
  return limits;
}

std::string eventsText(const std::vector<EventRow>& rows, const std::vector<EventLimit>& limits,
                       const EventPlan& plan) {
  std::string text;
  for (const EventRow& row : rows) {
    text += fmt::format("{:<18}{:<9}{:<11}{}\n", base::wordOf(row.event), levelCell(row.event, row.level), goText(row),
                        row.why());
    if (row.unknown > 0)
      text += fmt::format("{:<18}{} of its runs failed for reasons unrelated to the vehicle\n", "", row.unknown);
    if (row.incomplete > 0)
      text += fmt::format("{:<18}{}\n", "",
                          base::counted(row.incomplete, "of its runs is incomplete", "of its runs are incomplete"));
    if (row.pending > 0)
      text += fmt::format("{:<18}{}\n", "",
                          base::counted(row.pending, "of its runs is pending", "of its runs are pending"));
    for (const FigureOverSeeds& f : row.figures)
      text += fmt::format("{:<18}  {:<50} {}{}\n", "", f.name,
                          f.values.size() > 1 ? jobs::valueText(f.estimate) : fmt::format("{:.4g}", f.estimate.value),
                          row.doubtOf(f).empty() ? "" : "  inconclusive");
  }
  for (const auto& [event, why] : plan.omitted) text += fmt::format("{:<18}skipped: {}\n", base::wordOf(event), why);
  if (plan.shoesAlone()) text += fmt::format("\n{}\n", kShoesOnly);
  if (!limits.empty()) text += "\nlimits\n";
  for (const EventLimit& limit : limits)
    text += fmt::format("{:<18}{:<42}{:<26}{}\n", base::wordOf(limit.event), levelText(limit.event), limitText(limit),
                        referenceText(limit));
  return text;
}

std::string eventsCsv(const std::vector<EventRow>& rows, const std::pair<std::string, std::string>& first) {
  const auto led = [](const std::string& cell) { return cell.empty() ? "" : support::csvCell(cell) + ","; };
  std::string text =
      led(first.first) + "event,level,level is,runs,go,why,figure,runs with it,mean,half width,inconclusive\n";
  for (const EventRow& row : rows) {
    const std::string head =
        led(first.second) + fmt::format("{},{},{},{},{},{}", base::wordOf(row.event), levelCell(row.event, row.level),
                                        support::csvCell(levelText(row.event)), row.runs, row.gos,
                                        support::csvCell(row.why()));
    if (row.figures.empty()) text += head + ",,,,,\n";
    for (const FigureOverSeeds& f : row.figures)
      text += fmt::format("{},{},{},{},{},{}\n", head, support::csvCell(f.name), f.values.size(),
                          support::csvCell(f.estimate.value), support::csvCell(f.estimate.halfWidth),
                          support::csvCell(row.doubtOf(f)));
  }
  return text;
}

nlohmann::ordered_json eventsJson(const std::vector<EventRow>& rows, const std::vector<EventLimit>& limits,
                                  const EventPlan& plan) {
  using Json = nlohmann::ordered_json;
  const auto number = [](const std::optional<double>& v) { return v && std::isfinite(*v) ? Json(*v) : Json(); };
  Json json;
  json["rows"] = Json::array();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const EventRow& row = rows[i];
    Json entry = {{"event", base::wordOf(row.event)},
                  {"title", titleOf(row.event)},
                  {"level", levelText(row.event).empty() ? Json() : Json(row.level)},
                  {"level_is", levelText(row.event)},
                  {"verdict", goText(row)},
                  {"runs", row.runs},
                  {"go", row.gos},
                  {"failed", row.unknown},
                  {"pending", row.pending},
                  {"incomplete", row.incomplete},
                  {"why", row.why()},
                  {"each", Json::array()},
                  {"picture", row.picture},
                  {"scene", plan.sweep.runs[plan.trials[i].runs.front()].file.filename().string()},
                  {"overrides", plan.sweep.runs[plan.trials[i].runs.front()].overrides}};
    for (const RunVerdict& r : row.each)
      entry["each"].push_back({{"run", r.run}, {"verdict", r.verdict}, {"why", r.why}});
    entry["figures"] = Json::array();
    for (const FigureOverSeeds& f : row.figures)
      entry["figures"].push_back({{"name", f.name},
                                  {"runs", f.values.size()},
                                  {"values", f.values},
                                  {"mean", f.estimate.value},
                                  {"half_width", number(f.estimate.halfWidth)},
                                  {"doubt", row.doubtOfMean(f.name)},
                                  {"inconclusive", !row.doubtOf(f).empty()}});
    json["rows"].push_back(entry);
  }
  json["limits"] = Json::array();
  for (const EventLimit& limit : limits)
    json["limits"].push_back({{"event", base::wordOf(limit.event)},
                              {"level_is", levelText(limit.event)},
                              {"go", number(limit.go)},
                              {"no_go", number(limit.noGo)},
                              {"reference", limit.reference ? Json(limit.reference->text) : Json()},
                              {"passes", limit.reference ? number(limit.reference->passes) : Json()},
                              {"blocks", limit.reference ? number(limit.reference->blocks) : Json()},
                              {"agrees", limit.agrees ? Json(*limit.agrees) : Json()}});
  for (const auto& [event, why] : plan.omitted) json["left_out"][std::string(base::wordOf(event))] = why;
  return json;
}

} // namespace grouser::events
