// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"

#include <cstddef>
#include <string>
#include <vector>

/// `grouser bench contacts`: speed of contact detection.
namespace grouser::bench {

struct ContactsBench {
  std::vector<double> contacts; ///< approximate numbers of contacts, each pair once; empty: a range for the device
  bool countOnly = false;
  std::size_t atATime = 0; ///< spheres sorted at a time; 0: default of PairSearch
  int repeats = 3;
  std::size_t bulletSpheres = 100000; ///< maximum number of spheres of the comparison with Bullet
  std::string device = "auto";
  int threads = 0;                    ///< 0: all
  std::string json;                   ///< file; empty: none
  std::string plot;                   ///< PNG file; empty: none
  const base::Ranks* ranks = nullptr; ///< ranks of each search; null: one process
};

/// Prints a table over the number of contacts; each search starts from positions, which every rank has.
void benchContactsCommand(const ContactsBench& bench);

} // namespace grouser::bench
