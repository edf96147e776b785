// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/forecast/kept_ratios.hpp"

#include "runs/support/file_lock.hpp"
#include "runs/support/json_text.hpp"
#include "runs/support/kept_files.hpp"
#include "runs/support/text_file.hpp"

#include <nlohmann/json.hpp>

#include <chrono>
#include <exception>
#include <filesystem>
#include <fstream>
#include <thread>

namespace grouser::forecast {

namespace fs = std::filesystem;
constexpr auto kTimes = support::KeptFiles::Kind::times;

namespace {

constexpr double kMostRatio = 100; // measured over modelled, either way [-]: beyond it the file is wrong
constexpr auto kLook = std::chrono::milliseconds(20); // between two attempts to lock
constexpr int kLooks = 100;

bool isPlausible(double ratio) { return ratio >= 1 / kMostRatio && ratio <= kMostRatio; }

} // namespace

Ratios keptRatios(const std::string& machine) {
  const auto kept = support::KeptFiles::ofUser();
  if (!kept) return {};
  try {
    const fs::path path = kept->fileOf(kTimes, machine);
    if (!fs::is_regular_file(path)) return {};
    std::ifstream file(path);
    const nlohmann::json json = nlohmann::json::parse(file);
    if (!json.is_object() || json.value("of", nlohmann::json()) != machine) return {};
    const auto all = json.find("ratios");
    if (all == json.end() || !all->is_object()) return {};
    Ratios ratios;
    for (const auto& [work, ratio] : all->items())
      if (ratio.is_number() && isPlausible(ratio.get<double>())) ratios[work] = ratio.get<double>();
    support::KeptFiles::noteUse(path);
    return ratios;
  } catch (const std::exception&) {
    return {};
  }
}

void keepRatios(const std::string& machine, const Ratios& ratios) {
  const auto kept = support::KeptFiles::ofUser();
  if (!kept || !kept->writable()) return;
  const fs::path file = kept->fileOf(kTimes, machine), fresh = support::KeptFiles::freshName(file);
  std::error_code error;
  try {
    support::FileLock lock; // another plan may add its ratios at the same time
    for (int k = 0; k < kLooks && !lock.take(support::KeptFiles::lockOf(file)); ++k) std::this_thread::sleep_for(kLook);
    Ratios all;
    for (const auto& [work, ratio] : ratios)
      if (isPlausible(ratio)) all[work] = ratio;
    all.merge(keptRatios(machine));
    support::replaceTextFile(fresh, support::jsonText(nlohmann::json{{"of", machine}, {"ratios", all}}) + "\n");
    if (!kept->put(fresh, file)) fs::remove(fresh, error);
  } catch (const std::exception&) {
    fs::remove(fresh, error);
  }
}

} // namespace grouser::forecast
