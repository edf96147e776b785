// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Version of the interface and of the program. While MAJOR is 0, an incompatible change of the interface increments
/// MINOR; docs/control.md#interface-changes lists these changes.
#define GROUSER_VERSION_MAJOR 0
#define GROUSER_VERSION_MINOR 1
#define GROUSER_VERSION_PATCH 0

namespace grouser {

/// Version of the linked library, such as "0.1.0".
const char* version();
/// Commit from which the library was built, with suffix "-dirty" if sources were modified.
const char* commit();

} // namespace grouser
