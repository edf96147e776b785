// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grain_boundaries.hpp"

#include "base/algorithms.hpp"
#include "contact/strongest_force.hpp"
#include "terrain/grain_kernel_data.cuh"

#include <algorithm>
#include <stdexcept>

namespace grouser::terrain {

using base::Vec3d;

namespace {

/// Marks the grains that may touch a wall, the floor or a surface before a grain moves half the skin or a surface
/// exceeds its allowed travel.
struct MarkNearBoundary {
  static constexpr double kNanoseconds = 20;
  GrainKernelData d;
  double reach; ///< maximum displacement of a grain, plus the radius if all radii are equal [m]
  bool manyRadii;
  double way;                 ///< maximum displacement of a surface before the next list [m]
  const std::uint32_t* ghost; ///< null without ghosts
  std::uint32_t* mark;
  GROUSER_HD void operator()(int i) const {
    if (ghost && ghost[i]) {
      mark[i] = 0;
      return;
    }
    const Vec3d x = base::toUnits(d.position[i]).as<double>() * d.unitLength;
    const double within = reach + (manyRadii ? fabs(static_cast<double>(d.motion[i].velocity.w)) : 0.0);
    // Walls and floor do not act on a fixed grain; it only interacts with surfaces.
    const bool moves = !(d.features & kFixed) || !isFixed(d.motion[i].velocity);
    // A grain in contact is listed wherever it is: the next step clears the bits of ended contacts, and until then its
    // springs need storage.
    bool near = d.boundaryContactMask[i] != 0 || (moves && (d.features & kFloor) && !d.floor.clearOf(x, within));
    for (int b = 0; moves && b < d.wallCount; ++b)
      near = near || dot(d.walls[b].normal, x) - d.walls[b].offset < within;
    for (int s = 0; s < d.surfaceCount; ++s) near = near || nearSurface(s, x, within);
    mark[i] = near ? 1u : 0u;
  }

private:
  GROUSER_HD bool nearSurface(int s, const Vec3d& x, double within) const {
    const contact::PartMotion& motion = d.placements[s].motion;
    const SurfaceTravel room = roomOf(d.surfaces[s], way);
    return gapTo(d.surfaces[s], motion.toPart(x)).distance < within + room.way + room.turn * norm(x - motion.centre);
  }
};

/// Copies row `from` of the source, counted from 1, to row `to` of the target; 0: no row.
GROUSER_HD void copySprings(const float* source, std::uint32_t from, float* target, std::uint32_t to, int width) {
  for (int w = 0; w < width; ++w)
    target[std::int64_t{to} * width + w] = from > 0 ? source[(std::int64_t{from} - 1) * width + w] : 0.0f;
}

/// Converts the counts before each slot to the list, and to each slot's index in it. Moves springs from the previous to
/// the new indices.
struct ListNearBoundary {
  const std::uint32_t* before;
  std::int64_t count;
  std::uint32_t total;
  std::uint32_t *list, *placeOf;
  const float* formerSprings;
  float* springs;
  int width;
  GROUSER_HD void operator()(int i) const {
    const std::uint32_t next = i + 1 < count ? before[i + 1] : total, former = placeOf[i];
    const bool listed = next > before[i];
    placeOf[i] = listed ? next : 0u;
    if (!listed) return;
    list[before[i]] = static_cast<std::uint32_t>(i);
    copySprings(formerSprings, former, springs, before[i], width);
  }
};

struct ExportSprings {
  const std::uint32_t *slots, *placeOf;
  const float* springs;
  float* out;
  int width;
  GROUSER_HD void operator()(int k) const {
    copySprings(springs, placeOf[slots[k]], out, static_cast<std::uint32_t>(k), width);
  }
};

/// Sets the indices of received grains: consecutive slots have their springs at consecutive indices.
struct NumberArrived {
  std::uint32_t place; ///< index of the first one
  std::uint32_t* placeOf;
  GROUSER_HD void operator()(int k) const { placeOf[k] = place + 1 + static_cast<std::uint32_t>(k); }
};

} // namespace

GrainBoundaries::GrainBoundaries(const base::Exec& exec, const GrainConstants& c, const Boundaries& boundaries)
    : exec_(exec), count_(c.boundaryCount), room_(0.5 * c.smallestRadius), walls_(exec, boundaries.walls), near_(exec),
      floorPlaces_(c.floorPlaces), springsWidth_(c.springsWidth()), springs_(exec), fromSurfaces_(exec),
      singleLoads_(exec), doubleLoads_(exec) {
  if (boundaries.floor) floor_ = SearchedHeightField(exec, *boundaries.floor, c.model.radius);
  makeSurfaces(c.model, boundaries.surfaces);
}

void GrainBoundaries::makeSurfaces(const GrainModel& model, const std::vector<RigidSurface>& surfaces) {
  std::vector<SurfacePose> start;
  // The strongest contact is 2^40 quanta: a sum has room for eight million of them per surface.
  double pressed = 0;
  const auto consider = [&](const contact::ContactLaw& law) {
    pressed = std::max(pressed, contact::strongestForce(law, model.radius, contact::kForcePress));
  };
  for (const RigidSurface& surface : surfaces) {
    geometries_.push_back(surface.geometry), start.push_back(surface.start);
    consider(surface.law);
  }
  for (const contact::ContactLaw& law : model.materials.boundaries) consider(law);
  surfaces_ = base::Array<SurfaceGeometry>(exec_, geometries_);
  if (start.empty()) return;
  poses_ = base::Mirrored<SurfacePose>(exec_, start.size());
  surfaceSums_ = base::Mirrored<contact::PartLoad>(exec_, start.size());
  surfaceLoads_.resize(start.size());
  strongest_ = pressed;
  surfaceForce_ = base::fixedPointFor(pressed, 40);
  surfaceTorque_ = base::fixedPointFor(pressed * contact::leverScale(model.radius), 40);
  setSurfacePoses(start);
}

void GrainBoundaries::setSurfacePoses(const std::vector<SurfacePose>& poses) {
  if (poses.size() != geometries_.size()) throw std::logic_error("one pose per surface is required");
  std::copy(poses.begin(), poses.end(), poses_.host());
  poses_.upload();
}

bool GrainBoundaries::surfacesHaveLeft() const {
  for (std::size_t s = 0; s < geometries_.size(); ++s) {
    const SurfaceTravel room = roomOf(geometries_[s], room_);
    const SurfaceTravel gone = travelBetween(geometries_[s], listedAt_[s], poses_.host()[s]);
    if (!(gone.way <= room.way && gone.turn <= room.turn)) return true;
  }
  return false;
}

void GrainBoundaries::list(const GrainConstants& c, const GrainKernelData& d, GrainArrays& arrays,
                           const std::uint32_t* ghosts) {
  const std::size_t slots = arrays.slots();
  const auto n = static_cast<std::int64_t>(slots);
  auto before = base::Array<std::uint32_t>::unset(exec_, slots); // marks, then the marks before each
  // Surfaces may require a list between rebuilds. At that time a grain may already be half the skin from its reference
  // position, and it may later move to half the skin on the other side.
  const double skin = (hasSurfaces() ? 1.0 : 0.5) * c.model.skin * c.smallestRadius;
  const double margin = static_cast<double>(c.marginUnits) * d.unitLength;
  const double reach = (c.manyRadii() ? 0 : c.model.radius) + skin + margin + d.unitLength;
  base::forEach(exec_, "mark grains near boundaries", n,
                MarkNearBoundary{d, reach, c.manyRadii(), room_, ghosts, before.data()});
  const std::uint32_t total = base::exclusiveScan(exec_, before.data(), before.data(), slots);
  near_.resize(total);
  c.model.precision == Precision::single ? singleLoads_.resize(total) : doubleLoads_.resize(total);
  if (hasSurfaces()) {
    fromSurfaces_.resize(total);
    listedAt_.assign(poses_.host(), poses_.host() + poses_.size());
    ++listings_;
  }
  auto springs = base::Array<float>::unset(exec_, total * springsWidth_);
  base::forEach(exec_, "list grains near boundaries", n,
                ListNearBoundary{before.data(), n, total, near_.data(), arrays.fields().boundaryOf.now.data(),
                                 springs_.data(), springs.data(), static_cast<int>(springsWidth_)});
  springs_.swap(springs);
}

base::Array<float> GrainBoundaries::exportSprings(const GrainFields& fields, const std::uint32_t* slots,
                                                  std::size_t count) const {
  auto leaving = base::Array<float>::unset(exec_, count * springsWidth_);
  base::forEach(exec_, "export springs of boundaries", leaving.empty() ? 0 : static_cast<std::int64_t>(count),
                ExportSprings{slots, fields.boundaryOf.now.data(), springs_.data(), leaving.data(),
                              static_cast<int>(springsWidth_)});
  return leaving;
}

float* GrainBoundaries::makeRoomForSprings(std::size_t count) {
  const std::size_t before = springs_.size();
  springs_.resizeKeeping(before + count * springsWidth_);
  return springs_.data() + before;
}

void GrainBoundaries::numberArrived(GrainFields& fields, std::size_t first, std::size_t count) const {
  if (springsWidth_ == 0) return;
  const std::size_t before = springs_.size() / springsWidth_ - count;
  base::forEach(exec_, "number springs of boundaries", static_cast<std::int64_t>(count),
                NumberArrived{static_cast<std::uint32_t>(before), fields.boundaryOf.now.data() + first});
}

void GrainBoundaries::clearSurfaceLoads() {
  if (hasSurfaces()) surfaceSums_.device().zero();
}

void GrainBoundaries::downloadSurfaceLoads() {
  if (hasSurfaces()) surfaceSums_.download();
}

void GrainBoundaries::collectSurfaceLoads(const base::Comm& comm) {
  if (!hasSurfaces()) return;
  contact::PartLoad* sums = surfaceSums_.host();
  static_assert(sizeof(contact::PartLoad) == 6 * sizeof(std::int64_t));
  comm.sum(&sums->force.x, 6 * surfaceSums_.size());
  for (std::size_t s = 0; s < surfaceLoads_.size(); ++s)
    surfaceLoads_[s] = {surfaceForce_.checked(sums[s].force, "forces on a surface"),
                        surfaceTorque_.checked(sums[s].torque, "torques on a surface")};
}

std::optional<GrainBoundaries::Overlap> GrainBoundaries::overlapOf(const Vec3d& centre, double radius,
                                                                   double allowed) const {
  for (std::size_t s = 0; s < geometries_.size(); ++s) {
    const double depth = radius - gapTo(geometries_[s], poses_.host()[s].motion.toPart(centre)).distance;
    if (depth > allowed) return Overlap{s, depth};
  }
  return {};
}

void GrainBoundaries::describe(GrainKernelData& d) {
  d.walls = walls_.data(), d.wallCount = static_cast<int>(walls_.size()), d.boundaryCount = count_;
  d.floor = floor_.view(), d.floorPlaces = floorPlaces_;
  d.surfaces = surfaces_.data(), d.surfaceCount = static_cast<int>(geometries_.size());
  d.placements = poses_.device().data(), d.surfaceLoads = surfaceSums_.device().data();
  d.surfaceForce = surfaceForce_, d.surfaceTorque = surfaceTorque_, d.fromSurfaces = fromSurfaces_.data();
  d.nearBoundary = near_.data(), d.boundaryHistory = springs_.data();
  d.boundaryRow = static_cast<int>(springsWidth_);
}

std::size_t GrainBoundaries::bytes() const {
  return near_.bytes() + springs_.bytes() + fromSurfaces_.bytes() + singleLoads_.bytes() + doubleLoads_.bytes();
}

} // namespace grouser::terrain
