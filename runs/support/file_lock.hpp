// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/descriptor.hpp"

#include <filesystem>

namespace grouser::support {

/// Lock that one program holds at a time; released on destruction, or when the program ends for any reason.
class FileLock {
public:
  /// Tries to lock this file or folder. Returns false if another program holds the lock; true if it is acquired, or if
  /// the file system does not support locks. Creates a missing file.
  bool take(const std::filesystem::path& path);
  /// Whether a FileLock holds this existing file or folder, also one of this program.
  static bool isTaken(const std::filesystem::path& path);
  /// Releases the lock before this object is destroyed.
  void release() { file_.close(); }

private:
  Descriptor file_;
};

} // namespace grouser::support
