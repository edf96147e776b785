// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/kept_files.hpp"

#include "base/error.hpp"
#include "base/hash.hpp"
#include "runs/support/file_lock.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <pwd.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace grouser::support {

namespace fs = std::filesystem;

namespace {

constexpr auto kAbandoned = std::chrono::hours(24); // age of abandoned partial files and locks
constexpr auto kPause = std::chrono::minutes(1);    // a partial file of an ended process of this host is abandoned then

struct KindName {
  const char *prefix, *suffix;
};
constexpr std::array<KindName, 5> kKindNames{{{"bed-", ".h5"},
                                              {"friction-", ".json"},
                                              {"spheres-", ".bin"},
                                              {"check-", ".json"},
                                              {"times-", ".json"}}}; // by Kind

/// Path of the cache folder; empty if the cache is disabled.
std::string folderOfUser() {
  if (const char* set = std::getenv("GROUSER_CACHE")) return set;
  if (const char* set = std::getenv("XDG_CACHE_HOME"); set && *set) return (fs::path(set) / "grouser").string();
  if (const char* set = std::getenv("HOME"); set && *set) return (fs::path(set) / ".cache/grouser").string();
  const passwd* user = ::getpwuid(::getuid());
  return user && user->pw_dir && *user->pw_dir == '/' ? (fs::path(user->pw_dir) / ".cache/grouser").string() : "";
}

/// The host, and the table of its processes: containers of one host can share its name, but count processes apart.
std::string hostName() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  struct stat processes {};
  if (::stat("/proc/self/ns/pid", &processes) != 0) return host.data();
  return fmt::format("{}-{}", host.data(), processes.st_ino);
}

/// Whether a partial file (see freshName()) or lock that was last written `age` ago has no writer any more.
bool isAbandoned(const fs::path& file, fs::file_time_type::duration age) {
  const std::string name = file.filename().string();
  if (FileLock lock; name.ends_with(".lock"))
    return age > kAbandoned && lock.take(file); // its holder does not write it
  if (age > kAbandoned) return true;
  const std::string host = fmt::format(".{}.", hostName());
  const std::size_t at = name.rfind(host);
  if (at == std::string::npos || age < kPause) return false;
  int process = 0;
  const char* const begin = name.c_str() + at + host.size();
  return std::from_chars(begin, name.c_str() + name.size(), process).ec == std::errc() && process > 0 &&
         ::kill(process, 0) != 0 && errno == ESRCH;
}

} // namespace

std::optional<KeptFiles> KeptFiles::ofUser(const base::Comm& comm) {
  std::uint64_t limit = kDefaultLimit;
  if (const char* set = std::getenv("GROUSER_CACHE_GIB"); set && *set && comm.first()) {
    double gib = 0;
    const auto [end, error] = std::from_chars(set, set + std::strlen(set), gib);
    if (error != std::errc() || *end || !(gib >= 0 && gib <= 1e6))
      throw base::InputError(
          fmt::format("GROUSER_CACHE_GIB = {} [GiB] is not a number in [0, 1e6]; correct or unset it", set));
    limit = static_cast<std::uint64_t>(gib * 1073741824.0);
  }
  const std::string folder = comm.broadcast(folderOfUser());
  limit = comm.gatherValue(limit).front();
  return folder.empty() ? std::nullopt : std::optional(KeptFiles(folder, limit));
}

fs::path KeptFiles::fileOf(Kind kind, const std::string& origin) const {
  base::StateHash key;
  for (const char c : origin) key.add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
  const KindName& name = kKindNames[static_cast<std::size_t>(kind)];
  return folder_ / (name.prefix + key.hex() + name.suffix);
}

bool KeptFiles::writable() const {
  std::error_code error;
  fs::create_directories(folder_, error);
  return !error && ::access(folder_.c_str(), W_OK) == 0;
}

fs::path KeptFiles::freshName(const fs::path& file) {
  return fmt::format("{}.{}.{}", file.string(), hostName(), ::getpid());
}

bool KeptFiles::put(const fs::path& fresh, const fs::path& file) const {
  std::error_code error;
  fs::rename(fresh, file, error);
  const bool isKept = !error;
  if (!isKept) fs::remove(fresh, error);
  deleteOldest(file);
  return isKept;
}

void KeptFiles::noteUse(const fs::path& file) {
  std::error_code error; // another run may delete the file at the same time
  fs::last_write_time(file, fs::file_time_type::clock::now(), error);
}

/// Deletes only files that this program writes.
void KeptFiles::deleteOldest(const fs::path& except) const {
  struct Entry {
    fs::file_time_type time;
    std::uint64_t bytes;
    fs::path path;
  };
  std::vector<Entry> kept;
  std::uint64_t total = 0;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, error)) {
    const std::string name = entry.path().filename().string();
    const auto* kind = std::find_if(kKindNames.begin(), kKindNames.end(),
                                    [&](const KindName& k) { return name.rfind(k.prefix, 0) == 0; });
    if (kind == kKindNames.end() || !entry.is_regular_file(error)) continue;
    const auto time = entry.last_write_time(error);
    const std::uint64_t bytes = entry.file_size(error);
    if (error) continue; // deleted by another run
    if (entry.path().extension() == kind->suffix)
      kept.push_back({time, bytes, entry.path()});
    else if (isAbandoned(entry.path(), fs::file_time_type::clock::now() - time) && fs::remove(entry.path(), error))
      continue;
    total += bytes;
  }
  std::sort(kept.begin(), kept.end(), [](const Entry& a, const Entry& b) { return a.time < b.time; });
  for (const Entry& file : kept) {
    if (total <= limit_) break;
    if (file.path == except) continue;
    fs::remove(file.path, error);
    total -= file.bytes;
  }
}

} // namespace grouser::support
