// SPDX-License-Identifier: BSD-3-Clause
// Usual spans of fields: notes on values that suggest another unit.
#include "base/table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace grouser::base {

namespace {

/// A unit in which a value may have been entered by mistake.
struct OtherUnit {
  const char *name, *symbol;
  double factor; ///< value in the unit of the field / value in this unit
};

constexpr double kDegree = 0.017453292519943295; // [rad]

/// Units that are confused with the unit of a field, the most frequent first.
const std::vector<OtherUnit>& otherUnits(const std::string& unit) {
  static const std::vector<OtherUnit> lengths{{"millimetres", "mm", 1e-3}, {"centimetres", "cm", 1e-2},
                                              {"inches", "in", 0.0254},    {"feet", "ft", 0.3048},
                                              {"micrometres", "um", 1e-6}, {"kilometres", "km", 1e3}};
  static const std::vector<OtherUnit> pressures{
      {"kPa", "kPa", 1e3}, {"MPa", "MPa", 1e6}, {"GPa", "GPa", 1e9}, {"psi", "psi", 6894.757}};
  static const std::vector<OtherUnit> none;
  static const std::map<std::string, std::vector<OtherUnit>> all{
      {"m", lengths},
      {"deg", {{"radians", "rad", 1 / kDegree}}},
      {"rad", {{"degrees", "deg", kDegree}}},
      {"rad or m", {{"degrees", "deg", kDegree}, {"millimetres", "mm", 1e-3}}},
      {"m or rad", {{"millimetres", "mm", 1e-3}, {"degrees", "deg", kDegree}}},
      {"Pa", pressures},
      {"N/m^(n+1)", {{"kN/m^(n+1)", "kN/m^(n+1)", 1e3}}},
      {"N/m^(n+2)", {{"kN/m^(n+2)", "kN/m^(n+2)", 1e3}, {"MN/m^(n+2)", "MN/m^(n+2)", 1e6}}},
      {"N/m3", {{"kN/m3", "kN/m3", 1e3}, {"MN/m3", "MN/m3", 1e6}, {"N/mm3", "N/mm3", 1e9}}},
      {"Pa s/m", {{"kPa s/m", "kPa s/m", 1e3}}},
      {"N/m", {{"N/mm or kN/m", "kN/m", 1e3}, {"kN/mm", "kN/mm", 1e6}}},
      {"N", {{"kN", "kN", 1e3}}},
      {"N m", {{"kN m", "kN m", 1e3}, {"N mm", "N mm", 1e-3}}},
      {"N m/rad", {{"N m/deg", "N m/deg", 1 / kDegree}, {"kN m/rad", "kN m/rad", 1e3}}},
      {"kg/m3", {{"g/cm3 or t/m3", "g/cm3", 1e3}}},
      {"kg", {{"grams", "g", 1e-3}, {"tonnes", "t", 1e3}}},
      {"kg m2", {{"kg mm2", "kg mm2", 1e-6}, {"g cm2", "g cm2", 1e-7}, {"t m2", "t m2", 1e3}}},
      {"s", {{"milliseconds", "ms", 1e-3}, {"microseconds", "us", 1e-6}, {"minutes", "min", 60}}},
      {"m/s", {{"km/h", "km/h", 1 / 3.6}, {"mm/s", "mm/s", 1e-3}}},
      {"m/s2", {{"multiples of g", "g", 9.80665}, {"mm/s2", "mm/s2", 1e-3}, {"cm/s2", "cm/s2", 1e-2}}},
      {"rad/s", {{"revolutions per minute", "rpm", 6 * kDegree}, {"degrees per second", "deg/s", kDegree}}},
      {"Pa s", {{"mPa s (cP)", "mPa s", 1e-3}}},
      {"J/m2", {{"mJ/m2", "mJ/m2", 1e-3}}},
      {"Hz", {{"revolutions per minute", "rpm", 1.0 / 60}, {"kHz", "kHz", 1e3}}},
      {"-", {{"percent", "%", 1e-2}}}};
  const auto found = all.find(unit);
  return found == all.end() ? none : found->second;
}

/// True for multiples of 15 degrees in radians, up to a full turn, rounded to three digits or more.
bool isFractionOfTurn(double value) {
  constexpr double kRounding = 6e-4, kStep = 15 * kDegree;
  const double steps = std::fabs(value) / kStep, whole = std::round(steps);
  return whole >= 1 && whole <= 24 && std::fabs(steps - whole) <= kRounding * whole;
}

bool isUsual(const Field& field, double value) {
  const double size = std::fabs(value);
  return value == 0 || (size >= field.usualMin && size <= field.usualMax);
}

} // namespace

std::string Field::usualText() const {
  if (!hasUsualSpan()) return "";
  const std::string least = fmt::format("{:.6g}", usualMin), greatest = fmt::format("{:.6g}", usualMax);
  return !std::isfinite(usualMax) ? "at least " + least
         : usualMin == 0          ? "at most " + greatest
                                  : least + " to " + greatest;
}

std::string Field::unitSlip(double value) const {
  if (unit == "-" && !slip.empty()) return slip;
  for (const OtherUnit& other : otherUnits(unit)) {
    const double meant = value * other.factor;
    if (!isUsual(*this, meant) || meant < min || meant > max) continue;
    return fmt::format("in {}? {:.6g} {} = {:.4g}{}", other.name, value, other.symbol, meant,
                       unit == "-" ? "" : " " + unit);
  }
  return slip;
}

std::string Field::unusualText(double value) const {
  const bool usual = isUsual(*this, value);
  if (usual && !(unit == "deg" && isFractionOfTurn(value))) return "";
  const std::string cause = unitSlip(value);
  return fmt::format("{}; {}",
                     usual ? "is a common fraction of a turn in radians"
                           : fmt::format("is outside the usual span, {}{}", usualText(),
                                         unit.empty() || unit == "-" ? "" : " " + unit),
                     cause.empty() ? "check the value and its unit" : cause);
}

} // namespace grouser::base
