// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/file_lock.hpp"

#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace grouser::support {

FileLock::~FileLock() { release(); }

void FileLock::release() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

bool FileLock::take(const std::filesystem::path& path) {
  std::error_code error;
  const int access = std::filesystem::is_directory(path, error) ? O_RDONLY | O_DIRECTORY : O_CREAT | O_RDWR;
  if (descriptor_ < 0) descriptor_ = ::open(path.c_str(), access | O_CLOEXEC, 0666);
  return descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

} // namespace grouser::support
