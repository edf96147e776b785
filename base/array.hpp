// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"

#include <type_traits>
#include <utility>
#include <vector>

namespace grouser::base {

/// Owning array of `size()` trivially copyable elements on the device of an Exec. Kernels use the pointer `data()`.
template <class T> class Array {
  static_assert(std::is_trivially_copyable_v<T>);

public:
  Array() = default;
  explicit Array(const Exec& exec, std::size_t size = 0) : exec_(exec) { resize(size); }
  /// Array of `size` elements with undefined contents.
  static Array unset(const Exec& exec, std::size_t size) {
    Array array(exec);
    array.data_ = static_cast<T*>(allocateUnset(exec, size * sizeof(T)));
    array.size_ = array.capacity_ = size;
    return array;
  }
  Array(const Exec& exec, const std::vector<T>& values) : exec_(exec) { assign(values); }
  Array(Array&& other) noexcept { swap(other); }
  Array& operator=(Array&& other) noexcept {
    swap(other);
    return *this;
  }
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;
  ~Array() { release(exec_, data_); }

  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::size_t bytes() const { return capacity_ * sizeof(T); }

  /// Changes the size; the contents are undefined afterwards. The allocation grows but never shrinks.
  void resize(std::size_t size) {
    if (size > capacity_) {
      release(exec_, data_);
      data_ = nullptr, capacity_ = 0;
      data_ = static_cast<T*>(allocate(exec_, size * sizeof(T)));
      capacity_ = size;
    }
    size_ = size;
  }
  /// Changes the size and preserves the elements that fit. The capacity grows geometrically to amortise reallocation.
  void resizeKeeping(std::size_t size) {
    if (size > capacity_) {
      Array larger(exec_);
      larger.resize(size + size / 8);
      copyOnDevice(exec_, larger.data_, data_, size_ * sizeof(T));
      swap(larger);
    }
    size_ = size;
  }
  void zero() { setZero(exec_, data_, size_ * sizeof(T)); }
  void assign(const std::vector<T>& values) {
    resize(values.size());
    copyToDevice(exec_, data_, values.data(), values.size() * sizeof(T));
  }
  std::vector<T> toHost() const {
    std::vector<T> values(size_);
    copyToHost(exec_, values.data(), data_, size_ * sizeof(T));
    return values;
  }
  T at(std::size_t i) const {
    T value;
    copyToHost(exec_, &value, data_ + i, sizeof(T));
    return value;
  }
  void swap(Array& other) noexcept {
    std::swap(exec_, other.exec_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

private:
  Exec exec_{};
  T* data_{nullptr};
  std::size_t size_{0}, capacity_{0};
};

/// Returns a host copy of `count` elements of device memory.
template <class T> std::vector<T> toHost(const Exec& exec, const T* device, std::size_t count) {
  std::vector<T> values(count);
  copyToHost(exec, values.data(), device, count * sizeof(T));
  return values;
}

/// Device array with a pinned host copy, for data transferred in every step.
template <class T> class Mirrored {
  static_assert(std::is_trivially_copyable_v<T>);

public:
  Mirrored() = default;
  Mirrored(const Exec& exec, std::size_t size)
      : exec_(exec), device_(exec, size), host_(static_cast<T*>(allocatePinned(exec, size * sizeof(T)))) {}
  Mirrored(Mirrored&& other) noexcept { swap(other); }
  Mirrored& operator=(Mirrored&& other) noexcept {
    swap(other);
    return *this;
  }
  Mirrored(const Mirrored&) = delete;
  Mirrored& operator=(const Mirrored&) = delete;
  ~Mirrored() { releasePinned(exec_, host_); }

  std::size_t size() const { return device_.size(); }
  Array<T>& device() { return device_; }
  const Array<T>& device() const { return device_; }
  T* host() { return host_; }
  const T* host() const { return host_; }
  std::size_t bytes() const { return size() * sizeof(T); }
  /// Starts an asynchronous copy to the device: do not change the host side before the next synchronize().
  void upload() { copyToDeviceLater(exec_, device_.data(), host_, size() * sizeof(T)); }
  /// Starts an asynchronous copy to the host, valid after the next synchronize().
  void download() { copyToHostLater(exec_, host_, device_.data(), size() * sizeof(T)); }

private:
  void swap(Mirrored& other) noexcept {
    std::swap(exec_, other.exec_);
    device_.swap(other.device_);
    std::swap(host_, other.host_);
  }
  Exec exec_{};
  Array<T> device_;
  T* host_{nullptr};
};

} // namespace grouser::base
