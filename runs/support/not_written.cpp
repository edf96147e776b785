// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/not_written.hpp"

#include <fmt/format.h>
#include <unistd.h>

namespace grouser::support {

namespace fs = std::filesystem;

NotWritten notWritten(const fs::path& file, const std::string& what) {
  std::error_code error;
  const fs::path folder = fs::absolute(file, error).parent_path();
  const char* why = "is the disk full?";
  if (!fs::is_directory(folder, error))
    why = "its folder is gone";
  else if (access(fs::exists(file, error) ? file.c_str() : folder.c_str(), W_OK) != 0)
    why = "no write permission; check the permissions of file and folder";
  return NotWritten(fmt::format("{}: {}; {}", file.string(), what, why));
}

void putInPlace(const fs::path& whole, const fs::path& path) {
  std::error_code error;
  fs::rename(whole, path, error);
  if (error) throw notWritten(path, fmt::format("could not be renamed into place ({})", error.message()));
}

} // namespace grouser::support
