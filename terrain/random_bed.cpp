// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/random_bed.hpp"

#include "base/error.hpp"
#include "base/random.hpp"
#include "base/sphere.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grouser::terrain {

namespace {

constexpr std::uint64_t kPlace = base::purpose("terrain.random_bed.place");
constexpr std::uint64_t kRadius = base::purpose("terrain.random_bed.radius");
constexpr double kLoose = 0.28;   // solid fraction of the column; random sequential insertion saturates at 0.38
constexpr double kGap = 0.02;     // gap between grains, and to floor and walls, in radii
constexpr double kWindow = 4;     // half height of the search window for a grain's position, in its radii
constexpr int kTriesAWindow = 40; // tries before the window grows by half
constexpr double kEnds = 1.15, kRoughFloor = 0.35; // see the header
constexpr int kSlices = 200;                       // slices of a graded bed, for counting its grains

void check(const RandomBedOptions& o) {
  requireOfBed(o.radii.smallest() > 0 && std::isfinite(o.radii.largest()), "radius [m]", o.radii.smallest(),
               "(0, inf)");
  requireOfBed(o.depth > 0 && std::isfinite(o.depth), "depth [m]", o.depth, "(0, inf)");
  requireOfBed(o.porosity >= 0.2 && o.porosity <= 0.7, "porosity [-]", o.porosity, "[0.2, 0.7]");
}

/// Volume of all grains of a bed of this mean depth [m3].
double solidVolume(const RandomBedOptions& o, double depth, const Rectangle& area) {
  const double ends = (kEnds + (o.roughFloor ? kRoughFloor : 0.0)) * o.radii.meanPower(1);
  return (1 - o.porosity) * std::max(depth - ends, 0.2 * depth) * area.width() * area.length();
}

/// Local and mean depth of the settled bed.
class Depths {
public:
  Depths(const HeightField& surface, const RandomBedOptions& o) : surface_(surface), options_(o) {
    const std::vector<double>& h = surface.heights();
    lowest_ = *std::min_element(h.begin(), h.end());
    if (o.floor == FloorShape::follow) {
      mean_ = most_ = o.depth;
      return;
    }
    // Averages over the centres of cells, each at most two radii wide.
    const Rectangle& a = surface.area();
    const double wanted = 2 * o.radii.largest();
    const int nx = cells(a.width(), wanted), ny = cells(a.length(), wanted);
    double sum = 0;
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const double depth = at(a.xMin + (i + 0.5) * a.width() / nx, a.yMin + (j + 0.5) * a.length() / ny);
        sum += depth;
        most_ = std::max(most_, depth);
      }
    mean_ = sum / (double(nx) * ny);
  }
  double at(double x, double y) const {
    return options_.floor == FloorShape::follow ? options_.depth : surface_.height(x, y) - lowest_ + options_.depth;
  }
  double mean() const { return mean_; }
  double most() const { return most_; }
  HeightField floor() const {
    if (options_.floor == FloorShape::follow) return surface_.raised(-options_.depth);
    return HeightField::flat(surface_.area(), lowest_ - options_.depth);
  }

private:
  static int cells(double length, double wanted) {
    return static_cast<int>(std::clamp(std::ceil(length / wanted), 1.0, 2000.0));
  }
  const HeightField& surface_;
  const RandomBedOptions& options_;
  double lowest_{}, mean_{}, most_{0};
};

/// Placed grains, in cells as wide as the largest grain.
class Cells {
public:
  Cells(const Rectangle& area, double bottom, double top, double edge, const std::array<bool, 2>& periodic)
      : area_(area), bottom_(bottom), periodic_(periodic) {
    const auto fit = [&](double length) { return std::max(1, static_cast<int>(std::floor(length / edge))); };
    count_ = {fit(area.width()), fit(area.length()), fit(top - bottom)};
    edge_ = {area.width() / count_.x, area.length() / count_.y, (top - bottom) / count_.z};
    first_.assign(static_cast<std::size_t>(count_.x) * static_cast<std::size_t>(count_.y) *
                      static_cast<std::size_t>(count_.z),
                  -1);
  }
  void add(const Seed& grain) {
    const base::Vec3<int> c = cellOf(grain.centre);
    next_.push_back(first_[index(c)]);
    first_[index(c)] = static_cast<std::int64_t>(grains_.size());
    grains_.push_back(grain);
  }
  bool isFree(const Vec3d& p, double radius) const {
    const base::Vec3<int> c = cellOf(p);
    for (int z = std::max(0, c.z - 1); z <= std::min(count_.z - 1, c.z + 1); ++z)
      for (int y = c.y - 1; y <= c.y + 1; ++y)
        for (int x = c.x - 1; x <= c.x + 1; ++x) {
          const int xs = inRow(x, count_.x, periodic_[0]), ys = inRow(y, count_.y, periodic_[1]);
          if (xs < 0 || ys < 0) continue;
          for (std::int64_t g = first_[index({xs, ys, z})]; g >= 0; g = next_[static_cast<std::size_t>(g)]) {
            const Seed& other = grains_[static_cast<std::size_t>(g)];
            const double reach = radius + other.radius + kGap * std::min(radius, other.radius);
            Vec3d d = other.centre - p;
            if (periodic_[0]) d.x -= area_.width() * std::floor(d.x / area_.width() + 0.5);
            if (periodic_[1]) d.y -= area_.length() * std::floor(d.y / area_.length() + 0.5);
            if (dot(d, d) < reach * reach) return false;
          }
        }
    return true;
  }

private:
  static int inRow(int i, int n, bool ring) { return ring ? (i + n) % n : i < 0 || i >= n ? -1 : i; }
  /// Positions beyond an end belong to the last cell.
  base::Vec3<int> cellOf(const Vec3d& p) const {
    const auto at = [](double x, double from, double edge, int n) {
      return static_cast<int>(std::clamp(std::floor((x - from) / edge), 0.0, n - 1.0));
    };
    return {at(p.x, area_.xMin, edge_.x, count_.x), at(p.y, area_.yMin, edge_.y, count_.y),
            at(p.z, bottom_, edge_.z, count_.z)};
  }
  std::size_t index(const base::Vec3<int>& c) const {
    return (static_cast<std::size_t>(c.z) * static_cast<std::size_t>(count_.y) + static_cast<std::size_t>(c.y)) *
               static_cast<std::size_t>(count_.x) +
           static_cast<std::size_t>(c.x);
  }

  Rectangle area_;
  double bottom_;
  std::array<bool, 2> periodic_;
  base::Vec3<int> count_{};
  Vec3d edge_;
  std::vector<std::int64_t> first_, next_; ///< linked lists of the grains in a cell; -1: end
  std::vector<Seed> grains_;
};

/// Uniform random numbers of one grain.
struct Dice {
  std::uint64_t seed, purpose, id;
  double operator()(std::uint64_t k) const { return base::uniform(seed, purpose, id, k); }
};

/// Places the grains sequentially.
class Insertion {
public:
  Insertion(const HeightField& surface, const RandomBedOptions& o, const std::vector<Seed>& there)
      : o_(o), area_(surface.area()), depths_(surface, o), floor_(depths_.floor()), view_(floor_.view()),
        stretch_((1 - o.porosity) / kLoose), lift_(liftOf(there)),
        cells_(area_, floor_.bounds().lowest - largestRadius(o),
               floor_.bounds().highest + lift_ + depths_.most() * stretch_ + 2 * largestRadius(o),
               2.05 * largestRadius(o), o.periodic) {
    for (const Seed& grain : there) cells_.add(grain);
  }

  std::vector<Seed> lay() {
    const double wanted = solidVolume(o_, depths_.mean(), area_);
    std::vector<Seed> grains;
    for (double volume = 0; volume < wanted;) {
      const auto id = static_cast<std::uint64_t>(grains.size());
      const double share = volume / wanted;
      const double scale = o_.grading.scaleAt((1 - share) * depths_.mean(), o_.radii.medianRadius());
      const double radius = scale * o_.radii.draw(Dice{o_.seed, kRadius, id});
      const double own = base::sphereVolume(radius);
      grains.push_back(place(id, share + 0.5 * own / wanted, radius));
      cells_.add(grains.back());
      volume += own;
    }
    return grains;
  }

private:
  double liftOf(const std::vector<Seed>& there) const {
    double most = 0;
    for (const Seed& s : there) most = std::max(most, s.centre.z + s.radius - floor_.height(s.centre.x, s.centre.y));
    return 0.5 * most; // grains may start among them
  }

  Seed place(std::uint64_t id, double share, double radius) const {
    const Dice dice{o_.seed, kPlace, id};
    const double margin[2] = {o_.periodic[0] ? 0.0 : radius * (1 + kGap), o_.periodic[1] ? 0.0 : radius * (1 + kGap)};
    double window = kWindow * radius;
    for (std::uint64_t attempt = 0;; ++attempt) {
      if (attempt > 0 && attempt % kTriesAWindow == 0) window *= 1.5;
      Vec3d p{area_.xMin + margin[0] + dice(4 * attempt) * (area_.width() - 2 * margin[0]),
              area_.yMin + margin[1] + dice(4 * attempt + 1) * (area_.length() - 2 * margin[1]), 0};
      const double depth = depths_.at(p.x, p.y);
      if (dice(4 * attempt + 2) * depths_.most() > depth) continue; // grains per area follow column height
      const double column = depth * stretch_, ground = view_.height(p.x, p.y) + lift_;
      // The column is already full below its share: most free positions are above it.
      const double above = share * column + (2 * dice(4 * attempt + 3) - 1.7) * window;
      p.z = ground + radius + std::fabs(above); // reflected at the floor
      if (!view_.clearOf(p, radius * (1 + kGap))) p.z = clearHeight(floor_, p.x, p.y, p.z, radius * (1 + kGap));
      if (cells_.isFree(p, radius)) return {p, radius, false};
    }
  }

  const RandomBedOptions& o_;
  Rectangle area_;
  Depths depths_;
  HeightField floor_;
  HeightFieldView view_;
  double stretch_; ///< column height over bed height [-]
  double lift_;    ///< height of the column's foot above the floor [m]
  Cells cells_;
};

} // namespace

double largestRadius(const RandomBedOptions& o) {
  double scale = 1;
  if (o.grading.any()) scale = std::max(1.0, o.grading.coarsestRadius / o.radii.medianRadius());
  return scale * o.radii.largest();
}

BedPlan planBed(const HeightField& surface, const RandomBedOptions& options) {
  check(options);
  const Depths depths(surface, options);
  const double solid = solidVolume(options, depths.mean(), surface.area());
  double grains = 0;
  for (int k = 0; k < kSlices; ++k) {
    const double depth = (k + 0.5) / kSlices * depths.mean();
    const double scale = options.grading.scaleAt(depth, options.radii.medianRadius());
    const double volume = base::sphereVolume(1) * scale * scale * scale * options.radii.meanPower(3);
    grains += solid / kSlices / volume;
  }
  return {.walls = surface.area(),
          .floor = depths.floor(),
          .layers = 0,
          .thickness = options.depth,
          .fall = depths.most() * ((1 - options.porosity) / kLoose - 1),
          .grains = static_cast<std::int64_t>(std::llround(grains))};
}

std::vector<Seed> layGrains(const HeightField& surface, const RandomBedOptions& options,
                            const std::vector<Seed>& there) {
  check(options);
  const Rectangle& a = surface.area();
  const double least = 2 * largestRadius(options) * (1 + kGap);
  if (!(a.width() > least && a.length() > least))
    throw base::InputError(fmt::format("bed of grains: no grain of radius {} m fits between walls {} x {} m apart; use "
                                       "smaller grains or a larger terrain",
                                       largestRadius(options), a.width(), a.length()));
  return Insertion(surface, options, there).lay();
}

} // namespace grouser::terrain
