// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <grouser/types.hpp>

#include <optional>
#include <vector>

namespace grouser {

namespace detail {
struct Run;
} // namespace detail

/// One track. Vectors have one entry per shoe, in loop order. "Mean": average over the last Simulation::step() call.
struct Track {
  double sprocketSpeed = 0;    ///< current speed [rad/s], forward positive
  double driveTorque = 0;      ///< mean drive torque on the sprocket over the last step() call [N m]
  double drivePower = 0;       ///< mean drive power over the last step() call [W]
  double speed = 0;            ///< hull speed at this track, along the hull [m/s]
  double slip = 0;             ///< 1 - speed / (sprocket speed x pitch radius) [-]; NaN while the sprocket is at rest
  std::vector<double> tension; ///< tension in the pin ahead of each shoe [N]
  std::vector<double> sinkage; ///< sinkage of each shoe [m]; NaN outside the ground contact
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
  double pitch = 0;                 ///< nose up [rad]
  double roll = 0;                  ///< right side down [rad]
  double turnRate = 0;              ///< yaw rate, left positive [rad/s]
  Vec3 groundForce;                 ///< ground force: forward, left, up, mean [N]
  double drawbarPull = 0;           ///< pull of the vehicle on its hitch; net thrust without one; mean [N]
  std::optional<double> driveStart; ///< start time of the drive [s]; empty until it is known
  Track left, right;                ///< right: empty vectors for a single-track scene
};

/// The vehicle of a simulation; valid as long as the simulation, also after the simulation has been moved. An input
/// takes effect at the next step, once the drive has started, and holds until it is set again or released;
/// driver.drive_ramp smooths the start. Setters throw InputError if the scene does not support the input or the value
/// is out of range.
class Vehicle {
public:
  VehicleState state() const;
  double mass() const;        ///< [kg]
  double pitchRadius() const; ///< pitch radius of the sprockets [m]: track speed = sprocket speed x pitch radius
  int shoes() const;          ///< number of shoes of one track

  /// Sprocket speeds [rad/s], forward positive, within +-100. With driver.drive = "engine": governor speeds.
  void setSprocketSpeed(double left, double right);
  /// Sprocket torques [N m], forward positive; driver.drive = "torque".
  void setSprocketTorque(double left, double right);
  /// Throttle, -1 to 1: fraction of full-load torque, or of brake torque if it opposes the rotation; driver.drive =
  /// "engine". Throttle and governor speed are mutually exclusive: the last one set takes effect.
  void setThrottle(double left, double right);
  /// Returns control to the scene's driver.
  void releaseSprockets();
  /// Hitch force that resists the vehicle [N]; [hitch] kind = "force".
  void setHitchForce(double force);
  /// Speed of the towing carriage [m/s]; [hitch] kind = "speed".
  void setHitchSpeed(double speed);
  void releaseHitch();

private:
  friend class Simulation;
  explicit Vehicle(detail::Run& run) : run_(&run) {}
  detail::Run* run_;
};

} // namespace grouser
