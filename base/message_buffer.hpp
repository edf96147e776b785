// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"

#include <cstdint>

namespace grouser::base {

/// Buffer for messages between ranks, in words. It grows to 5/4 of the largest message and then loses its contents.
template <void* (*kAllocate)(const Exec&, std::size_t), void (*kRelease)(const Exec&, void*) noexcept>
class MessageWords {
public:
  explicit MessageWords(const Exec& exec) : exec_(exec) {}
  MessageWords(const MessageWords&) = delete;
  MessageWords& operator=(const MessageWords&) = delete;
  ~MessageWords() { kRelease(exec_, data_); }

  void reserve(std::size_t words) {
    if (words <= size_) return;
    kRelease(exec_, data_);
    data_ = nullptr, size_ = 0;
    const std::size_t size = words + words / 4;
    data_ = static_cast<std::uint32_t*>(kAllocate(exec_, size * sizeof(std::uint32_t)));
    size_ = size;
  }
  std::uint32_t* data() { return data_; }

private:
  Exec exec_;
  std::uint32_t* data_{nullptr};
  std::size_t size_{0};
};

/// Device buffer in memory that MPI can access.
using DeviceMessage = MessageWords<allocateForMessages, releaseForMessages>;
/// Page-locked host buffer, if MPI does not accept device memory.
using HostMessage = MessageWords<allocatePinned, releasePinned>;

} // namespace grouser::base
