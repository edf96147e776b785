// SPDX-License-Identifier: BSD-3-Clause
#include "runs/detail/raster.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace grouser::runs::detail {

namespace {

constexpr float kCreaseCosine = 0.82f; ///< of 35 degrees
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

/// Ends of the sphere's shadow on the plane at depth 1, along one axis: tangents from the eye in the plane of z and it.
std::pair<float, float> tangents(float x, float z, float radius) {
  const float t = std::sqrt(x * x + z * z - radius * radius);
  return {(x * t - radius * z) / (z * t + radius * x), (x * t + radius * z) / (z * t - radius * x)};
}

Rectangle sphereBounds(const View& v, const Vec3f& c, float radius) {
  std::pair<float, float> x{c.x - radius, c.x + radius}, y{c.y - radius, c.y + radius};
  if (v.perspective) x = tangents(c.x, c.z, radius), y = tangents(c.y, c.z, radius);
  const float scale = v.pixelsPerUnit(), middleX = 0.5f * float(v.width), middleY = 0.5f * float(v.height);
  const auto clampTo = [](float p, int n) { return static_cast<int>(std::clamp(p, 0.0f, float(n))); };
  return {clampTo(middleX + x.first * scale, v.width), clampTo(middleX + x.second * scale + 1, v.width),
          clampTo(middleY - y.second * scale, v.height), clampTo(middleY - y.first * scale + 1, v.height)};
}

struct PlacedSphere {
  Vec3f centre_C;
  float radius;
  Rectangle bounds;
  std::int32_t object;
};

std::vector<PlacedSphere> place(const View& view, const std::vector<RenderSphere>& spheres) {
  std::vector<PlacedSphere> placed;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Vec3f c = view.toCamera(spheres[i].centre);
    if (view.perspective && c.z < spheres[i].radius + view.near) continue;
    const Rectangle r = sphereBounds(view, c, spheres[i].radius);
    if (r.left < r.right && r.top < r.bottom) placed.push_back({c, spheres[i].radius, r, static_cast<std::int32_t>(i)});
  }
  return placed;
}

void draw(const PlacedSphere& sphere, int top, int bottom, Surfaces& s) {
  const View& v = s.view;
  const Vec3f& c = sphere.centre_C;
  for (int row = std::max(top, sphere.bounds.top); row < std::min(bottom, sphere.bounds.bottom); ++row)
    for (int column = sphere.bounds.left; column < sphere.bounds.right; ++column) {
      // Foot of the centre on the ray, then back along it: no difference of large squares.
      const Vec3f origin = v.perspective ? Vec3f{} : Vec3f{v.planeX(column), v.planeY(row), 0};
      const Vec3f along = v.perspective ? Vec3f{v.planeX(column), v.planeY(row), 1} : Vec3f{0, 0, 1};
      const float a = dot(along, along), foot = dot(c - origin, along) / a;
      const Vec3f away = c - origin - along * foot;
      const float inside = sphere.radius * sphere.radius - dot(away, away);
      if (inside <= 0) continue;
      const float depth = foot - std::sqrt(inside / a);
      const std::size_t i = s.index(column, row);
      if (depth >= s.depth[i]) continue;
      const Vec3f normal_C = (origin + along * depth - c) * (1.0f / sphere.radius);
      put(s, i, depth, v.turn(normal_C), sphere.object);
    }
}

struct Corner {
  Vec3f p_C, normal;
};

/// The part of a triangle beyond the near plane: none, three or four corners.
std::vector<Corner> clipped(const Facet& f, const View& view) {
  std::vector<Corner> in, out;
  for (std::size_t k = 0; k < 3; ++k) in.push_back({view.toCamera(f.corner[k]), f.normal[k]});
  if (!view.perspective) return in;
  for (std::size_t k = 0; k < 3; ++k) {
    const Corner &a = in[k], &b = in[(k + 1) % 3];
    const bool aIn = a.p_C.z > view.near, bIn = b.p_C.z > view.near;
    if (aIn) out.push_back(a);
    if (aIn != bIn) {
      const float t = (view.near - a.p_C.z) / (b.p_C.z - a.p_C.z);
      out.push_back({a.p_C + (b.p_C - a.p_C) * t, a.normal + (b.normal - a.normal) * t});
    }
  }
  return out;
}

/// One triangle on the screen; `w` is 1/depth (perspective) or 1 (parallel): what is linear over the screen is value w.
struct ScreenTriangle {
  std::array<float, 3> x, y, z, w;
  std::array<Vec3f, 3> normal;
  float area;
  Rectangle bounds;
  std::int32_t object;
};

void place(const View& view, const Facet& facet, std::vector<ScreenTriangle>& list) {
  const std::vector<Corner> corners = clipped(facet, view);
  for (std::size_t k = 2; k < corners.size(); ++k) {
    ScreenTriangle t;
    const Corner* c[3] = {&corners[0], &corners[k - 1], &corners[k]};
    for (std::size_t i = 0; i < 3; ++i) {
      t.z[i] = c[i]->p_C.z, t.w[i] = view.perspective ? 1 / t.z[i] : 1, t.normal[i] = c[i]->normal;
      t.x[i] = 0.5f * float(view.width) + c[i]->p_C.x * t.w[i] * view.pixelsPerUnit();
      t.y[i] = 0.5f * float(view.height) - c[i]->p_C.y * t.w[i] * view.pixelsPerUnit();
    }
    t.area = (t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) - (t.x[2] - t.x[0]) * (t.y[1] - t.y[0]);
    if (t.area == 0) continue;
    const auto [x0, x1] = std::minmax_element(t.x.begin(), t.x.end());
    const auto [y0, y1] = std::minmax_element(t.y.begin(), t.y.end());
    const auto clampTo = [](float p, int n) { return static_cast<int>(std::clamp(p, 0.0f, float(n))); };
    t.bounds = {clampTo(*x0, view.width), clampTo(*x1 + 1, view.width), clampTo(*y0, view.height),
                clampTo(*y1 + 1, view.height)};
    t.object = facet.object;
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

std::vector<Facet> facetsOf(const RenderScene& scene) {
  std::vector<Facet> facets;
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    const RenderMesh& part = scene.meshes[m];
    const std::size_t first = facets.size();
    // Faces round each place of the mesh, whatever vertices they name it by.
    std::map<std::tuple<double, double, double>, std::vector<Vec3f>> facesAt;
    const auto key = [&](std::uint32_t v) {
      const base::Vec3d& p = part.mesh.vertices[v];
      return std::tuple{p.x, p.y, p.z};
    };
    for (std::size_t i = 0; i + 2 < part.mesh.indices.size(); i += 3) {
      Facet f;
      f.object = static_cast<std::int32_t>(scene.spheres.size() + m);
      for (std::size_t k = 0; k < 3; ++k)
        f.corner[k] = part.pose.toWorld(part.mesh.vertices[part.mesh.indices[i + k]]).as<float>();
      const Vec3f areaNormal = cross(f.corner[1] - f.corner[0], f.corner[2] - f.corner[0]);
      f.normal.fill(areaNormal);
      for (std::size_t k = 0; k < 3; ++k) facesAt[key(part.mesh.indices[i + k])].push_back(areaNormal);
      facets.push_back(f);
    }
    for (std::size_t i = first; i < facets.size(); ++i) {
      const Vec3f own = facets[i].normal[0];
      for (std::size_t k = 0; k < 3; ++k) {
        Vec3f sum;
        for (const Vec3f& other : facesAt[key(part.mesh.indices[3 * (i - first) + k])])
          if (dot(own, other) > kCreaseCosine * norm(own) * norm(other)) sum += other;
        const float size = norm(sum);
        facets[i].normal[k] = size > 0 ? sum * (1 / size) : Vec3f{0, 0, 1};
      }
    }
  }
  return facets;
}

void rasterise(const std::vector<RenderSphere>& spheres, const std::vector<Facet>& facets, Surfaces& surfaces) {
  const std::vector<PlacedSphere> placed = place(surfaces.view, spheres);
  std::vector<ScreenTriangle> triangles;
  for (const Facet& f : facets) place(surfaces.view, f, triangles);
  const int bands = (surfaces.view.height + kBandRows - 1) / kBandRows;
#pragma omp parallel for schedule(dynamic)
  for (int band = 0; band < bands; ++band) {
    const int top = band * kBandRows, bottom = std::min(top + kBandRows, surfaces.view.height);
    for (const PlacedSphere& p : placed) draw(p, top, bottom, surfaces);
    for (const ScreenTriangle& t : triangles)
      if (t.bounds.bottom > top && t.bounds.top < bottom) draw(t, top, bottom, surfaces);
  }
}

} // namespace grouser::runs::detail
