// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"

#include <cstddef>
#include <string>
#include <vector>

/// `grouser bench contacts`: speed of contact detection.
namespace grouser::bench {

struct ContactsBench {
  std::vector<double> contacts; ///< approximate numbers of contacts (each pair once); empty: default of the device
  bool countOnly = false;
  std::size_t atATime = 0; ///< number of spheres sorted at a time; 0: default of PairSearch
  int repeats = 3;
  std::size_t bulletSpheres = 100000; ///< maximum number of spheres in the comparison with Bullet
  std::string device = "auto";
  int threads = 0;                    ///< number of CPU threads; 0: all
  std::string json;                   ///< JSON file; empty: no file
  std::string plot;                   ///< PNG file; empty: no file
  const base::Ranks* ranks = nullptr; ///< ranks that share each search; null: one process
};

/// Prints a table over the number of contacts. Each search starts from positions, which every rank stores.
void benchContactsCommand(const ContactsBench& bench);

} // namespace grouser::bench
