// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_kernel_data.cuh"

namespace grouser::terrain {

/// Runs one step of `count` grains on the CPU, `width` > 1 contacts at a time (KernelChoice::lanes); bitwise equal to
/// GrainStep.
void runGrainSimd(const base::Exec& exec, const GrainKernelData& d, const ForceData<float>& f, std::int64_t count,
                  int width);

/// Computes the forces of planes on the `near` grains listed near boundaries; bitwise equal to BoundaryContacts.
void runWallSimd(const base::Exec& exec, const GrainKernelData& d, const ForceData<float>& f, std::int64_t near,
                 int width);

namespace detail {

using LaneStep = void(const GrainKernelData& d, const ForceData<float>& f, int first, int last);
/// Steps grains [first, last) of a launch. Each instruction set has its own source file, named after it.
LaneStep stepSse, stepAvx2, stepAvx512;
/// Processes entries [first, last) of the list of grains near boundaries.
LaneStep wallsSse, wallsAvx2, wallsAvx512;

/// GrainStep's functions for a single grain, for rare cases.
void advanceGrain(const GrainKernelData& d, const ForceData<float>& f, int i, const base::Vec3d& force,
                  const base::Vec3d& torque, float deepest, const Lost& lost, GrainAccumulator& accumulator);
void addLoadsOf(const GrainKernelData& d, const ForceData<float>& f, int i, base::Vec3d& force, base::Vec3d& torque);
void raiseThrough(const GrainKernelData& d, const ForceData<float>& f, int i);
void stepAlone(const GrainKernelData& d, const ForceData<float>& f, int k, GrainAccumulator& accumulator);
/// Accounts for the plastic work of the contacts of grain i [J].
void accountPlasticWork(const GrainKernelData& d, int i, float yielded);
/// Adds the accumulated sums of a block of grains that starts at `first`.
void addToLedger(const GrainKernelData& d, int first, const GrainAccumulator& accumulator);
void addToLedger(const GrainKernelData& d, int first, const WallAccumulator& accumulator);
/// GrainStep's functions for fixed grains and their forces.
void copyFixedGrain(const GrainKernelData& d, const ForceData<float>& f, int i, GrainAccumulator& accumulator);
void accountFixedGrain(const GrainKernelData& d, const ForceData<float>& f, int i, const base::Vec3f& force,
                       const base::Vec3f& torque, GrainAccumulator& accumulator);

} // namespace detail
} // namespace grouser::terrain
