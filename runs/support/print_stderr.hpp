// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <utility>

namespace grouser::support {

/// Prints to stderr and ignores write errors (closed stream, lost terminal, full disk), which must not end a run.
template <class... Args> void printStderr(fmt::format_string<Args...> format, Args&&... args) {
  std::fputs(fmt::format(format, std::forward<Args>(args)...).c_str(), stderr);
}

} // namespace grouser::support
