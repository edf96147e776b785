// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <hdf5.h>

#include <mutex>

namespace grouser::support::detail {

/// Lock on the HDF5 library, since its parallel build is not thread-safe.
class Turn {
public:
  Turn() : held_(library()) {}

private:
  static std::recursive_mutex& library() {
    static std::recursive_mutex mutex;
    return mutex;
  }
  std::lock_guard<std::recursive_mutex> held_;
};

/// Closes an HDF5 handle at the end of a scope.
class Handle {
public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }

private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

} // namespace grouser::support::detail
