// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/ledger.hpp"
#include "multibody/model.hpp"
#include "multibody/spatial.hpp"

#include <cstddef>
#include <vector>

namespace grouser::multibody {

/// Readings of a joint in the last step. Forces: mean over the step with kSymplecticEuler, values at its end with
/// kRattle.
struct JointReading {
  Vec3d force; ///< on B from A, hard rows and axis force together, world components [N]; for a shoe joint the track
               ///< tension
  Vec3d
      torque; ///< on B from A about the joint point (origin of B's frame), axis torque included, world components [N m]
  double position = 0;    ///< angle [rad], unwrapped over turns, or slide [m]; 0 where the type has no axis; the angle
                          ///< of a cylindrical, whose slide is in State::slide
  double rate = 0;        ///< [rad/s] or [m/s]
  double axisForce = 0;   ///< damping, spring, stops and drive along the free axis, on B [N] or [N m]
  double driveForce = 0;  ///< the drive's part of it [N] or [N m]
  double springForce = 0; ///< the springs' part of it, with their dampers and stops [N] or [N m]
};

/// Force and torque of a joint, as in JointReading.
struct JointReaction {
  Vec3d force;  ///< [N]
  Vec3d torque; ///< about the joint point [N m]
};

/// Readings of the second axis of a joint, the slide of a cylindrical one, in the last step. As in JointReading.
struct AxisReading {
  double position = 0;    ///< [m]
  double rate = 0;        ///< [m/s]
  double axisForce = 0;   ///< [N]
  double driveForce = 0;  ///< [N]
  double springForce = 0; ///< [N]
};

/// Readings of a bushing in the last step.
struct BushingReading {
  Vec3d force;       ///< on B at the origin of its frame, world components [N]
  Vec3d torque;      ///< on B, world components [N m]
  Vec3d translation; ///< d, in the axes of A's frame [m]
  Vec3d rotation;    ///< phi, in the axes of A's frame [rad]
};

/// Readings of a coupling in the last step.
struct CouplingReading {
  double force = 0; ///< generalised force on axis 2 along +axis; axis 1 feels -ratio times it [N m] or [N]
};

/// Readings of a point spring in the last step.
struct SpringReading {
  double force = 0;  ///< positive pushes apart [N]
  double length = 0; ///< [m]
};

/// All state variables. After a step of Integrator::kRattle `pose` and `twist` are both at `time`. After one of
/// Integrator::kSymplecticEuler they are staggered, as in any kick-drift scheme: `pose` is at `time`, `twist` is the
/// mean twist over the step that led there.
struct State {
  double time = 0;
  std::vector<Pose> pose;             ///< X_WB, one a body
  std::vector<Twist> twist;           ///< one a body
  std::vector<Vec3d> angularMomentum; ///< angular momentum about the centre of mass, world components [kg m2/s]
  std::vector<JointReading> joint;    ///< one a joint
  std::vector<SpringReading> spring;  ///< one a point spring
  Ledger ledger;
  std::vector<AxisReading> slide; ///< one a joint if the model has cylindrical joints (others' stay 0), else empty
  std::vector<BushingReading> bushing;
  std::vector<CouplingReading> coupling;

  /// The complete dynamic state as a flat array: a run resumed from it gives the same bits as one straight through.
  std::vector<double> save() const;
  /// Number of trailing ledger values, on which no step depends: a hash of the state excludes them.
  static constexpr std::size_t kBooks = 39;
  /// Inverse of save(); throws base::InputError if the length does not fit this state's model.
  void restore(const std::vector<double>& flat);
};

/// Scale factors of one spring [-], to ramp it in.
struct SpringControl {
  double loadFactor = 1;      ///< of the preload
  double stiffnessFactor = 1; ///< of the stiffness
};

struct DriveControl {
  bool on = true;
  double speed = 0; ///< of a speed drive without a law [rad/s] or [m/s]
  double force = 0; ///< of a force drive without a law [N m] or [N]
};

/// External inputs of one step.
struct Loads {
  Vec3d gravity{0, 0, -9.81};             ///< [m/s2]
  std::vector<Wrench> external;           ///< one a body
  std::vector<SpringControl> axisSprings; ///< one an axis spring
  std::vector<SpringControl> pointSprings;
  std::vector<DriveControl> drives;
  std::vector<SpringControl> bushings; ///< one a bushing; loadFactor is not used
};

/// The model's state at the start; joint readings hold positions and rates, no forces yet.
State makeState(const Model& model);
/// No wrenches, all factors 1, drives as in the model.
Loads makeLoads(const Model& model);
/// Sets a body's velocity (its angular momentum follows).
void setTwist(const Model& model, State& state, int body, const Twist& twist);

} // namespace grouser::multibody
