// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace grouser::terrain {

struct GrainSystem;

/// Throws SimulationError with step, time, grain, place and remedy. `fault`: as StepFlags has it. All ranks call it.
[[noreturn]] void stopFor(std::uint64_t key, const GrainSystem& system);

} // namespace grouser::terrain
