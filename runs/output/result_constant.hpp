// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace grouser::output {

/// A number that applies to the whole run.
struct ResultConstant {
  const char *path, *unit, *help;
};

} // namespace grouser::output
