// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/jointed_bodies.hpp"
#include "coupling/mechanism_setup.hpp"
#include "coupling/obstacles.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <set>
#include <utility>

namespace grouser::coupling {

namespace {

/// Volume of the bounding box of a shape [m3].
double volumeAbout(const contact::SurfaceGeometry& g) {
  const base::Vec3d h = halfExtent(g);
  return 8 * h.x * h.y * h.z;
}

/// Laws of the bodies' shapes against materials.
struct BodyLaws {
  FoundationTable foundations;

  contact::PatchLaw on(int other, int material, double largestOverlap) const {
    contact::PatchLaw law = patchLaw(foundations.between(material, other));
    law.largestOverlap = largestOverlap;
    return law;
  }
  contact::PatchLaw on(int other, const BodyShape& s) const { return on(other, s.material, s.largestOverlap); }
  /// Law on a surface of the scene, whose thickness limits the overlap, too. Planes have none, tubes are hollow.
  contact::PatchLaw onObstacle(const Obstacle& o, int material, double largestOverlap) const {
    contact::PatchLaw law = on(foundations.indexOf(o.surface.material), material, largestOverlap);
    const contact::SurfaceGeometry& g = o.surface.geometry;
    if (g.shape != contact::SurfaceShape::plane && g.shape != contact::SurfaceShape::tube)
      law.largestOverlap = std::min(law.largestOverlap, kLargestOverlap * thinnest(g));
    return law;
  }
};

/// Mass properties of a part of a body.
contact::PartBody massOf(const multibody::Body& body, std::size_t index, const base::Pose& pose_B) {
  contact::PartBody part;
  if (body.fixed) return part;
  part.body = static_cast<int>(index), part.inverseMass = 1 / body.mass;
  const base::Mat3d r = pose_B.orientation.matrix(), turned = inverseOf(body.inertia_B) * r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) part.inverseInertia.m[i][j] += r.m[k][i] * turned.m[k][j];
  return part;
}

/// True if shape `a` provides the points, and `b` the surface: the smaller shape, but the round one on a box unless its
/// points are too far apart for the box.
bool providesPoints(const BodyShape& a, const BodyShape& b) {
  const bool boxA = a.shape.shape == contact::SurfaceShape::box, boxB = b.shape.shape == contact::SurfaceShape::box;
  if (!a.mesh && !b.mesh && boxA != boxB) {
    constexpr double kSpacing = 0.05; // largest distance of the points of a round shape [radius]
    const BodyShape &round = boxA ? b : a, &box = boxA ? a : b;
    if (kSpacing * round.shape.half.x < thinnest(box.shape)) return boxB;
  }
  return !(volumeAbout(b.shape) < volumeAbout(a.shape));
}

/// Finds the candidate pairs of shapes and vehicle parts.
class PartPairs {
public:
  PartPairs(const MechanismSetup& setup, const multibody::Model& model, const BodyLaws& laws)
      : shapes_(setup.shapes), bodies_(model.bodies()), laws_(laws) {
    for (const multibody::Joint& joint : model.joints()) tied_.insert(std::minmax(joint.bodyA, joint.bodyB));
  }

  void addAmongShapes(ContactParts& all, std::size_t first) const {
    for (std::size_t i = 0; i < shapes_.size(); ++i)
      for (std::size_t j = i + 1; j < shapes_.size(); ++j) {
        const BodyShape &a = shapes_[i], &b = shapes_[j];
        if (!mayTouch(a.body, b.body)) continue;
        contact::PatchLaw law = laws_.on(b.material, a);
        law.largestOverlap = std::min(law.largestOverlap, b.largestOverlap);
        const bool swapped = !providesPoints(a, b);
        all.pairs.push_back(
            {static_cast<int>(first + (swapped ? j : i)), static_cast<int>(first + (swapped ? i : j)), law});
      }
  }

  /// Tests the points of the vehicle's shoes, and of all its parts cut into spheres, against the shapes.
  void addOnVehicle(ContactParts& all, std::size_t first) const {
    for (std::size_t part = 0; part < first; ++part) {
      const ContactPart& p = all.parts[part];
      if (!p.canTouchGround && all.surfaces[static_cast<std::size_t>(p.surface)]->spheres.empty()) continue;
      for (std::size_t j = 0; j < shapes_.size(); ++j) {
        const BodyShape& s = shapes_[j];
        if (!mayTouch(p.body, s.body)) continue;
        contact::PatchLaw law = laws_.on(s.material, s);
        law.friction = laws_.foundations.onVehicle[static_cast<std::size_t>(s.material)];
        all.pairs.push_back({static_cast<int>(part), static_cast<int>(first + j), law});
      }
    }
  }

private:
  bool mayTouch(std::size_t a, std::size_t b) const {
    return a != b && !(bodies_[a].fixed && bodies_[b].fixed) &&
           !tied_.contains(std::minmax(static_cast<int>(a), static_cast<int>(b)));
  }

  const std::vector<BodyShape>& shapes_;
  const std::vector<multibody::Body>& bodies_;
  const BodyLaws& laws_;
  std::set<std::pair<int, int>> tied_; ///< bodies connected by a joint
};

} // namespace

void addBodyParts(ContactParts& all, const MechanismSetup& setup, const multibody::Model& model) {
  const std::vector<multibody::Body>& bodies = model.bodies();
  const std::size_t first = all.parts.size(), firstSet = all.pointSets;
  const BodyLaws laws{setup.foundations};
  const int ground = setup.foundations.ground;
  // Materials of the parts: the vehicle's material, if there is a vehicle, then the materials of the shapes.
  const int ofVehicle = first > 0 ? 1 : 0;
  std::size_t shown = 0; // number of vehicle parts in the frames
  for (const ContactPart& part : all.parts) shown = std::max(shown, part.shown + 1);
  if (first == 0) all.contactSize = base::kInfinity;
  std::vector<BodyShape> shapes; // distinct surfaces
  std::vector<int> surfaces;     // [distinct surface] its index in all.surfaces; -1: closed form
  int nextMesh = static_cast<int>(all.surfaces.size());
  for (const BodyShape& s : setup.shapes) {
    const auto same = std::find_if(shapes.begin(), shapes.end(), [&](const auto& b) { return sameSurface(b, s); });
    const auto index = static_cast<std::size_t>(same - shapes.begin());
    if (same == shapes.end()) shapes.push_back(s), surfaces.push_back(s.mesh ? nextMesh++ : -1);
    all.contactSize = std::min(all.contactSize, minFeature(s));
    const multibody::Body& body = bodies[s.body];
    all.parts.push_back({.name = fmt::format("body \"{}\"", body.name),
                         .body = s.body,
                         .pose_B = s.pose_B,
                         .surface = surfaces[index],
                         .shape = s.shape,
                         .mesh = s.mesh ? s.mesh->query : nullptr,
                         .points = static_cast<int>(firstSet + index),
                         .foundation = ground < 0 ? contact::PatchLaw{} : laws.on(ground, s),
                         .massOf = massOf(body, s.body, s.pose_B),
                         .largestOverlap = s.largestOverlap,
                         .material = ofVehicle + s.material,
                         .reach = norm(halfExtent(s.shape)) + norm(s.pose_B.position),
                         .canTouchGround = ground >= 0 && !body.fixed,
                         .fixed = body.fixed,
                         .ofBody = true,
                         .shown = shown + s.body - setup.ofVehicle.bodies});
    if (!s.mesh) all.parts.back().massOf.shape = s.shape;
  }
  for (std::size_t part = 0; part < first; ++part)
    all.parts[part].massOf = massOf(bodies[all.parts[part].body], all.parts[part].body, all.parts[part].pose_B);
  all.pointSets += shapes.size();
  all.points = [shapes, firstSet, ofParts = all.points](int set) {
    const auto index = static_cast<std::size_t>(set);
    return index < firstSet ? ofParts(set) : contact::PointTree(surfacePoints(shapes[index - firstSet]));
  };
  all.onObstacle = [laws, ofVehicle, ofParts = all.onObstacle](const ContactPart& part, const Obstacle& o) {
    if (!part.ofBody) return ofParts(part, o);
    return laws.onObstacle(o, part.material - ofVehicle, part.largestOverlap);
  };
  const PartPairs pairs(setup, model, laws);
  pairs.addAmongShapes(all, first), pairs.addOnVehicle(all, first);
  for (std::size_t b = setup.ofVehicle.bodies; b < bodies.size(); ++b)
    if (!bodies[b].fixed) all.weight += bodies[b].mass * kLoadScale;
  all.weight = std::max(all.weight, 1.0); // fixed bodies have no mass, but loads need a scale
}

} // namespace grouser::coupling
