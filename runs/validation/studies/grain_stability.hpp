// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"
#include "runs/validation/studies/contact_modes.hpp"
#include "terrain/grains.hpp"

#include <string>
#include <vector>

/// Stability maps of the grain integrator over time step, stiffness and damping; comparison with theory and with the
/// step limit of a run.
namespace grouser::studies {

/// Spheres at rest under gravity, before the disturbance. Gravity is proportional to the stiffness, so that at any
/// stiffness the overlap of a sphere under its own weight is 1e-3 radii.
struct RestingGrains {
  std::string name;  ///< "contact", "column", "bed", "bed with friction"
  std::string title; ///< title in tables
  double friction = 0;
  bool box = false;          ///< the spheres are between four walls
  double halfWidth = 0;      ///< half width of the box [m]
  bool vertical = false;     ///< the disturbance acts only along z (a column would fall over)
  terrain::GrainState state; ///< state at rest
  ContactNetwork network;
  double frequency = 0;  ///< highest natural frequency [sqrt(k / m)]
  double gershgorin = 0; ///< Gershgorin's bound of this frequency [sqrt(k / m)]
  double forceRatio = 0; ///< mean resultant force / weight of a grain after settling [-]
};
RestingGrains oneContact();
RestingGrains column(int grains);
/// A bed of `grains` grains that fell into a box and came to rest.
RestingGrains randomBed(int grains, double friction);

/// A cell of a map: one time step at one stiffness and damping.
struct GrainStabilityCell {
  double stiffness = 0; ///< [N/m]
  double zeta = 0;      ///< damping ratio c / (2 sqrt(k m)) of every contact [-]
  double timeStep = 0;  ///< [s]
  double scaled = 0;    ///< timeStep sqrt(k / m) [-]
  double ofLimit = 0;   ///< timeStep / predicted limit [-]
  bool calm = false;    ///< the step is within calmLimit()
  bool stable = false;  ///< the run was stable
  double growth = 0;    ///< maximum kinetic energy until the end or stop / kinetic energy of the disturbance [-]
  bool stopped = false; ///< a guard stopped the run
  bool predicted() const { return ofLimit < 1; }
  bool agrees() const { return stable == predicted(); }
};

/// Longest stable step in theory [1 / sqrt(k / m)]: omega dt < 2 (sqrt(1 + z^2) - z) for the highest mode, with its
/// damping ratio z = zeta omega / sqrt(k / m) (the dashpots are proportional to the springs).
double predictedLimit(const RestingGrains& grains, double zeta);
/// Longest step at which all motions in this scene decay [s], according to setup::stepLimit().
double calmLimit(const RestingGrains& grains, double stiffness, double zeta);

/// Disturbs the state at rest and runs steps. The cell is unstable if the kinetic energy exceeds kGrowth times the
/// energy of the disturbance, or if a guard stops the run.
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
  std::vector<double> ofLimit; ///< further steps: step / predicted limit [-]
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
