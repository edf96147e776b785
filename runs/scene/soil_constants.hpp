// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/soil.hpp"

#include <array>
#include <string>
#include <vector>

/// Constants of the soil contact model with their intervals, and samples of their joint distribution.
namespace grouser::scene {

inline constexpr std::array<SoilQuantity, 6> kContactQuantities = {
    SoilQuantity::exponent, SoilQuantity::cohesiveModulus, SoilQuantity::frictionalModulus,
    SoilQuantity::cohesion, SoilQuantity::frictionAngle,   SoilQuantity::shearModulus};

struct ContactConstant {
  SoilQuantity quantity{};
  double value = 0;       ///< value in unitOf(quantity)
  double deviation = 0;   ///< standard deviation / value (phi: of tan phi / tan phi) [-]; 0: not sampled
  bool isAssumed = false; ///< the deviation comes from the table in soil_constants.cpp

  double halfWidth() const; ///< half width of the 95 % interval, in unitOf(quantity)
};

/// Constants of a soil file, in the order of kContactQuantities, without missing ones. Deviations follow from low and
/// high of [[published]], or from half_width of [[reached]]; without either they are assumed. K, k_c and k_phi depend
/// on grain size; if [[reached]] contains several grain radii, uses the one with the most constants (the smallest of
/// several).
std::vector<ContactConstant> contactConstants(const Soil& soil, SoilConstantsFrom from);

/// The constant of this quantity; null if there is none.
const ContactConstant* findConstant(const std::vector<ContactConstant>& constants, SoilQuantity quantity);

/// Replaces the values by sample `number` (>= 1) of their joint distribution. A sample depends only on `number`, not on
/// the machine. Logarithms of the values are normally distributed, limited to 3 standard deviations:
/// - n, K, c and tan phi vary by their deviations; c and tan phi correlate by kStrengthCorrelation;
/// - k_c and k_phi vary by one common factor, so that the pressure at the sinkage under kReferencePressure, for the
///   width kReferenceWidth, deviates by kPressureDeviation and is independent of n.
/// The half widths of k_c and k_phi are not used, since their errors nearly cancel at the width of a track.
void drawContactConstants(std::vector<ContactConstant>& constants, int number);

/// Resulting correlation of ln k and n [-]; 0 if n, k_c or k_phi is missing.
double modulusCorrelation(const std::vector<ContactConstant>& constants);

/// "samples (scm.constants_draw): ...": the assumptions above in one line.
std::string jointDistributionText(const std::vector<ContactConstant>& constants);

inline constexpr double kReferencePressure = 50e3, kReferenceWidth = 0.28; ///< pressure [Pa] and width [m] of a track
inline constexpr double kPressureDeviation = 0.10;                         ///< assumed [-]
inline constexpr double kStrengthCorrelation = -0.5;                       ///< assumed [-]

} // namespace grouser::scene
