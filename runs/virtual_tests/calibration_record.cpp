// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/calibration_record.hpp"

#include "runs/jobs/estimate.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/json_text.hpp"
#include "runs/support/text_file.hpp"
#include "runs/virtual_tests/soil_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

namespace grouser::virtual_tests {

namespace {

using Json = nlohmann::ordered_json;

/// Value of a key in a soil file: a number, or a word without its quotes.
Json valueOf(const std::string& toml) {
  char* end = nullptr;
  const double number = std::strtod(toml.c_str(), &end);
  if (!toml.empty() && *end == '\0') return number;
  const bool isQuoted = toml.size() > 1 && toml.front() == '"' && toml.back() == '"';
  return isQuoted ? toml.substr(1, toml.size() - 2) : toml;
}

Json curveTargetsJson(const CurveTargets& t) {
  Json all = Json::array();
  if (t.repose)
    all.push_back({{"quantity", "repose"}, {"wanted", *t.repose}, {"unit", "deg"}, {"tolerance", t.reposeTolerance}});
  if (t.bulkDensity)
    all.push_back(
        {{"quantity", "bulk_density"}, {"wanted", *t.bulkDensity}, {"unit", "kg/m3"}, {"tolerance", nullptr}});
  for (const MeasuredPlate& plate : t.plates)
    for (const MeasuredPressure& p : plate.points)
      all.push_back({{"quantity", CurvePoint{plate.diameter, p, {}}.name()},
                     {"wanted", 1e-3 * p.mean},
                     {"unit", "kPa"},
                     {"tolerance", 1e-3 * p.mean * p.deviation}});
  return all;
}

Json targetsJson(const CalibrationTargets& t) {
  if (t.curves) return curveTargetsJson(*t.curves);
  Json all = Json::array();
  for (const auto& [q, wanted] : t.wanted) {
    Json one{{"quantity", symbolOf(q)}, {"wanted", wanted}, {"unit", unitOf(q)}, {"tolerance", nullptr}};
    if (q == Quantity::frictionAngle) one["tolerance"] = t.angleTolerance;
    if (q == Quantity::cohesion) one["tolerance"] = t.cohesionTolerance;
    all.push_back(one);
  }
  if (t.k) all.push_back({{"quantity", "k"}, {"wanted", *t.k}, {"unit", "kN/m^(n+2)"}, {"tolerance", nullptr}});
  if (t.breadth) all.push_back({{"quantity", "b"}, {"wanted", *t.breadth}, {"unit", "m"}, {"tolerance", nullptr}});
  return all;
}

} // namespace

bool TargetOutcome::isReached() const { return tolerance && std::fabs(reached.value - wanted) <= *tolerance; }

std::string outcomesText(const std::vector<TargetOutcome>& outcomes, bool coarse) {
  std::string text = fmt::format("\n{}targets and results\n", coarse ? "coarse: " : "");
  for (const TargetOutcome& o : outcomes) {
    text += fmt::format("  {:<22} {:>20} {:<11} target {:g}", o.what, jobs::valueText(o.reached), o.unit, o.wanted);
    text += o.isSought()
                ? fmt::format(" +- {:g}: {}\n", *o.tolerance, o.isReached() ? "reached" : "not reached (closest trial)")
                : std::string(": not fitted\n");
  }
  return text;
}

CalibrationRecord::CalibrationRecord(const CalibrationCommand& command, const CalibrationTargets& targets,
                                     const std::filesystem::path& folder)
    : file_(folder / "calibration.json") {
  const support::BuildInfo build = support::buildInfo();
  json_ = {
      {"soil", targets.start.name},
      {"targets_file", command.targets.string()},
      {"care", command.place.quick ? "coarse" : "full"},
      {"status", "searching"},
      {"grain_radius_m", targets.start.grainRadius},
      {"seeds", {{"small", command.plan.seeds}, {"large", command.plan.largeSeeds}, {"shear", command.plan.seeds}}},
      {"targets", targetsJson(targets)}};
  if (targets.curves) json_["contact_pressure_pa"] = targets.curves->contactPressure;
  if (targets.requestsSinkage())
    json_["pressure"] = {{"wanted", 1e-3 * kTrackPressure},
                         {"unit", "kPa"},
                         {"tolerance", 1e-3 * kTrackPressure * targets.stiffnessTolerance}};
  json_["trials"] = Json::array();
  json_["command"] = command.words;
  json_["machine"] = support::machineText();
  json_["version"] = build.version, json_["commit"] = build.commit;
}

bool CalibrationRecord::isOfThisCall() const {
  std::ifstream file(file_);
  const Json former = Json::parse(file, nullptr, false);
  if (!former.is_object()) return false;
  const auto keys = {"soil", "targets_file", "care", "grain_radius_m", "seeds", "targets", "contact_pressure_pa"};
  return std::all_of(keys.begin(), keys.end(),
                     [&](const char* key) { return former.value(key, Json()) == json_.value(key, Json()); });
}

void CalibrationRecord::begun() {
  if (!isBegun_) write();
  isBegun_ = true;
}

void CalibrationRecord::add(const std::string& name, const char* kind, const TestedSoil& soil, Json measured) {
  Json parameters;
  for (const auto& [key, value] : soil.keys) parameters[key] = valueOf(value);
  if (soil.porosity) parameters["porosity"] = *soil.porosity;
  json_["trials"].push_back(
      {{"name", name}, {"kind", kind}, {"parameters", parameters}, {"measured", std::move(measured)}});
  write();
}

void CalibrationRecord::shear(const std::string& name, const TestedSoil& soil,
                              const std::map<Quantity, support::Estimate>& measured) {
  Json values;
  for (const Quantity q : {Quantity::frictionAngle, Quantity::cohesion, Quantity::shearModulus})
    if (const auto found = measured.find(q); found != measured.end())
      values[symbolOf(q)] = estimateJson(found->second, unitOf(q));
  add(name, "shear", soil, values);
}

void CalibrationRecord::curves(const std::string& name, const SoilInBed& bed, const CurveComparison& curves,
                               const std::map<Quantity, support::Estimate>& measured, double misfit) {
  const auto exact = [](double value, const char* unit) {
    return Json{{"value", value}, {"half_width", nullptr}, {"unit", unit}};
  };
  Json values{{"misfit", exact(misfit, "-")},
              {"porosity", exact(curves.porosity, "-")},
              {"depth", exact(bed.depth, "m")},
              {"zero_of_sinkage", exact(curves.zeroOfSinkage, "m")}};
  for (const CurvePoint& p : curves.points)
    values[p.name()] = estimateJson({1e-3 * p.simulated.value, 1e-3 * p.simulated.halfWidth}, "kPa");
  if (const auto found = measured.find(Quantity::repose); found != measured.end())
    values["repose"] = estimateJson(found->second, unitOf(Quantity::repose));
  add(name, "curves", bed.soil, values);
}

void CalibrationRecord::plate(const std::string& name, const TestedSoil& soil, const support::Estimate& pressure,
                              double sinkage) {
  add(name, "plate", soil,
      {{"pressure", estimateJson({1e-3 * pressure.value, 1e-3 * pressure.halfWidth}, "kPa")},
       {"sinkage", {{"value", 1e3 * sinkage}, {"unit", "mm"}}}});
}

void CalibrationRecord::stopped(const std::string& name, int missingTests) {
  json_["status"] = "unfinished";
  json_["missing"] = {{"trial", name}, {"tests", missingTests}};
  write();
}

void CalibrationRecord::ended(const std::vector<TargetOutcome>& outcomes, const std::string& soilFile,
                              const std::string& tests) {
  json_["status"] = "finished";
  json_["outcomes"] = Json::array();
  for (const TargetOutcome& o : outcomes) {
    Json one{{"what", o.what}, {"wanted", o.wanted}, {"tolerance", nullptr}};
    if (o.tolerance) one["tolerance"] = *o.tolerance;
    one["reached"] = estimateJson(o.reached, o.unit);
    one["verdict"] = !o.isSought() ? "not sought" : o.isReached() ? "reached" : "not reached";
    json_["outcomes"].push_back(one);
  }
  json_["soil_file"] = soilFile;
  json_["tests"] = tests;
  write();
}

void CalibrationRecord::write() const {
  std::filesystem::create_directories(file_.parent_path());
  support::replaceTextFile(file_, support::jsonText(json_, 2) + "\n");
}

} // namespace grouser::virtual_tests
