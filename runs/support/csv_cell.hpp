// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::support {

/// A CSV cell, quoted if it contains a comma, a quote or a line break, which becomes a space.
std::string csvCell(const std::string& text);
/// Nine digits; empty where it is no finite number.
std::string csvCell(double value);

} // namespace grouser::support
