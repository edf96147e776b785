// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <grouser/types.hpp>

#include <optional>
#include <vector>

namespace grouser {

namespace detail {
struct Run;
} // namespace detail

/// State of a track. Vectors have one entry per shoe, in loop order. Means are over the last Simulation::step() call.
struct Track {
  double sprocketSpeed = 0;    ///< current sprocket speed [rad/s], forward positive
  double driveTorque = 0;      ///< mean drive torque on the sprocket over the last step() call [N m]
  double drivePower = 0;       ///< mean drive power over the last step() call [W]
  double speed = 0;            ///< hull speed at this track, along the hull [m/s]
  double slip = 0;             ///< 1 - speed / (sprocket speed x pitch radius) [-]; NaN while the sprocket is at rest
  std::vector<double> tension; ///< pull along the chain in the pin ahead of each shoe [N]
  std::vector<double> sinkage; ///< sinkage of each shoe [m]; NaN without ground contact
  std::vector<double> normalForce; ///< mean ground force normal to each pad [N]
  std::vector<double> shearForce;  ///< magnitude of the mean ground force tangential to each pad [N]
};

/// Motion of the vehicle and forces on it.
struct VehicleState {
  double time = 0;                  ///< [s]
  Vec3 position;                    ///< middle of the sprockets' axle line [m]
  Vec3 centre;                      ///< centre of mass of the hull [m]
  Vec3 velocity;                    ///< velocity of the hull's centre of mass [m/s]
  double speed = 0;                 ///< horizontal speed of the hull along its heading [m/s]
  double heading = 0;               ///< hull heading from x towards y, continuous over turns [rad]
  double pitch = 0;                 ///< positive if the nose points up [rad]
  double roll = 0;                  ///< positive if the right side is down [rad]
  double turnRate = 0;              ///< yaw rate, left positive [rad/s]
  Vec3 groundForce;                 ///< mean ground force (forward, left, up) [N]
  double drawbarPull = 0;           ///< mean drawbar pull; net thrust without a hitch [N]
  std::optional<double> driveStart; ///< start time of the drive [s]; empty until it is known
  Track left, right;                ///< right: empty vectors for a single-track scene
};

/// The vehicle of a simulation. The object is valid as long as the simulation exists, even if the simulation is moved.
/// An input takes effect at the next step after the start of the drive, and remains in effect until it is set again or
/// released; driver.drive_ramp smooths the start. Setters throw InputError if the scene does not support the input, or
/// if the value is out of range.
class Vehicle {
public:
  VehicleState state() const;
  double mass() const;        ///< [kg]
  double pitchRadius() const; ///< pitch radius of the sprockets [m]: track speed = sprocket speed x pitch radius
  int shoes() const;          ///< number of shoes of one track

  /// Sets sprocket speeds [rad/s], forward positive, within +-100. With driver.drive = "engine": governor speeds.
  void setSprocketSpeed(double left, double right);
  /// Sets sprocket torques [N m], forward positive; requires driver.drive = "torque".
  void setSprocketTorque(double left, double right);
  /// Sets throttles in [-1, 1]: a fraction of the full-load torque, or of the brake torque if it opposes the rotation.
  /// Requires driver.drive = "engine". Throttle and governor speed exclude each other: the last one set takes effect.
  void setThrottle(double left, double right);
  /// Returns control of the sprockets to the scene's driver.
  void releaseSprockets();
  /// Sets the hitch force that resists the vehicle [N]; requires [hitch] kind = "force".
  void setHitchForce(double force);
  /// Sets the speed of the towing carriage [m/s]; requires [hitch] kind = "speed".
  void setHitchSpeed(double speed);
  void releaseHitch();

private:
  friend class Simulation;
  explicit Vehicle(detail::Run& run) : run_(&run) {}
  detail::Run* run_;
};

} // namespace grouser
