// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"

#include <cstdint>

namespace grouser::base {

/// Words that go to other ranks or come from them: on the device in memory that MPI may pass on, and page-locked on the
/// host for where it takes none of the device's.
class MessageBuffer {
public:
  explicit MessageBuffer(const Exec& exec) : exec_(exec) {}
  MessageBuffer(const MessageBuffer&) = delete;
  MessageBuffer& operator=(const MessageBuffer&) = delete;
  ~MessageBuffer() { release(); }

  /// Room for `words`, and a quarter more where it has to grow; what was held is lost.
  void reserve(std::size_t words) {
    if (words <= size_) return;
    release();
    const std::size_t size = words + words / 4;
    device_ = static_cast<std::uint32_t*>(allocateForMessages(exec_, size * sizeof(std::uint32_t)));
    host_ = static_cast<std::uint32_t*>(allocatePinned(exec_, size * sizeof(std::uint32_t)));
    size_ = size;
  }
  std::uint32_t* device() { return device_; }
  std::uint32_t* host() { return host_; }

private:
  void release() noexcept {
    releaseForMessages(exec_, device_);
    releasePinned(exec_, host_);
    device_ = host_ = nullptr;
    size_ = 0;
  }
  Exec exec_;
  std::uint32_t *device_{nullptr}, *host_{nullptr};
  std::size_t size_{0};
};

} // namespace grouser::base
