// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/text_file.hpp"

#include "base/error.hpp"
#include "runs/support/disk_room.hpp"
#include "runs/support/not_written.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace grouser::support {

namespace fs = std::filesystem;

void writeTextFile(const fs::path& path, const std::string& text, const std::string& option) {
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  if (!file)
    throw base::InputError(
        fmt::format("{}: cannot be written ({}); choose another with {}", path.string(), std::strerror(errno), option));
  file << text;
  file.close();
  if (file) return;
  std::error_code error;
  if (fs::is_regular_file(path, error)) fs::remove(path, error); // does not delete a device such as /dev/full
  throw notWritten(path, "could not be written completely");
}

void replaceTextFile(const fs::path& path, const std::string& text, std::uint64_t room) {
  const fs::path part = path.string() + ".part";
  std::ofstream file(part, std::ios::binary);
  file << text;
  file.close();
  try {
    if (!file) throw notWritten(path);
    if (room) requireRoom(part, room);
  } catch (...) {
    std::error_code error;
    fs::remove(part, error);
    throw;
  }
  putInPlace(part, path);
}

void overwriteTextFile(const fs::path& path, const std::string& text) {
  // The file is not truncated first, to keep its space on the disk.
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file << text;
  file.close();
  std::error_code error;
  if (file) fs::resize_file(path, text.size(), error);
  if (!file || error) throw notWritten(path);
}

} // namespace grouser::support
