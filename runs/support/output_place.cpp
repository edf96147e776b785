// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/output_place.hpp"

#include "base/error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>

namespace grouser::support {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kRoomForNames = 128; ///< characters reserved for names of files and subfolders

[[noreturn]] void refuse(const fs::path& place, const std::string& why, const std::string& option) {
  throw base::InputError(fmt::format("{}: {}; choose another with {}", place.string(), why, option));
}

/// Tries to write a small file in this folder. Returns 0 or errno. Leaves no file.
int writeFault(const fs::path& folder) {
  std::string made = (folder / ".grouser-XXXXXX").string();
  if (!::mkdtemp(made.data())) return errno;
  const std::string file = made + "/try";
  constexpr std::array<char, 512> kBlock{}; // less than the smallest limit of file sizes (ulimit -f)
  const int out = ::open(file.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0600);
  int fault = out < 0 ? errno : 0;
  if (out >= 0 && ::write(out, kBlock.data(), kBlock.size()) != static_cast<ssize_t>(kBlock.size()))
    fault = errno ? errno : ENOSPC;
  if (out >= 0 && ::close(out) != 0 && fault == 0) fault = errno;
  ::unlink(file.c_str());
  ::rmdir(made.c_str());
  return fault;
}

/// The nearest folder at or above `whole` that exists. Throws if a file or broken link blocks `shown`.
fs::path existingAbove(const fs::path& shown, const fs::path& whole, const std::string& option) {
  std::error_code error;
  const fs::path itself = fs::absolute(shown, error).lexically_normal();
  fs::path there;
  for (const fs::path& part : whole) {
    const fs::path next = there / part;
    const std::string what = next == itself || next / "" == itself ? "is" : next.string() + " is";
    error.clear();
    const bool isThere = fs::exists(next, error);
    if (error) refuse(shown, fmt::format("cannot be created ({})", error.message()), option);
    if (!isThere && fs::is_symlink(fs::symlink_status(next, error)))
      refuse(shown,
             fmt::format("{} a link to {}, which does not exist: create that folder, or remove the link", what,
                         fs::read_symlink(next, error).string()),
             option);
    if (!isThere) return there;
    if (!fs::is_directory(next, error))
      refuse(shown, what == "is" ? "is a file, not a folder" : what + " a file, not a folder", option);
    there = next;
  }
  return there;
}

} // namespace

void requireFolder(const fs::path& folder, const std::string& option) {
  std::error_code error;
  const fs::path whole = fs::absolute(folder, error).lexically_normal(), there = existingAbove(folder, whole, option);
  const long longest = ::pathconf(there.c_str(), _PC_NAME_MAX);
  for (const fs::path& part : whole)
    if (longest > 0 && part.string().size() > static_cast<std::size_t>(longest))
      refuse(folder,
             fmt::format("a name in the path has {} bytes, more than the {} of the file system", part.string().size(),
                         longest),
             option);
  if (whole.string().size() + kRoomForNames > PATH_MAX)
    refuse(folder,
           fmt::format("the path has {} bytes, so paths of files in this folder exceed the system limit of {}",
                       whole.string().size(), PATH_MAX),
           option);
  const int fault = writeFault(there);
  if (fault == 0) return;
  const bool isIt = fs::equivalent(there, whole, error);
  refuse(folder,
         isIt ? fmt::format("cannot write in this folder ({})", std::strerror(fault))
              : fmt::format("cannot be created: cannot write in {} ({})", there.string(), std::strerror(fault)),
         option);
}

void requireFile(const fs::path& file, const std::string& option) {
  std::error_code error;
  if (fs::is_directory(file, error)) refuse(file, "is a folder, not a file", option);
  if (fs::exists(file, error)) {
    // Devices and pipes are accepted.
    if (fs::is_regular_file(file, error) && ::access(file.c_str(), W_OK) != 0)
      refuse(file, fmt::format("cannot be written ({})", std::strerror(errno)), option);
    return;
  }
  if (error) refuse(file, fmt::format("cannot be written ({})", error.message()), option);
  fs::path place = fs::absolute(file, error);
  if (fs::is_symlink(fs::symlink_status(place, error)))
    place = (place.parent_path() / fs::read_symlink(place, error)).lexically_normal();
  const fs::path folder = place.parent_path().lexically_normal();
  if (existingAbove(file, folder, option) != folder)
    throw base::InputError(fmt::format("{}: folder {} does not exist; create it, or choose another file with {}",
                                       file.string(), folder.string(), option));
  if (const int fault = writeFault(folder))
    refuse(file, fmt::format("cannot be written ({})", std::strerror(fault)), option);
}

} // namespace grouser::support
