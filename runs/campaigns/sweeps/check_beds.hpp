// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_cases.hpp"
#include "runs/storage/bed_cache.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// Beds that the runs of a check use, and which of them are in the cache.
namespace grouser::sweeps {

class CheckBeds {
public:
  /// `file` and `fixed`: scene file and overrides. Seeds are consecutive, starting at run.seed of the scene.
  CheckBeds(const std::filesystem::path& file, const std::vector<std::string>& fixed, const CheckCases& cases);

  /// [cases] first case that has the same bed for the same seed; without a cache, the case itself.
  const std::vector<int>& numbers() const { return numbers_; }
  /// Number of settling steps of the cached bed with this index and seed offset; empty if not cached.
  std::optional<std::int64_t> keptSteps(int number, int seed);

private:
  std::vector<scene::Scene> scenes_; ///< [cases] default-constructed for invalid cases
  std::vector<int> numbers_;
  std::optional<storage::BedCache> kept_;
  std::map<std::pair<int, int>, std::optional<std::int64_t>> found_;
};

} // namespace grouser::sweeps
