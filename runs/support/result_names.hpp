// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>

namespace grouser::support {

/// What is wrong with a name that a user has given to something and that files of results then bear: a control
/// character or a slash, which HDF5 takes for a group's border. Empty where nothing is.
inline std::string nameFault(const std::string& name) {
  if (name.empty()) return "is an empty name; choose one";
  const auto isControl = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  if (std::any_of(name.begin(), name.end(), isControl))
    return "has a control character (line feed, tab, escape...) in its name, which results cannot hold; leave it out";
  if (name.find('/') != std::string::npos) return "has a / in its name, which separates names in results; leave it out";
  return "";
}

} // namespace grouser::support
