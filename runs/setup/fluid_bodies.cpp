// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/fluid_bodies.hpp"

#include "base/math.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/bed_options.hpp"
#include "runs/setup/mechanism_setup.hpp"
#include "runs/setup/vehicle_setup.hpp"
#include "spheredecomp/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <map>

namespace grouser::setup {

using base::Vec3d;
using contact::SurfaceShape;

namespace {

/// Midpoints of equal parts of [-half, half], each about `spacing` long.
std::vector<double> partsOf(double half, double spacing) {
  const auto n = std::max(1, static_cast<int>(std::lround(2 * half / spacing)));
  std::vector<double> middles;
  for (int k = 0; k < n; ++k) middles.push_back(half * (2 * (k + 0.5) / n - 1));
  return middles;
}

std::vector<Vec3d> boxPoints(const Vec3d& half, double spacing, int flat) {
  std::vector<double> along[3];
  for (int a = 0; a < 3; ++a) along[a] = a == flat ? std::vector<double>{0} : partsOf(half[a], spacing);
  std::vector<Vec3d> points;
  for (const double x : along[0])
    for (const double y : along[1])
      for (const double z : along[2]) points.push_back({x, y, z});
  return points;
}

/// Points on circles about the z axis; circles and points on them are about `spacing` apart.
std::vector<Vec3d> discPoints(double radius, double spacing) {
  std::vector<Vec3d> points;
  for (double r = radius - 0.5 * spacing; r > 0.25 * spacing; r -= spacing) {
    const auto n = std::max(3, static_cast<int>(std::lround(2 * base::kPi * r / spacing)));
    for (int k = 0; k < n; ++k) {
      const double angle = 2 * base::kPi * (k + 0.5) / n;
      points.push_back({r * base::cos(angle), r * base::sin(angle), 0});
    }
  }
  return points;
}

std::vector<Vec3d> cylinderPoints(const Vec3d& half, double spacing, int flat) {
  std::vector<Vec3d> points;
  const std::vector<Vec3d> disc = discPoints(half.x, spacing);
  for (const double z : flat == 2 ? std::vector<double>{0} : partsOf(half.z, spacing))
    for (const Vec3d& p : disc) points.push_back({p.x, p.y, z});
  return points;
}

/// Points of concentric spheres, on each along a spiral with equal areas per point.
std::vector<Vec3d> spherePoints(double radius, double spacing) {
  const double turn = base::kPi * (3 - std::sqrt(5.0)); // golden angle
  std::vector<Vec3d> points;
  for (double r = radius - 0.5 * spacing; r > 0.25 * spacing; r -= spacing) {
    const auto n = std::max(4, static_cast<int>(std::lround(4 * base::kPi * r * r / (spacing * spacing))));
    for (int k = 0; k < n; ++k) {
      const double z = 1 - (2 * k + 1.0) / n, rho = std::sqrt(1 - z * z), angle = turn * k;
      points.push_back({r * rho * base::cos(angle), r * rho * base::sin(angle), r * z});
    }
  }
  return points;
}

std::vector<Vec3d> pointsOf(const coupling::BodyShape& s, double spacing, int flat) {
  if (!s.mesh) {
    if (s.shape.shape == SurfaceShape::box) return boxPoints(s.shape.half, spacing, flat);
    if (s.shape.shape == SurfaceShape::cylinder) return cylinderPoints(s.shape.half, spacing, flat);
    if (s.shape.shape == SurfaceShape::capsule && s.shape.half.z == 0) return spherePoints(s.shape.half.x, spacing);
  }
  return boxPoints(halfExtent(s.shape), spacing, flat);
}

/// Axis (0, 1, 2) of a shape's frame that is parallel to y, the normal of the plane of a two-dimensional fluid; -1:
/// none.
int axisAcross(const coupling::BodyShape& s, const base::Pose& pose) {
  const Vec3d across = transposedTimes(pose.orientation.matrix(), Vec3d{0, 1, 0});
  for (int a = 0; a < 3; ++a) {
    const bool fits =
        !s.mesh && (s.shape.shape == SurfaceShape::box || (s.shape.shape == SurfaceShape::cylinder && a == 2));
    if (fits && std::fabs(across[a]) > 1 - 1e-9) return a;
  }
  return -1;
}

/// Mesh of a part, moved so that its bounding box is centred at the origin. `centre`: centre of the box in the part's
/// frame.
coupling::BodyMesh partMesh(const std::string& file, Vec3d& centre) {
  base::TriangleMesh mesh = spheredecomp::importMesh(file);
  const auto [low, high] = spheredecomp::bounds(mesh);
  centre = 0.5 * (low + high);
  for (Vec3d& v : mesh.vertices) v -= centre;
  return coupling::bodyMesh(std::make_shared<const spheredecomp::MeshQuery>(std::move(mesh)), 0, false);
}

/// Markers of shapes in their frames. Parts of one kind share one set.
class PartMarkers {
public:
  /// Returns false if the shape contains no marker.
  bool add(const coupling::BodyShape& s, const fluid::FluidModel& model, int across) {
    std::vector<Vec3d>& markers = of_[keyOf(s)];
    const double dx = model.spacing, depth = std::ceil(model.kernel().support() / dx) * dx;
    if (markers.empty()) markers = shapeMarkers(s, dx, depth, across);
    return !markers.empty();
  }
  const std::vector<Vec3d>& of(const coupling::BodyShape& s) const { return of_.at(keyOf(s)); }

private:
  static const void* keyOf(const coupling::BodyShape& s) {
    return s.mesh ? static_cast<const void*>(s.mesh.get()) : static_cast<const void*>(&s);
  }
  std::map<const void*, std::vector<Vec3d>> of_;
};

/// Adds the markers of the shapes of one body, except markers inside an earlier shape, and sets the gain.
void addMarkers(coupling::BodyInFluid& in, const multibody::Body& body,
                const std::vector<const coupling::BodyShape*>& shapes, const PartMarkers& markers,
                const fluid::FluidModel& model) {
  const double dx = model.spacing,
               face = model.dimensions == 2 ? dx : dx * dx; // area per marker [m2]; [m] in the plane
  double shifting = 0, turning = 0;
  for (std::size_t k = 0; k < shapes.size(); ++k)
    for (const Vec3d& p : markers.of(*shapes[k])) {
      const Vec3d p_B = shapes[k]->pose_B.toWorld(p);
      const auto within = [&p_B](const coupling::BodyShape* o) { return distanceFrom(*o, o->pose_B.toBody(p_B)) < 0; };
      if (std::any_of(shapes.begin(), shapes.begin() + static_cast<std::ptrdiff_t>(k), within)) continue;
      in.markers.push_back(p_B);
      if (distanceFrom(*shapes[k], p) > -dx) shifting += face, turning += face * norm2(p_B);
    }
  // Fluid within half a spacing of each outermost marker moves with the body; twice this mass is a bound.
  const double ghost = 2 * 0.5 * model.density * dx;
  const auto& I = body.inertia_B.m;
  if (!body.fixed)
    in.gain = std::max(ghost * shifting / body.mass, ghost * turning / std::min({I[0][0], I[1][1], I[2][2]}));
}

std::string columnOf(const vehicle::Assembly& assembly, const vehicle::Part& part) {
  if (part.kind == vehicle::PartKind::kChassis) return "vehicle/hull";
  return fmt::format("vehicle/{}_track", vehicle::sideName(assembly.tracks[static_cast<std::size_t>(part.track)].side));
}

} // namespace

std::vector<Vec3d> shapeMarkers(const coupling::BodyShape& shape, double spacing, double depth, int flat) {
  std::vector<Vec3d> markers;
  for (const Vec3d& p : pointsOf(shape, spacing, flat)) {
    const double d = distanceFrom(shape, p);
    if (d < 0 && d > -depth) markers.push_back(p);
  }
  return markers;
}

/// The chassis is the first body of a vehicle.
StartingBodies::StartingBodies(const scene::Scene& scene) {
  if (scene.vehicle) addVehicle(scene);
  ofVehicle_ = bodies_.size(), parts_ = placed_.size();
  if (!scene.mechanism.touches()) return;
  const coupling::MechanismSetup mechanism = mechanismSetup(scene);
  const std::vector<multibody::Body>& all = mechanism.model.bodies();
  for (std::size_t b = ofVehicle_; b < all.size(); ++b) {
    if (b < mechanism.hitched.size() && mechanism.hitched[b])
      scene.fail(
          "body", b - ofVehicle_, "",
          "is connected to the vehicle, which [fluid] does not support; remove its joints and springs, or [fluid]");
    bodies_.push_back(all[b]), columns_.push_back("bodies/" + all[b].name);
  }
  for (const coupling::BodyShape& s : mechanism.shapes) add(s);
}

void StartingBodies::addVehicle(const scene::Scene& scene) {
  const coupling::VehicleSetup setup = vehicleSetup(scene);
  std::function<double(double, double)> height;
  if (setup.onTerrain) height = [ground = readSurface(scene)](double x, double y) { return ground.height(x, y); };
  const vehicle::Assembly assembly =
      coupling::assembleAt(setup, setup.onTerrain ? setDown(setup.spec, setup.place, setup.clearance, height)
                                                  : vehicle::placeOnGround(setup.spec, setup.place.x, setup.place.y, 0,
                                                                           0, setup.place.heading));
  bodies_ = assembly.model.bodies();
  columns_.resize(bodies_.size());
  struct Kind {
    std::shared_ptr<const coupling::BodyMesh> mesh;
    Vec3d centre, half; ///< centre and half edges of the bounding box in the part's frame [m]
  };
  std::map<std::string, Kind> kinds;
  for (const vehicle::Part& part : assembly.parts) {
    Kind& kind = kinds[part.mesh];
    if (!kind.mesh) {
      kind.mesh = std::make_shared<const coupling::BodyMesh>(
          partMesh((std::filesystem::path(setup.spec.meshFolder) / part.mesh).string(), kind.centre));
      kind.half = spheredecomp::bounds(kind.mesh->query->mesh()).second;
    }
    coupling::BodyShape s{.body = static_cast<std::size_t>(part.body),
                          .pose_B = {part.pose_B.toWorld(kind.centre), part.pose_B.orientation},
                          .shape = {contact::SurfaceShape::box, kind.half},
                          .material = 0,
                          .place = part.name};
    s.mesh = kind.mesh;
    columns_[s.body] = columnOf(assembly, part);
    add(s);
  }
}

void StartingBodies::add(const coupling::BodyShape& s) {
  const base::Pose& body = bodies_[s.body].pose;
  placed_.push_back(
      {s, {body.toWorld(s.pose_B.position), body.orientation * s.pose_B.orientation}, norm(halfExtent(s.shape))});
}

std::optional<base::Pose> StartingBodies::chassis() const {
  return ofVehicle_ > 0 ? std::optional(bodies_.front().pose) : std::nullopt;
}

double StartingBodies::distance(const Vec3d& p, std::size_t first, std::size_t last, double most) const {
  double least = most;
  for (std::size_t i = first; i < last; ++i)
    if (const Placed& s = placed_[i]; norm2(p - s.pose.position) < (s.reach + least) * (s.reach + least))
      least = std::min(least, distanceFrom(s.shape, s.pose.toBody(p)));
  return least;
}

double StartingBodies::vehicleBelow(double level) const {
  constexpr double kAcross = 0.01, kUp = 0.0025; // [m]
  std::int64_t inside = 0;
  for (std::size_t i = 0; i < parts_; ++i) {
    const Placed& part = placed_[i];
    const base::Mat3d turn = part.pose.orientation.matrix();
    const Vec3d half = halfExtent(part.shape.shape), centre = part.pose.position;
    Vec3d reach;
    for (int a = 0; a < 3; ++a)
      for (int k = 0; k < 3; ++k) reach[a] += std::fabs(turn.m[a][k]) * half[k];
    const double top = std::min(level, centre.z + reach.z);
    for (double x = centre.x - reach.x + 0.5 * kAcross; x < centre.x + reach.x; x += kAcross)
      for (double y = centre.y - reach.y + 0.5 * kAcross; y < centre.y + reach.y; y += kAcross)
        for (double z = top - 0.5 * kUp; z > centre.z - reach.z; z -= kUp)
          inside += part.shape.mesh->query->inside(part.pose.toBody({x, y, z})) ? 1 : 0;
  }
  return static_cast<double>(inside) * (kAcross * kAcross * kUp);
}

std::vector<coupling::BodyInFluid> StartingBodies::inFluid(const scene::Scene& scene,
                                                           const fluid::FluidModel& model) const {
  std::vector<coupling::BodyInFluid> all;
  PartMarkers ofParts;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const auto fail = [&](const std::string& message) {
      if (b < ofVehicle_) scene.fail("fluid", "spacing", "[m]: the " + bodies_[b].name + " " + message);
      scene.fail("body", b - ofVehicle_, "shape", message);
    };
    std::vector<const coupling::BodyShape*> shapes;
    for (const Placed& placed : placed_) {
      const coupling::BodyShape& s = placed.shape;
      if (s.body != b) continue;
      shapes.push_back(&s);
      const bool plane = model.dimensions == 2;
      const int across = plane ? axisAcross(s, placed.pose) : -1;
      if (plane && across < 0)
        fail("must be a box aligned with the x-z plane or a cylinder along y, since fluid.dimensions = 2; change the "
             "shape, or set dimensions = 3");
      if (!ofParts.add(s, model, across) || (b >= ofVehicle_ && 2 * coupling::halfThickness(s) < model.spacing))
        fail(fmt::format("is {:.3g} m thick, less than fluid.spacing = {:g} m, so it contains no markers; increase its "
                         "thickness, or reduce the spacing",
                         2 * coupling::halfThickness(s), model.spacing));
    }
    if (shapes.empty()) continue;
    coupling::BodyInFluid in{b, b < ofVehicle_ ? 0 : b, columns_[b], {}, b > 0 && b < ofVehicle_, 0};
    addMarkers(in, bodies_[b], shapes, ofParts, model);
    all.push_back(std::move(in));
  }
  return all;
}

} // namespace grouser::setup
