// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"

#include <cstddef>
#include <string>
#include <vector>

/// `grouser bench contacts`: the speed of contact detection alone.
namespace grouser::bench {

struct ContactsBench {
  std::vector<double> contacts; ///< about so many, each pair once; empty: a range that suits the device
  bool countOnly = false;
  std::size_t atATime = 0; ///< spheres sorted at a time; 0: as PairSearch has it
  int repeats = 3;
  std::size_t bulletSpheres = 100000; ///< compare with Bullet up to so many
  std::string device = "auto";
  int threads = 0;                    ///< 0: all
  std::string json;                   ///< file; empty: none
  std::string plot;                   ///< PNG file; empty: none
  const base::Ranks* ranks = nullptr; ///< that share each search; null: this program alone
};

/// Prints a table over the number of contacts; each search starts from positions alone, which every
/// rank holds.
void benchContactsCommand(const ContactsBench& bench);

} // namespace grouser::bench
