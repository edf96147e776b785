// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Version of the interface and of the program: a change that breaks callers raises MINOR while MAJOR is 0.
/// docs/control.md#interface-changes lists these changes.
#define GROUSER_VERSION_MAJOR 0
#define GROUSER_VERSION_MINOR 1
#define GROUSER_VERSION_PATCH 0

namespace grouser {

/// "0.1.0" of the library that the program is linked with.
const char* version();
/// The commit that it was built from, with suffix "-dirty" if sources were modified.
const char* commit();

} // namespace grouser
