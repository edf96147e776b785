// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/file_lock.hpp"

#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>

namespace grouser::support {

bool FileLock::take(const std::filesystem::path& path) {
  std::error_code error;
  const int access = std::filesystem::is_directory(path, error) ? O_RDONLY | O_DIRECTORY : O_CREAT | O_RDWR;
  if (!file_.good()) file_ = Descriptor(path, access);
  return !file_.good() || ::flock(file_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

} // namespace grouser::support
