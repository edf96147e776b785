// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::support {

/// A CSV cell, quoted if it contains a comma, a quote or a line break. A line break becomes a space.
std::string csvCell(const std::string& text);
/// A number with nine digits; empty if it is not finite.
std::string csvCell(double value);

} // namespace grouser::support
