// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

namespace grouser::jobs {

/// Calls `work(i)` for each i in [0, count) in `processes` processes, each of which takes the next when it has done
/// one. With one process the work is done in this one; several take the GPUs of the machine in turn. `done` is called
/// here, each time one more is ready.
///
/// If a piece of work throws, the other processes are ended and an exception of the same kind (support::FailureKind)
/// with the same message is thrown here. Throws Stopped after SIGINT or SIGTERM. No process outlives the call.
/// Call before this process has started any threads.
void shareWork(int processes, std::size_t count, const std::function<void(std::size_t)>& work,
               const std::function<void()>& done);

} // namespace grouser::jobs
