// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/kept_json.hpp"

#include "runs/support/json_text.hpp"
#include "runs/support/text_file.hpp"

#include <exception>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

namespace grouser::support {

namespace fs = std::filesystem;

nlohmann::json keptJson(const KeptFiles& files, KeptFiles::Kind kind, const std::string& origin) {
  try {
    const fs::path path = files.fileOf(kind, origin);
    if (!fs::is_regular_file(path)) return {};
    std::ifstream file(path);
    nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
    if (!json.is_object() || json.value("of", nlohmann::json()) != origin) return {};
    KeptFiles::noteUse(path);
    return json;
  } catch (const std::exception&) {
    return {};
  }
}

void keepJson(const KeptFiles& files, KeptFiles::Kind kind, const std::string& origin, nlohmann::json object) {
  if (!files.writable()) return;
  const fs::path file = files.fileOf(kind, origin), fresh = KeptFiles::freshName(file);
  bool isKept = false;
  try {
    object["of"] = origin;
    replaceTextFile(fresh, jsonText(object) + "\n");
    isKept = files.put(fresh, file);
  } catch (const std::exception&) {
    isKept = false;
  }
  std::error_code error;
  if (!isKept) fs::remove(fresh, error);
}

} // namespace grouser::support
