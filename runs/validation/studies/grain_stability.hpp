// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"
#include "runs/validation/studies/contact_modes.hpp"
#include "terrain/grains.hpp"

#include <string>
#include <vector>

/// Stability maps of the grain integrator over time step, stiffness and damping, against theory and against the step
/// limit that a run enforces.
namespace grouser::studies {

/// Spheres at rest under gravity, then disturbed. Gravity is proportional to the stiffness, so that the overlap under
/// a sphere's own weight is 1e-3 radii at any stiffness.
struct RestingGrains {
  std::string name;  ///< "contact", "column", "bed", "bed with friction"
  std::string title; ///< title in tables
  double friction = 0;
  bool box = false;          ///< four walls
  double halfWidth = 0;      ///< half width of the box [m]
  bool vertical = false;     ///< disturbed along z only (a column would fall over)
  terrain::GrainState state; ///< state at rest
  ContactNetwork network;
  double frequency = 0;  ///< highest natural frequency [sqrt(k / m)]
  double gershgorin = 0; ///< its Gershgorin bound [sqrt(k / m)]
  double forceRatio = 0; ///< mean resultant force / weight of a grain after settling [-]
};
RestingGrains oneContact();
RestingGrains column(int grains);
/// About `grains` grains, poured into a box and brought to rest.
RestingGrains randomBed(int grains, double friction);

/// One step at one stiffness and damping.
struct GrainStabilityCell {
  double stiffness = 0; ///< [N/m]
  double zeta = 0;      ///< c / (2 sqrt(k m)) of every contact [-]
  double timeStep = 0;  ///< [s]
  double scaled = 0;    ///< timeStep sqrt(k / m) [-]
  double ofLimit = 0;   ///< timeStep / predicted limit [-]
  bool calm = false;    ///< within calmLimit()
  bool stable = false;  ///< observed
  double growth = 0;    ///< maximum kinetic energy / that of the disturbance [-]; stopped runs: until the stop
  bool stopped = false; ///< stopped by a guard
  bool predicted() const { return ofLimit < 1; }
  bool agrees() const { return stable == predicted(); }
};

/// Longest stable step [1 / sqrt(k / m)]: omega dt < 2 (sqrt(1 + z^2) - z) for the highest mode, with damping ratio
/// z = zeta omega / sqrt(k / m) (dashpots proportional to springs).
double predictedLimit(const RestingGrains& grains, double zeta);
/// Longest step at which all motions of this scene decay according to setup::stepLimit() [s].
double calmLimit(const RestingGrains& grains, double stiffness, double zeta);

/// Disturbs the state at rest and steps. Unstable if the kinetic energy exceeds kGrowth times that of the disturbance,
/// or if a guard stops the run.
GrainStabilityCell tryCell(const RestingGrains& resting, double stiffness, double zeta, double timeStep);
inline constexpr double kGrowth = 1e3;
inline constexpr int kStabilitySteps = 600;

struct GrainStabilityMap {
  RestingGrains grains;
  std::vector<GrainStabilityCell> cells;
};
struct StabilityAxes {
  std::vector<double> stiffness, zeta;
  std::vector<double> scaled;  ///< steps on a grid [1 / sqrt(k / m)]
  std::vector<double> ofLimit; ///< steps over the predicted limit [-]
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
