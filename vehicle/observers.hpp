// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/cause.hpp"
#include "multibody/state.hpp"
#include "vehicle/assembly.hpp"
#include "vehicle/blow_meter.hpp"
#include "vehicle/ground_plane.hpp"
#include "vehicle/travel.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grouser::vehicle {

inline constexpr double kStandardGravity = 9.80665; ///< [m/s2]
/// Speed below which a sprocket is stopped and slip is undefined [rad/s].
inline constexpr double kStanding = 1e-6;

/// Ground force on each body of the model, world components [N]. Empty: not known. Preferably the mean over the output
/// interval: on grains the force of a single step fluctuates, and with it the set of loaded shoes.
struct GroundLoads {
  std::vector<base::Vec3d> force;
};

/// One track at one time. Vectors have one entry per shoe, in the order of the wrap.
struct TrackObservation {
  std::vector<double> padHeight;      ///< lowest point of the pad plate, not of its grouser [m]
  std::vector<double> sinkage;        ///< sinkage() of each shoe [m]; NaN without ground contact
  std::vector<double> tension;        ///< constraint force in the pin joint ahead of each shoe [N]
  std::vector<double> groundPressure; ///< ground force normal to the pad over the pad's area [Pa]; NaN if not known
  std::vector<double> onGround;       ///< 1 in ground contact and loaded, else 0
  std::vector<double> normalForce;    ///< ground force normal to the pad, positive away from the ground [N]
  std::vector<double> forwardForce;   ///< ground force along the shoe, forward in ground contact [N]
  std::vector<double> leftForce;      ///< ground force across the shoe [N]
  std::vector<double> shear;          ///< resultant of both over the pad's area [Pa]; NaN if not known
  std::vector<double> armAngle;       ///< per road wheel: arm angle from the drawn position, wheel up positive [rad]
  double sprocketSpeed = 0;           ///< [rad/s]
  double driveTorque = 0;             ///< of the hull on the sprocket, positive drives forward [N m]
  double meanTorque = 0;              ///< the same, mean since restartMeans() [N m]
  double drivePower = 0;              ///< of the drive, mean since restartMeans() [W]
  double idlerForce = 0;              ///< of the tensioner on the idler's carrier, positive away from the sprocket [N]
  double idlerSlide = 0;              ///< from the position of the wrap, forward positive [m]
  double speed = 0;                   ///< of the hull at this track, along the hull's x axis [m/s]
  double slip = 0;                    ///< 1 - speed / (omega r_pitch) [-]; NaN while the sprocket is stopped
  double toothSpeed = 0;              ///< mean over whole tooth passages [m/s]; NaN before the first
  double toothSlip = 0;               ///< the same for the slip [-]
  double teethPassed = 0;             ///< omega Z / (2 pi), integrated [-]
  double pitchesPassed = 0;           ///< of the track past the sprocket [-]
  double skipped = 0;                 ///< teethPassed - pitchesPassed [-]
  double sideways = 0;                ///< largest distance of a shoe from its track's plane [m]
  double wheelLift = 0;               ///< largest gap between a road wheel and the plates under it [m]
};

/// The direction of motion along the ground: a unit vector over the hull's heading. See Observer::observe().
struct Along {
  double forward = 1, up = 0; ///< its components along the heading, and upward [-]
  /// Component along the motion of a vector (forward along the heading, left, up).
  double of(const base::Vec3d& v) const { return v.x * forward + v.z * up; }
};

struct Observation {
  double time = 0;             ///< [s]
  base::Vec3d position;        ///< middle of the sprockets' axle line, world [m]
  base::Vec3d velocity;        ///< velocity of the chassis' centre of mass, world [m/s]
  double heading = 0;          ///< angle of the hull's x axis from world x towards y, continuous over turns [rad]
  double pitchAngle = 0;       ///< nose up positive, within +-pi/2 [rad]
  double rollAngle = 0;        ///< right side down positive, continuous over turns [rad]
  base::Vec3d groundForce;     ///< sum over all bodies: forward along the heading, left, up [N]; NaN if not known
  Along along;                 ///< direction of the next four
  double grossTraction = 0;    ///< sum of the mean drive torques over the pitch radius [N]
  double netThrust = 0;        ///< force of the ground on the vehicle [N]
  double drawbarPull = 0;      ///< force of the vehicle on its hitch; netThrust until VehicleRig sets it [N]
  double motionResistance = 0; ///< grossTraction - netThrust [N]; NaN where the tracks run against each other
  std::vector<TrackObservation> tracks;
  BlowMeter blows;   ///< of the whole run, if recorded
  base::Alarm alarm; ///< thrown or skipping track
};

struct ObserverOptions {
  int averageTeeth = 1; ///< tooth passages of one mean
  double stone{};       ///< [m] largest stone between a road wheel and its plates that does not count as a thrown track
  double heading{};     ///< [rad] initial heading of the vehicle: the series of headings begins within pi of it
  base::Vec3d gravity{0, 0, -kStandardGravity}; ///< gravity of the run [m/s2]; loads are judged against it
};

/// Observes a vehicle: update() after every step, observe() for output.
class Observer {
public:
  /// The vehicle must outlive the observer.
  explicit Observer(const Assembly& vehicle, const ObserverOptions& options = {});

  void update(const multibody::State& state, double dt);
  /// `surface` may be null without a bed: sinkage is then NaN, and the ground counts as level.
  ///
  /// Traction, thrust and resistance are stated in the direction of motion, along the ground: along the tangent of
  /// groundPlane() above the hull's heading, forward or backward as the tracks have run since restartMeans(). If they
  /// are stopped (locked, on a slope), the hull's own motion counts. The last direction is kept if nothing moves, and
  /// while the tracks reverse by less than 0.01 m/s (a stalled vehicle rocks); initially, and if the tracks run in
  /// opposite directions (a pivot turn, without motion resistance), it is forward.
  Observation observe(const multibody::State& state, const GroundLoads& ground, const SurfaceHeight& surface) const;
  /// Computes only the alarm; cheap enough to call every few steps.
  base::Alarm alarm(const multibody::State& state, const GroundLoads& ground) const;
  void setGravity(const base::Vec3d& gravity) { gravity_ = gravity; } ///< [m/s2]
  /// Restarts the means of torque and power. Until the next update() they equal the values of the state.
  void restartMeans();
  const Travel& travel(int track) const { return travel_[track]; }

  std::vector<double> save() const;
  void restore(const std::vector<double>& flat);

private:
  TrackObservation observeTrack(int track, const multibody::State& state, const GroundLoads& ground,
                                const SurfaceHeight& surface) const;

  /// Sums over the updates since restartMeans().
  struct DriveSums {
    double torque = 0, power = 0; ///< [N m], [W]
    double rate = 0, speed = 0;   ///< sprocket rate [rad/s], speed of the hull at the track [m/s]
  };
  std::vector<DriveSums> means(const multibody::State& state) const;
  std::optional<int> motion(const std::vector<DriveSums>& sums, double updates) const;
  struct Attitude {
    double heading, pitch, roll; ///< [rad]
  };
  double riseAhead(const multibody::State& state, const SurfaceHeight& surface) const;
  Attitude attitude(const multibody::State& state) const;

  const Assembly* vehicle_;
  double stone_;                  ///< [m]
  base::Vec3d gravity_;           ///< [m/s2]
  std::vector<DriveSums> driven_; ///< one per track
  double updates_ = 0;
  double heading_, roll_ = 0; ///< at the last update, continuous over turns [rad]
  int way_ = 0;               ///< last direction of motion: 1 forward, -1 backward, 0 none yet
  std::vector<Travel> travel_;
};

/// Lowest point of a shoe's pad plate: of its four lower corners, in the world [m].
double padHeight(const ShoeSpec& shoe, const base::Pose& pose_W);

/// Sinkage of a shoe [m]: the distance, along the local normal of the undisturbed surface, from that surface to the
/// middle of the underside of the shoe's pad plate (not of its grousers), downwards positive. Both are evaluated at the
/// foot point: the point of the surface whose normal passes through the pad's middle.
///
/// The normal is that of the least-squares plane through the heights at 5 x 5 points of an axis-parallel square, one
/// pitch wide, about the point: grains are smaller than a shoe. The foot point is iterated from the point below the
/// pad: the pad's middle is projected onto the plane with this normal through the surface there, until it moves by less
/// than 1e-9 m, at most 40 times. Exact for a plane in one step. On a bed whose surface jumps from grain to grain the
/// iteration may alternate between two points; the effect on the distance is second order.
double sinkage(const VehicleSpec& spec, const base::Pose& shoePose_W, const SurfaceHeight& surface);

/// True for a shoe of the lower run with its middle between the axles of the first and last road wheel, in the hull
/// frame, loaded or not.
bool onGroundRun(const Assembly& vehicle, int track, int shoe, const multibody::State& state);

/// Load above which a shoe counts as loaded: 1 % of the vehicle's weight per shoe in ground contact [N]. `gravity`
/// [m/s2].
double carryingLoad(const Assembly& vehicle, double gravity);

/// Largest distance of a shoe's middle from the track's plane [m].
double sidewaysShift(const Assembly& vehicle, int track, const multibody::State& state);

/// Largest gap between a road wheel's rim and the plates under it, normal to the hull [m].
double wheelLift(const Assembly& vehicle, int track, const multibody::State& state);

/// Sag of the lower run of a freely hanging vehicle, as a parabola between sprocket and idler: lambda g L^2 / (8 T)
/// [m], with `gravity` [m/s2]. Such a gap under a wheel is no thrown track.
double suspendedSag(const VehicleSpec& spec, double gravity);

} // namespace grouser::vehicle
