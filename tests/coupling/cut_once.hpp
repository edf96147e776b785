// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/sphere_sets.hpp"

#include <map>
#include <string>
#include <utility>

namespace grouser::coupling {

/// For tests that all have the same vehicle: its parts are cut once.
class CutOnce : public SphereSets {
public:
  base::SphereSet cut(const PartCut& part, spheredecomp::Protrusion* protrusion) override {
    const auto [at, fresh] = cuts_.try_emplace(part.name);
    if (fresh) at->second.first = cutPart(part, at->second.second);
    if (protrusion) *protrusion = at->second.second;
    return at->second.first;
  }

private:
  std::map<std::string, std::pair<base::SphereSet, spheredecomp::Protrusion>> cuts_;
};

inline SphereSets* cutOnce() {
  static CutOnce kept;
  return &kept;
}

} // namespace grouser::coupling
