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

/// Which beds the runs of a check settle, and which of them earlier runs have kept.
namespace grouser::sweeps {

class CheckBeds {
public:
  /// `file` and `fixed`: what the scene was loaded from; it has seeds from its own on.
  CheckBeds(const std::filesystem::path& file, const std::vector<std::string>& fixed, const CheckCases& cases);

  /// [cases] the first case that has the same bed for the same seed; where nothing is kept, the case itself.
  const std::vector<int>& numbers() const { return numbers_; }
  /// Steps in which the kept bed of that number and of the seed after so many came to rest; empty where none is kept.
  std::optional<std::int64_t> keptSteps(int number, int seed);

private:
  std::vector<scene::Scene> scenes_; ///< [cases] those that are refused have none of their own
  std::vector<int> numbers_;
  std::optional<storage::BedCache> kept_;
  std::map<std::pair<int, int>, std::optional<std::int64_t>> found_;
};

} // namespace grouser::sweeps
