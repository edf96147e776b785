// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/forecast/kept_ratios.hpp"

#include "runs/support/json_text.hpp"
#include "runs/support/kept_files.hpp"
#include "runs/support/text_file.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>

namespace grouser::forecast {

namespace fs = std::filesystem;
constexpr auto kTimes = support::KeptFiles::Kind::times;

Ratios keptRatios(const std::string& machine) {
  const auto kept = support::KeptFiles::ofUser();
  if (!kept) return {};
  const fs::path path = kept->fileOf(kTimes, machine);
  std::ifstream file(path);
  const nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
  if (!json.is_object() || json.value("of", nlohmann::json()) != machine || !json.contains("ratios")) return {};
  Ratios ratios;
  for (const auto& [work, ratio] : json["ratios"].items())
    if (ratio.is_number() && ratio.get<double>() > 0) ratios[work] = ratio.get<double>();
  support::KeptFiles::noteUse(path);
  return ratios;
}

void keepRatios(const std::string& machine, const Ratios& ratios) {
  const auto kept = support::KeptFiles::ofUser();
  if (!kept || !kept->writable()) return;
  const fs::path file = kept->fileOf(kTimes, machine), fresh = support::KeptFiles::freshName(file);
  try {
    Ratios all = ratios;
    all.merge(keptRatios(machine));
    support::replaceTextFile(fresh, support::jsonText(nlohmann::json{{"of", machine}, {"ratios", all}}) + "\n");
    kept->put(fresh, file);
  } catch (const std::exception&) {
    std::error_code error;
    fs::remove(fresh, error);
  }
}

} // namespace grouser::forecast
