// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scm/berms.hpp"
#include "scm/body_contacts.hpp"
#include "scm/pad_contacts.hpp"

#include <memory>
#include <vector>

namespace grouser::scm {

/// Soil displaced by sinking bodies.
struct Displacement {
  double share{};         ///< of the sunk volume that moves aside instead of being compacted [-], 0 to 1
  double repose{};        ///< tangent of the angle of repose [-]
  double interval = 5e-3; ///< between two rearrangements, rounded to steps [s]
};

/// All contacts of a scene with deformable soil.
class SoilContacts {
public:
  /// `deepest`: end of the table of pressures [m].
  SoilContacts(const SoilConstants& soil, double deepest, const Displacement& displacement, SoilMap& map,
               std::vector<Pad> pads, std::vector<Solid> solids, double timeStep);

  /// Advances the soil to the poses `motion`, indexed by part, and computes the loads.
  void step(const contact::PartMotion* motion);

  const PadContacts& pads() const { return pads_; }
  const BodyContacts& bodies() const { return bodies_; }
  const SoilEnergy& energy() const { return energy_; }
  double movedVolume() const { return berms_.moved(); } ///< deposited as loose soil since the start [m3]

  /// Calls look() for each node that a body presses, body by body: a node under two has a part of its stress from each.
  template <class Look> void forEachLoaded(const Look& look) const {
    pads_.forEachLoaded(look), bodies_.forEachLoaded(look);
  }

  /// State as numbers: energies, touched nodes, contacts.
  std::vector<double> save() const;
  /// Restores a state that save() returned. Returns false if it belongs to other bodies.
  bool restore(const std::vector<double>& saved);

private:
  SoilMap& map_;
  double timeStep_;
  std::int64_t interval_; ///< of rearrangements [steps]; 0: never
  LoadedNodes loaded_;
  PadContacts pads_;
  BodyContacts bodies_;
  Berms berms_;
  SoilEnergy energy_;
  std::int64_t steps_ = 0;
};

} // namespace grouser::scm
