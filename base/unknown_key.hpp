// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <utility>
#include <vector>

namespace grouser::base {

/// Unknown key or section of a file. The message names the nearest key of the same section; base/nearest_key.hpp
/// considers the keys of all sections.
class UnknownKey : public InputError {
public:
  struct Place {
    std::string origin;             ///< "scene.toml:14", or "--set"
    std::string path;               ///< section's path; empty at the root
    std::string key;                ///< as written in the file
    std::vector<std::string> inner; ///< keys inside an unknown section; empty for an unknown key
    std::vector<std::string> valid; ///< valid keys and sections in this section
  };
  UnknownKey(Place place, const std::string& nearest) : InputError(message(place, nearest)), place_(std::move(place)) {}

  const Place& place() const { return place_; }
  static std::string message(const Place& p, const std::string& nearest) {
    const std::string what = fmt::format("{}: unknown {} {}{}", p.origin, p.inner.empty() ? "key" : "section",
                                         p.path.empty() ? "" : p.path + ".", p.key);
    if (nearest.empty() && !p.valid.empty()) return fmt::format("{} (valid here: {})", what, fmt::join(p.valid, ", "));
    if (nearest.empty()) return fmt::format("{}; the scene has no [[{}]]", what, p.path);
    if (p.valid.empty()) return fmt::format("{}; did you mean {}?", what, nearest);
    return fmt::format("{}; did you mean {}? (valid here: {})", what, nearest, fmt::join(p.valid, ", "));
  }

private:
  Place place_;
};

} // namespace grouser::base
