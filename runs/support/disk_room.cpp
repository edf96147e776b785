// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/disk_room.hpp"

#include "runs/support/descriptor.hpp"
#include "runs/support/not_written.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <stdexcept>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace grouser::support {

namespace {

/// Reserves space. Returns 0, or the errno of the failure.
int makeRoom(int file, std::uint64_t bytes) {
  struct stat now {};
  if (fstat(file, &now) != 0) return errno;
  const auto size = static_cast<std::uint64_t>(now.st_size);
  // The kernel does not count space allocated beyond the end of the file towards this limit.
  struct rlimit limit {};
  if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && size + bytes > limit.rlim_cur)
    return EFBIG;
  int status = 0;
  do {
    status = fallocate(file, FALLOC_FL_KEEP_SIZE, now.st_size, static_cast<off_t>(bytes)) == 0 ? 0 : errno;
  } while (status == EINTR);
  // Other errors mean that the file system cannot preallocate; then only writing detects a full disk.
  return status == ENOSPC || status == EDQUOT || status == EFBIG ? status : 0;
}

} // namespace

void requireRoom(int file, const std::filesystem::path& path, std::uint64_t bytes) {
  if (const int status = makeRoom(file, bytes))
    throw notWritten(path, fmt::format("no space for {} more bytes ({})", bytes, std::strerror(status)));
}

void requireRoom(const std::filesystem::path& path, std::uint64_t bytes) {
  requireRoom(Descriptor(path, O_WRONLY), path, bytes);
}

} // namespace grouser::support
