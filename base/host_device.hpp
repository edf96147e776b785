// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Mark a function that runs on the CPU and, where CUDA is compiled, on the GPU too.
#if defined(__CUDACC__)
#define GROUSER_HD __host__ __device__ __forceinline__
#else
#define GROUSER_HD inline
#endif
