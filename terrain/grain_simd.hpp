// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_kernel_data.cuh"

namespace grouser::terrain {

/// One step of `count` grains on the CPU, `width` > 1 contacts at a time (KernelChoice::lanes); the bits are those of
/// GrainStep.
void runGrainSimd(const base::Exec& exec, const GrainKernelData& d, const ForceData<float>& f, std::int64_t count,
                  int width);

/// Forces of planes on the `near` grains that are listed near boundaries; the bits are those of BoundaryContacts.
void runWallSimd(const base::Exec& exec, const GrainKernelData& d, const ForceData<float>& f, std::int64_t near,
                 int width);

namespace detail {

using LaneStep = void(const GrainKernelData& d, const ForceData<float>& f, int first, int last);
/// Grains [first, last) of a launch. One file each, compiled for what its name says.
LaneStep stepSse, stepAvx2, stepAvx512;
/// Places [first, last) of the list of grains near boundaries.
LaneStep wallsSse, wallsAvx2, wallsAvx512;

/// GrainStep's own, of one grain, for what is rare.
void advanceGrain(const GrainKernelData& d, const ForceData<float>& f, int i, const base::Vec3d& force,
                  const base::Vec3d& torque, float deepest, const Lost& lost, GrainBooks& books);
void addLoadsOf(const GrainKernelData& d, const ForceData<float>& f, int i, base::Vec3d& force, base::Vec3d& torque);
void raiseThrough(const GrainKernelData& d, const ForceData<float>& f, int i);
void stepAlone(const GrainKernelData& d, const ForceData<float>& f, int k, GrainBooks& books);
/// Plastic work of the contacts of grain i [J].
void bookYielded(const GrainKernelData& d, int i, float yielded);
/// Adds what some grains of a launch, from `first` on, have done.
void addToBooks(const GrainKernelData& d, int first, const GrainBooks& books);
void addToBooks(const GrainKernelData& d, int first, const WallBooks& books);
/// GrainStep's own, of a grain that never moves and of forces by such grains.
void letStay(const GrainKernelData& d, const ForceData<float>& f, int i, GrainBooks& books);
void bookHeld(const GrainKernelData& d, const ForceData<float>& f, int i, const base::Vec3f& force,
              const base::Vec3f& torque, GrainBooks& books);

} // namespace detail
} // namespace grouser::terrain
