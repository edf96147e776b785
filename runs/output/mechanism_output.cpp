// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/mechanism_output.hpp"

#include "base/math.hpp"
#include "multibody/readings.hpp"
#include "runs/output/surface_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace grouser::output {

using base::Vec3d;
using multibody::JointType;

namespace {

bool isKept(const std::vector<std::string>& record, const std::string& name) {
  return record.empty() || std::find(record.begin(), record.end(), name) != record.end();
}

bool hasAngle(const multibody::Joint& j) { return j.type == JointType::kRevolute || j.type == JointType::kCylindrical; }
bool hasSlide(const multibody::Joint& j) {
  return j.type == JointType::kPrismatic || j.type == JointType::kCylindrical;
}

/// Free axes of a joint with the names of their quantities.
struct NamedAxis {
  multibody::JointAxis axis;
  std::string prefix; ///< prefix of the quantity names: "" for a single axis
  bool turns;
};
std::vector<NamedAxis> axesOf(const multibody::Joint& j) {
  if (j.type == JointType::kCylindrical)
    return {{multibody::JointAxis::kAngle, "angle_", true}, {multibody::JointAxis::kSlide, "slide_", false}};
  if (hasAngle(j) || hasSlide(j)) return {{multibody::JointAxis::kOnly, "", hasAngle(j)}};
  return {};
}

/// Whether the coordinate of an axis is an angle.
bool turns(const multibody::Joint& j, multibody::JointAxis axis) {
  return axis == multibody::JointAxis::kAngle || (axis == multibody::JointAxis::kOnly && hasAngle(j));
}

const multibody::Joint& jointOf(const multibody::Model& model, int joint) {
  return model.joints()[static_cast<std::size_t>(joint)];
}

/// End stops without stiffness, damping and preload are not listed as springs.
bool isSpring(const multibody::AxisSpring& s) { return s.stiffness > 0 || s.damping > 0 || s.preload != 0; }

std::string driveUnit(multibody::DriveKind kind, bool turning) {
  if (kind == multibody::DriveKind::kSpeed) return turning ? "rad/s" : "m/s";
  if (kind == multibody::DriveKind::kPosition) return turning ? "rad" : "m";
  return turning ? "N m" : "N";
}

/// Initial impulse energy / kinetic energy below which the impulse is attributed to rounding of the input [-].
constexpr double kBlowShown = 1e-6;
/// Number of redundant constraints printed before "and ... more".
constexpr std::size_t kRowsShown = 8;

/// Relative to the size of a mechanism [-]: thickness of the bars from a centre to the joints, edge of the cube at the
/// centre, smallest and largest edge of a free body without a box.
constexpr double kBar = 0.015, kCentre = 0.035, kMinEdge = 0.02, kMaxEdge = 0.5;

/// Adds a box with edge lengths `size` and centre `centre`; its axes are the columns of `R`.
void addBox(base::TriangleMesh& mesh, const Vec3d& centre, const base::Mat3d& R, const Vec3d& size) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i) {
    const Vec3d corner{(i & 1 ? 0.5 : -0.5) * size.x, (i & 2 ? 0.5 : -0.5) * size.y, (i & 4 ? 0.5 : -0.5) * size.z};
    mesh.vertices.push_back(centre + R * corner);
  }
  constexpr std::uint32_t kFaces[] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                      2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  for (const std::uint32_t f : kFaces) mesh.indices.push_back(first + f);
}

void addBar(base::TriangleMesh& mesh, const Vec3d& to, double thickness) {
  const double length = norm(to);
  if (!(length > thickness)) return;
  const base::Pose along = multibody::frameWithZ(to * 0.5, to);
  addBox(mesh, along.position, along.orientation.matrix(), {thickness, thickness, length});
}

void addShape(base::TriangleMesh& mesh, const coupling::BodyShape& s) {
  const base::TriangleMesh shape = s.mesh ? s.mesh->query->mesh() : shapeMesh(s.shape);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3d& v : shape.vertices) mesh.vertices.push_back(s.pose_B.toWorld(v));
  for (const std::uint32_t i : shape.indices) mesh.indices.push_back(first + i);
}

/// Edge lengths of the homogeneous box with the mass and principal inertia of a body [m].
Vec3d boxOf(const multibody::Body& body, double least, double greatest) {
  const auto& I = body.inertia_B.m;
  const auto edge = [&](double a, double b, double c) {
    return std::clamp(std::sqrt(std::max(0.0, 6 * (b + c - a) / body.mass)), least, greatest);
  };
  return {edge(I[0][0], I[1][1], I[2][2]), edge(I[1][1], I[0][0], I[2][2]), edge(I[2][2], I[0][0], I[1][1])};
}

/// Diagonal of the bounding box of all centres and joints at the start [m].
double sizeOf(const multibody::Model& model) {
  Vec3d low{1e300, 1e300, 1e300}, high = -low;
  const auto take = [&](const Vec3d& p) { low = base::min(low, p), high = base::max(high, p); };
  for (const multibody::Body& b : model.bodies()) take(b.pose.position);
  for (const multibody::Joint& j : model.joints())
    take(model.bodies()[static_cast<std::size_t>(std::max(j.bodyB, 0))].pose.toWorld(j.frame_B.position));
  const double size = norm(high - low);
  return size > 0 ? size : 1;
}

/// Columns of one mechanism: bodies, joints, springs, bushings, drives, couplings.
class MechanismColumns {
public:
  MechanismColumns(const multibody::Model& model, const std::vector<bool>& touching,
                   const std::vector<std::string>& record, const multibody::PartCounts& from)
      : model_(model), touching_(touching), record_(record), from_(from) {
    addBodies(), addJoints(), addSprings(), addBushings(), addDrives(), addCouplings();
    if (from_.bodies == 0) addWhole();
  }
  const Columns<MechanismReading>& all() const { return columns_; }

private:
  using Reading = MechanismReading;

  /// Calls add(i, "bodies/NAME/", part) for the recorded parts of one kind.
  template <class Part, class Add>
  void forKept(const std::vector<Part>& parts, std::size_t from, const char* group, const Add& add) {
    for (std::size_t i = from; i < parts.size(); ++i)
      if (isKept(record_, parts[i].name)) add(i, fmt::format("{}/{}/", group, parts[i].name), parts[i]);
  }
  /// Adds a number or vector that is computed during a step: NaN before the first step.
  template <class Read>
  void addOfStep(const std::string& path, const std::string& unit, const std::string& help, Read read) {
    columns_.add(path, unit, help, [read](const Reading& r) {
      using Value = std::decay_t<decltype(read(r))>;
      return r.mechanism.state().time > 0 ? Value(read(r)) : unknown<Value>();
    });
  }
  template <class Value> static Value unknown() {
    if constexpr (std::is_same_v<Value, double>)
      return base::kNaN;
    else
      return {base::kNaN, base::kNaN, base::kNaN};
  }
  bool turnsAbout(int joint, multibody::JointAxis axis) const { return turns(jointOf(model_, joint), axis); }

  void addBodies() {
    forKept(model_.bodies(), from_.bodies, "bodies", [&](std::size_t i, const std::string& path, const auto&) {
      const auto pose = [i](const Reading& r) -> const base::Pose& { return r.mechanism.state().pose[i]; };
      const auto twist = [i](const Reading& r) -> const multibody::Twist& { return r.mechanism.state().twist[i]; };
      columns_.add(path + "position", "m", "position of the centre of mass",
                   [=](const Reading& r) { return pose(r).position; });
      columns_.add(path + "orientation", "-", "quaternion from body to world",
                   [=](const Reading& r) { return pose(r).orientation; }, {"w", "x", "y", "z"});
      columns_.add(path + "velocity", "m/s", "velocity of the centre of mass",
                   [=](const Reading& r) { return twist(r).v; });
      columns_.add(path + "spin", "rad/s", "angular velocity, world components",
                   [=](const Reading& r) { return twist(r).w; });
      if (touching_[i])
        addOfStep(path + "contact_force", "N",
                  "resultant contact force on the body, mean since the last row, world components",
                  [i](const Reading& r) { return r.contacts[i]; });
    });
  }

  void addJoints() {
    forKept(model_.joints(), from_.joints, "joints",
            [&](std::size_t i, const std::string& path, const multibody::Joint& joint) {
              addOfStep(path + "force", "N",
                        "force of the first body on the second, including springs and drives on the axis, excluding "
                        "couplings; world components",
                        [i](const Reading& r) { return r.reactions[i].force; });
              addOfStep(
                  path + "torque", "N m",
                  "torque of the first body on the second about the joint, including springs and drives on the axis, "
                  "excluding couplings; world components",
                  [i](const Reading& r) { return r.reactions[i].torque; });
              for (const NamedAxis& a : axesOf(joint)) addAxis(static_cast<int>(i), path + a.prefix, a);
            });
  }
  void addAxis(int joint, const std::string& path, const NamedAxis& a) {
    const auto axis = [joint, which = a.axis](const Reading& r) {
      return multibody::axisReading(r.mechanism.model(), r.mechanism.state(), joint, which);
    };
    columns_.add(path + "position", a.turns ? "rad" : "m", "position of the free axis",
                 [=](const Reading& r) { return axis(r).position; });
    columns_.add(path + "rate", a.turns ? "rad/s" : "m/s", "rate of the free axis",
                 [=](const Reading& r) { return axis(r).rate; });
    addOfStep(path + "force_along", a.turns ? "N m" : "N",
              "force or torque along the free axis due to damping, springs, stops and drive",
              [=](const Reading& r) { return axis(r).axisForce; });
  }

  void addSprings() {
    forKept(model_.pointSprings(), from_.pointSprings, "springs",
            [&](std::size_t i, const std::string& path, const auto&) {
              addOfStep(path + "force", "N", "spring force, positive in compression",
                        [i](const Reading& r) { return r.mechanism.state().spring[i].force; });
              columns_.add(path + "length", "m", "length of the spring",
                           [i](const Reading& r) { return r.mechanism.state().spring[i].length; });
            });
    forKept(model_.axisSprings(), from_.axisSprings, "springs",
            [&](std::size_t i, const std::string& path, const auto& spring) {
              if (!isSpring(spring)) return;
              columns_.add(path + "force", turnsAbout(spring.joint, spring.axis) ? "N m" : "N",
                           "force or torque on the second body along the axis",
                           [i](const Reading& r) { return r.mechanism.axisSpringForce(static_cast<int>(i)); });
            });
  }

  void addBushings() {
    forKept(model_.bushings(), from_.bushings, "bushings", [&](std::size_t i, const std::string& path, const auto&) {
      const auto bushing = [i](const Reading& r) { return r.mechanism.state().bushing[i]; };
      addOfStep(path + "force", "N", "force on the second body, world components",
                [=](const Reading& r) { return bushing(r).force; });
      addOfStep(path + "torque", "N m", "torque on the second body, world components",
                [=](const Reading& r) { return bushing(r).torque; });
      columns_.add(path + "translation", "m", "displacement, in the bushing's axes on the first body",
                   [=](const Reading& r) { return bushing(r).translation; });
      columns_.add(path + "rotation", "rad", "rotation vector, in the bushing's axes on the first body",
                   [=](const Reading& r) { return bushing(r).rotation; });
    });
  }

  void addDrives() {
    forKept(model_.drives(), from_.drives, "drives",
            [&](std::size_t i, const std::string& path, const multibody::Drive& d) {
              const bool turning = turnsAbout(d.joint, d.axis);
              const auto drive = [i](const Reading& r) { return r.mechanism.drive(static_cast<int>(i)); };
              columns_.add(path + "value", driveUnit(d.kind, turning), "imposed value",
                           [=](const Reading& r) { return drive(r).value; });
              addOfStep(path + "torque", turning ? "N m" : "N", "torque or force of the drive along the axis",
                        [=](const Reading& r) { return drive(r).torque; });
              addOfStep(path + "power", "W", "power input to the mechanism",
                        [=](const Reading& r) { return drive(r).power; });
            });
  }

  void addCouplings() {
    forKept(model_.couplings(), from_.couplings, "couplings",
            [&](std::size_t i, const std::string& path, const auto& coupling) {
              addOfStep(path + "force", turnsAbout(coupling.joint2, coupling.axis2) ? "N m" : "N",
                        "force or torque on the second axis, excluded from the force and torque of the joint; on the "
                        "first axis it is -ratio times this value",
                        [i](const Reading& r) { return r.mechanism.state().coupling[i].force; });
            });
  }

  void addWhole() {
    columns_.add("momentum/linear", "kg m/s", "momentum of all bodies",
                 [](const Reading& r) { return r.now.linearMomentum; });
    columns_.add("momentum/angular", "kg m2/s", "angular momentum of all bodies about the world's origin",
                 [](const Reading& r) { return r.now.angularMomentum; });
    columns_.add("constraints/position_error", "m", "maximum position error of a joint since the last row [m, rad]",
                 [](const Reading& r) { return r.drift.position; });
    columns_.add("constraints/velocity_error", "m/s", "maximum velocity error of a joint at this time [m/s, rad/s]",
                 [](const Reading& r) { return r.drift.velocity; });
    columns_.add("constraints/iterations", "-", "maximum number of iterations per step since the last row",
                 [](const Reading& r) { return r.drift.iterations; });
    columns_.add("constraints/singular_steps", "-", "number of steps through a singular position since the last row",
                 [](const Reading& r) { return r.drift.singularSteps; });
  }

  const multibody::Model& model_;
  const std::vector<bool>& touching_;
  const std::vector<std::string>& record_;
  const multibody::PartCounts from_;
  Columns<MechanismReading> columns_;
};

} // namespace

MechanismReading::MechanismReading(const coupling::BodiesInContact& m, const coupling::Mechanism::Drift& openings)
    : mechanism(m), reactions(m.solver().reactions(m.state())), now(m.bodiesBalance().now), drift(openings),
      contacts(m.contactForces()) {}

Columns<MechanismReading> mechanismColumns(const multibody::Model& model, const std::vector<bool>& touching,
                                           const std::vector<std::string>& record,
                                           const multibody::PartCounts& ofVehicle) {
  const MechanismColumns columns(model, touching, record, ofVehicle);
  return columns.all();
}

Columns<std::vector<double>> probeColumns(const std::vector<std::string>& names) {
  Columns<std::vector<double>> columns("bodies/");
  for (std::size_t p = 0; p < names.size(); ++p)
    columns.add(names[p] + "/grain_mass", "kg", "mass of the grains with centres in the box of probe_size",
                [p](const std::vector<double>& masses) { return masses[p]; });
  return columns;
}

std::string integratorText(const multibody::SolverOptions& options) {
  if (options.integrator != multibody::Integrator::kRattle) return "symplectic Euler, order 1, springs implicit";
  return fmt::format("RATTLE, order {}, springs {}", options.order,
                     options.springs == multibody::Springs::kImplicit ? "implicit" : "explicit");
}

std::string mechanismSize(const coupling::Mechanism& mechanism) {
  const multibody::Model& model = mechanism.model();
  const multibody::Solver& solver = mechanism.solver();
  std::string text;
  const auto line = [&](const std::string& what, const std::string& value) {
    text += fmt::format("  {:<24} {}\n", what, value);
  };
  line("bodies", fmt::format("{}", model.bodies().size()));
  line("joints", fmt::format("{}", model.joints().size()));
  line("springs and bushings",
       fmt::format("{}", model.axisSprings().size() + model.pointSprings().size() + model.bushings().size()));
  line("drives and couplings", fmt::format("{}", model.drives().size() + model.couplings().size()));
  line("degrees of freedom", fmt::format("{}, excluding drives", solver.degreesOfFreedom()));
  if (std::fabs(mechanism.startBlow()) >
      kBlowShown * (std::fabs(mechanism.startBlow()) + mechanism.bodiesBalance().now.kinetic))
    line("at the start", fmt::format("the drives start at full speed, an impact of {:.4g} J; set this velocity for the "
                                     "bodies, or ramp up the drives",
                                     mechanism.startBlow()));
  const std::vector<std::string> redundant = solver.redundantRowNames();
  if (redundant.empty()) return text;
  line("redundant constraints", fmt::format("{}; reactions are the minimum-norm solution", redundant.size()));
  for (std::size_t i = 0; i < std::min(redundant.size(), kRowsShown); ++i) line("", redundant[i]);
  if (redundant.size() > kRowsShown) line("", fmt::format("and {} more", redundant.size() - kRowsShown));
  return text;
}

std::vector<FramePart> mechanismParts(const coupling::MechanismSetup& setup) {
  const multibody::Model& model = setup.model;
  const double size = sizeOf(model);
  std::vector<FramePart> parts;
  for (std::size_t b = setup.ofVehicle.bodies; b < model.bodies().size(); ++b) {
    const multibody::Body& body = model.bodies()[b];
    FramePart part{body.name, body.fixed ? PartKind::fixed : kBodyKinds[b % std::size(kBodyKinds)], {}};
    std::vector<Vec3d> ends;
    for (const multibody::Joint& j : model.joints()) {
      if (j.bodyA == static_cast<int>(b)) ends.push_back(j.frame_A.position);
      if (j.bodyB == static_cast<int>(b)) ends.push_back(j.frame_B.position);
    }
    const bool isSmall = !ends.empty() || body.fixed || body.point;
    const Vec3d fallback = isSmall ? Vec3d{1, 1, 1} * (kCentre * size) : boxOf(body, kMinEdge * size, kMaxEdge * size);
    const std::optional<Vec3d>& box = setup.boxes[b - setup.ofVehicle.bodies];
    for (const coupling::BodyShape& s : setup.shapes)
      if (s.body == b) addShape(part.mesh, s);
    const bool isShaped = !part.mesh.vertices.empty();
    if (!isShaped) addBox(part.mesh, {}, base::Mat3d::identity(), box.value_or(fallback));
    if (!box && !isShaped)
      for (const Vec3d& end : ends) addBar(part.mesh, end, kBar * size);
    parts.push_back(std::move(part));
  }
  return parts;
}

} // namespace grouser::output
