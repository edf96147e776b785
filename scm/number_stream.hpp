// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cstddef>
#include <vector>

namespace grouser::scm {

/// Writes or reads a sequence of numbers with the same code.
class NumberStream {
public:
  explicit NumberStream(std::vector<double>& numbers) : numbers_(numbers), writes_(true) {}
  explicit NumberStream(const std::vector<double>& numbers) : numbers_(copy_), copy_(numbers), writes_(false) {}

  template <class... T> void operator()(T&... values) { (one(values), ...); }
  /// Writes or reads the size of a list; a size beyond the remaining numbers counts as a premature end.
  template <class T> void size(std::vector<T>& list) {
    auto count = static_cast<double>(list.size());
    (*this)(count);
    if (writes_) return;
    if (!(count >= 0 && count <= static_cast<double>(numbers_.size() - at_))) isShort_ = true, count = 0;
    list.resize(static_cast<std::size_t>(count));
  }
  bool isShort() const { return isShort_; } ///< true after reading past the end
  bool isAtEnd() const { return at_ == numbers_.size(); }

private:
  void one(base::Vec3d& v) { (*this)(v.x, v.y, v.z); }
  template <class T> void one(T& value) {
    if (writes_)
      numbers_.push_back(static_cast<double>(value));
    else if (at_ < numbers_.size())
      value = static_cast<T>(numbers_[at_++]);
    else
      isShort_ = true;
  }

  std::vector<double>& numbers_;
  std::vector<double> copy_;
  std::size_t at_ = 0;
  bool writes_, isShort_ = false;
};

} // namespace grouser::scm
