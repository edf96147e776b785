// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace grouser::support {

/// JSON as text, indented by `indent` blanks; -1: on one line. Bytes that are not UTF-8, e.g. in file names, become
/// U+FFFD.
template <class Json> std::string jsonText(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

} // namespace grouser::support
