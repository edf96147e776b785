// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "coupling/sphere_sets.hpp"
#include "runs/support/kept_files.hpp"

#include <filesystem>
#include <optional>
#include <string>

/// Parts cut into spheres, kept from run to run: the cut takes seconds, and most runs have the parts of the run before.
namespace grouser::storage {

/// The user's folder as far as sphere sets lie in it, and where those of this run came from.
class SphereCache final : public coupling::SphereSets {
public:
  explicit SphereCache(support::KeptFiles files) : files_(std::move(files)) {}

  /// Where the user keeps such files; see KeptFiles::ofUser().
  static std::optional<SphereCache> ofUser(const base::Comm& comm = {});

  /// The set that decompose() gives, bit for bit: a kept one where there is one; otherwise it is cut and kept. While
  /// another program cuts the same it is waited for. What is wrong with the folder or with a file in it never ends a
  /// run: a damaged file is a warning. Throws as decompose() does. With a limit as decomposeWithin(), and `protrusion`
  /// receives what that measures.
  base::SphereSet cut(const coupling::PartCut& part, spheredecomp::Protrusion* protrusion = nullptr) override;

  /// Thrown by cut() after lookUpOnly(), instead of cutting.
  struct NotKept {};
  void lookUpOnly() { lookUpOnly_ = true; }

  /// One line: where the sets of all ranks came from, and how long that took. Empty where there were none. All ranks
  /// call it.
  std::string summary(const base::Comm& comm = {}) const;
  /// How long this rank has cut what was not kept [s].
  double cutting() const { return cutting_; }
  /// Sets that this rank has found in the cache.
  int found() const { return taken_; }
  /// Sets that this rank has cut and written to the cache.
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
  /// Of this rank, since the start.
  int taken_ = 0, cut_ = 0, kept_ = 0;
  double taking_ = 0, cutting_ = 0; ///< [s]
};

} // namespace grouser::storage
