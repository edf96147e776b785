// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "scm/soil_constants.hpp"

#include <algorithm>

namespace grouser::scm {

/// Shear strength of a contact, [N] = cohesion [Pa] * area + friction [-] * normal force.
struct ShearStrength {
  double cohesion{}, friction{};

  double of(double area, double force) const { return cohesion * area + friction * force; }
};

/// Grousers of a track shoe.
struct Grousers {
  int count{};
  double height{}; ///< [m]

  static constexpr double kSteel = 2.0 / 3; ///< soil-steel friction angle / phi, and adhesion / c [-]
};

/// Shear strengths of a shoe with these side lengths [m]. The lower one applies.
struct ShoeStrength {
  /// Internal shear of the soil in the plane of the grouser tips and along the sides of the shoe (Bekker 1956).
  ShearStrength block;
  /// Sliding of soil on the plate, plus Rankine's passive pressure on each grouser face.
  ShearStrength plate;

  double of(double area, double force) const { return std::min(block.of(area, force), plate.of(area, force)); }
};

inline ShoeStrength shoeStrength(const SoilConstants& soil, const Grousers& grousers, double length, double width) {
  const double h = grousers.height, phi = base::atan(soil.friction), ratio = h / width;
  const double N = base::tan(base::kPi / 4 + phi / 2) * base::tan(base::kPi / 4 + phi / 2);
  ShoeStrength s;
  s.block.cohesion = soil.cohesion * (1 + 2 * ratio);
  s.block.friction = soil.friction * (h > 0 ? 1 + 0.64 * ratio * base::atan(1 / ratio) : 1);
  // Passive force per width: unitWeight h^2 N / 2 + p h N + 2 c h sqrt(N).
  const double perLength = grousers.count / length;
  s.plate.cohesion = Grousers::kSteel * soil.cohesion +
                     perLength * h * (0.5 * soil.unitWeight * h * N + 2 * soil.cohesion * ::sqrt(N));
  s.plate.friction = base::tan(Grousers::kSteel * phi) + perLength * h * N;
  return s;
}

/// Bulldozing resistance per length of a vertical side pushing into soil of depth h [N/m] (Hegedus 1960): D1 (c h + D2
/// gamma h^2 / 2) with X = 45 deg - phi / 2, D1 = cot X + tan(X + phi), D2 = cot X + cot^2 X tan phi.
class SideResistance {
public:
  explicit SideResistance(const SoilConstants& soil) {
    const double phi = base::atan(soil.friction), X = base::kPi / 4 - phi / 2, cot = 1 / base::tan(X);
    const double D1 = cot + base::tan(X + phi);
    linear_ = D1 * soil.cohesion, square_ = 0.5 * D1 * (cot + cot * cot * soil.friction) * soil.unitWeight;
  }
  double at(double depth) const { return depth > 0 ? depth * (linear_ + square_ * depth) : 0; }

private:
  double linear_, square_;
};

} // namespace grouser::scm
