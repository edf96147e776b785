// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "coupling/sphere_sets.hpp"
#include "runs/support/kept_files.hpp"

#include <filesystem>
#include <optional>
#include <string>

/// Cache of sphere sets of parts: making them takes seconds, and most runs share parts.
namespace grouser::storage {

/// Sphere sets in the user's cache folder, and the origin of those of this run.
class SphereCache final : public coupling::SphereSets {
public:
  explicit SphereCache(support::KeptFiles files) : files_(std::move(files)) {}

  /// The user's cache; see KeptFiles::ofUser().
  static std::optional<SphereCache> ofUser(const base::Comm& comm = {});

  /// The set of decompose(), bit for bit, from the cache, or else made and cached. Waits while another program makes
  /// the same set. Errors of the folder or its files do not end a run: a damaged file is a warning. Throws as
  /// decompose(). With a limit as decomposeWithin(), whose measurement goes to `protrusion`.
  base::SphereSet cut(const coupling::PartCut& part, spheredecomp::Protrusion* protrusion = nullptr) override;

  /// Thrown by cut() after lookUpOnly(), instead of cutting.
  struct NotKept {};
  void lookUpOnly() { lookUpOnly_ = true; }

  /// One line: origin of the sets of all ranks, and time taken. Empty without sets. All ranks
  /// call it.
  std::string summary(const base::Comm& comm = {}) const;
  /// Time that this rank has spent on sets that were not cached [s].
  double cutting() const { return cutting_; }
  /// Sets that this rank has found in the cache.
  int found() const { return taken_; }
  /// Sets that this rank has made and written to the cache.
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
