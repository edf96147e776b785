// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "base/sphere_set.hpp"
#include "spheredecomp/protrusion.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grouser::coupling {

/// Part to be cut into spheres; `mesh` must outlive the cut.
struct PartCut {
  const base::TriangleMesh* mesh;
  std::string name; ///< name of the set, also in errors
  spheredecomp::DecompositionOptions options;
  std::optional<spheredecomp::ProtrusionLimit> limit{}; ///< empty: the set is not measured
  std::string key{};                                    ///< scene key of the radius
  std::string place{};                                  ///< file and line of that key, for errors; empty: the name
};

/// Source of stored sphere sets.
class SphereSets {
public:
  SphereSets() = default;
  SphereSets(const SphereSets&) = default;
  SphereSets(SphereSets&&) = default;
  SphereSets& operator=(const SphereSets&) = default;
  SphereSets& operator=(SphereSets&&) = default;
  virtual ~SphereSets() = default;
  /// Returns the same set as cutPart(), bit for bit; `protrusion` as in cutPart().
  virtual base::SphereSet cut(const PartCut& part, spheredecomp::Protrusion* protrusion) = 0;
};

/// Cuts a part into spheres; with a limit the protrusion satisfies it, and `protrusion` receives the measured values.
/// Throws like spheredecomp::decompose() or decomposeWithin().
base::SphereSet cutPart(const PartCut& part, spheredecomp::Protrusion& protrusion);

/// Cuts all parts on all ranks, which share the work. `kept`: source of stored sets, or null to cut all. Throws like
/// decompose(), or with a limit like decomposeWithin(); `reports` receives an entry for each part.
std::vector<base::SphereSet> cutParts(const std::vector<PartCut>& parts, SphereSets* kept, const base::Comm& comm,
                                      std::vector<spheredecomp::CutReport>* reports = nullptr);

} // namespace grouser::coupling
