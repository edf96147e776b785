// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace grouser::support {

/// JSON as text, indented by so many blanks; -1: in one line. Bytes of names of files that are no UTF-8 become U+FFFD.
template <class Json> std::string jsonText(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

} // namespace grouser::support
