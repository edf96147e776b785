// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/start_checks.hpp"

#include "base/error.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/periodic_boundaries.hpp"
#include "runs/setup/scene_surfaces.hpp"
#include "runs/setup/sources.hpp"
#include "terrain/feet_search.hpp"
#include "terrain/searched_height_field.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <tuple>

namespace grouser::setup {

using base::Vec3d;

namespace {

constexpr std::size_t kMaxChecked = 1'000'000; // maximum number of checked grains from sources

/// Search cells along one axis, each as long as the largest diameter; periodic boundaries make them a ring.
struct CellsAlong {
  double from = 0, width;
  std::int64_t ring = 0; ///< cells between periodic boundaries; 0: walls or nothing

  CellsAlong(double diameter, const std::optional<std::array<double, 2>>& periodic) : width(diameter) {
    if (!periodic) return;
    from = (*periodic)[0];
    const double period = (*periodic)[1] - from;
    ring = std::max<std::int64_t>(1, static_cast<std::int64_t>(period / diameter));
    width = period / static_cast<double>(ring);
  }
  std::int64_t of(double x) const { return wrapped(static_cast<std::int64_t>(std::floor((x - from) / width))); }
  std::int64_t wrapped(std::int64_t k) const { return ring > 0 ? (k % ring + ring) % ring : k; }
};

/// "at (1, 2, 3) m".
std::string at(const Vec3d& p) { return fmt::format("at ({:.6g}, {:.6g}, {:.6g}) m", p.x, p.y, p.z); }

/// Kind of section that places a grain: [[grain]], [[grains]], [[source]].
enum class Setter { grain, grains, source };

/// A grain to be placed, and its section.
struct Ball {
  Vec3d position;
  double radius;
  Setter setter;
  std::size_t number{}; ///< index of the section in its list
  double time{};        ///< [s]
  std::size_t id{};     ///< grain id, for grains present at the start
  bool fixed{};         ///< part of the ground: may overlap walls, the floor and other fixed grains
};

/// Places grains sequentially, and checks each for overlaps.
class Placing {
public:
  Placing(const scene::Scene& scene, const Surroundings& around, double largest)
      : scene_(scene), around_(around), periodic_(periodicBoundaries(scene)),
        largest_(largest), along_{CellsAlong(2 * largest_, periodic_[0]), CellsAlong(2 * largest_, periodic_[1]),
                                  CellsAlong(2 * largest_, {})} {
    if (around.floor) floor_ = terrain::SearchedHeightField(base::Exec{}, *around.floor, largest_);
  }

  /// Throws InputError if the grain overlaps a rigid surface, or a grain placed since forgetBalls().
  void place(const Ball& ball) {
    for (const Surroundings::Wall& wall : around_.walls)
      if (const double depth = ball.radius - dot(wall.normal, ball.position) + wall.offset;
          !ball.fixed && isTooDeep(depth, ball.radius))
        refuse(ball, depth, wall.name);
    if (terrain::FootPoint foot; !ball.fixed && around_.floor && !floor_.view().clearOf(ball.position, ball.radius) &&
                                 terrain::deepestFoot(floor_.view(), ball.position, ball.radius, foot))
      if (const double depth = ball.radius - foot.distance; isTooDeep(depth, ball.radius))
        refuse(ball, depth, "the terrain's floor");
    for (std::size_t i = 0; i < around_.surfaces.size(); ++i) {
      const SceneSurface& s = around_.surfaces[i];
      if (s.aboveBed || (s.free && ball.time > 0)) continue;
      if (const double depth = coupling::overlapAt(s, poseAt(i, ball.time), ball.position, ball.radius);
          isTooDeep(depth, ball.radius))
        refuse(ball, depth, fmt::format("{} {}", s.list(), s.number));
    }
    placeAmongBalls(ball);
  }
  /// Removes the grains placed so far, since they move before later grains enter.
  void forgetBalls() { balls_.clear(), cells_.clear(); }

private:
  using Cell = std::tuple<std::int64_t, std::int64_t, std::int64_t>;

  base::Pose poseAt(std::size_t i, double time) const {
    const SceneSurface& s = around_.surfaces[i];
    if (!s.moves || time <= 0) return s.start;
    const coupling::SurfaceMotion::State now = s.motion.at(time);
    return {now.centre, now.turned * s.start.orientation};
  }

  void placeAmongBalls(const Ball& ball) {
    const std::int64_t x = along_[0].of(ball.position.x), y = along_[1].of(ball.position.y),
                       z = along_[2].of(ball.position.z);
    for (std::int64_t k = 0; k < 27; ++k) {
      const auto found =
          cells_.find({along_[0].wrapped(x + k / 9 - 1), along_[1].wrapped(y + k / 3 % 3 - 1), z + k % 3 - 1});
      if (found == cells_.end()) continue;
      for (const std::size_t j : found->second) {
        const Ball& other = balls_[j];
        if (ball.fixed && other.fixed) continue;
        const double depth =
            ball.radius + other.radius - norm(terrain::toNearestImage(periodic_, ball.position - other.position));
        if (isTooDeep(depth, std::min(ball.radius, other.radius)))
          refuse(ball, depth,
                 (other.setter == Setter::source ? fmt::format("a grain of source.{} ", other.number)
                                                 : fmt::format("grain {} ", other.id)) +
                     at(other.position));
      }
    }
    cells_[{x, y, z}].push_back(balls_.size());
    balls_.push_back(ball);
  }

  /// `radius`: radius of the smaller grain [m].
  bool isTooDeep(double overlap, double radius) const { return overlap > scene_.run.entryOverlap() * radius; }

  [[noreturn]] void refuse(const Ball& ball, double overlap, const std::string& with) const {
    const std::string how = fmt::format("overlaps {} by {:.3g} m, more than {:g} of its radius (run.max_overlap)", with,
                                        overlap, scene_.run.entryOverlap());
    if (ball.setter == Setter::grain)
      scene_.fail("grain", ball.number, "position", fmt::format("[m]: the grain {}; move it", how));
    if (ball.setter == Setter::grains)
      scene_.fail("grains", ball.number, "",
                  fmt::format("places grain {} {}, which {}; move the whole block", ball.id, at(ball.position), how));
    scene_.fail("source", ball.number, "low",
                fmt::format("[m] and high allow a grain {} at {:g} s, which {}; move low and high{}", at(ball.position),
                            ball.time, how, ball.time > 0 ? ", or change start and every" : ""));
  }

  const scene::Scene& scene_;
  const Surroundings& around_;
  terrain::SearchedHeightField floor_;
  terrain::PeriodicBoundaries periodic_;
  double largest_;
  std::array<CellsAlong, 3> along_;
  std::vector<Ball> balls_;
  std::map<Cell, std::vector<std::size_t>> cells_;
};

/// Places [[grain]] and [[grains]] in the order of their ids, except grains with above_bed, which are checked after the
/// bed has settled.
void placeStarting(const scene::Scene& scene, const std::vector<scene::Grain>& grains, Placing& placing) {
  std::size_t id = 0;
  for (std::size_t k = 0; k < scene.grains.size(); ++k, ++id)
    if (!scene.grains[k].aboveBed)
      placing.place({grains[id].position, grains[id].radius, Setter::grain, k, 0, id, grains[id].fixed});
  for (std::size_t k = 0; k < scene.fills.size(); ++k)
    for (std::int64_t left = placedCount(scene.fills[k]); left > 0; --left, ++id)
      if (!scene.fills[k].aboveBed) placing.place({grains[id].position, grains[id].radius, Setter::grains, k, 0, id});
}

} // namespace

void checkStart(const scene::Scene& scene, const GrainKinds& kinds, const std::vector<scene::Grain>& grains,
                const Surroundings& around, double timeStep) {
  checkBetweenSides(scene, grains);
  checkSources(scene, kinds);
  Placing placing(scene, around, kinds.largest);
  placeStarting(scene, grains, placing);
  const coupling::Sources sources = sourcesOf(scene, kinds, timeStep);
  std::size_t checked = 0;
  for (auto step = sources.nextEntry(0); step && checked < kMaxChecked; step = sources.nextEntry(*step + 1)) {
    const double time = static_cast<double>(*step) * timeStep;
    if (time > scene.run.duration) break;
    if (*step > 0) placing.forgetBalls();
    for (const coupling::Sources::Batch& batch : sources.batchesAt(*step))
      for (const terrain::GrainSpec& g : batch.grains) {
        placing.place({g.position, g.radius, Setter::source, batch.source, time});
        ++checked;
      }
  }
}

} // namespace grouser::setup
