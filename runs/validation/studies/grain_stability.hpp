// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"
#include "runs/validation/studies/contact_modes.hpp"
#include "terrain/grains.hpp"

#include <string>
#include <vector>

/// Which steps the grains' integrator takes: maps over time step, stiffness and damping, against what theory predicts
/// and what a run's check of its scene refuses.
namespace grouser::studies {

/// Spheres at rest under gravity, whose rest is then disturbed. Gravity grows with the stiffness, so that a sphere's
/// own weight overlaps it by a thousandth of its radius at any stiffness.
struct RestingGrains {
  std::string name;  ///< "contact", "column", "bed", "bed with friction"
  std::string title; ///< for tables
  double friction = 0;
  bool box = false;          ///< four walls around
  double halfWidth = 0;      ///< of the box [m]
  bool vertical = false;     ///< disturbed along z only: a column would fall over
  terrain::GrainState state; ///< at rest
  ContactNetwork network;
  double frequency = 0;  ///< highest natural [sqrt(k / m)]
  double gershgorin = 0; ///< its bound from each sphere's own contacts [sqrt(k / m)]
  double forceRatio = 0; ///< mean resultant force a grain over its weight, once settled [-]
};
RestingGrains oneContact();
RestingGrains column(int grains);
/// About so many grains, poured into a box and brought to rest.
RestingGrains randomBed(int grains, double friction);

/// One step at one stiffness and damping.
struct GrainStabilityCell {
  double stiffness = 0; ///< [N/m]
  double zeta = 0;      ///< c / (2 sqrt(k m)) of every contact [-]
  double timeStep = 0;  ///< [s]
  double scaled = 0;    ///< timeStep sqrt(k / m) [-]
  double ofLimit = 0;   ///< timeStep over the predicted limit [-]
  bool calm = false;    ///< within calmLimit()
  bool stable = false;  ///< as found
  double growth = 0; ///< largest kinetic energy over that of the disturbance [-]; of a run that was stopped, until then
  bool stopped = false; ///< by a guard of the run
  bool predicted() const { return ofLimit < 1; }
  bool agrees() const { return stable == predicted(); }
};

/// Longest stable step [1 / sqrt(k / m)]: omega dt < 2 (sqrt(1 + z^2) - z) for the highest mode, whose damping ratio is
/// z = zeta omega / sqrt(k / m), since every contact's dashpot is to its spring as the others'.
double predictedLimit(const RestingGrains& grains, double zeta);
/// Longest step at which setup::stepLimit() takes all motions of this scene to decay [s].
double calmLimit(const RestingGrains& grains, double stiffness, double zeta);

/// Disturbs the rest, steps along; unstable when the kinetic energy passes kGrowth of the disturbance's, or when a
/// guard stops the run.
GrainStabilityCell tryCell(const RestingGrains& resting, double stiffness, double zeta, double timeStep);
inline constexpr double kGrowth = 1e3;
inline constexpr int kStabilitySteps = 600;

struct GrainStabilityMap {
  RestingGrains grains;
  std::vector<GrainStabilityCell> cells;
};
struct StabilityAxes {
  std::vector<double> stiffness, zeta;
  std::vector<double> scaled;  ///< steps on a regular grid [1 / sqrt(k / m)]
  std::vector<double> ofLimit; ///< and as shares of the predicted limit
};
StabilityAxes stabilityAxes(bool quick);
GrainStabilityMap stabilityMap(const RestingGrains& grains, const StabilityAxes& axes);

/// `grouser study stability`.
struct GrainStabilityCommand {
  jobs::StudyPlace place;
  int bedGrains = 300;
  int columnGrains = 10;
};
void studyGrainStabilityCommand(const GrainStabilityCommand& command);

std::string grainStabilityTable(const GrainStabilityMap& map);
std::string grainStabilityCsv(const std::vector<GrainStabilityMap>& maps);
std::string stabilityLimitsCsv(const std::vector<GrainStabilityMap>& maps);

} // namespace grouser::studies
