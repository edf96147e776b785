// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/assembly.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "vehicle/engine.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grouser::vehicle {
namespace {

using base::Mat3d;
using base::Pose;
using base::Vec3d;
using multibody::JointType;

const Vec3d kForward{1, 0, 0}, kLeft{0, 1, 0};
/// Mass of each guide body / hull mass.
constexpr double kGuideShare = 1e-4;

/// Adds the tracks to an assembly. Points and frames are in the vehicle frame V; initially its axes are the axes of the
/// chassis.
class Builder {
public:
  Builder(const VehicleSpec& spec, const AssemblyOptions& options) : options_(options) {
    assembly_.spec = spec;
    assembly_.wrap = wrapTrack(spec);
  }

  Assembly build() {
    addChassis();
    if (options_.left) addTrack(Side::kLeft);
    if (options_.right) addTrack(Side::kRight);
    pairParts();
    for (const multibody::Body& body : assembly_.model.bodies())
      if (!body.fixed) assembly_.mass += body.mass;
    return std::move(assembly_);
  }

private:
  const VehicleSpec& spec() const { return assembly_.spec; }
  std::string named(const std::string& what, int index = -1) const {
    const std::string name = std::string(sideName(track_.side)) + " " + what;
    return index < 0 ? name : name + " " + std::to_string(index);
  }

  int addBody(const std::string& name, const MassSpec& mass, const Pose& pose_V, bool fixed = false) {
    multibody::Body body;
    body.name = name;
    body.mass = mass.mass;
    body.inertia_B = Mat3d::diagonal(mass.inertia);
    body.pose = multibody::compose(options_.pose_W, pose_V);
    body.v_WB = options_.velocity;
    body.fixed = fixed;
    return assembly_.model.addBody(body);
  }

  /// Adds a part; its frame is the body frame unless `pose_B` is given. Returns the part's index.
  int addPart(PartKind kind, int body, const std::string& mesh, int track, const Pose& pose_B = {}) {
    assembly_.parts.push_back({assembly_.model.bodyName(body), kind, body, mesh, track, pose_B});
    return static_cast<int>(assembly_.parts.size()) - 1;
  }

  int trackIndex() const { return static_cast<int>(assembly_.tracks.size()); }

  /// Joint at an axle: a hinge about y, positive about +y, or another `type`.
  int addAxle(const std::string& name, int bodyA, int bodyB, const Vec3d& p_V, JointType type = JointType::kRevolute) {
    const Pose frame_W = multibody::compose(options_.pose_W, multibody::frameWithZX(p_V, kLeft, kForward));
    return assembly_.model.addJointAt(name, type, bodyA, bodyB, frame_W);
  }

  void addChassis() {
    const ChassisSpec& c = spec().chassis;
    MassSpec mass{c.mass, c.inertia};
    const bool guided = options_.guide != HullGuide::none && !options_.fixChassis;
    if (options_.guide == HullGuide::pitching && guided) mass.mass -= kGuideShare * c.mass; // slider mass
    assembly_.chassis = addBody("chassis", mass, {c.centre, {}}, options_.fixChassis);
    addPart(PartKind::kChassis, assembly_.chassis, c.mesh, -1, {-c.centre, {}});
    if (guided) addGuide();
  }

  /// Adds a carriage on rails along x, on which the hull, or its pitch bearing, slides vertically. Both are nearly
  /// massless: the rails support the carriage, and the slider's mass is subtracted from the hull.
  void addGuide() {
    const ChassisSpec& c = spec().chassis;
    const MassSpec light{kGuideShare * c.mass, c.inertia * kGuideShare};
    const auto along = [&](const Vec3d& axis, const Vec3d& other) {
      return multibody::compose(options_.pose_W, multibody::frameWithZX(c.centre, axis, other));
    };
    const int carriage = addBody("guide carriage", light, {c.centre, {}});
    assembly_.model.addJointAt("guide rails", JointType::kPrismatic, multibody::kWorld, carriage,
                               along(kForward, kLeft));
    int rises = assembly_.chassis;
    if (options_.guide == HullGuide::pitching) {
      rises = addBody("guide slider", light, {c.centre, {}});
      addAxle("guide pivot", rises, assembly_.chassis, c.centre);
    }
    assembly_.model.addJointAt("guide slide", JointType::kPrismatic, carriage, rises, along({0, 0, 1}, kForward));
  }

  void addTrack(Side side) {
    track_ = Track{};
    track_.side = side;
    track_.y = side == Side::kLeft ? spec().trackOffset : -spec().trackOffset;
    addRoadWheels();
    addRollers();
    addSprocket();
    addIdler();
    addShoes();
    assembly_.tracks.push_back(std::move(track_));
  }

  void addRoadWheels() {
    const RoadWheelSpec& w = spec().roadWheel;
    const ArmSpec& a = spec().arm;
    const Vec3d alongArm{base::cos(a.pivotAngle), 0, base::sin(a.pivotAngle)};
    for (int i = 0; i < w.count; ++i) {
      const Vec3d axle{w.firstX + i * w.spacing, track_.y, w.z};
      const int arm = addBody(named("arm", i), a, {axle + alongArm * (0.5 * a.length), planeRotation(a.pivotAngle)});
      const int wheel = addBody(named("road wheel", i), w, {axle, {}});
      const bool sprung = a.suspension == Suspension::sprung;
      const int joint = addAxle(named("arm pivot", i), assembly_.chassis, arm, axle + alongArm * a.length,
                                sprung ? JointType::kRevolute : JointType::kFixed);
      addAxle(named("road wheel axle", i), arm, wheel, axle);
      track_.arms.push_back(arm);
      track_.armJoints.push_back(joint);
      track_.wheels.push_back(wheel);
      addPart(PartKind::kRoadWheel, wheel, w.mesh, trackIndex());
      if (!sprung) continue;

      // A vertical load F on the axle rotates the arm about +y with F l cos(angle), balanced by the torsion bar.
      multibody::AxisSpring bar;
      bar.name = named("torsion bar", i);
      bar.joint = joint;
      bar.stiffness = a.stiffness;
      bar.damping = a.damping;
      bar.preload = -a.preload * a.length * alongArm.x;
      track_.armSprings.push_back(assembly_.model.addAxisSpring(bar));
    }
  }

  void addRollers() {
    const RollerSpec& r = spec().roller;
    for (std::size_t i = 0; i < r.x.size(); ++i) {
      const Vec3d axle{r.x[i], track_.y, r.z[i]};
      const int roller = addBody(named("roller", static_cast<int>(i)), r, {axle, {}});
      addAxle(named("roller axle", static_cast<int>(i)), assembly_.chassis, roller, axle);
      track_.rollers.push_back(roller);
      addPart(PartKind::kRoller, roller, r.mesh, trackIndex());
    }
  }

  void addSprocket() {
    const Vec3d axle{0, track_.y, 0};
    MassSpec mass{spec().sprocket.mass, spec().sprocket.inertia};
    // Add the rotating inertia of the engine as a disc, with half of this inertia about the other two axes.
    if (options_.drive == SprocketDrive::engine) {
      if (!spec().engine)
        throw base::InputError("vehicle: driver.drive = \"engine\" requires a section [engine] in the vehicle file");
      const double j = spec().engine->inertia;
      mass.inertia = mass.inertia + Vec3d{0.5 * j, j, 0.5 * j};
    }
    track_.sprocket = addBody(named("sprocket"), mass, {axle, planeRotation(assembly_.wrap.sprocketPhase)});
    track_.sprocketJoint = addAxle(named("sprocket axle"), assembly_.chassis, track_.sprocket, axle);
    track_.drive = assembly_.model.addDrive({named("drive"), track_.sprocketJoint, 0, true});
    if (options_.drive != SprocketDrive::speed) {
      multibody::Drive torque;
      torque.name = named("torque"), torque.joint = track_.sprocketJoint, torque.kind = multibody::DriveKind::kForce;
      track_.torque = assembly_.model.addDrive(torque);
    }
    addPart(PartKind::kSprocket, track_.sprocket, spec().sprocket.mesh, trackIndex());
  }

  void addIdler() {
    const IdlerSpec& s = spec().idler;
    const Vec3d axle{assembly_.wrap.idlerX, track_.y, s.z};
    track_.carrier = addBody(named("idler carrier"), {s.carrierMass, s.carrierInertia}, {axle, {}});
    track_.idler = addBody(named("idler"), s, {axle, {}});
    const Pose slide_W =
        multibody::compose(options_.pose_W, multibody::frameWithZX(axle, kForward * spec().outward(), kLeft));
    track_.slideJoint = assembly_.model.addJointAt(named("idler slide"), JointType::kPrismatic, assembly_.chassis,
                                                   track_.carrier, slide_W);
    addAxle(named("idler axle"), track_.carrier, track_.idler, axle);
    multibody::AxisSpring tensioner;
    tensioner.name = named("tensioner");
    tensioner.joint = track_.slideJoint;
    tensioner.stiffness = s.stiffness;
    tensioner.damping = s.damping;
    tensioner.preload = s.preload;
    tensioner.lowerLimit = s.slideMin;
    tensioner.upperLimit = s.slideMax;
    tensioner.stopStiffness = s.stopStiffness;
    tensioner.stopDamping = s.stopDamping;
    track_.tensioner = assembly_.model.addAxisSpring(tensioner);
    addPart(PartKind::kIdler, track_.idler, s.mesh, trackIndex());
  }

  void addShoes() {
    const ShoeSpec& s = spec().shoe;
    const Wrap& wrap = assembly_.wrap;
    for (int i = 0; i < s.count; ++i) {
      const PlanePoint c = wrap.shoeCentre(i);
      track_.shoes.push_back(addBody(named("shoe", i), s, {{c.x, track_.y, c.z}, planeRotation(wrap.shoeAngle(i))}));
      track_.shoeParts.push_back(addPart(PartKind::kShoe, track_.shoes.back(), s.mesh, trackIndex()));
    }
    // Pins rotate about -y, so that a fold about a wheel is positive. The universal joint also rotates about the shoe's
    // x axis; half a loop away this axis points at the spherical joint only for instants, in a sagging chain. The
    // reactions then pass through a pole, but not the motion (pin_reactions.hpp).
    const Pose front_B = multibody::frameWithZX({0.5 * s.pitch, 0, 0}, -kLeft, kForward);
    const Pose rear_B = multibody::frameWithZX({-0.5 * s.pitch, 0, 0}, -kLeft, kForward);
    for (int i = 0; i < s.count; ++i) {
      const JointType type = i == 0             ? JointType::kSpherical
                             : i == s.count / 2 ? JointType::kUniversal
                                                : JointType::kRevolute;
      multibody::Joint pin;
      pin.name = named("pin", i);
      pin.type = type;
      pin.bodyA = track_.shoes[i];
      pin.bodyB = track_.shoes[(i + 1) % s.count];
      pin.frame_A = front_B;
      pin.frame_B = rear_B;
      pin.damping = type == JointType::kRevolute ? s.pinDamping : 0.0;
      track_.shoeJoints.push_back(assembly_.model.addJoint(pin));
    }
  }

  void pairParts() {
    const auto& parts = assembly_.parts;
    for (int i = 0; i < static_cast<int>(parts.size()); ++i) {
      if (parts[i].kind != PartKind::kShoe) continue;
      assembly_.groundParts.push_back(i);
      for (int j = 0; j < static_cast<int>(parts.size()); ++j)
        if (parts[j].track == parts[i].track && parts[j].kind != PartKind::kShoe) assembly_.pairs.push_back({i, j});
    }
  }

  AssemblyOptions options_;
  Assembly assembly_;
  Track track_;
};

} // namespace

const char* sideName(Side side) { return side == Side::kLeft ? "left" : "right"; }

Assembly assemble(const VehicleSpec& spec, const AssemblyOptions& options) {
  if (!options.left && !options.right) throw base::InputError("vehicle: no track selected; select left, right or both");
  return Builder(spec, options).build();
}

base::Pose placeOnGround(const VehicleSpec& spec, double x, double y, double groundHeight, double clearance,
                         double heading) {
  return {{x, y, groundHeight + clearance - spec.groundHeight()},
          {base::cos(0.5 * heading), 0, 0, base::sin(0.5 * heading)}};
}

base::Pose placeOnSlope(const VehicleSpec& spec, double x, double y, double groundHeight, double clearance,
                        double heading, double ahead, double left) {
  // Half angles without trigonometric functions: cos(a) = 1 / sqrt(1 + tan^2), cos(a / 2) = sqrt((1 + cos a) / 2).
  const auto halfTurn = [](double tangent) {
    const double c = 1 / std::sqrt(1 + tangent * tangent), half = std::sqrt(0.5 * (1 + c));
    return std::pair{half, 0.5 * tangent * c / half};
  };
  const double slant = std::sqrt(1 + ahead * ahead + left * left);
  const auto [cosPitch, sinPitch] = halfTurn(ahead);
  const auto [cosRoll, sinRoll] = halfTurn(left / std::sqrt(1 + ahead * ahead));
  base::Pose pose = placeOnGround(spec, x, y, groundHeight, 0, heading);
  pose.orientation = pose.orientation * base::Quat{cosPitch, 0, -sinPitch, 0} * base::Quat{cosRoll, sinRoll, 0, 0};
  // `clearance` is normal to the ground; the height of the origin is measured vertically at (x, y).
  pose.position.z = groundHeight + (clearance - spec.groundHeight()) * slant;
  return pose;
}

void applyControls(const Assembly& vehicle, const Controls& controls, const base::Vec3d& gravity,
                   multibody::Loads& loads) {
  loads.gravity = gravity * controls.weight;
  for (const Track& track : vehicle.tracks) {
    loads.axisSprings[track.tensioner].loadFactor = controls.tension;
    for (const int bar : track.armSprings) loads.axisSprings[bar].loadFactor = controls.weight;
    const std::size_t side = track.side == Side::kLeft ? 0 : 1;
    loads.drives[track.drive].speed = controls.sprocketSpeed[side];
    if (track.torque < 0) continue;
    loads.drives[track.drive].on = controls.held;
    loads.drives[track.torque].force = controls.held ? 0 : controls.torque[side];
  }
}

HullMotion hullMotion(const Assembly& vehicle, const multibody::State& state) {
  const RoadWheelSpec& wheels = vehicle.spec.roadWheel;
  const base::Pose& hull = state.pose[vehicle.chassis];
  const multibody::Twist& twist = state.twist[vehicle.chassis];
  const Vec3d middle{wheels.firstX + 0.5 * vehicle.spec.groundRun(), 0, wheels.z - wheels.radius};
  const Vec3d lever = base::rotate(hull.orientation, middle - vehicle.spec.chassis.centre);
  const Vec3d p = hull.position + lever, v = twist.v + base::cross(twist.w, lever);
  const Vec3d ahead = base::rotate(hull.orientation, {1, 0, 0});
  const double level = std::max(std::sqrt(ahead.x * ahead.x + ahead.y * ahead.y), 1e-9);
  const double c = ahead.x / level, s = ahead.y / level;
  return {p.x, p.y, c, s, v.x * c + v.y * s, twist.w.z};
}

HitchMotion hitchMotion(const Assembly& vehicle, const multibody::State& state, const Vec3d& point) {
  const HullMotion hull = hullMotion(vehicle, state);
  const base::Pose& pose = state.pose[vehicle.chassis];
  const multibody::Twist& twist = state.twist[vehicle.chassis];
  const Vec3d lever = base::rotate(pose.orientation, point - vehicle.spec.chassis.centre);
  HitchMotion m{pose.position + lever, twist.v + base::cross(twist.w, lever), hull.forwardX, hull.forwardY, 0};
  for (const Track& track : vehicle.tracks) m.trackSpeed += state.joint[track.sprocketJoint].rate;
  m.trackSpeed *= vehicle.spec.pitchRadius() / static_cast<double>(vehicle.tracks.size());
  return m;
}

void addEngineTorques(const Assembly& vehicle, const multibody::State& state, Controls& controls) {
  for (const Track& track : vehicle.tracks) {
    const std::size_t side = track.side == Side::kLeft ? 0 : 1;
    const double rate = state.joint[track.sprocketJoint].rate;
    controls.torque[side] = controls.throttle[side]
                                ? throttleTorque(*vehicle.spec.engine, *controls.throttle[side], rate)
                                : engineTorque(*vehicle.spec.engine, controls.sprocketSpeed[side], rate);
  }
}

base::Pose partPose(const Part& part, const multibody::State& state) {
  return multibody::compose(state.pose[part.body], part.pose_B);
}

} // namespace grouser::vehicle
