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
/// A sprocket slower than this speed counts as stopped, and slip is undefined [rad/s].
inline constexpr double kStanding = 1e-6;

/// Ground force on each body of the model, world components [N]; empty: unknown. Use the mean over the output interval
/// if possible: on grains the force in a single step fluctuates, and therefore also the set of loaded shoes.
struct GroundLoads {
  std::vector<base::Vec3d> force;
};

/// Observation of one track at one time. Vectors have one entry per shoe, in the order of the wrap.
struct TrackObservation {
  std::vector<double> padHeight;      ///< lowest point of the pad plate (without grousers) [m]
  std::vector<double> sinkage;        ///< sinkage() of each shoe [m]; NaN without ground contact
  std::vector<double> tension;        ///< pull along the chain in the pin ahead of each shoe (PinReaction) [N]
  std::vector<double> pinLateral;     ///< force along this pin, of the shoe on the next one, left positive [N]
  std::vector<double> pinMoment;      ///< moment across this pin, magnitude [N m]
  std::vector<double> groundPressure; ///< normal ground force on the pad / pad area [Pa]; NaN if unknown
  std::vector<double> onGround;       ///< 1 if in ground contact and loaded, else 0
  std::vector<double> normalForce;    ///< ground force normal to the pad, positive for compression [N]
  std::vector<double> forwardForce;   ///< ground force along the shoe, positive forward (while in ground contact) [N]
  std::vector<double> leftForce;      ///< lateral ground force on the shoe, positive left [N]
  std::vector<double> shear;          ///< resultant of forward and left force / pad area [Pa]; NaN if unknown
  std::vector<double> armAngle;       ///< per road wheel: arm angle from the design position, positive upward [rad]
  double sprocketSpeed = 0;           ///< [rad/s]
  double driveTorque = 0;             ///< torque of the hull on the sprocket, positive forward [N m]
  double meanTorque = 0;              ///< mean of driveTorque since restartMeans() [N m]
  double drivePower = 0;              ///< mean power of the drive since restartMeans() [W]
  double idlerForce = 0;              ///< tensioner force on the idler carrier, positive away from the sprocket [N]
  double idlerSlide = 0;              ///< slide from the wrap position, forward positive [m]
  double speed = 0;                   ///< hull speed at this track, along the hull x axis [m/s]
  double slip = 0;                    ///< 1 - speed / (omega r_pitch) [-]; NaN while the sprocket is stopped
  double toothSpeed = 0;              ///< mean speed over whole tooth passages [m/s]; NaN before the first passage
  double toothSlip = 0;               ///< mean slip over whole tooth passages [-]
  double teethPassed = 0;             ///< integral of omega Z / (2 pi) [-]
  double pitchesPassed = 0;           ///< track pitches that passed the sprocket [-]
  double skipped = 0;                 ///< teethPassed - pitchesPassed [-]
  double sideways = 0;                ///< maximum lateral distance of a shoe from its track plane [m]
  double wheelLift = 0;               ///< maximum gap between a road wheel and the plates under it [m]
};

/// Direction of motion along the ground: a unit vector in the vertical plane of the heading. See Observer::observe().
struct Along {
  double forward = 1, up = 0; ///< components along the heading, and upward [-]
  /// Component of a vector (forward along the heading, left, up) in the direction of motion.
  double of(const base::Vec3d& v) const { return v.x * forward + v.z * up; }
};

struct Observation {
  double time = 0;             ///< [s]
  base::Vec3d position;        ///< middle of the sprocket axle line, world [m]
  base::Vec3d velocity;        ///< velocity of the chassis centre of mass, world [m/s]
  double heading = 0;          ///< angle of the hull x axis from world x towards y, continuous over full turns [rad]
  double pitchAngle = 0;       ///< nose up positive, within +-pi/2 [rad]
  double rollAngle = 0;        ///< right side down positive, continuous over full turns [rad]
  base::Vec3d groundForce;     ///< sum over all bodies: forward along the heading, left, up [N]; NaN if unknown
  Along along;                 ///< direction in which the four forces below count as positive
  double grossTraction = 0;    ///< sum of the mean drive torques / pitch radius [N]
  double netThrust = 0;        ///< ground force on the vehicle [N]
  double drawbarPull = 0;      ///< force of the vehicle on its hitch; netThrust until VehicleRig sets it [N]
  double motionResistance = 0; ///< grossTraction - netThrust [N]; NaN if the tracks run in opposite directions
  std::vector<TrackObservation> tracks;
  BlowMeter blows;   ///< ground impacts of the whole run, if recorded
  base::Alarm alarm; ///< thrown track or skipped teeth
};

struct ObserverOptions {
  int averageTeeth = 1; ///< number of tooth passages per mean of speed and slip
  double stone{};       ///< [m] stones up to this size between road wheel and plates raise no alarm
  double heading{};     ///< [rad] initial heading of the vehicle, from which headings are continuous
  base::Vec3d gravity{0, 0, -kStandardGravity}; ///< gravity of the run [m/s2]; reference for loads
  double step{};                                ///< time step until the first update() [s]
};

/// Observer of a vehicle: call update() after every step, observe() for output.
class Observer {
public:
  /// The vehicle must outlive the observer.
  explicit Observer(const Assembly& vehicle, const ObserverOptions& options = {});

  void update(const multibody::State& state, double dt);
  /// Observes the vehicle. `surface` may be null without a bed: sinkage is then NaN, and level ground is assumed.
  ///
  /// Traction, thrust and resistance refer to the direction of motion along the ground: the tangent of groundPlane() in
  /// the hull's heading, forward or backward according to the track motion since restartMeans(). If the tracks are
  /// stopped (locked, on a slope), the motion of the hull determines the direction. The last direction is kept if
  /// nothing moves, and while the tracks reverse by less than 0.01 m/s (a stalled vehicle rocks). The direction is
  /// forward initially, and if the tracks run in opposite directions (a pivot turn, without motion resistance).
  Observation observe(const multibody::State& state, const GroundLoads& ground, const SurfaceHeight& surface) const;
  /// Computes only the alarm; cheap enough for a call every few steps.
  base::Alarm alarm(const multibody::State& state, const GroundLoads& ground) const;
  void setGravity(const base::Vec3d& gravity) { gravity_ = gravity; } ///< [m/s2]
  /// Restarts the means of torque and power. Until the next update(), the means equal the current values.
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
    double rate = 0, speed = 0;   ///< sprocket rate [rad/s], hull speed at the track [m/s]
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
  double step_;                   ///< length of the last step [s]
  base::Vec3d gravity_;           ///< [m/s2]
  std::vector<DriveSums> driven_; ///< one per track
  double updates_ = 0;
  double heading_, roll_ = 0; ///< angles at the last update, continuous over full turns [rad]
  int way_ = 0;               ///< last direction of motion: 1 forward, -1 backward, 0 unknown
  std::vector<Travel> travel_;
};

/// Lowest of the four lower corners of a shoe's pad plate, in the world [m].
double padHeight(const ShoeSpec& shoe, const base::Pose& pose_W);

/// Sinkage of a shoe [m]: distance from the undisturbed surface, along its local normal, to the middle of the
/// underside of the pad plate (without grousers), positive downward. Height and normal of the surface are evaluated at
/// the foot point, that is where the normal passes through the middle of the pad.
///
/// The normal is the normal of the least-squares plane through the heights at 5 x 5 points of an axis-parallel square,
/// one pitch wide, about the foot point: an average over grains, which are smaller than a shoe. The foot point is found
/// by iteration, starting below the pad: the middle of the pad is projected onto the plane with this normal through the
/// current surface point, until the point moves by less than 1e-9 m, at most 40 times. One step is exact for a plane.
/// If the surface height jumps between grains, the iteration may alternate between two points; the effect on the
/// distance is second order.
double sinkage(const VehicleSpec& spec, const base::Pose& shoePose_W, const SurfaceHeight& surface);

/// True for a shoe of the lower run with its middle between the axles of the first and last road wheel, in the hull
/// frame, whether loaded or not.
bool onGroundRun(const Assembly& vehicle, int track, int shoe, const multibody::State& state);

/// Threshold of a loaded shoe: 1 % of the vehicle weight per shoe in ground contact [N]. `gravity`
/// [m/s2].
double carryingLoad(const Assembly& vehicle, double gravity);

/// Maximum lateral distance of a shoe's middle from the track plane [m].
double sidewaysShift(const Assembly& vehicle, int track, const multibody::State& state);

/// Maximum gap between a road wheel's rim and the plates under it, normal to the hull [m].
double wheelLift(const Assembly& vehicle, int track, const multibody::State& state);

/// Sag of the lower run of a freely hanging vehicle, a parabola between sprocket and idler [m]: lambda g L^2 / (8 T)
/// with mass per length lambda, `gravity` g [m/s2], distance L and tension T. A track with such a gap is not thrown.
double suspendedSag(const VehicleSpec& spec, double gravity);

} // namespace grouser::vehicle
