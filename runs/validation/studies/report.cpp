// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/report.hpp"

#include <fmt/format.h>

#include <cmath>

namespace grouser::studies {

namespace {

std::string orDash(double x, const char* format) {
  return std::isfinite(x) ? fmt::format(fmt::runtime(format), x) : "-";
}

/// A failure message, shortened for a table.
std::string brief(const std::string& failure) {
  constexpr std::size_t kWidth = 90;
  return failure.size() <= kWidth ? failure : failure.substr(0, kWidth - 3) + "...";
}

} // namespace

std::string caseTable(const StudyResult& r) {
  std::string text =
      fmt::format("\n{}: {}; reference: {}\n  {:<9} {:>10} {:>10} {:>10} {:>6} {:>11} {:>11} {:>11} {:>10} {:>8}\n",
                  r.study.name, r.study.title, r.study.source, "", "step [s]", "steps", "error [-]", "order", "gap [m]",
                  "rate [m/s]", "energy [J]", "CPU [s]", "us/step");
  for (const StudyPoint& p : r.points) {
    if (!p.error) {
      text += fmt::format("  {:<9} {:>10.4g} {:>10} {}\n", p.integrator, p.step, p.steps, brief(p.failure));
      continue;
    }
    text += fmt::format("  {:<9} {:>10.4g} {:>10} {:>10.3e} {:>6} {:>11.2e} {:>11.2e} {:>11.2e} {:>10.4g} {:>8.3g}\n",
                        p.integrator, p.step, p.steps, *p.error, orDash(p.order, "{:.2f}"), p.positionDrift,
                        p.velocityDrift, p.energyDrift, p.seconds, 1e6 * p.seconds / static_cast<double>(p.steps));
  }
  return text;
}

std::string pointsCsv(const std::vector<StudyResult>& results) {
  std::string text = "case,integrator,step [s],steps,error [-],order [-],largest gap [m],largest opening rate [m/s],"
                     "energy drift [J],CPU [s],failure\n";
  for (const StudyResult& r : results)
    for (const StudyPoint& p : r.points) {
      std::string failure = p.failure;
      for (char& c : failure)
        if (c == '"') c = '\'';
      text += fmt::format("{},{},{},{},{},{},{},{},{},{},\"{}\"\n", r.study.name, p.integrator, p.step, p.steps,
                          p.error ? fmt::format("{}", *p.error) : "",
                          std::isfinite(p.order) ? fmt::format("{}", p.order) : "", p.positionDrift, p.velocityDrift,
                          p.energyDrift, p.seconds, failure);
    }
  return text;
}

const StudyPoint* cheapest(const StudyResult& r, double threshold) {
  const StudyPoint* best = nullptr;
  for (const StudyPoint& p : r.points)
    if (p.error && *p.error <= threshold && (!best || p.seconds < best->seconds)) best = &p;
  return best;
}

std::string cheapestTable(const std::vector<StudyResult>& results) {
  std::string text = fmt::format("\ncheapest integrator and step for a given precision\n  {:<13} {:<34} {:<34}\n", "",
                                 "low: error <= 1e-1", "high: error <= 1e-3");
  for (const StudyResult& r : results) {
    text += fmt::format("  {:<13}", r.study.name);
    for (const double threshold : {kLowPrecision, kHighPrecision}) {
      const StudyPoint* p = cheapest(r, threshold);
      text += fmt::format(" {:<34}",
                          p ? fmt::format("{:.4g} s, {} at {:.4g} s", p->seconds, p->integrator, p->step) : "none");
    }
    text += "\n";
  }
  return text;
}

std::string cheapestCsv(const std::vector<StudyResult>& results) {
  std::string text = "case,precision [-],integrator,step [s],error [-],CPU [s]\n";
  for (const StudyResult& r : results)
    for (const double threshold : {kLowPrecision, kHighPrecision})
      if (const StudyPoint* p = cheapest(r, threshold))
        text +=
            fmt::format("{},{},{},{},{},{}\n", r.study.name, threshold, p->integrator, p->step, *p->error, p->seconds);
      else
        text += fmt::format("{},{},,,,\n", r.study.name, threshold);
  return text;
}

std::string reactionTable(const std::vector<ReactionResult>& results) {
  if (results.empty()) return "";
  std::string text = fmt::format("\nreactions\n  {:<48} {:<8} {:>16} {:>16} {:>14}\n", "", "", "exact [N]", "mean [N]",
                                 "worst step [-]");
  for (const ReactionResult& r : results) {
    const std::string what = fmt::format("{}: {}", r.reaction.name, r.reaction.title);
    if (r.mean)
      text += fmt::format("  {:<48} {:<8} {:>16.9g} {:>16.9g} {:>14.2e}\n", what, r.integrator, r.reaction.exact,
                          *r.mean, r.worst);
    else
      text += fmt::format("  {:<48} {:<8} {}\n", what, r.integrator, brief(r.failure));
  }
  return text;
}

std::string reactionsCsv(const std::vector<ReactionResult>& results) {
  std::string text = "case,what,integrator,exact [N],mean [N],worst step [-]\n";
  for (const ReactionResult& r : results)
    text += fmt::format("{},\"{}\",{},{},{},{}\n", r.reaction.name, r.reaction.title, r.integrator, r.reaction.exact,
                        r.mean ? fmt::format("{}", *r.mean) : "", r.worst);
  return text;
}

} // namespace grouser::studies
