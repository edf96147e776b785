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
  bool store = true;       ///< false: only count pairs
  std::size_t atATime = 0; ///< approximate number of spheres sorted at a time; 0: all on the CPU, 2.5e8 on a GPU
  int share = 0, of = 1;   ///< does part `share` of `of` parts of the work; all parts together find every pair once
};

struct FoundPairs {
  std::int64_t count = 0;
  /// Pairs on the device of the search, one array per slab; empty if pairs are not stored. Their order depends only on
  /// positions and options, not on the device or the number of threads.
  std::vector<base::Array<IdPair>> pairs;
  int slabs = 0;
  std::size_t workBytes = 0; ///< device memory of the search, excluding positions and pairs [B]
  /// Wall times [s] for bounds and slabs; for choosing, sorting and gathering spheres; for counting; for storing.
  double gridSeconds = 0, sortSeconds = 0, countSeconds = 0, storeSeconds = 0;
};

/// Finds all contacts of equal spheres, each once, without information from earlier searches. Supports up to 2^31 - 2
/// spheres in any arrangement.
///
/// Space is divided into cells of one diameter, and the layers of cells along x are grouped into slabs. For one slab at
/// a time, the spheres of the slab and of the next layer are chosen, sorted by cell and gathered. Each sphere of the
/// slab is compared with the following spheres in its cell and with the spheres in the 13 following cells. Therefore a
/// pair across two slabs is found once, and besides positions and pairs, the search needs the memory of one slab.
class PairSearch {
public:
  /// `diameter`: in units of the positions, above 0 and below 2^29. Two spheres touch if the distance between their
  /// centres is less than the diameter.
  PairSearch(const base::Exec& exec, std::int64_t diameter);
  ~PairSearch();
  PairSearch(const PairSearch&) = delete;
  PairSearch& operator=(const PairSearch&) = delete;

  /// Each call reuses the memory of the previous call. Throws std::invalid_argument for too many spheres, and
  /// base::SimulationError for 2^32 or more pairs in one slab.
  FoundPairs find(const base::Position* positions, std::size_t count, const PairSearchOptions& options);

private:
  struct Work;
  std::unique_ptr<Work> work_;
};

} // namespace grouser::bench
