// SPDX-License-Identifier: BSD-3-Clause
#include "runs/render/detail/raster.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace grouser::render::detail {

namespace {

constexpr float kCreaseCosine = 0.82f; ///< cosine of 35 degrees
constexpr int kBandRows = 32;

struct Rectangle {
  int left, right, top, bottom; ///< pixels, right and bottom excluded
};

void put(Surfaces& s, std::size_t i, float depth, const Vec3f& normal_W, std::int32_t object) {
  s.depth[i] = depth;
  for (int k = 0; k < 3; ++k)
    s.normal[i][static_cast<std::size_t>(k)] = static_cast<std::int16_t>(normal_W[k] * 32767.0f);
  s.object[i] = object;
}

/// Extent of the sphere's projection on the plane at depth 1 along one axis: tangents from the eye.
std::pair<float, float> tangents(float x, float z, float radius) {
  const float t = std::sqrt(x * x + z * z - radius * radius);
  return {(x * t - radius * z) / (z * t + radius * x), (x * t + radius * z) / (z * t - radius * x)};
}

/// The pixel at `p` in 0 ... `n`; 0 if `p` is not a number.
int clampTo(float p, int n) { return p > 0 ? static_cast<int>(std::min(p, float(n))) : 0; }

Rectangle sphereBounds(const View& v, const Vec3f& c, float radius) {
  std::pair<float, float> x{c.x - radius, c.x + radius}, y{c.y - radius, c.y + radius};
  if (v.perspective) x = tangents(c.x, c.z, radius), y = tangents(c.y, c.z, radius);
  const float scale = v.pixelsPerUnit(), middleX = 0.5f * float(v.width), middleY = 0.5f * float(v.height);
  return {clampTo(middleX + x.first * scale, v.width), clampTo(middleX + x.second * scale + 1, v.width),
          clampTo(middleY - y.second * scale, v.height), clampTo(middleY - y.first * scale + 1, v.height)};
}

struct PlacedSphere {
  Vec3f centre_C;
  float radius;
  float nearest; ///< depth of the nearest point of the sphere
  Rectangle bounds;
  std::int32_t object;
};

std::vector<PlacedSphere> place(const View& view, const std::vector<RenderSphere>& spheres) {
  std::vector<PlacedSphere> placed;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Vec3f c = view.toCamera(spheres[i].centre);
    if (view.perspective && c.z < spheres[i].radius + view.near) continue;
    const Rectangle r = sphereBounds(view, c, spheres[i].radius);
    if (r.left < r.right && r.top < r.bottom)
      placed.push_back({c, spheres[i].radius, c.z - spheres[i].radius, r, static_cast<std::int32_t>(i)});
  }
  // Front to back, so that most hidden spheres are rejected early.
  std::sort(placed.begin(), placed.end(), [](const PlacedSphere& a, const PlacedSphere& b) {
    return std::tie(a.nearest, a.object) < std::tie(b.nearest, b.object);
  });
  return placed;
}

void draw(const PlacedSphere& sphere, int top, int bottom, Surfaces& s) {
  const View& v = s.view;
  const Vec3f& c = sphere.centre_C;
  const float radius2 = sphere.radius * sphere.radius;
  for (int row = std::max(top, sphere.bounds.top); row < std::min(bottom, sphere.bounds.bottom); ++row)
    for (int column = sphere.bounds.left; column < sphere.bounds.right; ++column) {
      const std::size_t i = s.index(column, row);
      if (sphere.nearest >= s.depth[i]) continue;
      // Foot point of the centre on the ray, then back along the ray: avoids differences of large squares.
      const Vec3f origin = v.perspective ? Vec3f{} : Vec3f{v.planeX(column), v.planeY(row), 0};
      const Vec3f along = v.perspective ? Vec3f{v.planeX(column), v.planeY(row), 1} : Vec3f{0, 0, 1};
      const float a = dot(along, along), foot = dot(c - origin, along) / a;
      const Vec3f away = c - origin - along * foot;
      const float inside = radius2 - dot(away, away);
      if (inside <= 0) continue;
      const float depth = foot - std::sqrt(inside / a);
      if (depth >= s.depth[i]) continue;
      const Vec3f normal_C = (origin + along * depth - c) * (1.0f / sphere.radius);
      put(s, i, depth, v.turn(normal_C), sphere.object);
    }
}

struct Corner {
  Vec3f p_C, normal, colour;
};

struct Polygon {
  std::array<Corner, 4> corner;
  std::size_t count = 0;
  void add(const Corner& c) { corner[count++] = c; }
};

/// Part of a triangle beyond the near plane: zero, three or four corners.
Polygon clipped(const Facet& f, const View& view) {
  std::array<Corner, 3> in;
  Polygon out;
  for (std::size_t k = 0; k < 3; ++k) in[k] = {view.toCamera(f.corner[k]), f.normal[k], f.colour[k]};
  if (!view.perspective) return {{in[0], in[1], in[2]}, 3};
  for (std::size_t k = 0; k < 3; ++k) {
    const Corner &a = in[k], &b = in[(k + 1) % 3];
    const bool aIn = a.p_C.z > view.near, bIn = b.p_C.z > view.near;
    if (aIn) out.add(a);
    if (aIn != bIn) {
      const float t = (view.near - a.p_C.z) / (b.p_C.z - a.p_C.z);
      out.add(
          {a.p_C + (b.p_C - a.p_C) * t, a.normal + (b.normal - a.normal) * t, a.colour + (b.colour - a.colour) * t});
    }
  }
  return out;
}

/// One triangle on the screen; `w`: 1/depth (perspective) or 1 (parallel); value * w is linear on the screen.
struct ScreenTriangle {
  std::array<float, 3> x, y, z, w;
  std::array<Vec3f, 3> normal, colour;
  float area;
  Rectangle bounds;
  std::int32_t object;
  bool coloured;
};

void place(const View& view, const Facet& facet, std::vector<ScreenTriangle>& list) {
  if (facet.oneSided) {
    const Vec3f out = cross(facet.corner[1] - facet.corner[0], facet.corner[2] - facet.corner[0]);
    if (dot(out, view.perspective ? facet.corner[0] - view.eye : view.forward) > 0) return;
  }
  const Polygon polygon = clipped(facet, view);
  for (std::size_t k = 2; k < polygon.count; ++k) {
    ScreenTriangle t;
    const Corner* c[3] = {polygon.corner.data(), &polygon.corner[k - 1], &polygon.corner[k]};
    for (std::size_t i = 0; i < 3; ++i) {
      t.z[i] = c[i]->p_C.z, t.w[i] = view.perspective ? 1 / t.z[i] : 1, t.normal[i] = c[i]->normal;
      t.colour[i] = c[i]->colour;
      t.x[i] = 0.5f * float(view.width) + c[i]->p_C.x * t.w[i] * view.pixelsPerUnit();
      t.y[i] = 0.5f * float(view.height) - c[i]->p_C.y * t.w[i] * view.pixelsPerUnit();
    }
    t.area = (t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) - (t.x[2] - t.x[0]) * (t.y[1] - t.y[0]);
    if (t.area == 0) continue;
    const auto [x0, x1] = std::minmax_element(t.x.begin(), t.x.end());
    const auto [y0, y1] = std::minmax_element(t.y.begin(), t.y.end());
    // Pixels with centres that may be inside: most small triangles have no such pixel.
    t.bounds = {clampTo(std::ceil(*x0 - 0.5f), view.width), clampTo(std::floor(*x1 + 0.5f), view.width),
                clampTo(std::ceil(*y0 - 0.5f), view.height), clampTo(std::floor(*y1 + 0.5f), view.height)};
    t.object = facet.object, t.coloured = facet.coloured;
    if (t.bounds.left < t.bounds.right && t.bounds.top < t.bounds.bottom) list.push_back(t);
  }
}

void draw(const ScreenTriangle& t, int top, int bottom, Surfaces& s) {
  for (int row = std::max(top, t.bounds.top); row < std::min(bottom, t.bounds.bottom); ++row)
    for (int column = t.bounds.left; column < t.bounds.right; ++column) {
      const float px = float(column) + 0.5f, py = float(row) + 0.5f;
      float b[3];
      bool isInside = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
        b[k] = ((t.x[j] - t.x[i]) * (py - t.y[i]) - (px - t.x[i]) * (t.y[j] - t.y[i])) / t.area;
        isInside = isInside && b[k] >= 0;
      }
      if (!isInside) continue;
      const float w = b[0] * t.w[0] + b[1] * t.w[1] + b[2] * t.w[2];
      const float depth = (b[0] * t.w[0] * t.z[0] + b[1] * t.w[1] * t.z[1] + b[2] * t.w[2] * t.z[2]) / w;
      const std::size_t at = s.index(column, row);
      if (depth >= s.depth[at]) continue;
      Vec3f n = t.normal[0] * (b[0] * t.w[0]) + t.normal[1] * (b[1] * t.w[1]) + t.normal[2] * (b[2] * t.w[2]);
      const float size = norm(n);
      n = size > 0 ? n * (1 / size) : Vec3f{0, 0, 1};
      const Vec3f ray = s.view.turn(s.view.perspective ? s.view.at(column, row, 1) : Vec3f{0, 0, 1});
      put(s, at, depth, dot(n, ray) > 0 ? -n : n, t.object);
      if (t.coloured)
        s.colour[at] =
            (t.colour[0] * (b[0] * t.w[0]) + t.colour[1] * (b[1] * t.w[1]) + t.colour[2] * (b[2] * t.w[2])) * (1 / w);
    }
}

} // namespace

View viewTowards(const base::Vec3d& eye, const base::Vec3d& target, const base::Vec3d& up) {
  View v;
  v.eye = eye.as<float>();
  const base::Vec3d forward = normalized(target - eye);
  base::Vec3d right = cross(forward, up);
  if (norm2(right) < 1e-12) right = cross(forward, base::Vec3d{1, 0, 0});
  right = normalized(right);
  v.forward = forward.as<float>(), v.right = right.as<float>(), v.up = cross(right, forward).as<float>();
  return v;
}

namespace {

/// Position index of each vertex; vertices at the same position have the same index.
std::vector<std::uint32_t> placesOf(const base::TriangleMesh& mesh, std::size_t& count) {
  std::vector<std::uint32_t> order(mesh.vertices.size()), place(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto tied = [&](std::uint32_t v) {
    const base::Vec3d& p = mesh.vertices[v];
    return std::tie(p.x, p.y, p.z);
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return tied(a) < tied(b); });
  count = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    count += i == 0 || tied(order[i - 1]) != tied(order[i]);
    place[order[i]] = static_cast<std::uint32_t>(count - 1);
  }
  return place;
}

/// Appends the facets of one mesh to `facets`.
void facetsOf(const RenderMesh& part, std::int32_t object, Facet* facets) {
  const std::vector<std::uint32_t>& corners = part.mesh.indices;
  const std::size_t triangles = corners.size() / 3;
  std::size_t places = 0;
  const std::vector<std::uint32_t> place = placesOf(part.mesh, places);
  // Triangles at each position: those of position p are at[start[p]] ... at[start[p + 1] - 1].
  std::vector<std::uint32_t> start(places + 1, 0), at(3 * triangles);
  for (std::size_t k = 0; k < 3 * triangles; ++k) ++start[place[corners[k]]];
  std::partial_sum(start.begin(), start.end(), start.begin());
  for (std::size_t k = 3 * triangles; k-- > 0;) at[--start[place[corners[k]]]] = static_cast<std::uint32_t>(k / 3);

  std::vector<Vec3f> areaNormal(triangles);
  for (std::size_t t = 0; t < triangles; ++t) {
    Facet& f = facets[t];
    f.object = object, f.oneSided = part.oneSided, f.coloured = !part.vertexColours.empty();
    for (std::size_t k = 0; k < 3 && f.coloured; ++k) f.colour[k] = part.vertexColours[corners[3 * t + k]];
    for (std::size_t k = 0; k < 3; ++k)
      f.corner[k] = part.pose.toWorld(part.mesh.vertices[corners[3 * t + k]]).as<float>();
    areaNormal[t] = cross(f.corner[1] - f.corner[0], f.corner[2] - f.corner[0]);
  }
  for (std::size_t t = 0; t < triangles; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t p = place[corners[3 * t + k]];
      Vec3f sum;
      for (std::uint32_t i = start[p]; i < start[p + 1]; ++i) {
        const Vec3f& other = areaNormal[at[i]];
        if (dot(areaNormal[t], other) > kCreaseCosine * norm(areaNormal[t]) * norm(other)) sum += other;
      }
      const float size = norm(sum);
      facets[t].normal[k] = size > 0 ? sum * (1 / size) : Vec3f{0, 0, 1};
    }
}

} // namespace

std::vector<Facet> facetsOf(const RenderScene& scene) {
  std::vector<std::size_t> first(scene.meshes.size() + 1, 0);
  for (std::size_t m = 0; m < scene.meshes.size(); ++m)
    first[m + 1] = first[m] + scene.meshes[m].mesh.indices.size() / 3;
  std::vector<Facet> facets(first.back());
#pragma omp parallel for schedule(dynamic)
  for (std::size_t m = 0; m < scene.meshes.size(); ++m)
    facetsOf(scene.meshes[m], static_cast<std::int32_t>(scene.spheres.size() + m), facets.data() + first[m]);
  return facets;
}

namespace {

/// All triangles on the screen, in the order of the facets.
std::vector<ScreenTriangle> place(const View& view, const std::vector<Facet>& facets) {
  constexpr std::size_t kChunk = 4096;
  std::vector<std::vector<ScreenTriangle>> parts((facets.size() + kChunk - 1) / kChunk);
#pragma omp parallel for schedule(dynamic)
  for (std::size_t c = 0; c < parts.size(); ++c)
    for (std::size_t i = c * kChunk; i < std::min(facets.size(), (c + 1) * kChunk); ++i)
      place(view, facets[i], parts[c]);
  std::vector<ScreenTriangle> all;
  for (const std::vector<ScreenTriangle>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// Objects overlapping each band of rows, in order.
template <class Placed> std::vector<std::vector<std::uint32_t>> byBand(const std::vector<Placed>& things, int bands) {
  std::vector<std::vector<std::uint32_t>> lists(static_cast<std::size_t>(bands));
  for (std::size_t i = 0; i < things.size(); ++i) {
    const Rectangle& r = things[i].bounds;
    for (int band = r.top / kBandRows; band <= (r.bottom - 1) / kBandRows; ++band)
      lists[static_cast<std::size_t>(band)].push_back(static_cast<std::uint32_t>(i));
  }
  return lists;
}

} // namespace

void rasterise(const std::vector<RenderSphere>& spheres, const std::vector<Facet>& facets, Surfaces& surfaces) {
  const std::vector<PlacedSphere> placed = place(surfaces.view, spheres);
  const std::vector<ScreenTriangle> triangles = place(surfaces.view, facets);
  if (std::any_of(facets.begin(), facets.end(), [](const Facet& f) { return f.coloured; }))
    surfaces.colour.resize(surfaces.depth.size());
  const int bands = (surfaces.view.height + kBandRows - 1) / kBandRows;
  const auto trianglesIn = byBand(triangles, bands), spheresIn = byBand(placed, bands);
#pragma omp parallel for schedule(dynamic)
  for (int band = 0; band < bands; ++band) {
    const int top = band * kBandRows, bottom = std::min(top + kBandRows, surfaces.view.height);
    const auto b = static_cast<std::size_t>(band);
    for (const std::uint32_t i : trianglesIn[b]) draw(triangles[i], top, bottom, surfaces);
    for (const std::uint32_t i : spheresIn[b]) draw(placed[i], top, bottom, surfaces);
  }
}

} // namespace grouser::render::detail
