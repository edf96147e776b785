// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/layers.hpp"

#include "base/error.hpp"
#include "base/random.hpp"
#include "base/sphere.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::terrain {

namespace {

using base::InputError;

constexpr std::uint64_t kJitter = base::purpose("terrain.layers.jitter");
constexpr double kFloorGap = 0.05;    ///< between grain and floor or wall, in radii
constexpr double kJitterReach = 0.49; ///< fraction of the gap between two grains for each of them: half, with a reserve

void check(const LayerOptions& o) {
  requireOfBed(o.radius > 0 && std::isfinite(o.radius), "radius [m]", o.radius, "(0, inf)");
  requireOfBed(o.layers >= 0, "layers", o.layers, "[1, inf), or 0 to use depth");
  if (o.layers == 0)
    requireOfBed(o.depth > 0 && std::isfinite(o.depth), "depth [m]", o.depth, "(0, inf); give layers or depth");
  requireOfBed(o.spacingInRadii > 2 && o.spacingInRadii <= 10, "spacing [radii]", o.spacingInRadii, "(2, 10]");
  requireOfBed(o.jitter >= 0 && o.jitter <= 1, "jitter [-]", o.jitter, "[0, 1]");
  requireOfBed(o.packing >= 0.3 && o.packing <= 0.74, "packing [-]", o.packing, "[0.3, 0.74]");
  requireOfBed(o.wallMargin >= 0 && std::isfinite(o.wallMargin), "wall margin [m]", o.wallMargin, "[0, inf)");
}

/// Lattice points along one axis: `count[0]` in even layers, `count[1]` in odd ones, which start `offset` later.
struct Axis {
  double start{}, spacing{}, offset{};
  int count[2]{};
  double period{0}; ///< distance between periodic boundaries [m]; 0: walls

  double at(int i, int layer) const { return start + (layer & 1) * offset + i * spacing; }
  /// Distance from `a` to `b`, or to its nearest image.
  double apart(double a, double b) const {
    return period > 0 ? b - a - period * std::floor((b - a) / period + 0.5) : b - a;
  }
};

/// Places as many points as fit between walls, centred in the `length` for grain centres; odd layers are offset.
Axis fit(double from, double length, double spacing) {
  const int n = static_cast<int>(std::floor(length / spacing)) + 1;
  const double left = length - (n - 1) * spacing;
  if (left >= spacing / 2) return {from + (left - spacing / 2) / 2, spacing, spacing / 2, {n, n}};
  if (n == 1) return {from + left / 2, spacing, 0, {1, 1}};
  return {from + left / 2, spacing, spacing / 2, {n, n - 1}};
}

/// Ring of points, as many as fit between periodic boundaries; odd layers are offset.
Axis ring(double from, double length, double spacing) {
  const int n = static_cast<int>(std::floor(length / spacing * (1 + 1e-12)));
  const double pitch = length / std::max(1, n);
  return {from + pitch / 4, pitch, pitch / 2, {n, n}, length};
}

/// Sites of a bed: lattice points with a grain.
class Lattice {
public:
  Lattice(const HeightField& surface, const LayerOptions& o)
      : options_(o), spacing_(o.spacingInRadii * o.radius),
        jitter_(o.jitter * kJitterReach * (spacing_ - 2 * o.radius)) {
    check(o);
    const Rectangle& a = surface.area();
    walls_ = {a.xMin + o.wallMargin, a.xMax - o.wallMargin, a.yMin + o.wallMargin, a.yMax - o.wallMargin};
    const double inset = o.radius * (1 + kFloorGap) + jitter_;
    const auto axis = [&](std::size_t which, double from, double to) {
      if (o.periodic[which]) return ring(from, to - from, spacing_);
      return to - from < 2 * inset ? Axis{} : fit(from + inset, to - from - 2 * inset, spacing_);
    };
    x_ = axis(0, walls_.xMin, walls_.xMax), y_ = axis(1, walls_.yMin, walls_.yMax);
    if (x_.count[0] < 1 || y_.count[0] < 1)
      throw InputError(
          fmt::format("bed of grains: no grain of radius {} m fits between walls {} x {} m apart; use smaller "
                      "grains, a larger terrain or a smaller wall margin",
                      o.radius, walls_.width(), walls_.length()));

    const double volume = base::sphereVolume(o.radius);
    const double mean = 0.5 * (double(x_.count[0]) * y_.count[0] + double(x_.count[1]) * y_.count[1]);
    layerThickness_ = mean * volume / (o.packing * walls_.width() * walls_.length());
    const double wanted = o.layers > 0 ? o.layers : std::floor(o.depth / layerThickness_ + 0.5);
    requireOfBed(wanted < 1e6, "layers", wanted, "[1, 1e6)");
    layers_ = std::max(1, static_cast<int>(wanted));
    fullLayers_ = layers_;
    if (o.floor == FloorShape::flat) fillHills(surface);
  }

  const Axis& x() const { return x_; }
  const Axis& y() const { return y_; }
  const Rectangle& walls() const { return walls_; }
  double spacing() const { return spacing_; }
  double jitter() const { return jitter_; }
  double thickness() const { return fullLayers_ * layerThickness_; }
  int layers() const { return layers_; }
  std::size_t index(int i, int j, int layer) const { return static_cast<std::size_t>(j) * x_.count[layer & 1] + i; }
  std::size_t layerSize(int layer) const {
    return static_cast<std::size_t>(x_.count[layer & 1]) * static_cast<std::size_t>(y_.count[layer & 1]);
  }
  /// True if a site has a grain: its column is high enough and all its supports exist.
  bool occupied(int i, int j, int layer) const {
    return height_[layer & 1].empty() || layer < height_[layer & 1][index(i, j, layer)];
  }

  HeightField floor(const HeightField& surface) const {
    if (options_.floor == FloorShape::follow) return surface.raised(-thickness());
    return HeightField::flat(surface.area(), lowest_ - thickness());
  }

  /// Calls f(i, j) for the one to four sites of the layer below that support the site (i, j) of `layer`.
  template <class F> void forEachSupport(int i, int j, int layer, F&& f) const {
    const int below = layer - 1;
    const auto [i0, i1] = supports(x_, i, layer);
    const auto [j0, j1] = supports(y_, j, layer);
    for (int b = j0; b <= j1; ++b)
      for (int a = i0; a <= i1; ++a)
        if (site(x_, a, below) >= 0 && site(y_, b, below) >= 0) f(site(x_, a, below), site(y_, b, below));
  }

private:
  /// Lattice point i of a layer, wrapped around a ring; -1: there is none.
  static int site(const Axis& axis, int i, int layer) {
    const int n = axis.count[layer & 1];
    if (axis.period > 0) return (i + n) % n;
    return i >= 0 && i < n ? i : -1;
  }
  static std::pair<int, int> supports(const Axis& axis, int i, int layer) {
    if (axis.offset == 0) return {i, i};
    return (layer & 1) ? std::pair{i, i + 1} : std::pair{i - 1, i};
  }

  /// Counts the layers below `surface` in every column on a flat floor; a layer needs its supports.
  void fillHills(const HeightField& surface) {
    const HeightFieldView view = surface.view();
    lowest_ = *std::min_element(surface.heights().begin(), surface.heights().end());
    const double floorZ = lowest_ - thickness();
    int most = 0;
    for (int parity = 0; parity < 2; ++parity)
      for (int j = 0; j < y_.count[parity]; ++j)
        for (int i = 0; i < x_.count[parity]; ++i) {
          const double depth = view.height(x_.at(i, parity), y_.at(j, parity)) - floorZ;
          const double fits = std::floor(depth / layerThickness_ + 0.5);
          requireOfBed(fits < 1e6, "layers on the flat floor", fits, "[1, 1e6); use larger grains");
          height_[parity].push_back(std::max(fullLayers_, static_cast<int>(fits)));
          most = std::max(most, height_[parity].back());
        }
    for (layers_ = fullLayers_; layers_ < most && supportLayer(layers_);) ++layers_;
  }

  /// Removes the sites of `layer` that lack a support; returns false if none remains.
  bool supportLayer(int layer) {
    bool any = false;
    for (int j = 0; j < y_.count[layer & 1]; ++j)
      for (int i = 0; i < x_.count[layer & 1]; ++i) {
        int& height = height_[layer & 1][index(i, j, layer)];
        if (height <= layer) continue;
        bool carried = true;
        forEachSupport(i, j, layer, [&](int a, int b) { carried = carried && occupied(a, b, layer - 1); });
        if (!carried) height = layer;
        any = any || carried;
      }
    return any;
  }

  LayerOptions options_;
  Rectangle walls_;
  Axis x_, y_;
  double spacing_{}, jitter_{}, layerThickness_{}, lowest_{};
  int layers_{}, fullLayers_{};
  std::vector<int> height_[2]; ///< flat floor: layers in each column, for even and odd layers; empty: all of them
};

} // namespace

BedPlan planBed(const HeightField& surface, const LayerOptions& options) {
  const Lattice lattice(surface, options);
  std::int64_t grains = 0;
  for (int layer = 0; layer < lattice.layers(); ++layer)
    for (int j = 0; j < lattice.y().count[layer & 1]; ++j)
      for (int i = 0; i < lattice.x().count[layer & 1]; ++i) grains += lattice.occupied(i, j, layer);
  return {.walls = lattice.walls(),
          .floor = lattice.floor(surface),
          .layers = lattice.layers(),
          .thickness = lattice.thickness(),
          .fall = lattice.layers() * (options.spacingInRadii - 1.6) * options.radius,
          .grains = grains};
}

std::vector<Seed> layGrains(const HeightField& surface, const LayerOptions& options, double lift) {
  const Lattice lattice(surface, options);
  const HeightField floor = lattice.floor(surface).raised(lift);
  const double clear = options.radius * (1 + kFloorGap);
  const double apart2 = 1.5 * lattice.spacing() * lattice.spacing();

  std::vector<Seed> grains;
  std::vector<Vec3d> below, here; // centres of two layers, by site
  for (int layer = 0; layer < lattice.layers(); ++layer) {
    here.assign(lattice.layerSize(layer), Vec3d{});
    for (int j = 0; j < lattice.y().count[layer & 1]; ++j)
      for (int i = 0; i < lattice.x().count[layer & 1]; ++i) {
        if (!lattice.occupied(i, j, layer)) continue;
        const auto shift = [&, id = grains.size()](int k) {
          return lattice.jitter() * (2 * base::uniform(options.seed, kJitter, id, k) - 1);
        };
        Vec3d c{lattice.x().at(i, layer) + shift(0), lattice.y().at(j, layer) + shift(1), 0};

        // Places the grain as low as the supports and the floor allow, then raises it by the jitter.
        c.z = floor.bounds().lowest;
        if (layer > 0)
          lattice.forEachSupport(i, j, layer, [&](int a, int b) {
            const Vec3d& s = below[lattice.index(a, b, layer - 1)];
            const double dx = lattice.x().apart(s.x, c.x), dy = lattice.y().apart(s.y, c.y);
            const double flat2 = dx * dx + dy * dy;
            c.z = std::max(c.z, s.z + std::sqrt(apart2 - flat2));
          });
        c.z = clearHeight(floor, c.x, c.y, c.z, clear);
        c.z += shift(2) + lattice.jitter();
        here[lattice.index(i, j, layer)] = c;
        grains.push_back({c, options.radius});
      }
    std::swap(below, here);
  }
  return grains;
}

} // namespace grouser::terrain
