// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/child_process.hpp"
#include "runs/support/private_folder.hpp"

#include <memory>
#include <optional>

namespace grouser::support {

/// Runs NVIDIA's Multi-Process Service during the lifetime of this object: with it, kernels of several processes run
/// concurrently on a GPU, otherwise in turns. A bed of some ten thousand grains uses a small part of a large GPU.
///
/// The service starts if GROUSER_MPS is 1, for this call only, with pipes in its own folder, and ends with this object.
/// It does not start if its program (part of the driver) is not on the PATH, if the user already runs the service
/// (CUDA_MPS_PIPE_DIRECTORY is set, or the default pipe exists), or if CUDA_VISIBLE_DEVICES contains GPU numbers, since
/// the service would number GPUs differently.
///
/// Processes that share a GPU also share its faults: if one process fails on the GPU, the others end too. A signal to
/// the whole group, such as Ctrl-C, also reaches the service; runs may then end before their last checkpoint.
class GpuSharing {
public:
  /// `wanted`: whether several processes will use a GPU at the same time.
  explicit GpuSharing(bool wanted);
  ~GpuSharing();
  GpuSharing(const GpuSharing&) = delete;
  GpuSharing& operator=(const GpuSharing&) = delete;

  bool runs() const { return service_ != nullptr; }
  /// Variables that client processes need to find the service; empty if the service does not run.
  Environment environment() const;

private:
  std::optional<PrivateFolder> folder_;
  std::unique_ptr<ChildProcess> service_;
};

} // namespace grouser::support
