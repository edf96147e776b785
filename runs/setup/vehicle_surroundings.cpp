// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/vehicle_surroundings.hpp"

#include "base/math.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/bed_options.hpp"
#include "runs/setup/placement.hpp"
#include "runs/setup/scene_surfaces.hpp"
#include "spheredecomp/mesh.hpp"
#include "vehicle/spec_file.hpp"
#include "vehicle/wrap.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace grouser::setup {

using base::Vec3d;

namespace {

/// Spacing of the points of a surface that are checked [m].
constexpr double kCell = 0.1;
/// Height above the ground [m]; lower surfaces are no obstacles.
constexpr double kFree = 0.05;
/// Maximum search distance without terrain [m].
constexpr double kFarthest = 100;

/// Region that a vehicle covers, or can cover while driving, along its heading from its position.
struct Corridor {
  double rear, front, half; ///< [m]
  double height;            ///< above the ground [m]
};

/// Point at which a vehicle reaches the end of the terrain.
struct Edge {
  double way;  ///< distance from the start [m]
  double time; ///< arrival [s]
  bool ahead;  ///< false: behind the vehicle
};

/// Moving surfaces, which have contact with grains only.
std::vector<SceneSurface> movingSurfaces(const scene::Scene& scene) {
  std::vector<SceneSurface> moving;
  for (const SceneSurface& s : surfacesOf(scene))
    if (s.moves) moving.push_back(s);
  return moving;
}

class Course {
public:
  explicit Course(const scene::Scene& scene)
      : scene_(scene), spec_(vehicleSpec(scene)), place_(placeVehicle(scene, spec_)) {
    const vehicle::Wrap wrap = vehicle::wrapTrack(spec_);
    const double reach = 0.5 * spec_.shoe.pitch - spec_.shoe.padBottom + spec_.shoe.grouserHeight;
    double rear = 1e300, front = -1e300, top = -1e300;
    for (int i = 0; i < spec_.shoe.count; ++i) {
      rear = std::min(rear, wrap.shoeCentre(i).x - reach), front = std::max(front, wrap.shoeCentre(i).x + reach);
      top = std::max(top, wrap.shoeCentre(i).z + reach);
    }
    if (scene.terrain) ground_ = readSurface(scene);
    start_ = {rear, front, spec_.trackOffset + spec_.shoe.padHalfWidth, top - spec_.groundHeight()};
  }

  const Corridor& start() const { return start_; }
  bool turns() const {
    if (const auto& course = scene_.driver.course) return course->radius || !course->x.empty();
    const scene::TorqueTable torques = scene_.driver.torques();
    for (std::size_t i = 0; i < torques.time.size(); ++i)
      if (torques.left[i] != torques.right[i]) return true;
    const scene::SpeedTable table = scene_.driver.speeds();
    for (std::size_t i = 0; i < table.time.size(); ++i)
      if (table.left[i] != table.right[i]) return true;
    return false;
  }
  /// Maximum distance without slip in the whole run [m].
  double farthest() const {
    const scene::SpeedTable table = scene_.driver.speeds();
    double fastest = 0;
    for (const std::vector<double>* side : {&table.left, &table.right})
      for (const double omega : *side) fastest = std::max(fastest, std::fabs(omega));
    if (scene_.vehicle->chassis == scene::ChassisMount::fixed) return 0;
    double speed = fastest * spec_.pitchRadius();
    if (scene_.driver.course)
      speed = std::fabs(scene_.driver.course->speed);
    else if (scene_.driver.isFree())
      speed = 1e6; // the speed with given torques is unknown
    const double way = speed * std::max(0.0, scene_.run.duration - scene_.driver.driveBegins());
    return std::min(way, ground_ ? ground_->area().width() + ground_->area().length() : kFarthest);
  }
  /// Point at which the vehicle leaves the terrain if it drives straight, without slip and ramp; empty if it stays on
  /// it.
  std::optional<Edge> edge() const {
    const auto area = terrainArea(scene_);
    const scene::SpeedTable table = scene_.driver.speeds();
    if (!area || table.left.empty() || turns() || scene_.driver.isFree() || scene_.driver.course ||
        scene_.vehicle->chassis == scene::ChassisMount::fixed)
      return {};
    constexpr int kPieces = 2000;
    const double begins = scene_.driver.driveBegins(), dt = (scene_.run.duration - begins) / kPieces;
    const double front = wayTo(*area, start_.front, 1), rear = wayTo(*area, -start_.rear, -1);
    double way = 0;
    for (int k = 0; dt > 0 && k < kPieces; ++k) {
      way += speedAt(table, (k + 0.5) * dt) * spec_.pitchRadius() * dt;
      if (way > front) return Edge{front, begins + (k + 1) * dt, true};
      if (-way > rear) return Edge{rear, begins + (k + 1) * dt, false};
    }
    return {};
  }
  /// Region that the vehicle can cover when it drives straight ahead and back.
  Corridor way() const {
    const scene::SpeedTable table = scene_.driver.speeds();
    bool ahead = false, back = false;
    if (const auto& course = scene_.driver.course; course && !turns())
      (course->speed < 0 ? back : ahead) = course->speed != 0;
    for (const double torque : scene_.driver.torques().left) ahead = ahead || torque > 0, back = back || torque < 0;
    for (const double omega : table.left) ahead = ahead || omega > 0, back = back || omega < 0;
    Corridor c = start_;
    if (ahead) c.front += farthest();
    if (back) c.rear -= farthest();
    return c;
  }

  /// Returns true if the surface, at its initial position, reaches into the corridor.
  bool meets(const SceneSurface& s, const Corridor& c) const {
    const base::Pose pose = placeOf(s);
    const bool plane = s.geometry.shape == terrain::SurfaceShape::plane;
    // Planes are checked at the corners of the corridor, other surfaces with balls on a lattice.
    const double cell = plane ? 1e300 : kCell, radius = plane ? 0 : 0.87 * kCell;
    const double reach = plane ? 1e300 : sizeOf(s) + radius + c.height;
    const int nx = cellsOf(c.front - c.rear, cell), ny = cellsOf(2 * c.half, cell), nz = cellsOf(c.height, cell);
    for (int i = 0; i <= nx; ++i)
      for (int j = 0; j <= ny; ++j) {
        Vec3d p = inWorld(c.rear + (c.front - c.rear) * i / nx, -c.half + 2 * c.half * j / ny);
        if (std::fabs(p.x - pose.position.x) > reach || std::fabs(p.y - pose.position.y) > reach || !onTerrain(p))
          continue;
        const double ground = ground_ ? ground_->height(p.x, p.y) : 0;
        for (int k = 0; k <= nz; ++k) {
          p.z = ground + kFree + radius + (c.height - kFree) * k / nz;
          if (coupling::overlapAt(s, pose, p, radius) > 0) return true;
        }
      }
    return false;
  }

private:
  /// Sprocket speed at `time` [s] after the start of the drive.
  static double speedAt(const scene::SpeedTable& table, double time) {
    const auto after =
        static_cast<std::size_t>(std::upper_bound(table.time.begin(), table.time.end(), time) - table.time.begin());
    if (after == 0) return table.left.front();
    if (after == table.time.size()) return table.left.back();
    const double from = table.time[after - 1], share = (time - from) / (table.time[after] - from);
    return table.left[after - 1] + share * (table.left[after] - table.left[after - 1]);
  }
  /// Distance from a point `reach` [m] beyond the vehicle's position to the end of the terrain, along the heading or
  /// back [m].
  double wayTo(const terrain::Rectangle& area, double reach, double sign) const {
    const double c = sign * base::cos(place_.heading), s = sign * base::sin(place_.heading);
    const auto along = [](double from, double slope, double low, double high) {
      return slope > 1e-9 ? (high - from) / slope : slope < -1e-9 ? (low - from) / slope : 1e300;
    };
    return std::min(along(place_.x, c, area.xMin, area.xMax), along(place_.y, s, area.yMin, area.yMax)) - reach;
  }
  /// Initial pose; surfaces with above_bed are assumed at this height above the surface of the bed.
  base::Pose placeOf(const SceneSurface& s) const {
    base::Pose pose = s.start;
    if (!s.aboveBed || !ground_) return pose;
    const bool plane = s.geometry.shape == terrain::SurfaceShape::plane;
    const double lowest = plane ? pose.position.z : coupling::boundsOf(s, pose).low.z;
    pose.position.z += ground_->height(pose.position.x, pose.position.y) + *s.aboveBed - lowest;
    return pose;
  }
  static int cellsOf(double length, double cell) { return std::max(1, static_cast<int>(std::ceil(length / cell))); }
  /// Farthest point of a surface from its own origin [m].
  static double sizeOf(const SceneSurface& s) {
    double size = norm(s.geometry.half);
    if (s.geometry.shape != terrain::SurfaceShape::box)
      size = norm(Vec3d{s.geometry.half.x, s.geometry.half.x, s.geometry.half.z});
    if (s.mesh)
      for (const Vec3d& v : s.mesh->mesh().vertices) size = std::max(size, norm(v));
    return size;
  }
  Vec3d inWorld(double ahead, double left) const {
    const double c = base::cos(place_.heading), s = base::sin(place_.heading);
    return {place_.x + c * ahead - s * left, place_.y + s * ahead + c * left, 0};
  }
  /// Points beyond the terrain do not matter, since the run ends there.
  bool onTerrain(const Vec3d& p) const {
    const auto area = terrainArea(scene_);
    return !area || (p.x >= area->xMin && p.x <= area->xMax && p.y >= area->yMin && p.y <= area->yMax);
  }

  const scene::Scene& scene_;
  vehicle::VehicleSpec spec_;
  coupling::Placement place_;
  std::optional<terrain::HeightField> ground_;
  Corridor start_{};
};

} // namespace

void checkVehicleSurroundings(const scene::Scene& scene) {
  if (!scene.vehicle) return;
  const bool grains = !scene.grains.empty() || !scene.fills.empty() || !scene.sources.empty();
  if (!scene.terrain && !grains && scene.vehicle->chassis != scene::ChassisMount::fixed)
    scene.fail("vehicle", "chassis",
               "is \"free\", which requires a [terrain] (planes do not support a vehicle); add [terrain] with kind = "
               "\"rigid\", or set chassis = \"fixed\"");
  const std::vector<SceneSurface> all = movingSurfaces(scene);
  if (all.empty()) return;
  const Course course(scene);
  for (const SceneSurface& s : all) {
    const bool atStart = course.meets(s, course.start());
    if (!atStart && !course.meets(s, course.way())) continue;
    const std::string key = s.kind == coupling::SurfaceKind::plane ? "point" : "position";
    scene.fail(
        s.list(), s.number, key,
        fmt::format(
            "[m]: {} \"{}\" moves and is {}, but moving surfaces have contact with grains only, so the vehicle would "
            "pass through it; {}",
            s.list(), s.name,
            atStart ? "at the vehicle's initial position"
                    : fmt::format("in the path of the vehicle, which can travel {:.1f} m within run.duration",
                                  course.farthest()),
            atStart ? "remove its motion, move it, change vehicle.position, or remove it"
                    : "remove its motion, move it aside, change vehicle.heading, shorten run.duration, or remove it"));
  }
}

std::vector<std::string> vehicleWarnings(const scene::Scene& scene) {
  std::vector<std::string> warnings;
  if (!scene.vehicle) return warnings;
  if (scene.driver.table && scene.driver.rampOfDrive() == 0 &&
      (scene.driver.table->left.front() != 0 || scene.driver.table->right.front() != 0))
    warnings.push_back(fmt::format("driver.table starts at {:g} and {:g} rad/s, so the sprockets accelerate within one "
                                   "step; start the table at 0, or set driver.drive_ramp",
                                   scene.driver.table->left.front(), scene.driver.table->right.front()));
  const std::optional<Edge> edge = scene.stop.edge ? std::nullopt : Course(scene).edge();
  if (edge && !(scene.stop.distance && *scene.stop.distance <= edge->way))
    warnings.push_back(
        fmt::format("the terrain ends {:.2f} m {} the vehicle; without slip, the vehicle reaches the edge at {:.3g} s, "
                    "and the run ends with an error when a shoe leaves the terrain; enlarge terrain.size, shorten "
                    "run.duration ({:g} s), or set stop.distance or stop.edge",
                    edge->way, edge->ahead ? "ahead of" : "behind", edge->time, scene.run.duration));
  for (const SceneSurface& s : movingSurfaces(scene))
    warnings.push_back(fmt::format(
        "{} \"{}\" moves, so it has contact with grains only; the vehicle passes through it without contact force",
        s.list(), s.name));
  return warnings;
}

std::vector<std::string> meshNotes(const scene::Scene& scene) {
  std::vector<std::string> notes;
  const auto add = [&](const std::string& note) {
    if (!note.empty() && std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
  };
  for (const scene::MeshSection& mesh : scene.meshes) add(mesh.loaded.note);
  for (const scene::BodySection& body : scene.mechanism.bodies)
    for (const scene::ShapeSection& shape : body.shapes) add(shape.loaded.note);
  if (!scene.vehicle) return notes;
  const vehicle::VehicleSpec spec = vehicle::readVehicleSpec(scene.vehicle->source());
  for (const std::string& mesh : {spec.chassis.mesh, spec.shoe.mesh, spec.sprocket.mesh, spec.roadWheel.mesh,
                                  spec.roller.mesh, spec.idler.mesh}) {
    const std::filesystem::path file = std::filesystem::path(spec.meshFolder) / mesh;
    if (!std::filesystem::is_regular_file(file)) continue; // a vehicle without rollers
    std::string note;
    spheredecomp::importMesh(file.string(), &note);
    add(note);
  }
  return notes;
}

} // namespace grouser::setup
