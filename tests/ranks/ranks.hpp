// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"

namespace grouser::test {

/// All ranks of this test program: 1 if it was started without MPI.
const base::Comm& comm();

} // namespace grouser::test
