// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.hpp"
#include "base/vec.hpp"
#include "terrain/grain_records.hpp"

#include <cstdint>
#include <string>

namespace grouser::terrain {

struct GrainSystem;

/// Error of a grain that stops the run. Callers with more information may state the cause.
class GrainFault : public base::SimulationError {
public:
  GrainFault(Fault which, std::uint32_t grain, const std::string& what, const std::string& remedy)
      : base::SimulationError(what + "; " + remedy, causeOf(which)), fault(which), id(grain), fact(what) {}
  static base::Cause causeOf(Fault fault);
  Fault fault;
  std::uint32_t id;
  std::string fact; ///< step, time, grain, position and fault, without a remedy
};

/// Throws GrainFault with step, time, grain, position and remedy. `key`: as in StepFlags::fault. Collective.
[[noreturn]] void stopFor(std::uint64_t key, const GrainSystem& system);

} // namespace grouser::terrain
