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

/// Beds that the runs of a check settle, and those in the cache.
namespace grouser::sweeps {

class CheckBeds {
public:
  /// `file` and `fixed`: scene file and overrides; seeds count up from that of the scene.
  CheckBeds(const std::filesystem::path& file, const std::vector<std::string>& fixed, const CheckCases& cases);

  /// [cases] first case with the same bed for the same seed; the case itself without a cache.
  const std::vector<int>& numbers() const { return numbers_; }
  /// Settling steps of the cached bed of that number and seed offset; empty if not cached.
  std::optional<std::int64_t> keptSteps(int number, int seed);

private:
  std::vector<scene::Scene> scenes_; ///< [cases] default-constructed for refused cases
  std::vector<int> numbers_;
  std::optional<storage::BedCache> kept_;
  std::map<std::pair<int, int>, std::optional<std::int64_t>> found_;
};

} // namespace grouser::sweeps
