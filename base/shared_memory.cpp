// SPDX-License-Identifier: BSD-3-Clause
#include "base/shared_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

namespace grouser::base {

namespace {

void* map(int file, std::size_t bytes) {
  void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  return memory == MAP_FAILED ? nullptr : memory;
}

/// Asked before any page is taken: on a machine with much memory the attempt would fill it, and end in a kill.
bool hasRoom(int file, std::size_t bytes) {
  struct statvfs there {};
  return fstatvfs(file, &there) == 0 && bytes / there.f_frsize < there.f_bavail;
}

} // namespace

void* createShared(const std::string& name, std::size_t bytes) noexcept {
  const int file = shm_open(name.c_str(), O_CREAT | O_EXCL | O_RDWR, S_IRUSR | S_IWUSR);
  if (file < 0) return nullptr;
  // Reserves all pages now: the first access to one that does not fit any more would end the program (SIGBUS).
  const bool reserved = hasRoom(file, bytes) && posix_fallocate(file, 0, static_cast<off_t>(bytes)) == 0;
  void* const memory = reserved ? map(file, bytes) : nullptr;
  ::close(file);
  if (!memory) forgetShared(name);
  return memory;
}

void* openShared(const std::string& name, std::size_t bytes) noexcept {
  const int file = shm_open(name.c_str(), O_RDWR, 0);
  if (file < 0) return nullptr;
  struct stat is {};
  void* const memory =
      fstat(file, &is) == 0 && static_cast<std::size_t>(is.st_size) == bytes ? map(file, bytes) : nullptr;
  ::close(file);
  return memory;
}

void forgetShared(const std::string& name) noexcept { shm_unlink(name.c_str()); }

void closeShared(void* memory, std::size_t bytes) noexcept {
  if (memory) munmap(memory, bytes);
}

} // namespace grouser::base
