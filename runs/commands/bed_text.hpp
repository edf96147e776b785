// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"

#include <string>
#include <vector>

namespace grouser::commands {

/// Number of grains, their radii, and the number of fixed grains: "1000 of radius 0.02 to 0.03 m, 50 fixed".
std::string grainsText(const terrain::Grains& grains);

/// Lines about settling, packing and surface of the bed; empty without a bed.
std::string bedText(const coupling::Simulation& simulation);

/// Dimensions of a vehicle and of the bed under it.
struct TrackOnBed {
  double padWidth;     ///< pad width b [m]
  double gauge;        ///< distance between the track centre lines [m]
  double thickness;    ///< bed thickness [m]
  double width;        ///< bed width, across the driving direction [m]
  double meanDiameter; ///< mean diameter of all grains [m]
  bool walls;          ///< true: side walls; false: periodic boundaries
  bool roughFloor;
  double pressedDiameter; ///< mean diameter of the grains under the pads [m]
};

/// Notes on a bed that is too small or too coarse for its vehicle, one per rule. The failure mechanism below a strip of
/// width b is 1.6 b deep and 9.6 b wide at an angle of internal friction of 30 degrees (Prandtl). A plate narrower than
/// 20 grain diameters sinks too little (docs/beds.md).
std::vector<std::string> bedNotes(const TrackOnBed& track);

/// The same for the planned bed of a scene; empty without a vehicle on a bed.
std::vector<std::string> bedNotes(const scene::Scene& scene);
/// The same for the settled bed of a run; empty without a vehicle on a bed.
std::vector<std::string> bedNotes(const coupling::Simulation& simulation);

/// Angle between gravity and the vertical [deg]; 0 without gravity.
double leanOf(const base::Vec3d& gravity);

/// Warning with cause if the porosity of a settled bed differs from terrain.porosity; else empty.
std::string porosityWarning(double wanted, const terrain::BedStructure& bed, const base::Vec3d& gravity);
/// The same for the settled bed of a run; empty without a target porosity.
std::string porosityWarning(const coupling::Simulation& simulation);

/// Prints setup::terrainRemarks().
void warnOfTerrain(const scene::Scene& scene);

} // namespace grouser::commands
