// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/forecast/kept_ratios.hpp"

#include "runs/support/file_lock.hpp"
#include "runs/support/kept_files.hpp"
#include "runs/support/kept_json.hpp"

#include <nlohmann/json.hpp>

#include <chrono>
#include <exception>
#include <filesystem>
#include <thread>

namespace grouser::forecast {

constexpr auto kTimes = support::KeptFiles::Kind::times;

namespace {

constexpr double kMaxRatio = 100;                     // ratios above it, or below its inverse, are ignored [-]
constexpr auto kLook = std::chrono::milliseconds(20); // delay between two attempts to lock the file
constexpr int kLooks = 100;

bool isPlausible(double ratio) { return ratio >= 1 / kMaxRatio && ratio <= kMaxRatio; }

} // namespace

Ratios keptRatios(const std::string& machine) {
  const auto kept = support::KeptFiles::ofUser();
  if (!kept) return {};
  const nlohmann::json json = support::keptJson(*kept, kTimes, machine);
  const auto all = json.find("ratios");
  if (!json.is_object() || all == json.end() || !all->is_object()) return {};
  Ratios ratios;
  for (const auto& [work, ratio] : all->items())
    if (ratio.is_number() && isPlausible(ratio.get<double>())) ratios[work] = ratio.get<double>();
  return ratios;
}

void keepRatios(const std::string& machine, const Ratios& ratios) {
  const auto kept = support::KeptFiles::ofUser();
  if (!kept || !kept->writable()) return;
  try {
    support::FileLock lock; // another plan may add its ratios at the same time
    const std::filesystem::path name = support::KeptFiles::lockOf(kept->fileOf(kTimes, machine));
    for (int k = 0; k < kLooks && !lock.take(name); ++k) std::this_thread::sleep_for(kLook);
    Ratios all;
    for (const auto& [work, ratio] : ratios)
      if (isPlausible(ratio)) all[work] = ratio;
    all.merge(keptRatios(machine));
    support::keepJson(*kept, kTimes, machine, nlohmann::json::object({{"ratios", all}}));
  } catch (const std::exception&) {
    return; // then later plans use typical values
  }
}

} // namespace grouser::forecast
