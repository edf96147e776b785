// SPDX-License-Identifier: BSD-3-Clause
#include "base/input_file.hpp"

#include "base/error.hpp"

#include <fmt/format.h>
#include <linux/magic.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <ios>
#include <iterator>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

namespace grouser::base {

namespace {

std::string kindOf(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a FIFO";
  if (S_ISSOCK(mode)) return "a socket";
  if (S_ISCHR(mode) || S_ISBLK(mode)) return "a device";
  return "a special file";
}

/// Whether the kernel generates the contents of the file, as in /proc and /sys.
bool isOfKernel(const std::filesystem::path& path) {
  struct statfs system {};
  if (::statfs(path.c_str(), &system) != 0) return false;
  constexpr std::array<unsigned long, 5> kKernel{PROC_SUPER_MAGIC, SYSFS_MAGIC, DEBUGFS_MAGIC, TRACEFS_MAGIC,
                                                 SECURITYFS_MAGIC};
  return std::find(kKernel.begin(), kKernel.end(), static_cast<unsigned long>(system.f_type)) != kKernel.end();
}

std::string faultOf(int error) {
  if (error == ENOENT || error == ENOTDIR) return ": no such file";
  if (error == ELOOP) return " is a link that leads back to itself (a regular file is required)";
  return fmt::format(": cannot be read ({})", std::strerror(error));
}

std::string unreadable(const std::filesystem::path& path, const std::string& fault, const std::string& remedy) {
  return fmt::format("{}{}; {}", path.string(), fault, remedy);
}

} // namespace

std::string inputFault(const std::filesystem::path& path) {
  struct stat file {};
  if (::stat(path.c_str(), &file) != 0) return faultOf(errno);
  if (!S_ISREG(file.st_mode)) return fmt::format(" is {} (a regular file is required)", kindOf(file.st_mode));
  if (isOfKernel(path)) return " is a file of the kernel (a regular file is required)";
  return ::access(path.c_str(), R_OK) == 0 ? "" : faultOf(errno);
}

void requireInput(const std::filesystem::path& path, const std::string& remedy) {
  if (const std::string fault = inputFault(path); !fault.empty()) throw InputError(unreadable(path, fault, remedy));
}

std::string readInput(const std::filesystem::path& path, const std::string& remedy) {
  requireInput(path, remedy);
  std::string text;
  try {
    if (std::ifstream file(path, std::ios::binary); file) {
      text.assign(std::istreambuf_iterator<char>(file), {});
      if (file.good() || file.eof()) return text;
    }
  } catch (const std::ios_base::failure&) { // a file that opens but fails while it is read
  }
  throw InputError(unreadable(path, ": cannot be read", remedy));
}

} // namespace grouser::base
