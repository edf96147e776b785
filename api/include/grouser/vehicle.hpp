// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <grouser/types.hpp>

#include <optional>
#include <vector>

namespace grouser {

namespace detail {
struct Run;
} // namespace detail

/// One track. Vectors have an entry a shoe, in the order of the loop. "Mean": over the steps of the last call of
/// Simulation::step().
struct Track {
  double sprocketSpeed = 0; ///< now [rad/s], forward positive
  double driveTorque = 0;   ///< of the hull on the sprocket, mean [N m]
  double drivePower = 0;    ///< of the drive, mean [W]
  double speed = 0;         ///< of the hull at this track, along the hull [m/s]
  double slip = 0;          ///< 1 - speed / (sprocket speed x pitch radius) [-]; NaN while the sprocket stands
  std::vector<double> tension;     ///< in the pin ahead of each shoe [N]
  std::vector<double> sinkage;     ///< of each shoe [m]; NaN off the ground run
  std::vector<double> normalForce; ///< of the ground square to each pad, mean [N]
  std::vector<double> shearForce;  ///< of the ground along each pad and across it together, mean [N]
};

/// How the vehicle moves now, and what acts on it.
struct VehicleState {
  double time = 0;       ///< [s]
  Vec3 position;         ///< middle of the sprockets' axle line [m]
  Vec3 velocity;         ///< of the hull's centre of mass [m/s]
  double speed = 0;      ///< of the hull along its heading, level [m/s]
  double heading = 0;    ///< of the hull from x towards y, continuous over turns [rad]
  double pitch = 0;      ///< nose up [rad]
  double roll = 0;       ///< right side down [rad]
  double turnRate = 0;   ///< yaw rate, left positive [rad/s]
  Vec3 groundForce;      ///< forward, left, up, mean [N]
  double drawbarPull = 0; ///< of the vehicle on its hitch; net thrust without one; mean [N]
  std::optional<double> driveStart; ///< when the drive began [s]; empty while the vehicle is lowered and comes to rest
  Track left, right;      ///< right: empty vectors where the scene has a single track
};

/// The vehicle of a simulation; valid as long as that. What is set acts from the next step on until it is set again
/// or released, once the drive has begun; the driver's ramp (driver.drive_ramp) smooths its begin. Setters throw
/// InputError where the scene's vehicle has nothing of the kind, or a value is out of range.
class Vehicle {
public:
  VehicleState state() const;
  double mass() const;        ///< [kg]
  double pitchRadius() const; ///< of the sprockets [m]: track speed = sprocket speed x pitch radius
  int shoes() const;          ///< of one track

  /// [rad/s], forward positive, within +-100. With driver.drive = "engine" the governors' set points.
  void setSprocketSpeed(double left, double right);
  /// [N m], forward positive; driver.drive = "torque".
  void setSprocketTorque(double left, double right);
  /// -1 to 1: share of the engines' full load, or of their brakes where against the way; driver.drive = "engine".
  void setThrottle(double left, double right);
  /// Back to the scene's driver.
  void releaseSprockets();
  /// Force that holds the vehicle back [N]; [hitch] kind = "force".
  void setHitchForce(double force);
  /// Speed of the carriage that holds it [m/s]; [hitch] kind = "speed".
  void setHitchSpeed(double speed);
  void releaseHitch();

private:
  friend class Simulation;
  explicit Vehicle(detail::Run& run) : run_(&run) {}
  detail::Run* run_;
};

} // namespace grouser
