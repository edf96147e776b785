// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

namespace grouser::jobs {

/// Calls `work(i)` for each i in [0, count) in `processes` child processes; each process continues with the next index
/// when it has finished one. With one process, the work is done in this process. Several processes use the GPUs of the
/// machine in turn. Calls `done` in this process after each finished index.
///
/// If `work` throws, ends the other processes, and throws an exception of the same kind (support::FailureKind) with the
/// same message. Throws Stopped after SIGINT or SIGTERM. No process outlives the call. Call before this process has
/// started any threads.
void shareWork(int processes, std::size_t count, const std::function<void(std::size_t)>& work,
               const std::function<void()>& done);

} // namespace grouser::jobs
