// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace grouser::output {

/// Names of options in messages: on the command line, or in the library.
struct OptionNames {
  const char* out = "--out";
  const char* force = "--force";
  const char* resume = "--resume";
};

} // namespace grouser::output
