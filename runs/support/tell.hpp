// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <utility>

namespace grouser::support {

/// Prints to the standard error what no run may end for: where nobody can read it (closed, a terminal that is gone, a
/// full disk) it is lost.
template <class... Args> void tell(fmt::format_string<Args...> format, Args&&... args) {
  std::fputs(fmt::format(format, std::forward<Args>(args)...).c_str(), stderr);
}

} // namespace grouser::support
