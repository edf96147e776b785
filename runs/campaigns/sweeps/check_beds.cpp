// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/check_beds.hpp"

#include "runs/campaigns/sweeps/overrides.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/bed_alone.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/storage/bed_cache.hpp"

#include <algorithm>

namespace grouser::sweeps {

CheckBeds::CheckBeds(const std::filesystem::path& file, const std::vector<std::string>& fixed, const CheckCases& cases)
    : kept_(storage::BedCache::ofUser()) {
  std::vector<std::string> origins;
  for (const CheckCase& c : cases.cases) {
    std::vector<std::string> overrides = fixed;
    for (const std::string& o : c.overrides) putOverride(overrides, o);
    scenes_.push_back(c.refused.empty() ? setup::loadScene(file, overrides) : scene::Scene{});
    origins.push_back(kept_ && c.refused.empty() ? setup::originOfBed(scenes_.back()) : "");
    const auto same =
        origins.back().empty() ? origins.end() - 1 : std::find(origins.begin(), origins.end(), origins.back());
    numbers_.push_back(static_cast<int>(same - origins.begin()));
  }
}

std::optional<std::int64_t> CheckBeds::keptSteps(int number, int seed) {
  if (!kept_) return {};
  const auto [at, isNew] = found_.try_emplace({number, seed});
  if (!isNew) return at->second;
  scene::Scene scene = scenes_[static_cast<std::size_t>(number)];
  scene.run.seed += seed;
  const std::string origin = setup::originOfBed(scene);
  if (const auto settled = origin.empty() ? std::nullopt : kept_->find(origin)) at->second = settled->steps;
  return at->second;
}

} // namespace grouser::sweeps
