// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace grouser::output {

/// Names of the options that messages recommend: those of the command line, or of the library.
struct OptionNames {
  const char* out = "--out";
  const char* force = "--force";
  const char* resume = "--resume";
};

} // namespace grouser::output
