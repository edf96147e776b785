// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/ledger.hpp"
#include "multibody/model.hpp"
#include "multibody/spatial.hpp"

#include <cstddef>
#include <vector>

namespace grouser::multibody {

/// Readings of a joint in the last step. Forces are means over the step with kSymplecticEuler, and values at its end
/// with kRattle.
struct JointReading {
  Vec3d force; ///< force of A on B: hard rows plus axis force, world components [N]; of all solutions in redundant
               ///< loops, the solver's (Solver::reactions(); shoes: vehicle/pin_reactions.hpp)
  Vec3d
      torque; ///< torque of A on B about the joint point (origin of frame_B), with axis torque, world components [N m]
  double position = 0;    ///< angle [rad], unwrapped over full turns, or slide [m]; 0 if the type has no axis; for a
                          ///< cylindrical joint the angle (slide: State::slide)
  double rate = 0;        ///< [rad/s] or [m/s]
  double axisForce = 0;   ///< sum of damping, spring, stops and drive along the free axis, on B [N] or [N m]
  double driveForce = 0;  ///< contribution of the drive to axisForce [N] or [N m]
  double springForce = 0; ///< contribution of springs to axisForce, with their dampers and stops [N] or [N m]
};

/// Force and torque of a joint, as in JointReading.
struct JointReaction {
  Vec3d force;  ///< [N]
  Vec3d torque; ///< torque about the joint point [N m]
};

/// Readings of the slide of a cylindrical joint in the last step; members as in JointReading.
struct AxisReading {
  double position = 0;    ///< [m]
  double rate = 0;        ///< [m/s]
  double axisForce = 0;   ///< [N]
  double driveForce = 0;  ///< [N]
  double springForce = 0; ///< [N]
};

/// Readings of a bushing in the last step.
struct BushingReading {
  Vec3d force;       ///< force on B at the origin of its frame, world components [N]
  Vec3d torque;      ///< torque on B, world components [N m]
  Vec3d translation; ///< d, in the axes of A's frame [m]
  Vec3d rotation;    ///< phi, in the axes of A's frame [rad]
};

/// Readings of a coupling in the last step.
struct CouplingReading {
  double force = 0; ///< generalised force on axis 2 along +axis [N m] or [N]; axis 1 receives -ratio * force
};

/// Readings of a point spring in the last step.
struct SpringReading {
  double force = 0;  ///< positive: repulsive [N]
  double length = 0; ///< [m]
};

/// State variables of a mechanism. After a step of Integrator::kRattle `pose` and `twist` are both at `time`. After a
/// step of Integrator::kSymplecticEuler they are staggered, as in any kick-drift scheme: `pose` is at `time`, `twist`
/// is the mean twist over the last step.
struct State {
  double time = 0;
  std::vector<Pose> pose;             ///< X_WB, one per body
  std::vector<Twist> twist;           ///< one per body
  std::vector<Vec3d> angularMomentum; ///< angular momentum about the centre of mass, world components [kg m2/s]
  std::vector<JointReading> joint;    ///< one per joint
  std::vector<SpringReading> spring;  ///< one per point spring
  Ledger ledger;
  std::vector<AxisReading> slide; ///< one per joint if the model has cylindrical joints (0 for other types), else empty
  std::vector<BushingReading> bushing;
  std::vector<CouplingReading> coupling;

  /// Returns the complete state as a flat array; a run resumed from it is bitwise equal to an uninterrupted run.
  std::vector<double> save() const;
  /// Number of ledger values at the end of save(); state hashes exclude them, since no step depends on them.
  static constexpr std::size_t kBooks = 39;
  /// Inverse of save(); throws base::InputError if the length does not match this state's model.
  void restore(const std::vector<double>& flat);
};

/// Scale factors of one spring [-], for ramping.
struct SpringControl {
  double loadFactor = 1;      ///< scales the preload
  double stiffnessFactor = 1; ///< scales the stiffness
};

struct DriveControl {
  bool on = true;
  double speed = 0; ///< speed of a speed drive without a law [rad/s] or [m/s]
  double force = 0; ///< force of a force drive without a law [N m] or [N]
};

/// External inputs of one step.
struct Loads {
  Vec3d gravity{0, 0, -9.81};             ///< [m/s2]
  std::vector<Wrench> external;           ///< one per body
  std::vector<SpringControl> axisSprings; ///< one per axis spring
  std::vector<SpringControl> pointSprings;
  std::vector<DriveControl> drives;
  std::vector<SpringControl> bushings; ///< one per bushing; loadFactor is ignored
};

/// Returns the model's initial state; joint readings contain positions and rates, but no forces yet.
State makeState(const Model& model);
/// Returns default loads: no wrenches, all factors 1, drives as in the model.
Loads makeLoads(const Model& model);
/// Sets a body's velocity and its angular momentum consistently.
void setTwist(const Model& model, State& state, int body, const Twist& twist);

} // namespace grouser::multibody
