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

/// Settings of error-controlled steps.
struct StepControl {
  double tolerance = 0; ///< error per second [m/s, rad/s]
  double first = 0;     ///< first step [s]
  double longest = 0;   ///< step limit set by drives [s]
};

/// Setup of a mechanism for its solver.
struct MechanismSetup {
  multibody::Model model;
  multibody::SolverOptions solver;
  base::Vec3d gravity;                             ///< [m/s2]
  double largestTurn;                              ///< maximum rotation of a body in a step [rad]
  std::optional<StepControl> control{};            ///< empty: fixed steps
  std::vector<std::optional<base::Vec3d>> boxes{}; ///< edges of each body in images [m]; empty: from its inertia
  std::vector<BodyShape> shapes{};                 ///< empty: the bodies have no contacts
  FoundationTable foundations{};                   ///< foundations between the shapes and rigid surfaces
  std::vector<BodyProbe> probes{};                 ///< boxes in which the grain mass is recorded
  std::optional<double> aboveBed{}; ///< clearance of the shapes above the settled bed [m]; empty: position of the scene
  std::string place{};              ///< section of that key for messages: "scene.toml:14: mechanism"

  // For scenes with a vehicle.
  multibody::PartCounts ofVehicle{}; ///< parts of the vehicle, which are first in the model; 0 without a vehicle
  std::vector<bool> hitched{};       ///< [body] true if connected to the vehicle by joints or springs; placed with it
  base::Pose chassis{};              ///< pose of the chassis in the model: X_WB
};

/// Adds the bodies' shapes to the contact parts. Shapes of one body, of two fixed bodies and of two bodies connected by
/// a joint do not touch each other. `model`: model of the setup, or of the vehicle with the bodies. Parts already in
/// `all` are the vehicle's. The caller appends the sphere sets of meshCuts() to `all.surfaces`.
void addBodyParts(ContactParts& all, const MechanismSetup& setup, const multibody::Model& model);

/// Throws InputError if a shape initially overlaps rigid `terrain` (null without), one of the `obstacles` or another
/// body by more than 2 % of its half thickness. `model` as in addBodyParts().
void requireApart(const MechanismSetup& setup, const multibody::Model& model, const std::vector<Obstacle>& obstacles,
                  const terrain::HeightField* terrain);

/// Initialises `state` of the model and `loads`: gravity, and velocities consistent with joints and drives. Returns the
/// kinetic energy added by the drives, if the velocities do not match theirs [J].
double beginMotion(const MechanismSetup& setup, multibody::Solver& solver, multibody::State& state,
                   multibody::Loads& loads);

} // namespace grouser::coupling
