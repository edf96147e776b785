// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Compiles a function for the CPU and, in CUDA builds, also for the GPU.
#if defined(__CUDACC__)
#define GROUSER_HD __host__ __device__ __forceinline__
#else
#define GROUSER_HD inline
#endif
