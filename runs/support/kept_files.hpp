// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace grouser::support {

/// A cache folder: settled beds, preparation frictions, parts converted to spheres, check results, probe times. A
/// file's name is a hash of its origin, a text with all inputs of its contents. The file also contains the origin, to
/// detect hash collisions. Missing files are made again, so any file may be deleted at any time. All kinds share one
/// size limit.
class KeptFiles {
public:
  enum class Kind { bed, friction, spheres, check, times };
  static constexpr std::uint64_t kDefaultLimit = std::uint64_t{2} << 30; ///< [bytes]

  /// `limit` [bytes]: maximum total size; the most recently used files are kept.
  explicit KeptFiles(std::filesystem::path folder, std::uint64_t limit = kDefaultLimit)
      : folder_(std::move(folder)), limit_(limit) {}

  /// Cache from the environment: folder GROUSER_CACHE (no cache if set but empty), otherwise $XDG_CACHE_HOME/grouser,
  /// otherwise ~/.cache/grouser, with the home folder from HOME or the user database. GROUSER_CACHE_GIB limits the
  /// size. Throws InputError if GROUSER_CACHE_GIB is not a number. On several ranks, the environment of the first rank
  /// counts.
  static std::optional<KeptFiles> ofUser(const base::Comm& comm = {});

  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path fileOf(Kind kind, const std::string& origin) const;
  /// Path of the lock that the program holds while it makes this file.
  static std::filesystem::path lockOf(const std::filesystem::path& file) { return file.string() + ".lock"; }

  bool fits(double bytes) const { return bytes <= static_cast<double>(limit_); }
  /// Makes a missing folder. Returns false if it is not writable.
  bool writable() const;
  /// A unique temporary name beside the file, also among machines that share the folder.
  static std::filesystem::path freshName(const std::filesystem::path& file);
  /// Moves a completed file from its temporary name to its final one, then deletes the least recently used files until
  /// the cache is within its limit. If the rename fails, deletes the file and returns false.
  bool put(const std::filesystem::path& fresh, const std::filesystem::path& file) const;
  /// Marks the file as most recently used.
  static void noteUse(const std::filesystem::path& file);

private:
  void deleteOldest(const std::filesystem::path& except) const;

  std::filesystem::path folder_;
  std::uint64_t limit_;
};

} // namespace grouser::support
