// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/run_summary.hpp"

#include "base/math.hpp"
#include "runs/campaigns/sweeps/run_figures.hpp"
#include "runs/jobs/estimate.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace grouser::commands {

namespace {

struct Line {
  const char* label;
  const char* figure; ///< name in the summary of a sweep
  double scale;
  const char* unit;
  const char* note;
  bool ofHitch; ///< printed only for scenes with [hitch]
};
constexpr const char* kSinkage = "sinkage mean [m]";
constexpr Line kLines[] = {{"speed", "speed [m/s]", 1, "m/s", "", false},
                           {"slip", "slip [-]", 100, "%", "", false},
                           {"sinkage", kSinkage, 1e3, "mm", ", mean of the shoes in ground contact", false},
                           {"torque", "drive torque [N m]", 1, "N m", ", both sprockets", false},
                           {"pull", "drawbar pull [N]", 1e-3, "kN", ", drawbar pull", true},
                           {"motion", "motion resistance [N]", 1e-3, "kN", ", motion resistance", true}};

constexpr double kUnsteady = 0.08; ///< half range of the speed in the steady part over its mean, above which runs warn
constexpr double kSlow = 0.05;     ///< [m/s] no such warning below this mean speed

/// Warnings that precede the figures of a run.
std::string warningsOf(const nlohmann::json& run, const std::string& incomplete) {
  std::string text;
  if (const std::string doubt = run.value("inconclusive", ""); !doubt.empty() && doubt != incomplete)
    text = fmt::format("WARNING: the figures are inconclusive: {}\n", doubt);
  else if (const nlohmann::json range = run.value("speed_range", nlohmann::json()); range.is_array())
    if (const double low = range[0], high = range[1];
        std::fabs(high + low) > 2 * kSlow && high - low > kUnsteady * std::fabs(high + low))
      text =
          fmt::format("WARNING: the speed varies from {:.3g} to {:.3g} m/s in the steady part, so the means depend on "
                      "the length of that part; raise driver.drive_ramp or run.duration\n",
                      low, high);
  return text;
}

/// Error bar of a figure from the last check of the scene; infinite without a check.
double barOf(const nlohmann::json& run, const char* name) {
  const nlohmann::json& kept = run.at("check");
  if (!kept.is_object()) return base::kInfinity;
  for (const nlohmann::json& f : kept.at("check").at("figures"))
    if (f.at("name") == name && f.at("bar").is_number()) return f.at("bar");
  return base::kInfinity;
}

/// Height of the pads above rigid ground, on their grousers [m]; NaN on other ground, and if the pads sink.
double padHeight(const nlohmann::json& run) {
  if (!run.value("rigid_ground", false)) return base::kNaN;
  for (const nlohmann::json& f : run.at("figures"))
    if (f.at("name") == kSinkage && f.at("value").is_number() && f.at("value") < 0) return -f.at("value").get<double>();
  return base::kNaN;
}

/// ", drawbar pull, mean from 2.5 to 4 s": remark after the value of a line.
std::string noteOf(const nlohmann::json& run, const Line& line) {
  if (const double height = padHeight(run); line.figure == std::string(kSinkage) && std::isfinite(height))
    return fmt::format(": the shoes stand on their grousers, with the pads {:.3g} mm above the rigid ground",
                       line.scale * height);
  if (!line.ofHitch || !run.at("steady_from").is_number() || !run.at("until").is_number()) return line.note;
  return fmt::format("{}, mean from {:.4g} to {:.4g} s", line.note, run.at("steady_from").get<double>(),
                     run.at("until").get<double>());
}

std::string valueOf(const nlohmann::json& run, const Line& line) {
  if (line.ofHitch && !run.value("hitch", false)) return {};
  if (line.figure == std::string(kSinkage) && std::isfinite(padHeight(run))) return "none";
  for (const nlohmann::json& f : run.at("figures")) {
    if (f.at("name") != line.figure || !f.at("value").is_number()) continue;
    const double value = line.scale * f.at("value").get<double>(), bar = line.scale * barOf(run, line.figure);
    return fmt::format("{} {}", std::isfinite(bar) ? jobs::valueText({value, bar}) : fmt::format("{:.3g}", value),
                       line.unit);
  }
  return {};
}

} // namespace

std::string integrationWarning(const output::Summary& summary) {
  constexpr double kLarge = 0.05;         // [-] of the work of all forces
  constexpr std::int64_t kFewSteps = 100; // n steps from rest at constant acceleration have an error of 1 / n
  const double converted = summary.figures.at("energy_converted_J"),
               error = std::fabs(summary.figures.at("integration_error_J"));
  // The solver of complementarity contacts reports its own residual; its implicit steps damp motions by design.
  if (summary.steps < kFewSteps || summary.figures.contains("solver_missed_steps")) return {};
  if (!(converted > 0) || !(error > kLarge * converted + summary.figures.at("quiet_energy_J"))) return {};
  return fmt::format("the time-integration error is {:.2g} % of the work of all forces, {:.3g} J, so the results are "
                     "inaccurate; reduce run.time_step, and compare the results",
                     100 * error / converted, converted);
}

std::string sinkageWarning(const output::Summary& summary, double tabulated) {
  const auto sunk = summary.figures.find("largest_sinkage_m");
  if (sunk == summary.figures.end() || !(sunk->second > tabulated)) return {};
  return fmt::format("the soil sank by {:.3g} m, more than scm.largest_sinkage, {:g} m; beyond it the pressure is "
                     "linear in the sinkage instead of z^n; raise scm.largest_sinkage",
                     sunk->second, tabulated);
}

std::string energyText(const output::Summary& summary) {
  const double converted = summary.figures.at("energy_converted_J");
  if (!(converted > 0)) return {};
  const std::string warning = integrationWarning(summary);
  return fmt::format(
      "{}energy    residual {:.0e}, time-integration error {:.2g} %, relative to the absolute work of all "
      "forces, {:.3g} J\n",
      warning.empty() ? "" : fmt::format("WARNING: {}\n", warning),
      std::fabs(summary.figures.at("energy_residual_J")) / converted,
      100 * std::fabs(summary.figures.at("integration_error_J")) / converted, converted);
}

std::string driveFiguresText(const std::filesystem::path& folder, const std::filesystem::path& beside,
                             const std::string& incomplete) {
  const nlohmann::json run = sweeps::runFigures(folder);
  const nlohmann::json other = beside.empty() ? nlohmann::json() : nlohmann::json(sweeps::runFigures(beside));
  std::string text;
  for (const Line& line : kLines) {
    const std::string value = valueOf(run, line);
    if (value.empty()) continue;
    const std::string second = other.is_object() ? valueOf(other, line) : "";
    if (text.empty() && other.is_object())
      text += fmt::format("{:<10}{:<24}{}\n", "", folder.filename().string(), beside.filename().string());
    const std::string columns = second.empty() ? value : fmt::format("{:<24}{}", value, second);
    text += fmt::format("{:<10}{}{}\n", line.label, columns, noteOf(run, line));
  }
  return text.empty() ? text : warningsOf(run, incomplete) + text;
}

} // namespace grouser::commands
