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
  std::size_t atATime = 0; ///< spheres that are sorted at a time, about; 0: all on the CPU, 2.5e8 on a GPU
  int share = 0, of = 1;   ///< this call does one of so many parts of the work; together they find every pair once
};

struct FoundPairs {
  std::int64_t count = 0;
  /// On the device of the search, one array a slab, empty where not stored. The order depends on positions and options
  /// alone, not on the device or the number of threads.
  std::vector<base::Array<IdPair>> pairs;
  int slabs = 0;
  std::size_t workBytes = 0; ///< device memory of the search, beside positions and pairs [B]
  /// Wall time [s]: bounds and slabs; choosing, sorting and gathering the spheres of each slab; counting; storing.
  double gridSeconds = 0, sortSeconds = 0, countSeconds = 0, storeSeconds = 0;
};

/// All pairs of equal spheres that touch, each once: a search from nothing, without history, for any number of spheres
/// up to 2^31 - 2 and any arrangement.
///
/// Space is cut into cells of one diameter, and the cells into slabs along x. Of one slab at a time, the spheres of it
/// and of the next layer of cells are chosen, sorted by cell and gathered; each looks at the 13 cells that follow its
/// own and at what follows in its own. So a pair that crosses from one slab to the next is found once, and the memory
/// beside positions and pairs is that of one slab.
class PairSearch {
public:
  /// `diameter` in units of the positions, > 0 and below 2^29. Spheres touch where their centres are less than a
  /// diameter apart.
  PairSearch(const base::Exec& exec, std::int64_t diameter);
  ~PairSearch();
  PairSearch(const PairSearch&) = delete;
  PairSearch& operator=(const PairSearch&) = delete;

  /// Memory of the search is kept for the next call. Throws std::invalid_argument for too many spheres, and
  /// base::SimulationError where 2^32 pairs or more lie in one slab.
  FoundPairs find(const base::Position* positions, std::size_t count, const PairSearchOptions& options);

private:
  struct Work;
  std::unique_ptr<Work> work_;
};

} // namespace grouser::bench
