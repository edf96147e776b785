// SPDX-License-Identifier: BSD-3-Clause
#include "base/summed_banks.hpp"

namespace grouser::base {

std::vector<WideSum> summedBanks(const std::vector<WideSum>& banks, std::size_t count, const Comm& comm) {
  std::vector<WideSum> mine(count), all(count);
  for (std::size_t k = 0; k < banks.size(); ++k) mine[k % count] += banks[k];
  if (comm.alone()) return mine;
  for (const std::vector<WideSum>& rank : comm.gatherAll(mine))
    for (std::size_t k = 0; k < count; ++k) all[k] += rank[k];
  return all;
}

} // namespace grouser::base
