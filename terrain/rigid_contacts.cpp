// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/rigid_contacts.hpp"

#include "contact/patch_contacts.hpp"
#include "contact/point_press.hpp"
#include "terrain/feet_search.hpp"

#include <algorithm>
#include <array>

namespace grouser::terrain {

using base::Vec3d;
using contact::PartMotion;
using contact::PointBlock;
using contact::PointLanes;
using contact::PointTree;
using contact::PressureLanes;
using contact::Vec3P;

/// Contact pressure of one cluster of a part on one surface, in the part frame.
struct RigidContacts::Press {
  const Surface& surface;
  const PartMotion* motion;
  const PartMotion& part;
  const PointTree& tree;
  const BoxInPart* box; ///< the surface, if it is a box
  contact::PointPress law;
  contact::PatchPressure planar; ///< sum of blocks on planes
  PressureLanes& other;          ///< sum of other blocks, if `any`
  bool any;
  std::vector<const PointBlock*>& touched; ///< scratch: blocks that may touch a plane
};

namespace {

/// Thread group of size one for deepestDisc().
struct Alone {
  static constexpr int width = 1;
  int rank = 0;
  void agreeOnGreatest(double&, std::uint32_t&) const {}
};

/// Converts from the part frame and its origin to world axes and the centre of mass.
contact::PatchPressure inWorld(const contact::PatchPressure& p, const PartMotion& part) {
  contact::PatchPressure w = p;
  const Vec3d lever = part.origin - part.centre;
  w.force = part.rotation * p.force;
  w.torque = part.rotation * p.torque + cross(lever, w.force);
  w.place = part.rotation * p.place + lever * p.weight;
  return w;
}

} // namespace

RigidContacts::RigidContacts(const Model& model, std::vector<PointTree> points, const std::vector<int>& setOfPart,
                             const std::vector<Surface>& surfaces, const std::vector<Pair>& pairs,
                             const std::vector<const base::SphereSet*>& meshes, const HeightField* field)
    : model_(model), points_(std::move(points)), setOfPart_(setOfPart), surfaces_(surfaces), pairs_(pairs),
      patches_(model.quanta, model.timeStep, pairs.size() * contact::kClusters) {
  double widest = 0;
  for (const Pair& pair : pairs) widest = std::max(widest, treeOf(pair.part).widest());
  const base::Exec host = base::cpuExec(1);
  for (const base::SphereSet* mesh : meshes)
    grids_.emplace_back(host, *mesh, widest, std::max(0.004, 0.75 * mesh->spacing));
  if (!field) return;
  field_ = SearchedHeightField(host, *field, widest);
  if (!field->isPlane()) {
    cells_ = HeightFieldCells(*field);
    feet_ = FootLanes(field_.view());
    return;
  }
  const SurfaceJet jet = field->view().jet(field->area().xMin, field->area().yMin);
  const Vec3d normal = base::normalized(Vec3d{-jet.hx, -jet.hy, 1});
  fieldPlane_ = Plane{normal, dot(normal, Vec3d{field->area().xMin, field->area().yMin, jet.h})};
}

void RigidContacts::compute(const PartMotion* motion, contact::PartLoad* loads) {
  patches_.beginStep();
  for (std::size_t pair = 0; pair < pairs_.size(); ++pair) press(pair, motion, loads);
  patches_.endStep();
}

/// Returns the plane, in the part frame, if the whole surface is planar.
std::optional<Plane> RigidContacts::planeOf(const Surface& s, const PartMotion* motion, const PartMotion& part) const {
  if (s.kind == Surface::Kind::field) return fieldPlane_ ? std::optional(inPart(*fieldPlane_, part)) : std::nullopt;
  if (s.kind != Surface::Kind::shape || s.geometry.shape != SurfaceShape::plane) return {};
  const PartMotion& at = motion[s.motion];
  const Vec3d normal{at.rotation.m[0][2], at.rotation.m[1][2], at.rotation.m[2][2]};
  return inPart({normal, dot(normal, at.origin)}, part);
}

/// False if a ball cannot touch the surface.
bool RigidContacts::mayTouch(const Surface& s, const PartMotion* motion, const Vec3d& x, double radius) const {
  if (s.kind == Surface::Kind::field)
    return cells_.near(x - Vec3d{radius, radius, radius}, x + Vec3d{radius, radius, radius});
  const PartMotion& at = motion[s.motion];
  if (s.kind == Surface::Kind::shape) return gapTo(s.geometry, at.toPart(x)).distance < radius;
  return grids_[static_cast<std::size_t>(s.set)].view().reaches(at.toPart(x), radius);
}

/// Finds the outward normal of the surface and the overlap of a ball.
bool RigidContacts::touches(const Surface& s, const PartMotion* motion, const Vec3d& x, double radius, Vec3d& normal,
                            double& overlap) const {
  if (s.kind == Surface::Kind::field) {
    FootPoint foot;
    if (field_.view().clearOf(x, radius) || !deepestFoot(field_.view(), x, radius, foot)) return false;
    overlap = radius - foot.distance, normal = foot.normal;
    return overlap > 0;
  }
  const PartMotion& at = motion[s.motion];
  if (s.kind == Surface::Kind::mesh)
    return contact::deepestDisc(grids_[static_cast<std::size_t>(s.set)].view(), at, x, radius, Alone{}, normal,
                                overlap);
  const SurfaceGap gap = gapTo(s.geometry, at.toPart(x));
  overlap = radius - gap.distance, normal = at.rotation * gap.normal;
  return overlap > 0;
}

/// Finds normals and overlaps of the points of a block, in the part frame. Returns false if no point touches.
bool RigidContacts::gapsOf(const PointBlock& block, const Surface& s, const PartMotion* motion, const PartMotion& part,
                           Vec3P& normal, PointLanes& overlap) const {
  std::array<Vec3d, contact::kPointLanes> x;
  for (std::size_t l = 0; l < x.size(); ++l)
    x[l] = part.toWorld({block.place.x[l], block.place.y[l], block.place.z[l]});
  unsigned found = 0;
  normal = contact::allLanes(Vec3d{}), overlap = contact::allLanes(0);
  if (s.kind == Surface::Kind::field) {
    Vec3P centre;
    for (std::size_t l = 0; l < x.size(); ++l) centre.x[l] = x[l].x, centre.y[l] = x[l].y, centre.z[l] = x[l].z;
    found = feet_.find(centre, block.radius, normal, overlap);
  }
  bool any = false;
  for (std::size_t l = 0; l < static_cast<std::size_t>(block.count); ++l) {
    Vec3d out{normal.x[l], normal.y[l], normal.z[l]};
    double depth = overlap[l];
    const bool touching = found >> l & 1u ? depth > 0 : touches(s, motion, x[l], block.radius[l], out, depth);
    const Vec3d local = touching ? transposedTimes(part.rotation, out) : Vec3d{};
    normal.x[l] = local.x, normal.y[l] = local.y, normal.z[l] = local.z, overlap[l] = touching ? depth : 0;
    any = any || touching;
  }
  return any;
}

/// Adds the blocks of nodes [from, to), all over one plane.
void RigidContacts::pressOnPlane(Press& press, const Plane& plane, std::uint32_t from, std::uint32_t to) const {
  press.touched.clear();
  for (std::uint32_t n = from; n < to;) {
    const PointTree::Node& node = press.tree.nodes()[n];
    const bool clear = clearOf(plane, node);
    if (!clear && node.block >= 0) press.touched.push_back(&press.tree.block(node.block));
    n = clear ? node.behind : n + 1;
  }
  if (!press.touched.empty())
    press.planar += contact::pressOnPlane(press.touched, press.law, plane.normal, plane.height);
}

/// True if points of a node may touch the surface. Sets `plane` if the surface is planar below all of them.
bool RigidContacts::mayTouch(const Press& press, const PointTree::Node& node, std::optional<Plane>& plane) const {
  if (press.box) {
    if (press.box->clearOf(node)) return false;
    plane = press.box->faceFor(node);
    return true;
  }
  const PartMotion& part = press.part;
  const Vec3d centre = part.toWorld(node.centre);
  if (press.surface.kind != Surface::Kind::field) return mayTouch(press.surface, press.motion, centre, norm(node.half));
  const auto extent = [&](int row) {
    const double(&m)[3] = part.rotation.m[row];
    return std::fabs(m[0]) * node.half.x + std::fabs(m[1]) * node.half.y + std::fabs(m[2]) * node.half.z;
  };
  const Vec3d half{extent(0), extent(1), extent(2)};
  if (!cells_.near(centre - half, centre + half)) return false;
  const HeightFieldCells::Under under = cells_.under(centre - half, centre + half);
  if (under.plane) plane = inPart(*under.plane, part);
  if (under.plane || std::isinf(under.curvature)) return true;
  // Within the box the surface is below its tangent plane, raised by the curvature.
  const SurfaceJet jet = field_.view().jet(centre.x, centre.y);
  const Vec3d normal = base::normalized(Vec3d{-jet.hx, -jet.hy, 1});
  const double raised = 0.5 * under.curvature * (half.x * half.x + half.y * half.y);
  return !clearOf(inPart({normal, dot(normal, Vec3d{centre.x, centre.y, jet.h + raised})}, part), node);
}

/// Adds the blocks of nodes [from, to).
void RigidContacts::pressNodes(Press& press, std::uint32_t from, std::uint32_t to) const {
  for (std::uint32_t n = from; n < to;) {
    const PointTree::Node& node = press.tree.nodes()[n];
    std::optional<Plane> plane;
    const bool near = mayTouch(press, node, plane);
    if (near && !plane && node.block < 0) {
      ++n;
      continue;
    }
    if (plane)
      pressOnPlane(press, *plane, n, node.behind);
    else if (near)
      pressBlock(press, press.tree.block(node.block));
    n = node.behind;
  }
}

/// Adds a block on a surface that is not planar under it.
void RigidContacts::pressBlock(Press& press, const PointBlock& block) const {
  Vec3P normal;
  PointLanes overlap;
  if (!gapsOf(block, press.surface, press.motion, press.part, normal, overlap)) return;
  if (!press.any) press.other.clear();
  press.any = true;
  contact::pressBlock(block, press.law, normal, overlap, press.other);
}

/// Computes the pressure of one part on one surface. Traverses the point tree of each cluster.
void RigidContacts::press(std::size_t pair, const PartMotion* motion, contact::PartLoad* loads) {
  const Pair& of = pairs_[pair];
  const Surface& surface = surfaces_[static_cast<std::size_t>(of.surface)];
  const PointTree& tree = treeOf(of.part);
  const PartMotion& part = motion[of.part];
  const std::optional<Plane> plane = planeOf(surface, motion, part);
  if (plane ? plane->height < -tree.reach() : !mayTouch(surface, motion, part.origin, tree.reach())) return;

  Vec3d velocity = part.velocityAt(part.origin), spin = part.spin; // relative to the surface
  if (surface.motion >= 0)
    velocity -= motion[surface.motion].velocityAt(part.origin), spin -= motion[surface.motion].spin;
  const contact::PointPress pointPress{
      of.law, model_.timeStep, {transposedTimes(part.rotation, velocity), transposedTimes(part.rotation, spin)}};
  std::optional<BoxInPart> box;
  if (surface.kind == Surface::Kind::shape && surface.geometry.shape == SurfaceShape::box)
    box.emplace(surface.geometry.half, motion[surface.motion], part);
  PressureLanes other;
  for (int cluster = 0; cluster < contact::kClusters; ++cluster) {
    Press press{surface, motion, part, tree, box ? &*box : nullptr, pointPress, {}, other, false, touched_};
    if (plane)
      pressOnPlane(press, *plane, tree.firstNode(cluster), tree.firstNode(cluster + 1));
    else
      pressNodes(press, tree.firstNode(cluster), tree.firstNode(cluster + 1));
    contact::PatchPressure& pressure = press.planar;
    if (press.any) pressure += contact::sumOf(press.other);
    if (!(pressure.area > 0)) continue;
    patches_.press(pair * contact::kClusters + static_cast<std::size_t>(cluster), of.law, motion, of.part,
                   surface.motion, inWorld(pressure, part), loads);
  }
}

} // namespace grouser::terrain
