// SPDX-License-Identifier: BSD-3-Clause
// `grouser study fluid`: selection of flows and spacings, tables and files.
#include "runs/validation/studies/fluid_command.hpp"

#include "runs/output/plots.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/text_file.hpp"
#include "runs/validation/studies/fluid_cases.hpp"
#include "runs/validation/studies/option_parts.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>

namespace grouser::studies {

namespace {

struct FluidResult {
  FluidCase study;
  std::vector<FluidPoint> points;
};

/// Verdict at the finest spacing; "" if this spacing was not run or the quantity has no tolerance.
std::string verdictOf(const FluidResult& result, std::size_t quantity) {
  const double bar = result.study.quantities[quantity].bar, error = result.points.back().errors[quantity];
  return bar == 0 || result.points.size() < result.study.spacings.size()
             ? ""
             : fmt::format("{} {:g}", error <= bar ? "within" : "beyond", bar);
}

std::string fluidTable(const FluidResult& result) {
  const FluidCase& c = result.study;
  std::string text = fmt::format("\n{}: relative errors\n  {:>11} {:>10} {:>8} {:>10} {:>9}", c.title, "spacing [m]",
                                 "particles", "steps", "step [s]", "wall [s]");
  for (const FluidQuantity& q : c.quantities) text += fmt::format(" {:>20}", q.name);
  for (const FluidPoint& p : result.points) {
    text += fmt::format("\n  {:>11g} {:>10} {:>8} {:>10.3g} {:>9.3g}", p.spacing, p.particles, p.steps, p.timeStep,
                        p.seconds);
    for (const double error : p.errors) text += fmt::format(" {:>20.2e}", error);
  }
  text += fmt::format("\n  {:<52}", "order in spacing");
  for (std::size_t q = 0; q < c.quantities.size(); ++q)
    text += fmt::format(" {:>20}", fluidOrder(result.points, q).slopeText());
  text += fmt::format("\n  {:<52}", "finest spacing, tolerance");
  for (std::size_t q = 0; q < c.quantities.size(); ++q) text += fmt::format(" {:>20}", verdictOf(result, q));
  return text + "\n";
}

std::string fluidCsv(const std::vector<FluidResult>& results) {
  std::string text = "case,quantity,spacing [m],particles,steps,step [s],wall time [s],error [-],bar [-]\n";
  for (const FluidResult& r : results)
    for (const FluidPoint& p : r.points)
      for (std::size_t q = 0; q < p.errors.size(); ++q)
        text +=
            fmt::format("{},\"{}\",{:g},{},{},{:.6g},{:.6g},{:.6g},{:g}\n", r.study.name, r.study.quantities[q].name,
                        p.spacing, p.particles, p.steps, p.timeStep, p.seconds, p.errors[q], r.study.quantities[q].bar);
  return text;
}

} // namespace

void studyFluidCommand(const FluidCommand& command) {
  const std::vector<FluidCase> cases = chosenCases(fluidCases(), command.cases);
  const auto begin = std::chrono::steady_clock::now();
  const auto folder = jobs::beginStudy("fluid", command.place);
  const support::StopSignals signals;
  const base::Exec exec = support::chooseDevice(support::deviceChoice(command.device), command.threads, nullptr);
  fmt::print("          two-dimensional flows on {}\n", base::describe(exec));
  support::Progress progress("studying");
  std::vector<FluidResult> results;
  int beyond = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    FluidResult result{cases[i], {}};
    std::vector<double> spacings = cases[i].spacings;
    if (command.place.quick) spacings.pop_back();
    for (const double spacing : spacings) {
      progress.update(static_cast<double>(i) / static_cast<double>(cases.size()),
                      fmt::format("{}, spacing {:g} m", cases[i].name, spacing));
      result.points.push_back({});
      result.points.back().spacing = spacing;
      cases[i].run(exec, result.points.back());
    }
    progress.note(fluidTable(result));
    for (std::size_t q = 0; q < cases[i].quantities.size(); ++q) beyond += verdictOf(result, q).starts_with("beyond");
    results.push_back(std::move(result));
  }
  progress.finish(fmt::format("{} cases, {} errors above the tolerance", cases.size(), beyond));
  support::writeTextFile(folder / "fluid.csv", fluidCsv(results), "--out");
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  jobs::writeStudyOrigin(folder, "fluid", seconds,
                         {{"device", base::describe(exec)}, {"threads", exec.threads}, {"quick", command.place.quick}});
  output::drawPicture("study_fluid.py", {folder / "fluid.csv"}, folder / "fluid.png");
  fmt::print("tables    {}\n", folder.string());
}

} // namespace grouser::studies
