// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/placed_on_bed.hpp"

#include "base/error.hpp"
#include "coupling/insertion_guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace grouser::coupling {

using base::Vec3d;
using terrain::GrainState;

namespace {

/// Allowed overlap of a surface on a bed with a grain / grain radius: tolerance for rounded input.
constexpr double kPressed = 0.01;

constexpr double kNoGrain = -1e300;

std::string pointOf(const Vec3d& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", p.x, p.y, p.z); }

/// Grain of this rank.
struct Row {
  std::uint32_t id;
  Vec3d position; ///< [m]
  double radius;  ///< [m]
};

std::vector<Row> rowsOf(const terrain::Grains& bed) {
  const terrain::GrainSnapshot s = bed.snapshot();
  std::vector<Row> rows(s.position.size());
  for (std::size_t k = 0; k < rows.size(); ++k)
    rows[k] = {s.id[k], s.position[k], s.radius.empty() ? bed.model().radius : double{s.radius[k]}};
  return rows;
}

/// True if a ball, or one of its images beyond periodic boundaries, overlaps [low, high] along x or y.
bool isOver(int axis, double place, double radius, const SurfaceBounds& b, const terrain::PeriodicBoundaries& sides) {
  const auto reaches = [&](double x) { return x + radius > b.low[axis] && x - radius < b.high[axis]; };
  const auto& periodic = sides[static_cast<std::size_t>(axis)];
  if (!periodic) return reaches(place);
  const double period = (*periodic)[1] - (*periodic)[0];
  return reaches(place) || reaches(place + period) || reaches(place - period);
}

/// Highest point of the grains below these bounds, over all ranks [m]; kNoGrain if there is none.
double topUnder(const std::vector<Row>& rows, const SurfaceBounds& bounds, const terrain::PeriodicBoundaries& sides,
                const base::Comm& comm) {
  double top = kNoGrain;
  for (const Row& g : rows)
    if (isOver(0, g.position.x, g.radius, bounds, sides) && isOver(1, g.position.y, g.radius, bounds, sides))
      top = std::max(top, g.position.z + g.radius);
  comm.maximum(&top, 1);
  return top;
}

/// Lift of an object with these bounds so that its lowest point is `above` the highest grain below it [m].
double liftOf(const std::vector<Row>& rows, const SurfaceBounds& bounds, double above,
              const terrain::PeriodicBoundaries& sides, const std::string& place, const base::Comm& comm) {
  const double top = topUnder(rows, bounds, sides, comm);
  if (top == kNoGrain)
    throw base::InputError(fmt::format("{}.above_bed [m]: no grain of the bed lies under it, between x = {:.6g} and "
                                       "{:.6g} m, y = {:.6g} and {:.6g} m; move it over the bed, or set its height "
                                       "instead",
                                       place, bounds.low.x, bounds.high.x, bounds.low.y, bounds.high.y));
  return top + above - bounds.low.z;
}

SurfaceBounds boundsOf(const SurfaceSetup& s) {
  constexpr double kWide = 1e300;
  if (s.geometry.shape == terrain::SurfaceShape::plane && !s.mesh)
    return {{-kWide, -kWide, s.start.position.z}, {kWide, kWide, kWide}};
  return boundsOf(s, s.start);
}

SurfaceBounds boundsOf(const BodyShape& shape, const multibody::Body& body) {
  const base::Pose pose = multibody::compose(body.pose, shape.pose_B);
  const base::Mat3d R = pose.orientation.matrix();
  SurfaceBounds b;
  for (int a = 0; a < 3; ++a) {
    const Vec3d axis{R.m[a][0], R.m[a][1], R.m[a][2]}; // world axis a in the shape's frame
    b.low[a] = pose.position[a] - farthestAlong(shape, -axis);
    b.high[a] = pose.position[a] + farthestAlong(shape, axis);
  }
  return b;
}

SurfaceBounds boundsOf(const std::vector<terrain::GrainSpec>& grains) {
  SurfaceBounds b{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
  for (const terrain::GrainSpec& g : grains) {
    const Vec3d reach{g.radius, g.radius, g.radius};
    b.low = base::min(b.low, g.position - reach), b.high = base::max(b.high, g.position + reach);
  }
  return b;
}

/// Grain with the deepest overlap.
struct Deepest {
  double share = kNoGrain, depth = 0; ///< overlap / radius [-]; overlap [m]
  Row grain{};
};

/// Finds the grain with the deepest overlap over all ranks; among equal ones the lowest id. `depthOf`: overlap of a row
/// [m].
template <class DepthOf>
Deepest deepestOf(const std::vector<Row>& rows, const base::Comm& comm, const DepthOf& depthOf) {
  Deepest deepest;
  for (const Row& g : rows)
    if (const double depth = depthOf(g); depth > deepest.share * g.radius) deepest = {depth / g.radius, depth, g};
  for (const Deepest& other : comm.gatherValue(deepest))
    if (other.share > deepest.share || (other.share == deepest.share && other.grain.id < deepest.grain.id))
      deepest = other;
  return deepest;
}

Deepest deepestIn(const SurfaceSetup& surface, const std::vector<Row>& rows, const base::Comm& comm) {
  const SurfaceBounds b = boundsOf(surface);
  const bool plane = surface.geometry.shape == terrain::SurfaceShape::plane && !surface.mesh;
  return deepestOf(rows, comm, [&](const Row& g) {
    for (int a = 0; a < 3 && !plane; ++a)
      if (g.position[a] + g.radius <= b.low[a] || g.position[a] - g.radius >= b.high[a]) return kNoGrain;
    return startingOverlap(surface, g.position, g.radius);
  });
}

void requireRoomInBed(const SurfaceSetup& surface, const std::vector<Row>& rows, const base::Comm& comm) {
  const Deepest d = deepestIn(surface, rows, comm);
  if (!(d.share > kPressed)) return;
  throw base::InputError(fmt::format(
      "{}: {} would penetrate {:.3g} m into grain {} of the settled bed, radius {:g} m at {}, more than {:g} of the "
      "radius; set above_bed [m] to place it on the settled bed, move it, or set placed = \"before\" to lay the bed "
      "around it",
      surface.place, surface.name, d.depth, d.grain.id, d.grain.radius, pointOf(d.grain.position), kPressed));
}

/// Checks overlaps that Grains::add() does not check: with meshes, and with walls if the height was not known before.
void requireRoomFor(const PlacedGrains& section, const GroundSetup& scene) {
  const GrainsSetup& all = *scene.grains;
  const auto refuse = [&](const terrain::GrainSpec& g, double depth, const std::string& what) {
    if (depth > all.model.maxEntryOverlap * g.radius)
      throw base::InputError(fmt::format("{}: a grain of radius {:g} m at {} would penetrate {:.3g} m into {}, more "
                                         "than {:g} of its radius (run.max_overlap); move it",
                                         section.place, g.radius, pointOf(g.position), depth, what,
                                         all.model.maxEntryOverlap));
  };
  for (const terrain::GrainSpec& g : section.grains) {
    for (const SurfaceSetup& s : scene.surfaces)
      if (s.mesh) refuse(g, startingOverlap(s, g.position, g.radius), s.name);
    for (std::size_t w = 0; section.aboveBed && w < all.boundaries.walls.size(); ++w)
      refuse(g, g.radius - dot(all.boundaries.walls[w].normal, g.position) + all.boundaries.walls[w].offset,
             all.wallNames[w]);
  }
}

/// All grains of a state, on every rank.
std::vector<terrain::GrainSpec> specsOf(const GrainState& rows, const terrain::GrainModel& model,
                                        const base::PositionScale& scale, const std::vector<int>& materials,
                                        const base::Comm& comm) {
  std::vector<terrain::GrainSpec> mine;
  for (std::size_t k = 0; k < rows.rows(); ++k)
    mine.push_back({scale.toMetres(rows.position[k]),
                    {},
                    {},
                    rows.radius.empty() ? model.radius : double{rows.radius[k]},
                    materials[rows.material.empty() ? 0 : rows.material[k]],
                    !rows.fixed.empty() && rows.fixed[k] != 0});
  if (comm.alone()) return mine;
  std::vector<terrain::GrainSpec> all;
  for (const std::vector<terrain::GrainSpec>& part : comm.gatherAll(mine))
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

void makeGrains(LaidGround& ground, const GroundSetup& scene, const std::vector<terrain::GrainSpec>& start,
                const base::Exec& exec, const base::Comm& comm) {
  const GrainsSetup& g = *scene.grains;
  terrain::PartitionOptions partition = g.partition;
  partition.comm = comm;
  ground.grains = std::make_unique<terrain::Grains>(exec, g.model, g.boundaries, start, partition);
  guardInsertion(*ground.grains, g.sources, namesOfShapes(scene));
}

/// Index of each boundary of the bed among those of the whole scene: walls, floor contacts, then surfaces. With larger
/// grains a floor may have more contacts per grain than before.
std::vector<std::size_t> boundariesInScene(const GroundSetup& scene, const terrain::GrainLayout& alone,
                                           const terrain::GrainLayout& layout) {
  std::size_t surfaces = 0, later = 0;
  for (const SurfaceSetup& s : scene.surfaces)
    if (!s.mesh) ++surfaces, later += s.placedLater ? 1 : 0;
  const std::size_t fixed = static_cast<std::size_t>(alone.boundaries) - (surfaces - later);
  std::size_t next = static_cast<std::size_t>(layout.boundaries) - surfaces;
  std::vector<std::size_t> places(fixed);
  std::iota(places.begin(), places.end(), std::size_t{0});
  for (const SurfaceSetup& s : scene.surfaces) {
    if (s.mesh) continue;
    if (!s.placedLater) places.push_back(next);
    ++next;
  }
  return places;
}

/// Copies velocities and springs of the bed's grains to rows ordered like `bed`.
void takeMotion(const GrainState& bed, bool sameUnits, GrainState& scene) {
  scene.velocity = bed.velocity, scene.spin = bed.spin, scene.remainders = bed.remainders;
  if (!sameUnits)
    for (terrain::Remainders& r : scene.remainders) r.position = 0; // its position has been rounded
  if (scene.layout.periodic) scene.crossings = bed.crossings;
  scene.contacts = bed.contacts, scene.neighbour = bed.neighbour;
  const auto orNone = [&]<class T>(const std::vector<T>& springs) {
    return springs.empty() ? std::vector<T>(bed.neighbour.size()) : springs;
  };
  if (scene.layout.friction) scene.contactShear = orNone(bed.contactShear);
  if (scene.layout.rolling) scene.contactRolling = orNone(bed.contactRolling);
  if (scene.layout.plastic)
    scene.contactDeepest = orNone(bed.contactDeepest), scene.contactOrigin = orNone(bed.contactOrigin);
}

/// Copies the springs on walls, floor and surfaces.
void takeBoundaries(const GrainState& bed, const std::vector<std::size_t>& places, GrainState& scene) {
  const auto from = static_cast<std::size_t>(bed.layout.boundaries),
             to = static_cast<std::size_t>(scene.layout.boundaries);
  for (std::size_t k = 0; k < bed.rows(); ++k)
    for (std::size_t b = 0; b < from; ++b) {
      if (!(bed.wallBits[k] >> b & 1u)) continue;
      const std::size_t place = places[b];
      scene.wallBits[k] |= 1u << place;
      if (!bed.wallShear.empty()) scene.wallShear[k * to + place] = bed.wallShear[k * from + b];
      if (!bed.wallRolling.empty()) scene.wallRolling[k * to + place] = bed.wallRolling[k * from + b];
      if (!bed.wallDeepest.empty()) {
        scene.wallDeepest[k * to + place] = bed.wallDeepest[k * from + b];
        scene.wallOrigin[k * to + place] = bed.wallOrigin[k * from + b];
      }
    }
}

/// Copies the normals that identify contacts on a floor with several contacts per grain.
void takeFloorNormals(const GrainState& bed, const terrain::Boundaries& boundaries, const base::PositionScale& scale,
                      GrainState& scene) {
  const auto places = static_cast<std::size_t>(scene.layout.places);
  if (bed.layout.places > 0) scene.floorNormal = bed.floorNormal;
  if (places == 0 || bed.layout.places > 0) return;
  for (std::size_t k = 0; k < scene.rows(); ++k)
    if (scene.wallBits[k] >> boundaries.walls.size() & 1u)
      scene.floorNormal[k * places] =
          boundaries.floor->closestPoint(scale.toMetres(scene.position[k])).normal.as<float>();
}

} // namespace

std::vector<double> liftsOnto(const terrain::Grains& bed, const GroundSetup& scene, const base::Comm& comm) {
  const std::vector<Row> rows = rowsOf(bed);
  const terrain::PeriodicBoundaries& sides = scene.grains->boundaries.periodic;
  std::vector<double> lifts;
  for (const SurfaceSetup& s : scene.surfaces)
    lifts.push_back(s.aboveBed ? liftOf(rows, boundsOf(s), *s.aboveBed, sides, s.place, comm) : 0.0);
  for (const PlacedGrains& p : scene.grains->onBed)
    lifts.push_back(p.aboveBed ? liftOf(rows, boundsOf(p.grains), *p.aboveBed, sides, p.place, comm) : 0.0);
  return lifts;
}

void lift(GroundSetup& scene, const std::vector<double>& lifts) {
  GrainsSetup& grains = *scene.grains;
  if (lifts.size() < scene.surfaces.size() + grains.onBed.size()) // a lift of the mechanism may follow
    throw base::InputError("the checkpoint belongs to another scene; resume with the scene that was run");
  for (Obstacle& o : scene.obstacles)
    if (o.amongSurfaces) o.surface.lift(lifts[*o.amongSurfaces]);
  auto way = lifts.begin();
  auto boundary = grains.boundaries.surfaces.begin();
  for (SurfaceSetup& s : scene.surfaces) {
    s.lift(*way++);
    if (!s.mesh) (boundary++)->start = startingPose(s);
  }
  for (PlacedGrains& p : grains.onBed) {
    for (terrain::GrainSpec& g : p.grains) g.position.z += *way;
    ++way;
  }
}

double liftOnto(const terrain::Grains& bed, const GroundSetup& scene, const MechanismSetup& mechanism,
                const base::Comm& comm) {
  const std::vector<Row> rows = rowsOf(bed);
  double way = kNoGrain;
  for (const BodyShape& s : mechanism.shapes) {
    const SurfaceBounds bounds = boundsOf(s, mechanism.model.bodies()[s.body]);
    const double top = topUnder(rows, bounds, scene.grains->boundaries.periodic, comm);
    if (top != kNoGrain) way = std::max(way, top + *mechanism.aboveBed - bounds.low.z);
  }
  if (way == kNoGrain)
    throw base::InputError(fmt::format("{}.above_bed [m]: no grain of the bed lies under a shape of a body; move the "
                                       "bodies over the bed, or remove the key",
                                       mechanism.place));
  return way;
}

void requireRoom(const terrain::Grains& bed, const GroundSetup& scene, const base::Comm& comm) {
  const std::vector<Row> rows = rowsOf(bed);
  for (const SurfaceSetup& s : scene.surfaces)
    if (s.placedLater) requireRoomInBed(s, rows, comm);
  for (const PlacedGrains& p : scene.grains->onBed) requireRoomFor(p, scene);
}

void requireRoom(const terrain::Grains& grains, const MechanismSetup& mechanism, const multibody::Model& model,
                 const base::Comm& comm) {
  if (mechanism.shapes.empty()) return;
  const std::vector<Row> rows = rowsOf(grains);
  const double most = grains.model().maxEntryOverlap;
  for (const BodyShape& s : mechanism.shapes) {
    const multibody::Body& body = model.bodies()[s.body];
    const base::Pose pose = multibody::compose(body.pose, s.pose_B);
    const double reach = norm(halfExtent(s.shape));
    const Deepest d = deepestOf(rows, comm, [&](const Row& g) {
      if (norm2(g.position - pose.position) > (reach + g.radius) * (reach + g.radius)) return kNoGrain;
      return g.radius - distanceFrom(s, pose.toBody(g.position));
    });
    if (d.share > most)
      throw base::InputError(fmt::format(
          "{}: body \"{}\" overlaps grain {} of radius {:g} m at {} by {:.3g} m at the start, more than {:g} of its "
          "radius (run.max_overlap); move the body",
          s.place, body.name, d.grain.id, d.grain.radius, pointOf(d.grain.position), d.depth, most));
  }
}

void extendBedToScene(LaidGround& ground, const GroundSetup& scene, const base::Exec& exec, const base::Comm& comm) {
  const GrainsSetup &alone = *scene.grains->bed->alone->grains, &all = *scene.grains;
  const GrainState bed = ground.grains->state();
  const base::PositionScale scale = ground.grains->scale();
  std::vector<int> materials(std::max<std::size_t>(1, alone.model.materials.count()), all.bed->material);
  for (std::size_t k = 0; k < alone.materials.size(); ++k)
    materials[k] = static_cast<int>(std::find(all.materials.begin(), all.materials.end(), alone.materials[k]) -
                                    all.materials.begin());
  const std::vector<terrain::GrainSpec> start = specsOf(bed, alone.model, scale, materials, comm);
  ground.grains.reset(); // frees memory, which may not suffice for both sets of grains
  makeGrains(ground, scene, start, exec, comm);
  GrainState rows = ground.grains->state();
  takeMotion(bed, scale.unit == ground.grains->scale().unit, rows);
  takeBoundaries(bed, boundariesInScene(scene, bed.layout, rows.layout), rows);
  takeFloorNormals(bed, all.boundaries, ground.grains->scale(), rows);
  ground.grains->restore(rows);
}

LaidGround groundAt(const GroundSetup& scene, const GrainState& rows, const base::Exec& exec, const base::Comm& comm) {
  LaidGround ground;
  ground.surface = scene.surface, ground.rigid = scene.rigid;
  ground.walls = scene.grains->bed->walls;
  std::vector<int> materials(std::max<std::size_t>(1, scene.grains->materials.size()));
  for (std::size_t k = 0; k < materials.size(); ++k) materials[k] = static_cast<int>(k);
  const terrain::GrainModel& model = scene.grains->model;
  makeGrains(ground, scene, specsOf(rows, model, base::positionScale(2 * model.radius), materials, comm), exec, comm);
  return ground;
}

void putGrains(LaidGround& ground, const GroundSetup& scene) {
  terrain::Grains& grains = *ground.grains;
  for (const PlacedGrains& p : scene.grains->onBed) {
    grains.onInsertionOverlap([&](const terrain::InsertionOverlap& o) {
      throw base::InputError(fmt::format(
          "{}: its grain at {} would penetrate {:.3g} m into {}, more than {:g} of the radius (run.max_overlap); set "
          "above_bed [m] to place it on the settled bed, or move it",
          p.place, pointOf(p.grains[o.entering].position), o.overlap,
          o.grain ? fmt::format("grain {} at {}", *o.grain, pointOf(o.position)) : namesOfShapes(scene)[o.surface],
          grains.model().maxEntryOverlap));
    });
    grains.add(p.grains);
  }
  grains.onInsertionOverlap({});
  guardInsertion(grains, scene.grains->sources, namesOfShapes(scene));
}

} // namespace grouser::coupling
