// SPDX-License-Identifier: BSD-3-Clause
#include "base/shared_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/sysinfo.h>
#include <unistd.h>

#include <array>
#include <string>

namespace grouser::base {

namespace {

constexpr const char* kName = "grouser-shared"; // visible only in /proc
constexpr const char* kTarget = "/memfd:grouser-shared";

void* map(int file, std::size_t bytes) {
  void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  return memory == MAP_FAILED ? nullptr : memory;
}

/// Anonymous memory has no limit, unlike /dev/shm: a block larger than the machine's memory would end the process.
bool fitsMachine(std::size_t bytes) {
  struct sysinfo machine {};
  return sysinfo(&machine) == 0 && bytes / machine.mem_unit < machine.totalram;
}

/// Checks that the block belongs to this program: in another namespace, the process number may denote another process.
bool isShared(const std::string& link) {
  std::array<char, 64> target{};
  const ssize_t length = readlink(link.c_str(), target.data(), target.size());
  return length > 0 && std::string(target.data(), static_cast<std::size_t>(length)).rfind(kTarget, 0) == 0;
}

} // namespace

SharedBlock createShared(std::size_t bytes) noexcept {
  SharedBlock block;
  if (!fitsMachine(bytes)) return block;
  block.file = memfd_create(kName, MFD_CLOEXEC);
  if (block.file < 0) return block;
  // Reserve all pages now; otherwise a first access beyond the available memory would end the program (SIGBUS).
  if (posix_fallocate(block.file, 0, static_cast<off_t>(bytes)) == 0) block.memory = map(block.file, bytes);
  if (!block.memory) endSharing(block);
  return block;
}

void* openShared(int process, int file, std::size_t bytes) noexcept {
  const std::string link = "/proc/" + std::to_string(process) + "/fd/" + std::to_string(file);
  if (!isShared(link)) return nullptr;
  const int own = ::open(link.c_str(), O_RDWR | O_CLOEXEC);
  if (own < 0) return nullptr;
  struct stat is {};
  void* const memory =
      fstat(own, &is) == 0 && static_cast<std::size_t>(is.st_size) == bytes ? map(own, bytes) : nullptr;
  ::close(own);
  return memory;
}

void endSharing(SharedBlock& block) noexcept {
  if (block.file >= 0) ::close(block.file);
  block.file = -1;
}

void closeShared(void* memory, std::size_t bytes) noexcept {
  if (memory) munmap(memory, bytes);
}

} // namespace grouser::base
