// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "coupling/sphere_sets.hpp"
#include "runs/support/kept_files.hpp"

#include <filesystem>
#include <optional>
#include <string>

/// Cache of sphere sets of parts: computing them takes seconds, and most runs share parts.
namespace grouser::storage {

/// Sphere sets in the user's cache folder, and statistics on the sets of this run.
class SphereCache final : public coupling::SphereSets {
public:
  explicit SphereCache(support::KeptFiles files) : files_(std::move(files)) {}

  /// The user's cache; see KeptFiles::ofUser().
  static std::optional<SphereCache> ofUser(const base::Comm& comm = {});

  /// Returns a set bitwise identical to decompose(), from the cache, or computed and then cached. Waits while another
  /// program computes the same set. Errors of the folder or its files do not end a run; a damaged file causes a
  /// warning. Throws like decompose(). With a limit, like decomposeWithin(), and `protrusion` receives the measured
  /// values.
  base::SphereSet cut(const coupling::PartCut& part, spheredecomp::Protrusion* protrusion = nullptr) override;

  /// Exception of cut() after lookUpOnly() for a set that is not cached.
  struct NotKept {};
  void lookUpOnly() { lookUpOnly_ = true; }

  /// One line: source of the sets of all ranks (cache or conversion), and time. Empty without sets. All ranks call it.
  std::string summary(const base::Comm& comm = {}) const;
  /// Time that this rank has spent on computing sets [s].
  double cutting() const { return cutting_; }
  /// Number of sets that this rank has found in the cache.
  int found() const { return taken_; }
  /// Number of sets that this rank has computed and written to the cache.
  int saved() const { return kept_; }

private:
  struct Found {
    base::SphereSet set;
    spheredecomp::Protrusion protrusion;
  };
  std::optional<Found> find(const std::filesystem::path& file, const std::string& origin) const;
  bool keep(const std::filesystem::path& file, const std::string& origin, const Found& found) const;
  static void write(const std::filesystem::path& path, const std::string& origin, const Found& found);
  static Found parsed(const std::string& bytes, const std::string& origin);

  support::KeptFiles files_;
  bool lookUpOnly_ = false;
  /// Counts of this rank since the start.
  int taken_ = 0, cut_ = 0, kept_ = 0;
  double taking_ = 0, cutting_ = 0; ///< [s]
};

} // namespace grouser::storage
