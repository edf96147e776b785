// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>

namespace grouser::support {

/// Error message for a user's name that results files do not support: it is empty, or contains a control character or a
/// slash (separator of HDF5 groups). Empty for a valid name.
inline std::string nameFault(const std::string& name) {
  if (name.empty()) return "is an empty name; set a name";
  const auto isControl = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  if (std::any_of(name.begin(), name.end(), isControl))
    return "has a control character (line feed, tab, escape...) in its name, which results files do not support; "
           "remove it";
  if (name.find('/') != std::string::npos)
    return "has a / in its name, which separates names in results files; remove it";
  return "";
}

} // namespace grouser::support
