// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/name_fault.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <utility>

namespace grouser::support {

/// Prints to stderr and ignores write errors (closed stream, lost terminal, full disk), which must not end a run.
/// Control characters, which names of files may contain, are escaped.
template <class... Args> void printStderr(fmt::format_string<Args...> format, Args&&... args) {
  std::fputs(base::escaped(fmt::format(format, std::forward<Args>(args)...)).c_str(), stderr);
}

} // namespace grouser::support
