// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "base/sphere_set.hpp"
#include "spheredecomp/protrusion.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grouser::coupling {

/// A part to be cut; `mesh` must outlive the cut.
struct PartCut {
  const base::TriangleMesh* mesh;
  std::string name; ///< of the set, and in errors
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
  /// The set that cutPart() returns, bit for bit; `protrusion` as there.
  virtual base::SphereSet cut(const PartCut& part, spheredecomp::Protrusion* protrusion) = 0;
};

/// Cuts a part; with a limit so that it is kept, and `protrusion` receives the measured values. Throws as
/// spheredecomp::decompose() or decomposeWithin() do.
base::SphereSet cutPart(const PartCut& part, spheredecomp::Protrusion& protrusion);

/// Sphere sets of all parts, on all ranks, which share the work. `kept` may be null: then all are cut. Throws as
/// decompose() does, or with a limit decomposeWithin(); `reports` receives an entry for each part.
std::vector<base::SphereSet> cutParts(const std::vector<PartCut>& parts, SphereSets* kept, const base::Comm& comm,
                                      std::vector<spheredecomp::CutReport>* reports = nullptr);

} // namespace grouser::coupling
