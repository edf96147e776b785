// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "runs/support/kept_files.hpp"
#include "spheredecomp/decompose.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Parts cut into spheres, kept from run to run: the cut takes seconds, and most runs have the parts of the run before.
namespace grouser::simulation {

/// A part that is to be cut; `mesh` must outlive the cutting.
struct PartCut {
  const base::TriangleMesh* mesh;
  std::string name; ///< of the set, and in errors
  spheredecomp::DecompositionOptions options;
};

/// The user's folder as far as sphere sets lie in it, and where those of this run came from.
class SphereCache {
public:
  explicit SphereCache(support::KeptFiles files) : files_(std::move(files)) {}

  /// Where the user keeps such files; see KeptFiles::ofUser().
  static std::optional<SphereCache> ofUser(const base::Comm& comm = {});

  /// The set that decompose() gives, bit for bit: a kept one where there is one; otherwise it is cut and kept. While
  /// another program cuts the same it is waited for. What is wrong with the folder or with a file in it never ends a
  /// run: a damaged file is a warning. Throws as decompose() does.
  base::SphereSet cut(const PartCut& part);

  /// One line: where the sets of all ranks came from, and how long that took. Empty where there were none. All ranks
  /// call it.
  std::string summary(const base::Comm& comm = {}) const;
  /// How long this rank has cut what was not kept [s].
  double cutting() const { return cutting_; }

private:
  std::optional<base::SphereSet> find(const std::filesystem::path& file, const std::string& origin) const;
  bool keep(const std::filesystem::path& file, const std::string& origin, const base::SphereSet& set) const;

  support::KeptFiles files_;
  /// Of this rank, since the start.
  int taken_ = 0, cut_ = 0, kept_ = 0;
  double taking_ = 0, cutting_ = 0; ///< [s]
};

/// The sets of all parts, on all ranks, which share the work. `cache` may be null: then all are cut. Throws as
/// decompose() does.
std::vector<base::SphereSet> cutParts(const std::vector<PartCut>& parts, SphereCache* cache, const base::Comm& comm);

} // namespace grouser::simulation
