// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/file_lock.hpp"

#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

namespace grouser::support {

namespace {

/// Whether the path still names the open file: another program may delete or replace it while this one opens it.
bool isAt(const std::filesystem::path& path, int file) {
  struct stat there {
  }, open{};
  return ::fstat(file, &open) != 0 ||
         (::stat(path.c_str(), &there) == 0 && there.st_ino == open.st_ino && there.st_dev == open.st_dev);
}

} // namespace

bool FileLock::take(const std::filesystem::path& path) {
  std::error_code error;
  const int access = std::filesystem::is_directory(path, error) ? O_RDONLY | O_DIRECTORY : O_CREAT | O_RDWR;
  for (int tries = 0; tries < 8; ++tries) {
    if (!file_.good()) file_ = Descriptor(path, access);
    if (!file_.good()) return true;
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) return errno != EWOULDBLOCK;
    if (isAt(path, file_)) return true;
    file_.close();
  }
  return true;
}

bool FileLock::isTaken(const std::filesystem::path& path) {
  const Descriptor file(path, O_RDONLY);
  return file.good() && ::flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

} // namespace grouser::support
