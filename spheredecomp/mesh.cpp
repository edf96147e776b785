// SPDX-License-Identifier: BSD-3-Clause
#include "spheredecomp/mesh.hpp"

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "spheredecomp/detail/obj_text.hpp"
#include "spheredecomp/detail/ply_text.hpp"
#include "spheredecomp/detail/polygon.hpp"

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

namespace grouser::spheredecomp {

TriangleMesh weld(const TriangleMesh& mesh) {
  TriangleMesh welded;
  std::map<std::tuple<double, double, double>, std::uint32_t> seen;
  std::vector<std::uint32_t> target;
  target.reserve(mesh.vertices.size());
  for (const Vec3d& v : mesh.vertices) {
    // Add +0.0, so that -0 and 0 have the same key.
    const auto next = static_cast<std::uint32_t>(welded.vertices.size());
    const auto [it, added] = seen.try_emplace({v.x + 0.0, v.y + 0.0, v.z + 0.0}, next);
    if (added) welded.vertices.push_back(v);
    target.push_back(it->second);
  }
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t a = target[mesh.indices[i]], b = target[mesh.indices[i + 1]], c = target[mesh.indices[i + 2]];
    if (a != b && b != c && c != a) welded.indices.insert(welded.indices.end(), {a, b, c});
  }
  return welded;
}

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Directed edges without a matching opposite edge.
std::vector<Edge> openEdges(const TriangleMesh& mesh) {
  std::vector<Edge> edges, opposite, open;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.indices[i + k], b = mesh.indices[i + (k + 1) % 3];
      edges.emplace_back(a, b);
      opposite.emplace_back(b, a);
    }
  std::sort(edges.begin(), edges.end());
  std::sort(opposite.begin(), opposite.end());
  std::set_difference(edges.begin(), edges.end(), opposite.begin(), opposite.end(), std::back_inserter(open));
  return open;
}

/// Vertices at open edges, ascending by x.
std::vector<std::uint32_t> openVertices(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> found;
  for (const auto& [a, b] : openEdges(mesh)) found.push_back(a), found.push_back(b);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  std::stable_sort(found.begin(), found.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return mesh.vertices[a].x < mesh.vertices[b].x; });
  return found;
}

void checkFinite(const TriangleMesh& mesh, const std::string& name) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (const Vec3d& v = mesh.vertices[i]; !std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
      throw base::InputError(fmt::format("{}: vertex {} of the mesh is not finite: ({}, {}, {}) m; "
                                         "repair it in a mesh editor",
                                         name, i + 1, v.x, v.y, v.z));
}

/// True if the whole mesh is in the plane of its largest triangle.
bool isFlat(const TriangleMesh& mesh) {
  Vec3d normal, point;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Vec3d& a = mesh.vertices[mesh.indices[i]];
    const Vec3d n = cross(mesh.vertices[mesh.indices[i + 1]] - a, mesh.vertices[mesh.indices[i + 2]] - a);
    if (base::norm2(n) > base::norm2(normal)) normal = n, point = a;
  }
  const auto [low, high] = bounds(mesh);
  const double thickness = 1e-6 * norm(high - low) * norm(normal); // float coordinates of a tilted plane
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                     [&](const Vec3d& v) { return std::fabs(dot(v - point, normal)) <= thickness; });
}

/// Volumes below this share of area times diagonal are sums of opposite terms that cancel except for rounding [-].
constexpr double kVolumeRounding = 1e-12;

/// Hint on vertices of open edges that are close together, which indicates rounding gaps; empty without such vertices.
std::string nearOpenVertices(const TriangleMesh& mesh) {
  TriangleMesh welded = mesh;
  const auto [low, high] = bounds(mesh);
  const double tolerance = 1e-3 * norm(high - low);
  const std::size_t near = weldOpenEdges(welded, tolerance);
  return near == 0 ? ""
                   : fmt::format("{} of their vertices are within {:.2g} m of another: merge these by distance in a "
                                 "mesh editor, ",
                                 near, tolerance);
}

} // namespace

void checkClosed(const TriangleMesh& mesh, const std::string& name) {
  if (mesh.indices.size() < 3)
    throw base::InputError(name + ": the mesh has no triangles; export it as a triangulated surface");
  checkFinite(mesh, name);
  if (isFlat(mesh))
    throw base::InputError(name +
                           ": the mesh is flat and encloses no volume; extrude it, or use a thin box or a plane");

  if (const std::vector<Edge> open = openEdges(mesh); !open.empty()) {
    const Vec3d a = mesh.vertices[open.front().first], b = mesh.vertices[open.front().second];
    throw base::InputError(
        fmt::format("{}: the mesh is not watertight: {} open edges, one from ({:.6g}, {:.6g}, {:.6g}) to "
                    "({:.6g}, {:.6g}, {:.6g}) m; {}close the holes and make all faces point outwards",
                    name, open.size(), a.x, a.y, a.z, b.x, b.y, b.z, nearOpenVertices(mesh)));
  }
  const auto [low, high] = bounds(mesh);
  const double volume = signedVolume(mesh), rounding = kVolumeRounding * area(mesh) * norm(high - low);
  if (std::fabs(volume) <= rounding)
    throw base::InputError(name + ": the mesh encloses no volume, since its faces occur in both orientations; delete "
                                  "the faces that point inwards");
  if (!(volume > 0))
    throw base::InputError(
        fmt::format("{}: the mesh encloses {:.3g} m3, i.e. its faces point inwards; flip the faces", name, volume));
}

std::size_t weldOpenEdges(TriangleMesh& mesh, double tolerance) {
  const std::vector<std::uint32_t> open = openVertices(mesh);
  std::vector<std::uint32_t> target(mesh.vertices.size());
  std::iota(target.begin(), target.end(), 0u);
  std::size_t merged = 0;
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (target[open[i]] != open[i]) continue;
    const Vec3d& p = mesh.vertices[open[i]];
    for (std::size_t k = i + 1; k < open.size() && mesh.vertices[open[k]].x - p.x <= tolerance; ++k)
      if (target[open[k]] == open[k] && norm(mesh.vertices[open[k]] - p) <= tolerance)
        target[open[k]] = open[i], ++merged;
  }
  if (merged == 0) return 0;
  TriangleMesh welded = mesh;
  for (std::uint32_t& v : welded.indices) v = target[v];
  for (std::size_t i = 0; i + 2 < welded.indices.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = i + (k + 1) % 3;
      if (welded.indices[i + k] == welded.indices[next] && mesh.indices[i + k] != mesh.indices[next]) return 0;
    }
  for (std::size_t v = 0; v < target.size(); ++v) welded.vertices[v] = mesh.vertices[target[v]];
  mesh = weld(welded);
  return merged;
}

namespace {

/// Tolerance of weldOpenEdges() for equal vertices [largest coordinate]: floats have about seven digits, numbers
/// written by "%.6f" often five.
constexpr double kWeldTolerances[] = {4e-6, 2e-5};

double largestCoordinate(const TriangleMesh& mesh) {
  double largest = 0;
  for (const Vec3d& v : mesh.vertices) largest = std::max({largest, std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  return largest;
}

/// Welds vertices separated by rounding if that closes the mesh; otherwise the mesh is unchanged.
void closeByWelding(TriangleMesh& mesh, const std::string& path, std::string* note) {
  if (openEdges(mesh).empty()) return;
  for (const double share : kWeldTolerances) {
    const double tolerance = share * largestCoordinate(mesh);
    TriangleMesh welded = mesh;
    const std::size_t merged = weldOpenEdges(welded, tolerance);
    if (merged == 0 || !openEdges(welded).empty()) continue;
    mesh = std::move(welded);
    if (note)
      *note = fmt::format("{}: {} vertices at open edges were merged with neighbours within {:.2g} file units "
                          "(rounding)",
                          path, merged, tolerance);
    return;
  }
}

/// Removes repetitions of faces with equal corners and orientation, which would count the volume once for each. Keeps
/// them if the mesh would lose a face that two shells share.
void removeRepeatedFaces(TriangleMesh& mesh, const std::string& path, std::string* note) {
  std::set<std::array<std::uint32_t, 3>> seen;
  TriangleMesh unique{mesh.vertices, {}};
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    std::array<std::uint32_t, 3> face{mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    if (seen.insert(face).second)
      unique.indices.insert(unique.indices.end(), {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
  }
  const std::size_t removed = (mesh.indices.size() - unique.indices.size()) / 3;
  if (removed == 0 || openEdges(unique).size() > openEdges(mesh).size()) return;
  mesh = std::move(unique);
  if (note) *note += fmt::format("{}{}: {} repeated faces were removed", note->empty() ? "" : "; ", path, removed);
}

/// Checks the indices, since assimp's later steps and append() do not: a damaged file may refer to missing vertices.
void checkIndices(const aiScene& scene, const std::string& path) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& part = *scene.mMeshes[m];
    for (unsigned f = 0; f < part.mNumFaces; ++f)
      for (unsigned k = 0; k < part.mFaces[f].mNumIndices; ++k)
        if (part.mFaces[f].mIndices[k] >= part.mNumVertices)
          throw base::InputError(
              fmt::format("{}: corner {} of face {} refers to a vertex beyond the {} of the mesh; the "
                          "file is damaged or truncated; export it again",
                          path, k + 1, f + 1, part.mNumVertices));
  }
}

std::vector<Vec3d> cornersOf(const aiMesh& part, const aiFace& face) {
  std::vector<Vec3d> corners;
  for (unsigned k = 0; k < face.mNumIndices; ++k) {
    const aiVector3D& v = part.mVertices[face.mIndices[k]];
    corners.push_back({v.x, v.y, v.z});
  }
  return corners;
}

/// True if assimp triangulates all faces correctly: it may fail on non-convex outlines of five or more corners, and
/// does not detect self-crossing quads.
bool assimpTriangulates(const aiScene& scene) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& part = *scene.mMeshes[m];
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const unsigned count = part.mFaces[f].mNumIndices;
      if (count == 0) return false; // assimp counts this face as a polygon, and aborts if it finds no other polygon
      if (count <= 3) continue;
      const std::vector<Vec3d> corners = cornersOf(part, part.mFaces[f]);
      if (!detail::isConvex(corners) && (count > 4 || detail::triangulate(corners).empty())) return false;
    }
  }
  return true;
}

/// Shortens a message of assimp, which may quote the rest of the file.
std::string shortened(const std::string& message) {
  constexpr std::size_t kMax = 40;
  const std::size_t from = message.find('"'), to = message.rfind('"');
  if (from == std::string::npos || to - from <= kMax) return message;
  return message.substr(0, from + 1 + kMax) + "..." + message.substr(to);
}

/// Reads all meshes of a file into one frame. assimp triangulates if it does so correctly: its triangles of convex
/// faces must not change, since decompositions depend on them bitwise.
const aiScene& readScene(Assimp::Importer& importer, const std::string& path) {
  const aiScene* scene = importer.ReadFile(path, 0);
  if (scene) {
    checkIndices(*scene, path);
    scene = importer.ApplyPostProcessing(aiProcess_PreTransformVertices);
  }
  if (scene && assimpTriangulates(*scene)) scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (!scene)
    throw base::InputError(fmt::format("{}: cannot be read as a mesh: {}; export it again as OBJ, STL or PLY", path,
                                       shortened(importer.GetErrorString())));
  return *scene;
}

/// Appends the faces of one assimp mesh as triangles.
void append(const aiMesh& part, const std::string& path, TriangleMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned v = 0; v < part.mNumVertices; ++v)
    mesh.vertices.push_back({part.mVertices[v].x, part.mVertices[v].y, part.mVertices[v].z});
  checkFinite(mesh, path); // before faces are cut and vertices welded, since NaN breaks comparisons
  for (unsigned f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    if (face.mNumIndices < 3) continue; // a point or a line
    const std::vector<Vec3d> corners = cornersOf(part, face);
    const auto triangles = detail::triangulate(corners);
    if (triangles.empty())
      throw base::InputError(
          fmt::format("{}: the outline of a face of {} corners crosses itself, one corner at ({:.6g}, "
                      "{:.6g}, {:.6g}) m; repair the face or export triangles",
                      path, corners.size(), corners[0].x, corners[0].y, corners[0].z));
    for (const auto& triangle : triangles)
      for (const std::uint32_t k : triangle) mesh.indices.push_back(first + face.mIndices[k]);
  }
}

/// Checks text files for content that assimp silently misreads, by file extension in any case, like assimp.
void checkText(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (ending == ".obj") detail::checkObj(path);
  if (ending == ".ply") detail::checkPly(path);
}

} // namespace

TriangleMesh importMesh(const std::string& path, std::string* note) {
  base::requireInput(path, "check the path of the mesh file");
  checkText(path);
  Assimp::Importer importer;
  const aiScene& scene = readScene(importer, path);
  TriangleMesh mesh;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) append(*scene.mMeshes[m], path, mesh);
  mesh = weld(mesh);
  closeByWelding(mesh, path, note);
  removeRepeatedFaces(mesh, path, note);
  checkClosed(mesh, path);
  return mesh;
}

double signedVolume(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    sum += dot(mesh.vertices[mesh.indices[i]],
               cross(mesh.vertices[mesh.indices[i + 1]], mesh.vertices[mesh.indices[i + 2]]));
  return sum / 6;
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Vec3d& a = mesh.vertices[mesh.indices[i]];
    sum += norm(cross(mesh.vertices[mesh.indices[i + 1]] - a, mesh.vertices[mesh.indices[i + 2]] - a)) / 2;
  }
  return sum;
}

std::pair<Vec3d, Vec3d> bounds(const TriangleMesh& mesh) {
  Vec3d low = mesh.vertices.at(0), high = low;
  for (const Vec3d& v : mesh.vertices) low = base::min(low, v), high = base::max(high, v);
  return {low, high};
}

} // namespace grouser::spheredecomp
