// SPDX-License-Identifier: BSD-3-Clause
#include "runs/storage/kept_frictions.hpp"

#include "runs/support/json_text.hpp"
#include "runs/support/text_file.hpp"

#include <nlohmann/json.hpp>

#include <exception>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace grouser::storage {

namespace fs = std::filesystem;
constexpr auto kFriction = support::KeptFiles::Kind::friction;

std::optional<double> KeptFrictions::find(const std::string& origin) const {
  try {
    const fs::path path = files_.fileOf(kFriction, origin);
    if (!fs::is_regular_file(path)) return {};
    std::ifstream file(path);
    const nlohmann::json json = nlohmann::json::parse(file);
    if (!json.is_object() || json.value("of", nlohmann::json()) != origin) return {};
    const auto friction = json.find("friction");
    if (friction == json.end() || !friction->is_number() || !(friction->get<double>() > 0)) return {};
    support::KeptFiles::noteUse(path);
    return friction->get<double>();
  } catch (const std::exception&) {
    return {};
  }
}

void KeptFrictions::keep(const std::string& origin, double friction) const {
  if (!files_.writable()) return;
  const fs::path file = files_.fileOf(kFriction, origin), fresh = support::KeptFiles::freshName(file);
  std::error_code error;
  try {
    support::replaceTextFile(fresh, support::jsonText(nlohmann::json{{"of", origin}, {"friction", friction}}) + "\n");
    if (!files_.put(fresh, file)) fs::remove(fresh, error);
  } catch (const std::exception&) {
    fs::remove(fresh, error);
  }
}

} // namespace grouser::storage
