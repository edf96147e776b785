// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grains.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <tuple>

namespace grouser::terrain {

using base::Position;
using base::Vec3d;
using base::Vec3f;

namespace {

constexpr StepFlags kNoFlags{~std::uint64_t{0}, 0, 0};

bool anyFriction(const GrainModel& model, const Boundaries& boundaries) {
  bool friction = model.law.friction > 0 || (boundaries.floor && model.floorLaw.friction > 0);
  for (const Wall& wall : boundaries.walls) friction = friction || wall.law.friction > 0;
  return friction;
}

std::int64_t wholeUnits(double length, const base::PositionScale& scale) {
  return static_cast<std::int64_t>(std::floor(length * scale.perMetre + 0.5));
}

/// Throws InputError when two grains have the same place: no direction would push them apart.
void checkDistinct(const std::vector<Position>& position) {
  std::vector<std::size_t> order(position.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t i) {
    const Position& p = position[i];
    return std::tuple(p.x, p.y, p.z, p.high);
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  for (std::size_t k = 1; k < order.size(); ++k)
    if (key(order[k - 1]) == key(order[k]))
      throw base::InputError(fmt::format("grains {} and {} have the same position; move one of them",
                                         std::min(order[k - 1], order[k]), std::max(order[k - 1], order[k])));
}

} // namespace

Grains::Grains(const base::Exec& exec, const GrainModel& model, Boundaries boundaries,
               const std::vector<GrainStart>& start)
    : exec_(exec), model_(model), scale_(base::positionScale(2 * model.radius)), count_(start.size()),
      diameterUnits_(wholeUnits(2 * model.radius, scale_)), skinUnits_(wholeUnits(model.skin * model.radius, scale_)),
      frictional_(anyFriction(model, boundaries)),
      boundaryCount_(static_cast<int>(boundaries.walls.size()) + (boundaries.floor ? 1 : 0)),
      neighbours_(exec, diameterUnits_, skinUnits_, frictional_) {
  if (boundaryCount_ > 31) throw base::InputError(fmt::format("{} planes; at most 31 are possible", boundaryCount_));
  std::vector<Position> position(count_);
  std::vector<Vec4f> velocity(count_), spin(count_);
  std::vector<std::uint32_t> id(count_);
  const double limit = scale_.limit();
  for (std::size_t i = 0; i < count_; ++i) {
    const Vec3d& x = start[i].position;
    if (!(std::fabs(x.x) < limit && std::fabs(x.y) < limit && std::fabs(x.z) < limit))
      throw base::InputError(
          fmt::format("grain {} at ({}, {}, {}) m is farther than {:.6g} m from the origin, the range of "
                      "positions for grains of radius {} m; move the scene nearer to the origin",
                      i, x.x, x.y, x.z, limit, model.radius));
    position[i] = scale_.fromMetres(x);
    const Vec3f v = start[i].velocity.as<float>(), w = start[i].spin.as<float>();
    velocity[i] = {v.x, v.y, v.z, 0};
    spin[i] = {w.x, w.y, w.z, 0};
    id[i] = static_cast<std::uint32_t>(i);
  }
  checkDistinct(position);
  position_[0] = base::Array<Position>(exec, position);
  velocity_[0] = base::Array<Vec4f>(exec, velocity);
  spin_[0] = base::Array<Vec4f>(exec, spin);
  position_[1] = base::Array<Position>(exec, count_);
  velocity_[1] = base::Array<Vec4f>(exec, count_);
  spin_[1] = base::Array<Vec4f>(exec, count_);
  remainders_ = base::Array<Remainders>(exec, count_);
  id_ = base::Array<std::uint32_t>(exec, id);
  reference_ = base::Array<base::Vec3<std::uint32_t>>(exec, count_);
  const std::size_t perBoundary = boundaryCount_ > 0 ? count_ : 0;
  wallShear_ = base::Array<Vec3f>(exec, frictional_ ? perBoundary * boundaryCount_ : 0);
  wallTouching_ = base::Array<std::uint32_t>(exec, perBoundary);
  nearBoundary_ = base::Array<std::uint32_t>(exec);
  boundaryOf_ = base::Array<std::uint32_t>(exec, perBoundary);
  boundaryLoads_ = base::Array<BoundaryLoad>(exec);
  dissipated_ = base::Array<double>(exec, model.ledger ? count_ : 0);
  flags_ = base::Mirrored<StepFlags>(exec, 1);
  *flags_.host() = kNoFlags;
  flags_.upload();
  walls_ = base::Array<Wall>(exec, boundaries.walls);
  if (boundaries.floor) {
    hasFloor_ = true;
    floorHeights_ = base::Array<double>(exec, boundaries.floor->heights());
    floorView_ = boundaries.floor->view();
    floorView_.heights = floorHeights_.data();
  }
}

void Grains::endStep() {
  ++steps_;
  checkFlags();
}

void Grains::checkFlags() {
  base::synchronize(exec_);
  const StepFlags flags = *flags_.host();
  if (flags.stale) stale_ = true;
  if (flags.stale || flags.fault != kNoFlags.fault) {
    *flags_.host() = kNoFlags;
    flags_.upload();
  }
  if (flags.fault == kNoFlags.fault) return;
  const auto fault = static_cast<Fault>(flags.fault >> 56);
  const auto id = static_cast<std::size_t>(flags.fault & 0xFFFFFFFFFFFFFFull);
  const GrainSnapshot s = snapshot();
  const Vec3d x = s.position[id];
  const double speed = norm(s.velocity[id].as<double>());
  const std::string where = fmt::format("step {}, time {:.6g} s: grain {} at ({:.6g}, {:.6g}, {:.6g}) m", steps_,
                                        static_cast<double>(steps_) * model_.timeStep, id, x.x, x.y, x.z);
  if (fault == Fault::overlap)
    throw base::SimulationError(fmt::format("{} overlaps by more than {:.3g} of its radius; use stiffer contacts "
                                            "(material stiffness) or a smaller time_step",
                                            where, model_.maxOverlap));
  if (fault == Fault::range)
    throw base::SimulationError(
        fmt::format("{} leaves the range of positions, {:.6g} m from the origin; give the scene a "
                    "floor or walls that hold it",
                    where, scale_.limit()));
  if (fault == Fault::speed)
    throw base::SimulationError(fmt::format("{} moves at {:.4g} m/s, more than half the neighbour list's skin in one "
                                            "step; use a smaller time_step or a larger skin",
                                            where, speed));
  throw base::SimulationError(where + " has a velocity that is no number; use a smaller time_step");
}

void Grains::stop() {
  velocity_[0].zero();
  spin_[0].zero();
  remainders_.zero();
}

GrainSnapshot Grains::snapshot() const {
  const auto position = position_[0].toHost();
  const auto velocity = velocity_[0].toHost(), spin = spin_[0].toHost();
  const auto id = id_.toHost();
  GrainSnapshot s{std::vector<Vec3d>(count_), std::vector<Vec3f>(count_), std::vector<Vec3f>(count_)};
  for (std::size_t i = 0; i < count_; ++i) {
    s.position[id[i]] = scale_.toMetres(position[i]);
    s.velocity[id[i]] = velocity[i].xyz();
    s.spin[id[i]] = spin[i].xyz();
  }
  return s;
}

std::size_t Grains::deviceBytes() const {
  std::size_t total = neighbours_.bytes() + remainders_.bytes() + id_.bytes() + reference_.bytes() +
                      wallShear_.bytes() + wallTouching_.bytes() + dissipated_.bytes() + nearBoundary_.bytes() +
                      boundaryOf_.bytes() + boundaryLoads_.bytes();
  for (int k = 0; k < 2; ++k) total += position_[k].bytes() + velocity_[k].bytes() + spin_[k].bytes();
  return total;
}

} // namespace grouser::terrain
