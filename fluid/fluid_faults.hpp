// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "fluid/fluid_setup.hpp"

#include <cstdint>
#include <string>

namespace grouser::fluid {

/// Returns the model of a setup after checks. Throws InputError for values out of range.
const FluidModel& checkedModel(const FluidSetup& setup);

/// Message for a fault in FluidFlags, with step, time, particle and remedy. `particle`: its current state.
std::string faultText(std::uint64_t fault, const FluidModel& model, std::int64_t step, const FluidParticle& particle);

/// Message for a body that would move by `way` [m] in the step after step number `step`, too far for the neighbour
/// lists.
std::string bodyFaultText(const std::string& name, double way, const FluidModel& model, std::int64_t step);

} // namespace grouser::fluid
