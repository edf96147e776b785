// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/child_process.hpp"

#include <filesystem>
#include <memory>

namespace grouser::support {

/// NVIDIA's Multi-Process Service, for as long as this object lives: with it kernels of several processes run side by
/// side on a GPU, and without it in turns. A bed of some ten thousand grains fills a small part of a large GPU.
///
/// It starts where GROUSER_MPS is 1, for this call alone, with pipes in a folder of its own, and is asked to end with
/// this object. It is not started where its program is not on the PATH (it comes with the driver), where the user runs
/// the service already (CUDA_MPS_PIPE_DIRECTORY is set, or it listens in its usual place), or where
/// CUDA_VISIBLE_DEVICES names GPUs by number, which the service would count anew.
///
/// Processes that share a GPU in this way also share a fault of it: one that fails there ends the others. A signal to
/// the whole group, such as Ctrl-C, reaches the service too; runs may then end before their last checkpoint.
class GpuSharing {
public:
  /// `wanted`: whether several processes will use a GPU at the same time.
  explicit GpuSharing(bool wanted);
  ~GpuSharing();
  GpuSharing(const GpuSharing&) = delete;
  GpuSharing& operator=(const GpuSharing&) = delete;

  bool runs() const { return service_ != nullptr; }
  /// Variables by which client processes find the service; empty if none runs.
  Environment environment() const;

private:
  std::filesystem::path folder_;
  std::unique_ptr<ChildProcess> service_;
};

} // namespace grouser::support
