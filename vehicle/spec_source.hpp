// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/table.hpp"

#include <string>
#include <utility>
#include <vector>

namespace grouser::vehicle {

/// Changed key of a vehicle file.
struct SpecKey {
  std::string section, key; ///< "shoe", "count"
  base::Node value;         ///< with its location: a line of a scene file, or "--set"
  std::string text;         ///< the value as TOML

  /// Compares keys and values, not their locations.
  bool operator==(const SpecKey& other) const {
    return section == other.section && key == other.key && text == other.text;
  }
};

/// Source of a vehicle: its file and changed keys. A path converts implicitly to a source without changed keys.
struct SpecSource {
  std::string file;
  std::vector<SpecKey> changed{};

  SpecSource(std::string path, std::vector<SpecKey> keys = {}) : file(std::move(path)), changed(std::move(keys)) {}
  SpecSource(const char* path) : file(path) {}
};

} // namespace grouser::vehicle
