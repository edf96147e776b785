// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/body_foundation.hpp"
#include "coupling/body_probes.hpp"
#include "coupling/body_shape.hpp"
#include "coupling/contact_parts.hpp"
#include "multibody/solver.hpp"
#include "multibody/state.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grouser::terrain {
class HeightField;
}

namespace grouser::coupling {

/// Steps that follow the error.
struct StepControl {
  double tolerance = 0; ///< error that steps add a second [m/s, rad/s]
  double first = 0;     ///< step to begin with [s]
  double longest = 0;   ///< that drives allow [s]
};

/// A mechanism as its solver takes it.
struct MechanismSetup {
  multibody::Model model;
  multibody::SolverOptions solver;
  base::Vec3d gravity;                  ///< [m/s2]
  double largestTurn;                   ///< largest turn of a body in a step [rad]
  std::optional<StepControl> control{}; ///< empty: fixed steps
  std::vector<std::optional<base::Vec3d>>
      boxes{};                      ///< edges of each body as it is drawn [m]; empty: as its inertia has it
  std::vector<BodyShape> shapes{};  ///< empty: the bodies touch nothing
  FoundationTable foundations{};    ///< between the shapes and what is rigid
  std::vector<BodyProbe> probes{};  ///< boxes in which the mass of grains is recorded
  std::optional<double> aboveBed{}; ///< clearance of the shapes above the settled bed [m]; empty: as the scene has it
  std::string place{};              ///< section of that key in messages: "scene.toml:14: mechanism"

  // Scenes with a vehicle.
  multibody::PartCounts ofVehicle{}; ///< parts of the vehicle, with which the model begins; 0 without
  std::vector<bool> hitched{}; ///< [body] whether it is set down with the vehicle, to which joints or springs tie it
  base::Pose chassis{};        ///< pose of the chassis in the model: X_WB
};

/// Adds the bodies' shapes to what touches. Shapes of one body, of two fixed bodies and of two that a joint ties do not
/// touch each other. `model`: the setup's, or that of the vehicle with the bodies; the parts of `all` are the
/// vehicle's. The caller appends the sphere sets of meshCuts() to `all.surfaces`.
void addBodyParts(ContactParts& all, const MechanismSetup& setup, const multibody::Model& model);

/// Throws InputError where a shape stands deeper than 2 % of its half thickness in rigid `terrain` (null without), in
/// one of the `obstacles` or in another body at the start. `model` as in addBodyParts().
void requireApart(const MechanismSetup& setup, const multibody::Model& model, const std::vector<Obstacle>& obstacles,
                  const terrain::HeightField* terrain);

/// Brings `state`, as the model says it, and `loads` to the start: gravity, and velocities that fit joints and drives.
/// Returns the kinetic energy that the drives gave in an impact, since the velocities did not fit theirs [J].
double beginMotion(const MechanismSetup& setup, multibody::Solver& solver, multibody::State& state,
                   multibody::Loads& loads);

} // namespace grouser::coupling
