// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scm/berms.hpp"
#include "scm/body_contacts.hpp"
#include "scm/pad_contacts.hpp"

#include <memory>
#include <vector>

namespace grouser::scm {

/// Parameters of soil displaced by sinking bodies.
struct Displacement {
  double share{};         ///< fraction of the sunk volume displaced sideways instead of compacted [-], 0 to 1
  double repose{};        ///< tangent of the angle of repose [-]
  double interval = 5e-3; ///< interval of rearrangements, rounded to whole steps [s]
};

/// All soil contacts of a scene with deformable soil.
class SoilContacts {
public:
  /// `deepest`: maximum sinkage of the pressure table [m].
  SoilContacts(const SoilConstants& soil, double deepest, const Displacement& displacement, SoilMap& map,
               std::vector<Pad> pads, std::vector<Solid> solids, double timeStep);

  /// Advances the soil to the poses `motion`, indexed by part, and computes the loads.
  void step(const contact::PartMotion* motion);

  const PadContacts& pads() const { return pads_; }
  const BodyContacts& bodies() const { return bodies_; }
  const SoilEnergy& energy() const { return energy_; }
  double movedVolume() const { return berms_.moved(); } ///< total deposited as loose soil since the start [m3]

  /// Calls look() for each node pressed by a body, body by body; a node under two bodies has a stress share from each.
  template <class Look> void forEachLoaded(const Look& look) const {
    pads_.forEachLoaded(look), bodies_.forEachLoaded(look);
  }

  /// Returns the state as numbers: energies, touched nodes, contacts.
  std::vector<double> save() const;
  /// Restores a state returned by save(). Returns false if it belongs to other bodies.
  bool restore(const std::vector<double>& saved);

private:
  SoilMap& map_;
  double timeStep_;
  std::int64_t interval_; ///< interval of rearrangements [steps]; 0: never
  LoadedNodes loaded_;
  PadContacts pads_;
  BodyContacts bodies_;
  Berms berms_;
  SoilEnergy energy_;
  std::int64_t steps_ = 0;
};

} // namespace grouser::scm
