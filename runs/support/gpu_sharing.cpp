// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/gpu_sharing.hpp"

#include "base/error.hpp"

#include <chrono>
#include <cstdlib>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>

namespace grouser::support {

namespace {

namespace fs = std::filesystem;

constexpr const char* kControl = "nvidia-cuda-mps-control";
constexpr const char* kPipes = "CUDA_MPS_PIPE_DIRECTORY";

constexpr const char* kUsualPipe = "/tmp/nvidia-mps/control";

std::string_view variable(const char* name) {
  const char* text = std::getenv(name);
  return text ? text : "";
}

bool isAskedFor() {
  const std::string_view gpus = variable("CUDA_VISIBLE_DEVICES");
  const bool areNumbered = !gpus.empty() && gpus.find("GPU-") == std::string_view::npos;
  std::error_code error;
  return variable("GROUSER_MPS") == "1" && variable(kPipes).empty() && !areNumbered && !fs::exists(kUsualPipe, error);
}

/// Waits for the service to start: it then creates a pipe named `control`. Returns false if it does not start.
bool comesUp(ChildProcess& service, const fs::path& folder) {
  constexpr int kMaxWaits = 100;
  for (int wait = 0; wait < kMaxWaits && !service.ended(); ++wait) {
    std::error_code error;
    if (fs::exists(folder / "control", error)) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

} // namespace

GpuSharing::GpuSharing(bool wanted) {
  if (!wanted || !isAskedFor()) return;
  try {
    folder_.emplace("grouser_mps");
    Program control{{kControl, "-f"}};
    control.environment = {{kPipes, folder_->path().string()}, {"CUDA_MPS_LOG_DIRECTORY", folder_->path().string()}};
    control.log = folder_->path() / "service.log";
    service_ = std::make_unique<ChildProcess>(control);
    if (!comesUp(*service_, folder_->path())) service_.reset();
  } catch (const std::exception&) { // no folder, or program missing: processes use the GPU in turns
    service_.reset();
  }
}

GpuSharing::~GpuSharing() {
  if (service_) {
    try { // the servers of the service end with "quit", not with its process
      Program quit{{kControl}};
      quit.environment = environment(), quit.log = folder_->path() / "quit.log", quit.input = true;
      ChildProcess process(quit);
      process.write("quit\n");
      process.wait();
    } catch (const base::DeviceError&) {}
    service_.reset();
  }
}

Environment GpuSharing::environment() const {
  return runs() ? Environment{{kPipes, folder_->path().string()}} : Environment{};
}

} // namespace grouser::support
