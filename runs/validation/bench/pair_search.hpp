// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/position.hpp"
#include "runs/validation/bench/id_pair.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace grouser::bench {

struct PairSearchOptions {
  bool store = true;       ///< false: count only
  std::size_t atATime = 0; ///< approximate number of spheres sorted at a time; 0: all on the CPU, 2.5e8 on a GPU
  int share = 0, of = 1;   ///< part `share` of `of` parts of the work; together they find every pair once
};

struct FoundPairs {
  std::int64_t count = 0;
  /// On the device of the search, one array per slab, empty if not stored. The order depends only on positions and
  /// options, not on the device or the number of threads.
  std::vector<base::Array<IdPair>> pairs;
  int slabs = 0;
  std::size_t workBytes = 0; ///< device memory of the search without positions and pairs [B]
  /// Wall time [s]: bounds and slabs; choosing, sorting and gathering the spheres of each slab; counting; storing.
  double gridSeconds = 0, sortSeconds = 0, countSeconds = 0, storeSeconds = 0;
};

/// All contacts of equal spheres, each once: a search without history for up to 2^31 - 2 spheres in any arrangement.
///
/// Space is cut into cells of one diameter, and the cells into slabs along x. Of one slab at a time, the spheres of it
/// and of the next layer of cells are chosen, sorted by cell and gathered; each looks at the 13 cells that follow its
/// own and at the following spheres in its own. So a pair across two slabs is found once, and the memory without
/// positions and pairs is that of one slab.
class PairSearch {
public:
  /// `diameter` in units of the positions, > 0 and below 2^29. Spheres touch where their centres are less than a
  /// diameter apart.
  PairSearch(const base::Exec& exec, std::int64_t diameter);
  ~PairSearch();
  PairSearch(const PairSearch&) = delete;
  PairSearch& operator=(const PairSearch&) = delete;

  /// Reuses its memory in the next call. Throws std::invalid_argument for too many spheres, and base::SimulationError
  /// for 2^32 or more pairs in one slab.
  FoundPairs find(const base::Position* positions, std::size_t count, const PairSearchOptions& options);

private:
  struct Work;
  std::unique_ptr<Work> work_;
};

} // namespace grouser::bench
