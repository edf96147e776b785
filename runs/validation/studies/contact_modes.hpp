// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cstdint>
#include <vector>

namespace grouser::studies {

/// Network of equal spheres at rest and their contact springs.
struct ContactNetwork {
  struct Contact {
    std::uint32_t i = 0;
    std::int64_t j = -1; ///< index of the other sphere; -1: a fixed plane
    base::Vec3d normal;  ///< unit vector from i to j
  };
  std::size_t spheres = 0;
  std::vector<Contact> contacts;
  double tangentialRatio = 0; ///< tangential / normal stiffness of sticking contacts [-]; 0: frictionless
};

/// Highest natural frequency in units of sqrt(k / m), if all contacts have the stiffness k, and all spheres have the
/// mass m and the moment of inertia 2/5 m R^2. Power iteration on M^-1 K; Rayleigh quotient (a lower bound).
double highestFrequency(const ContactNetwork& network);

/// Gershgorin's upper bound of this frequency for frictionless contacts, from the largest sum, over the contacts of a
/// sphere, of 2 n n^T (contacts with spheres) and n n^T (contacts with planes).
double gershgorinFrequency(const ContactNetwork& network);

} // namespace grouser::studies
