// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/folder_use.hpp"

#include "base/error.hpp"

#include <array>
#include <ctime>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <sstream>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

namespace grouser::support {

namespace fs = std::filesystem;

namespace {

/// Start of a process [s since 1970], from proc(5); 0 if unknown.
std::time_t startOf(long process) {
  std::ifstream own(fmt::format("/proc/{}/stat", process)), system("/proc/stat");
  const std::string text(std::istreambuf_iterator<char>(own), {});
  const std::size_t name = text.rfind(')'); // the name of the program may contain blanks
  if (name == std::string::npos) return 0;
  std::istringstream words(text.substr(name + 1));
  constexpr int kBefore = 19; // words between the name and starttime
  std::string word;
  for (int i = 0; i < kBefore; ++i) words >> word;
  long long ticks = 0, boot = 0;
  words >> ticks;
  for (std::string line; std::getline(system, line);)
    if (line.starts_with("btime ")) std::istringstream(line) >> word >> boot;
  const long perSecond = ::sysconf(_SC_CLK_TCK);
  return ticks > 0 && boot > 0 && perSecond > 0 ? static_cast<std::time_t>(boot + ticks / perSecond) : 0;
}

/// " since 2026-11-30 14:02:10", local time; empty if unknown.
std::string sinceText(std::time_t start) {
  std::tm local{};
  std::array<char, 64> text{};
  if (start == 0 || !::localtime_r(&start, &local)) return "";
  const std::size_t length = std::strftime(text.data(), text.size(), " since %Y-%m-%d %H:%M:%S", &local);
  return {text.data(), length};
}

[[noreturn]] void refuse(const fs::path& folder, const std::string& holder, const std::string& option) {
  throw base::InputError(fmt::format("{}: in use by {}; wait until it ends, or choose another folder with {}",
                                     folder.string(), holder.empty() ? "another command" : holder, option));
}

} // namespace

std::string lockHolder(const fs::path& path) {
  struct stat file {};
  if (::stat(path.c_str(), &file) != 0) return "";
  // Lines such as "3: FLOCK  ADVISORY  WRITE 4711 08:01:1234567 0 EOF"; waiting processes have "->" after the number.
  std::ifstream locks("/proc/locks");
  const std::string wanted = fmt::format("{:02x}:{:02x}:{}", ::major(file.st_dev), ::minor(file.st_dev), file.st_ino);
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number, kind, advice, access, place;
    long process = 0;
    if (!(words >> number >> kind >> advice >> access >> process >> place) || kind != "FLOCK" || place != wanted ||
        process <= 0 || process == ::getpid())
      continue;
    return fmt::format("process {}{}", process, sinceText(startOf(process)));
  }
  return "";
}

void requireUnused(const fs::path& folder, const std::string& option) {
  // The lock itself counts: /proc/locks is missing in some containers, and omits processes of other containers.
  if (FileLock::isTaken(folder)) refuse(folder, lockHolder(folder), option);
}

void claimUnused(FileLock& lock, const fs::path& folder, const std::string& option) {
  std::error_code error;
  if (fs::is_directory(folder, error) && !lock.take(folder)) refuse(folder, lockHolder(folder), option);
}

} // namespace grouser::support
