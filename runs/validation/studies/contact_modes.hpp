// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cstdint>
#include <vector>

namespace grouser::studies {

/// Equal spheres at rest and their contacts, as springs between masses.
struct ContactNetwork {
  struct Contact {
    std::uint32_t i = 0;
    std::int64_t j = -1; ///< the other sphere; -1: a plane that does not move
    base::Vec3d normal;  ///< unit, from i to j
  };
  std::size_t spheres = 0;
  std::vector<Contact> contacts;
  double tangentialRatio = 0; ///< tangential over normal stiffness of contacts that stick [-]; 0: frictionless
};

/// Highest natural frequency [-], in units of sqrt(k / m): all contacts of stiffness k, spheres of mass m and moment
/// 2/5 m R^2. Power iteration on M^-1 K; its Rayleigh quotient, which comes from below.
double highestFrequency(const ContactNetwork& network);

/// Gershgorin's bound: the largest sum over a sphere's contacts of what each adds, 2 (n n^T) among spheres and n n^T at
/// a plane [-]; frictionless.
double gershgorinFrequency(const ContactNetwork& network);

} // namespace grouser::studies
