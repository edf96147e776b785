// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/render/render_scene.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace grouser::render::detail {

using base::Vec3f;

/// Camera of the rasteriser. Camera frame C: x right, y up, z into the picture.
struct View {
  Vec3f eye, right, up, forward;
  bool perspective = true;
  float halfHeight = 1; ///< half picture height at depth 1 (perspective), or at any depth (parallel)
  float near = 0.01f;   ///< near plane (perspective) [m]
  int width = 0, height = 0;

  Vec3f toCamera(const Vec3f& p_W) const {
    const Vec3f d = p_W - eye;
    return {dot(d, right), dot(d, up), dot(d, forward)};
  }
  Vec3f toWorld(const Vec3f& p_C) const { return eye + turn(p_C); }
  Vec3f turn(const Vec3f& v_C) const { return right * v_C.x + up * v_C.y + forward * v_C.z; }
  Vec3f toCameraFrame(const Vec3f& v_W) const { return {dot(v_W, right), dot(v_W, up), dot(v_W, forward)}; }
  float pixelsPerUnit() const { return 0.5f * static_cast<float>(height) / halfHeight; }
  /// Camera-frame coordinates (x, y) of a pixel centre at depth 1; parallel view: at any depth.
  float planeX(int column) const {
    return (static_cast<float>(column) + 0.5f - 0.5f * static_cast<float>(width)) / pixelsPerUnit();
  }
  float planeY(int row) const {
    return (0.5f * static_cast<float>(height) - static_cast<float>(row) - 0.5f) / pixelsPerUnit();
  }
  /// Camera-frame point of a pixel at a depth.
  Vec3f at(int column, int row, float depth) const {
    const float s = perspective ? depth : 1.0f;
    return {planeX(column) * s, planeY(row) * s, depth};
  }
};

/// View from `eye` to `target`.
View viewTowards(const base::Vec3d& eye, const base::Vec3d& target, const base::Vec3d& up);

/// Buffers of visible objects per pixel.
struct Surfaces {
  explicit Surfaces(const View& v)
      : view(v), depth(static_cast<std::size_t>(v.width) * v.height, std::numeric_limits<float>::infinity()),
        normal(depth.size()), object(depth.size(), -1) {}

  View view;
  std::vector<float> depth;                        ///< depth along the camera's z axis; infinite for empty pixels
  std::vector<std::array<std::int16_t, 3>> normal; ///< normal in the world frame, times 32767
  std::vector<std::int32_t> object;                ///< sphere i, or spheres + mesh j; -1: empty
  std::vector<Vec3f> colour;                       ///< vertex colours of meshes; empty: none

  std::size_t index(int column, int row) const { return static_cast<std::size_t>(row) * view.width + column; }
  Vec3f normalAt(std::size_t i) const {
    return Vec3f{float(normal[i][0]), float(normal[i][1]), float(normal[i][2])} * (1.0f / 32767.0f);
  }
};

/// A triangle in the world with the normal at each corner.
struct Facet {
  std::array<Vec3f, 3> corner, normal, colour; ///< `colour`: vertex colours of meshes
  std::int32_t object{};
  bool oneSided{}, coloured{};
};

/// All triangles of a scene; faces that differ by less than 35 degrees have smooth shading between them.
std::vector<Facet> facetsOf(const RenderScene& scene);

/// Renders all objects into the depth buffer.
void rasterise(const std::vector<RenderSphere>& spheres, const std::vector<Facet>& facets, Surfaces& surfaces);

} // namespace grouser::render::detail
