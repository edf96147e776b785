// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/descriptor.hpp"

#include <filesystem>

namespace grouser::support {

/// Held by one program at a time; given back when it is destroyed, or when the program ends in whatever way.
class FileLock {
public:
  /// True when the lock of this file or folder is now held, or where it cannot be locked at all: some file systems
  /// cannot. False while another holds it. A file is made where it is missing.
  bool take(const std::filesystem::path& path);
  /// Gives it back before the end of this object.
  void release() { file_.close(); }

private:
  Descriptor file_;
};

} // namespace grouser::support
