// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/rigid_contacts.hpp"

#include "contact/patch_contacts.hpp"
#include "contact/point_press.hpp"
#include "terrain/feet_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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
  contact::FoundationPress whole; ///< for laws damped as a whole
  contact::PatchPressure planar;  ///< sum of blocks on planes
  PressureLanes& other;           ///< sum of other blocks, if `any`
  contact::FoundationSums& wholePlanar;
  contact::FoundationLanes& wholeOther; ///< in place of `planar` and `other`
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

contact::FoundationSums inWorld(const contact::FoundationSums& p, const PartMotion& part) {
  contact::FoundationSums w = p;
  const Vec3d lever = part.origin - part.centre;
  const auto turn = [&](const Vec3d& force, const Vec3d& torque, Vec3d& inForce, Vec3d& inTorque) {
    inForce = part.rotation * force, inTorque = part.rotation * torque + cross(lever, inForce);
  };
  turn(p.force, p.torque, w.force, w.torque);
  turn(p.normals, p.turns, w.normals, w.turns);
  turn(p.rated, p.ratedTurns, w.rated, w.ratedTurns);
  w.place = part.rotation * p.place + lever * p.pressed;
  return w;
}

/// A round surface rolls on the points of a part: only its flat ends resist rocking.
void removeRockingOnRound(const SurfaceGeometry& round, const PartMotion& at, const PartMotion& part,
                          contact::FoundationSums& sums) {
  constexpr double kOnEnd = 0.99; // cosine of the angle between normal and axis
  const Vec3d axis =
      transposedTimes(part.rotation, Vec3d{at.rotation.m[0][2], at.rotation.m[1][2], at.rotation.m[2][2]});
  if (round.shape != SurfaceShape::capsule && std::fabs(dot(axis, sums.force)) > kOnEnd * norm(sums.force)) return;
  sums.rocking = 0, sums.normals = sums.turns = sums.rated = sums.ratedTurns = {};
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
  whole_.clear(), tooDeep_.reset();
  for (std::size_t pair = 0; pair < pairs_.size(); ++pair) press(pair, motion, loads);
  if (!whole_.empty()) pressWhole(motion, loads);
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
  if (press.touched.empty()) return;
  if (press.law.law.isWhole())
    press.wholePlanar += contact::foundationOnPlane(press.touched, press.whole, plane.normal, plane.height);
  else
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
  const bool first = !press.any;
  press.any = true;
  if (press.law.law.isWhole()) {
    if (first) press.wholeOther.clear();
    return contact::addFoundation(block, press.whole, normal, overlap, press.wholeOther);
  }
  if (first) press.other.clear();
  contact::pressBlock(block, press.law, normal, overlap, press.other);
}

/// Computes the pressure of one part on one surface. Traverses the point tree of each cluster.
void RigidContacts::press(std::size_t pair, const PartMotion* motion, contact::PartLoad* loads) {
  const Pair& of = pairs_[pair];
  const Surface& surface = surfaces_[static_cast<std::size_t>(of.surface)];
  const PointTree& tree = treeOf(of.part);
  const contact::PartBody* const body = of.law.isWhole() ? &model_.bodies[static_cast<std::size_t>(of.part)] : nullptr;
  PartMotion round;
  if (body && contact::isRound(body->shape)) round = contact::withoutOwnTurn(body->shape, motion[of.part]);
  const PartMotion& part = body && contact::isRound(body->shape) ? round : motion[of.part];
  const std::optional<Plane> plane = planeOf(surface, motion, part);
  if (plane ? plane->height < -tree.reach() : !mayTouch(surface, motion, part.origin, tree.reach())) return;

  Vec3d velocity = part.velocityAt(part.origin), spin = part.spin; // relative to the surface
  if (surface.motion >= 0)
    velocity -= motion[surface.motion].velocityAt(part.origin), spin -= motion[surface.motion].spin;
  const contact::PointPress pointPress{
      of.law, model_.timeStep, {transposedTimes(part.rotation, velocity), transposedTimes(part.rotation, spin)}};
  contact::FoundationPress foundation{pointPress.motion, base::kInfinity};
  if (body) {
    const Vec3d own = transposedTimes(part.rotation, motion[of.part].spin);
    foundation.motion.spin += contact::shapeSpin(body->shape, own) - own;
    if (body->shape.shape == SurfaceShape::capsule)
      foundation.flatWithin = isBall(body->shape) ? -1 : body->shape.half.z;
  }
  std::optional<BoxInPart> box;
  if (surface.kind == Surface::Kind::shape && surface.geometry.shape == SurfaceShape::box)
    box.emplace(surface.geometry.half, motion[surface.motion], part);
  PressureLanes other;
  for (int cluster = 0; cluster < contact::kClusters; ++cluster) {
    if (body) wholePlanar_ = {};
    Press press{surface,      motion,      part,  tree,    box ? &*box : nullptr, pointPress, foundation, {}, other,
                wholePlanar_, wholeOther_, false, touched_};
    if (plane)
      pressOnPlane(press, *plane, tree.firstNode(cluster), tree.firstNode(cluster + 1));
    else
      pressNodes(press, tree.firstNode(cluster), tree.firstNode(cluster + 1));
    if (body) {
      addWhole(pair, cluster, press, motion);
      continue;
    }
    contact::PatchPressure& pressure = press.planar;
    if (press.any) pressure += contact::sumOf(press.other);
    if (!(pressure.area > 0)) continue;
    patches_.press(pair * contact::kClusters + static_cast<std::size_t>(cluster), of.law, motion, of.part,
                   surface.motion, inWorld(pressure, part), loads);
  }
}

/// Adds a patch of a contact that is damped as a whole.
void RigidContacts::addWhole(std::size_t pair, int cluster, const Press& press, const PartMotion* motion) {
  contact::FoundationSums sums = press.wholePlanar;
  if (press.any) sums += contact::sumOf(press.wholeOther);
  if (!(sums.area > 0)) return;
  const Pair& of = pairs_[pair];
  const Surface& surface = surfaces_[static_cast<std::size_t>(of.surface)];
  const contact::PartBody& body = model_.bodies[static_cast<std::size_t>(of.part)];
  const bool known = surface.motion >= 0 && static_cast<std::size_t>(surface.motion) < model_.bodies.size();
  contact::removeOwnMoments(body.shape, sums);
  if (surface.kind == Surface::Kind::shape && contact::isRound(surface.geometry))
    removeRockingOnRound(surface.geometry, motion[surface.motion], press.part, sums);
  const contact::RelativeMotion<double>& moved = press.whole.motion;
  const auto powerOf = [&](const Vec3d& force, const Vec3d& torque) {
    return dot(force, moved.velocity) + dot(torque, moved.spin);
  };
  // Friction acts on the undeformed radius of a round part.
  const Vec3d centre = sums.place * (1 / sums.pressed);
  sums.place = contact::rollingPoint(body.shape, centre) * sums.pressed;
  whole_.push_back({pair * contact::kClusters + static_cast<std::size_t>(cluster), of.part, surface.motion, body.body,
                    known ? model_.bodies[static_cast<std::size_t>(surface.motion)].body : -1, &of.law,
                    inWorld(sums, press.part), powerOf(sums.force, sums.torque), powerOf(sums.normals, sums.turns),
                    powerOf(sums.rated, sums.ratedTurns)});
  const double most = of.law.largestOverlap;
  if (sums.deepest > most && !(tooDeep_ && tooDeep_->overlap * most >= sums.deepest * tooDeep_->most))
    tooDeep_ = {of.part, of.surface, sums.deepest, press.part.toWorld(centre), most};
}

/// Presses all patches of contacts that are damped as a whole.
void RigidContacts::pressWhole(const PartMotion* motion, contact::PartLoad* loads) {
  contact::dampWholeContacts(whole_, model_.bodies, motion, model_.timeStep, damped_);
  for (std::size_t i = 0; i < whole_.size(); ++i) {
    const contact::WholePatch& w = whole_[i];
    contact::PatchLaw law = *w.law;
    law.relaxation = damped_[i].relaxation;
    patches_.press(w.patch, law, motion, w.a, w.b, damped_[i].pressure, loads);
  }
}

} // namespace grouser::terrain
