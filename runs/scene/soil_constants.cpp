// SPDX-License-Identifier: BSD-3-Clause
#include "runs/scene/soil_constants.hpp"

#include "base/math.hpp"
#include "base/random.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace grouser::scene {

namespace {

using Q = SoilQuantity;

constexpr double kNormal95 = 1.959964; // half width of a 95 % interval / standard deviation
constexpr double kMaxDeviations = 3;

/// ASSUMED standard deviation / value [-], for constants without an interval in their source. No publication was found
/// for these values; they are about half of the deviation from a table of soils that `grouser soil` accepts (n 15 %,
/// phi 2 degrees, K 30 %). The deviations of k_c and k_phi follow from n and kPressureDeviation.
double assumedDeviation(SoilQuantity quantity) {
  switch (quantity) {
  case Q::exponent:
    return 0.05;
  case Q::cohesion:
    return 0.20;
  case Q::frictionAngle:
    return 0.05; // deviation of tan phi
  case Q::shearModulus:
    return 0.25;
  default:
    return 0;
  }
}

double lengthOf(double a, double b) { return std::sqrt(a * a + b * b); }
double tangent(double degrees) { return base::tan(degrees * base::kPi / 180); }
double degrees(double tangent) { return base::atan(tangent) * 180 / base::kPi; }

/// Standard deviation / value, from the half width of a 95 % interval.
double deviationOf(SoilQuantity quantity, double value, double halfWidth) {
  if (quantity == Q::frictionAngle)
    return value > 0 ? (tangent(value + halfWidth) - tangent(value - halfWidth)) / (2 * kNormal95 * tangent(value)) : 0;
  return value != 0 ? halfWidth / (kNormal95 * std::fabs(value)) : 0;
}

ContactConstant constantOf(const PublishedConstant& p) {
  ContactConstant c{p.quantity, p.value, assumedDeviation(p.quantity), true};
  if (p.low || p.high) {
    const double halfWidth = std::max(p.high.value_or(p.value) - p.value, p.value - p.low.value_or(p.value));
    c.deviation = deviationOf(p.quantity, p.value, halfWidth), c.isAssumed = false;
  }
  return c;
}

/// Pressure-sinkage relation at the reference: ln of the sinkage [m] under kReferencePressure. Empty where constants
/// are missing, or where k is not positive.
std::optional<double> referenceSinkage(const std::vector<ContactConstant>& constants) {
  const ContactConstant *n = findConstant(constants, Q::exponent), *kc = findConstant(constants, Q::cohesiveModulus),
                        *kphi = findConstant(constants, Q::frictionalModulus);
  if (!n || !kc || !kphi || !(n->value > 0)) return {};
  const double k = kc->value / kReferenceWidth + kphi->value;
  if (!(k > 0)) return {};
  return base::log(kReferencePressure / k) / n->value;
}

/// Standard deviation of the logarithm of a quantity with this deviation of its value.
double logDeviation(double deviation) { return std::sqrt(base::log(1 + deviation * deviation)); }

/// Grain radius with the most measured constants; the smallest if several have as many.
double measuredRadius(const Soil& soil) {
  std::map<double, int> constants;
  for (const ReachedConstant& r : soil.reached)
    if (std::find(kContactQuantities.begin(), kContactQuantities.end(), r.quantity) != kContactQuantities.end())
      ++constants[r.grainRadius];
  const auto most = std::max_element(constants.begin(), constants.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == constants.end() ? 0 : most->first;
}

std::optional<ContactConstant> published(const Soil& soil, SoilQuantity quantity) {
  const PublishedConstant* p = soil.publishedValue(quantity);
  return p ? std::optional(constantOf(*p)) : std::nullopt;
}

std::optional<ContactConstant> measured(const Soil& soil, SoilQuantity quantity, double radius) {
  const ReachedConstant* found = nullptr;
  for (const ReachedConstant& r : soil.reached)
    if (r.quantity == quantity && (!found || (r.grainRadius == radius && found->grainRadius != radius))) found = &r;
  if (!found) return {};
  return ContactConstant{quantity, found->value, deviationOf(quantity, found->value, found->halfWidth), false};
}

/// Standard normal number of a sample for a constant, by Box and Muller's formula.
double normal(int number, SoilQuantity quantity) {
  constexpr std::uint64_t kPurpose = base::purpose("scm.constants");
  const auto id = static_cast<std::uint64_t>(std::find(kContactQuantities.begin(), kContactQuantities.end(), quantity) -
                                             kContactQuantities.begin());
  const auto seed = static_cast<std::uint64_t>(number);
  const double u = 1 - base::uniform(seed, kPurpose, id, 0), v = base::uniform(seed, kPurpose, id, 1);
  return std::clamp(std::sqrt(-2 * base::log(u)) * base::cos(2 * base::kPi * v), -kMaxDeviations, kMaxDeviations);
}

} // namespace

const ContactConstant* findConstant(const std::vector<ContactConstant>& constants, SoilQuantity quantity) {
  const auto found = std::find_if(constants.begin(), constants.end(),
                                  [quantity](const ContactConstant& c) { return c.quantity == quantity; });
  return found == constants.end() ? nullptr : &*found;
}

double ContactConstant::halfWidth() const {
  if (quantity != Q::frictionAngle) return kNormal95 * deviation * std::fabs(value);
  const double by = kNormal95 * deviation;
  return 0.5 * (degrees((1 + by) * tangent(value)) - degrees((1 - by) * tangent(value)));
}

std::vector<ContactConstant> contactConstants(const Soil& soil, SoilConstantsFrom from) {
  const double radius = measuredRadius(soil);
  std::vector<ContactConstant> constants;
  for (const SoilQuantity q : kContactQuantities)
    if (const auto c = from == SoilConstantsFrom::published ? published(soil, q) : measured(soil, q, radius))
      constants.push_back(*c);
  const std::optional<double> sinkage = referenceSinkage(constants);
  const ContactConstant* n = findConstant(constants, Q::exponent);
  for (ContactConstant& c : constants)
    if (c.isAssumed && (c.quantity == Q::cohesiveModulus || c.quantity == Q::frictionalModulus))
      c.deviation = sinkage ? lengthOf(kPressureDeviation, n->deviation * n->value * *sinkage) : kPressureDeviation;
  return constants;
}

void drawContactConstants(std::vector<ContactConstant>& constants, int number) {
  const std::optional<double> sinkage = referenceSinkage(constants); // with the nominal constants
  const auto isFixed = [&](SoilQuantity q) {
    const ContactConstant* c = findConstant(constants, q);
    return c && c->deviation == 0;
  };
  const bool modulusIsFixed = isFixed(Q::cohesiveModulus) && isFixed(Q::frictionalModulus);
  double modulusFactor = base::exp(kPressureDeviation * normal(number, Q::frictionalModulus));
  for (ContactConstant& c : constants) { // n first
    if (c.deviation == 0) continue;
    double spread = logDeviation(c.deviation), at = normal(number, c.quantity);
    if (c.quantity == Q::exponent) {
      // With a given k only n contributes to the deviation of the pressure.
      if (modulusIsFixed && sinkage) spread = std::min(spread, kPressureDeviation / std::fabs(c.value * *sinkage));
      const double drawn = c.value * base::exp(spread * at);
      if (sinkage) modulusFactor *= base::exp((c.value - drawn) * *sinkage);
      c.value = drawn;
    } else if (c.quantity == Q::cohesiveModulus || c.quantity == Q::frictionalModulus) {
      c.value *= modulusFactor;
    } else if (c.quantity == Q::frictionAngle) {
      at = kStrengthCorrelation * normal(number, Q::cohesion) +
           std::sqrt(1 - kStrengthCorrelation * kStrengthCorrelation) * at;
      c.value = degrees(tangent(c.value) * base::exp(spread * at));
    } else {
      c.value *= base::exp(spread * at);
    }
  }
}

double modulusCorrelation(const std::vector<ContactConstant>& constants) {
  const std::optional<double> sinkage = referenceSinkage(constants);
  if (!sinkage) return 0;
  const ContactConstant& n = *findConstant(constants, Q::exponent);
  const double byExponent = -n.deviation * n.value * *sinkage;
  return byExponent / lengthOf(kPressureDeviation, byExponent);
}

std::string jointDistributionText(const std::vector<ContactConstant>& constants) {
  return fmt::format("sampled constants (scm.constants_draw): pressure is assumed to have a standard deviation of {:g} "
                     "% at the sinkage under {:g} kPa, which implies a correlation of {:.2f} between ln k and n; the "
                     "correlation between c and tan phi is assumed to be {:g}",
                     100 * kPressureDeviation, 1e-3 * kReferencePressure, modulusCorrelation(constants),
                     kStrengthCorrelation);
}

} // namespace grouser::scene
