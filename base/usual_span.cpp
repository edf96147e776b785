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
  double least;  ///< smallest magnitude that is written in this unit; below it, nobody uses the unit
};

constexpr double kDegree = 0.017453292519943295; // [rad]

/// Units that are confused with the unit of the field, the most frequent first.
const std::vector<OtherUnit>& otherUnits(const Field& field) {
  static const std::vector<OtherUnit> lengths{{"millimetres", "mm", 1e-3, 0.01},
                                              {"centimetres", "cm", 1e-2, 0.1},
                                              {"inches", "in", 0.0254, 0.1},
                                              {"feet", "ft", 0.3048, 0.1},
                                              {"micrometres", "um", 1e-6, 1}};
  static const std::vector<OtherUnit> pressures{
      {"kPa", "kPa", 1e3, 0.01}, {"MPa", "MPa", 1e6, 1e-3}, {"GPa", "GPa", 1e9, 1e-3}, {"psi", "psi", 6894.757, 0.1}};
  static const std::vector<OtherUnit> moduli{pressures[2], pressures[1], pressures[0], pressures[3]};
  static const std::vector<OtherUnit> none;
  static const std::map<std::string, std::vector<OtherUnit>> all{
      {"m", lengths},
      {"deg", {{"radians", "rad", 1 / kDegree, 1e-3}}},
      {"rad", {{"degrees", "deg", kDegree, 0.1}}},
      {"rad or m", {{"degrees", "deg", kDegree, 0.1}, {"millimetres", "mm", 1e-3, 0.01}}},
      {"m or rad", {{"millimetres", "mm", 1e-3, 0.01}, {"degrees", "deg", kDegree, 0.1}}},
      {"Pa", pressures},
      {"N/m^(n+1)", {{"kN/m^(n+1)", "kN/m^(n+1)", 1e3, 0.01}}},
      {"N/m^(n+2)", {{"kN/m^(n+2)", "kN/m^(n+2)", 1e3, 1}, {"MN/m^(n+2)", "MN/m^(n+2)", 1e6, 1e-3}}},
      {"N/m3", {{"kN/m3", "kN/m3", 1e3, 1}, {"MN/m3", "MN/m3", 1e6, 0.1}, {"N/mm3", "N/mm3", 1e9, 1e-5}}},
      {"Pa s/m", {{"kPa s/m", "kPa s/m", 1e3, 0.01}}},
      {"N/m", {{"N/mm or kN/m", "kN/m", 1e3, 0.01}, {"kN/mm", "kN/mm", 1e6, 1e-3}}},
      {"N", {{"kN", "kN", 1e3, 1e-3}}},
      {"N m", {{"kN m", "kN m", 1e3, 1e-3}, {"N mm", "N mm", 1e-3, 1}}},
      {"N m/rad", {{"N m/deg", "N m/deg", 1 / kDegree, 1e-3}, {"kN m/rad", "kN m/rad", 1e3, 1e-3}}},
      {"kg/m3", {{"g/cm3 or t/m3", "g/cm3", 1e3, 0.1}}},
      {"kg", {{"grams", "g", 1e-3, 1e-3}, {"tonnes", "t", 1e3, 1e-3}}},
      {"kg m2", {{"kg mm2", "kg mm2", 1e-6, 1}, {"g cm2", "g cm2", 1e-7, 0.01}, {"t m2", "t m2", 1e3, 1e-4}}},
      {"s", {{"milliseconds", "ms", 1e-3, 0.01}, {"microseconds", "us", 1e-6, 0.1}}},
      {"m/s", {{"km/h", "km/h", 1 / 3.6, 0.1}, {"mm/s", "mm/s", 1e-3, 0.01}}},
      {"m/s2", {{"multiples of g", "g", 9.80665, 0.1}, {"mm/s2", "mm/s2", 1e-3, 1}, {"cm/s2", "cm/s2", 1e-2, 1}}},
      {"rad/s", {{"revolutions per minute", "rpm", 6 * kDegree, 0.1}, {"degrees per second", "deg/s", kDegree, 0.1}}},
      {"Pa s", {{"mPa s (cP)", "mPa s", 1e-3, 0.01}}},
      {"J/m2", {{"mJ/m2", "mJ/m2", 1e-3, 0.01}}},
      {"Hz", {{"revolutions per minute", "rpm", 1.0 / 60, 0.1}}},
      {"-", {{"percent", "%", 1e-2, 1.5}}}};                // 1.0000001 is one, rounded, rather than a percentage
  if (field.unit == "-" && field.usualMax > 1) return none; // exponents and gear ratios are not in percent
  if (field.unit == "Pa" && field.usualMax > 1e9) return moduli;
  const auto found = all.find(field.unit);
  return found == all.end() ? none : found->second;
}

/// True if values in the unit occur for the field: depths and positions are not entered in micrometres.
bool isOfTheFieldsSize(const OtherUnit& unit, const Field& field) {
  return unit.factor > 1e-6 || (field.unit != "m" && field.unit != "s") ||
         (field.usualMin > 0 && field.usualMin < 1e3 * unit.factor);
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
  for (const OtherUnit& other : otherUnits(*this)) {
    const double meant = value * other.factor;
    if (std::fabs(value) < other.least || !isOfTheFieldsSize(other, *this)) continue;
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
                     usual ? fmt::format("is a common fraction of a turn{}", cause.empty() ? " in radians" : "")
                           : fmt::format("is outside the usual span, {}{}", usualText(),
                                         unit.empty() || unit == "-" ? "" : " " + unit),
                     cause.empty() ? "check the value and its unit" : cause);
}

} // namespace grouser::base
