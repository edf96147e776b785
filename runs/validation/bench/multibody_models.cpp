// SPDX-License-Identifier: BSD-3-Clause
// Models of `grouser bench multibody`: guiding forces of a vehicle's tracks, and rings of any size with a hull.
#include "base/math.hpp"
#include "runs/validation/bench/multibody.hpp"

#include <algorithm>

namespace grouser::bench {

using base::Vec3d;
using multibody::JointType;

namespace {

constexpr double kStiffness = 1e7; // [N/m]
constexpr double kDamping = 4e3;   // [N s/m]
// The drag of the sprocket is high, because teeth do not slip.
constexpr double kSprocketDrag = 2e4, kWheelDrag = 2e2; // [N s/m]

Vec3d velocity(int body, const Vec3d& p, const multibody::State& state) {
  const auto b = static_cast<std::size_t>(body);
  return state.twist[b].v + cross(state.twist[b].w, p - state.pose[b].position);
}

void push(int body, const Vec3d& p, const Vec3d& force, const multibody::State& state, multibody::Loads& loads) {
  const auto b = static_cast<std::size_t>(body);
  loads.external[b].force += force;
  loads.external[b].torque += cross(p - state.pose[b].position, force);
}

} // namespace

TrackGuide::TrackGuide(const vehicle::Assembly& vehicle) : vehicle_(vehicle) {
  const vehicle::VehicleSpec& spec = vehicle.spec;
  for (const vehicle::Track& track : vehicle.tracks) {
    // The pins touch the sprocket and the idler; the plates touch the other wheels.
    std::vector<Circle> circles{{track.sprocket, spec.sprocketPinRadius(), 0, kSprocketDrag},
                                {track.idler, spec.idlerPinRadius(), 0, kWheelDrag}};
    for (const int wheel : track.wheels)
      circles.push_back({wheel, spec.roadWheel.radius, spec.shoe.plateTop, kWheelDrag});
    for (const int roller : track.rollers)
      circles.push_back({roller, spec.roller.radius, spec.shoe.plateTop, kWheelDrag});
    circles_.push_back(std::move(circles));
  }
}

void TrackGuide::apply(const multibody::State& state, multibody::Loads& loads) const {
  for (multibody::Wrench& wrench : loads.external) wrench = {};
  const vehicle::ShoeSpec& spec = vehicle_.spec.shoe;
  for (std::size_t t = 0; t < vehicle_.tracks.size(); ++t)
    for (const int shoe : vehicle_.tracks[t].shoes) {
      const base::Pose& X = state.pose[static_cast<std::size_t>(shoe)];
      for (const Circle& circle : circles_[t]) touch(shoe, X, circle, state, loads);
      for (const double x : {-0.3, 0.3})
        for (const double y : {-1.0, 1.0}) {
          const Vec3d tip = X.toWorld({x * spec.pitch, y * spec.padHalfWidth, spec.padBottom - spec.grouserHeight});
          if (tip.z >= 0) continue;
          const Vec3d v = velocity(shoe, tip, state);
          const double up = std::max(0.0, -kStiffness * tip.z - kDamping * v.z);
          push(shoe, tip, 0.25 * Vec3d{-kDamping * v.x, -kDamping * v.y, up}, state, loads);
        }
    }
}

/// Contact points at both ends and in the middle of the shoe.
void TrackGuide::touch(int shoe, const base::Pose& X, const Circle& circle, const multibody::State& state,
                       multibody::Loads& loads) const {
  const Vec3d axle = state.pose[static_cast<std::size_t>(circle.body)].position;
  const double reach = circle.radius + vehicle_.spec.shoe.pitch;
  if (norm2(axle - X.position) > reach * reach) return;
  for (const double x : {-0.5, 0.0, 0.5}) {
    const Vec3d p = X.toWorld({x * vehicle_.spec.shoe.pitch, 0, circle.height});
    const Vec3d away{p.x - axle.x, 0, p.z - axle.z};
    const double distance = norm(away);
    if (distance >= circle.radius || distance == 0) continue;
    const Vec3d normal = away * (1 / distance);
    const Vec3d v = velocity(shoe, p, state) - velocity(circle.body, p, state);
    const double closing = dot(v, normal);
    const double out = std::max(0.0, kStiffness * (circle.radius - distance) - kDamping * closing);
    const Vec3d force = normal * out - (v - normal * closing) * circle.drag;
    push(shoe, p, force, state, loads);
    push(circle.body, p, -force, state, loads);
  }
}

/// Two rings of `shoes` links, which spin about their centres at 1 rad/s, and a hull with 32 bodies: arms with wheels,
/// rollers, driven sprockets, and carriers with idlers. The dimensions are those of the light vehicle.
multibody::Model ringsAndHull(int shoes) {
  multibody::Model model;
  const double pitch = 0.154, turn = 2 * base::kPi / shoes;
  const double radius = pitch / (2 * base::sin(0.5 * turn)), apothem = radius * base::cos(0.5 * turn);
  const Vec3d axis{0, 1, 0};
  const auto add = [&](const std::string& name, double mass, const Vec3d& inertia, const base::Pose& pose,
                       const Vec3d& v, const Vec3d& w) {
    multibody::Body body;
    body.name = name, body.mass = mass, body.inertia_B = base::Mat3d::diagonal(inertia);
    body.pose = pose, body.v_WB = v, body.w_WB = w;
    return model.addBody(body);
  };
  const auto joint = [&](const std::string& name, JointType type, int a, int b, const Vec3d& p, const Vec3d& z,
                         double damping) {
    return model.addJointAt(name, type, a, b, multibody::frameWithZ(p, z), damping);
  };
  for (const double y : {1.0, -1.0}) {
    const std::string side = y > 0 ? "left " : "right ";
    const int first = static_cast<int>(model.bodies().size());
    const auto onCircle = [&](double r, double angle) { return Vec3d{r * base::sin(angle), y, r * base::cos(angle)}; };
    for (int i = 0; i < shoes; ++i) {
      const double angle = turn * (i + 0.5);
      const Vec3d p = onCircle(apothem, angle);
      add(side + "shoe " + std::to_string(i), 8.5, {0.09, 0.02, 0.10},
          {p, {base::cos(0.5 * angle), 0, base::sin(0.5 * angle), 0}}, cross(axis, p), axis);
    }
    for (int i = 0; i < shoes; ++i) {
      const JointType type = i == 0           ? JointType::kSpherical
                             : i == shoes / 2 ? JointType::kUniversal
                                              : JointType::kRevolute;
      joint(side + "pin " + std::to_string(i), type, first + i, first + (i + 1) % shoes,
            onCircle(radius, turn * (i + 1)), axis, type == JointType::kRevolute ? 5 : 0);
    }
  }
  const int hull = add("hull", 3700, {3000, 4000, 5000}, {}, {}, {});
  for (const double y : {1.0, -1.0}) {
    const std::string side = y > 0 ? "left " : "right ";
    const auto hang = [&](const std::string& name, const Vec3d& p, int parent, JointType type, const Vec3d& z) {
      const int body = add(side + name, 20, {0.4, 0.7, 0.5}, {p, {}}, {}, {});
      joint(side + name + " joint", type, parent, body, p, z, 0.1);
      return body;
    };
    for (int i = 0; i < 5; ++i) {
      const std::string n = std::to_string(i);
      const int arm = hang("arm " + n, {0.5 * i, y, -0.1}, hull, JointType::kRevolute, axis);
      multibody::AxisSpring bar;
      bar.name = side + "bar " + n, bar.joint = model.jointIndex(side + "arm " + n + " joint");
      bar.stiffness = 7700, bar.damping = 300;
      model.addAxisSpring(bar);
      hang("wheel " + n, {0.5 * i - 0.2, y, -0.2}, arm, JointType::kRevolute, axis);
    }
    for (int i = 0; i < 3; ++i)
      hang("roller " + std::to_string(i), {0.7 * i, y, 0.2}, hull, JointType::kRevolute, axis);
    hang("sprocket", {-0.5, y, 0}, hull, JointType::kRevolute, axis);
    multibody::Drive drive;
    drive.name = side + "drive", drive.joint = model.jointIndex(side + "sprocket joint");
    model.addDrive(drive);
    const int carrier = hang("carrier", {2.5, y, 0}, hull, JointType::kPrismatic, {1, 0, 0});
    multibody::AxisSpring tensioner;
    tensioner.name = side + "tensioner", tensioner.joint = model.jointIndex(side + "carrier joint");
    tensioner.stiffness = 3e5, tensioner.damping = 4000;
    model.addAxisSpring(tensioner);
    hang("idler", {2.6, y, 0}, carrier, JointType::kRevolute, axis);
  }
  return model;
}

} // namespace grouser::bench
