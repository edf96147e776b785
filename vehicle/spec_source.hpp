// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/table.hpp"

#include <string>
#include <utility>
#include <vector>

namespace grouser::vehicle {

/// A key of a vehicle file with another value than it has there.
struct SpecKey {
  std::string section, key; ///< "shoe", "count"
  base::Node value;         ///< and where it stands: a line of a scene file, or "--set"
  std::string text;         ///< the value as TOML

  /// Wherever they stand.
  bool operator==(const SpecKey& other) const {
    return section == other.section && key == other.key && text == other.text;
  }
};

/// What makes a vehicle: its file, and keys that are changed in it. A path alone is one.
struct SpecSource {
  std::string file;
  std::vector<SpecKey> changed{};

  SpecSource(std::string path, std::vector<SpecKey> keys = {}) : file(std::move(path)), changed(std::move(keys)) {}
  SpecSource(const char* path) : file(path) {}
};

} // namespace grouser::vehicle
