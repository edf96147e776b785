// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cstdint>
#include <vector>

namespace grouser::studies {

/// Equal spheres at rest with contact springs.
struct ContactNetwork {
  struct Contact {
    std::uint32_t i = 0;
    std::int64_t j = -1; ///< other sphere; -1: fixed plane
    base::Vec3d normal;  ///< unit, from i to j
  };
  std::size_t spheres = 0;
  std::vector<Contact> contacts;
  double tangentialRatio = 0; ///< tangential / normal stiffness of sticking contacts [-]; 0: frictionless
};

/// Highest natural frequency [-], in units of sqrt(k / m): all contacts of stiffness k, spheres of mass m and moment
/// 2/5 m R^2. Power iteration on M^-1 K; Rayleigh quotient (a lower bound).
double highestFrequency(const ContactNetwork& network);

/// Gershgorin's bound [-], frictionless: largest sum over a sphere's contacts of 2 n n^T (spheres) and n n^T (planes).
double gershgorinFrequency(const ContactNetwork& network);

} // namespace grouser::studies
