// SPDX-License-Identifier: BSD-3-Clause
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
  std::vector<double> mass; ///< [body] mass [kg]; 1 for fixed bodies
  double gravity;           ///< [m/s2]

  BodyLaws(const MechanismSetup& setup, const multibody::Model& model)
      : foundations(setup.foundations), gravity(norm(setup.gravity)) {
    for (const multibody::Body& body : model.bodies()) mass.push_back(body.fixed ? 1 : body.mass);
  }
  contact::PatchLaw on(int other, const contact::SurfaceGeometry& shape, int material, std::size_t body) const {
    return patchLaw(foundations.between(material, other), shape, mass[body], gravity);
  }
  contact::PatchLaw on(int other, const BodyShape& s) const { return on(other, s.shape, s.material, s.body); }
};

/// Finds the candidate pairs of shapes and vehicle parts.
class PartPairs {
public:
  PartPairs(const MechanismSetup& setup, const multibody::Model& model, const BodyLaws& laws)
      : shapes_(setup.shapes), bodies_(model.bodies()), laws_(laws) {
    for (const multibody::Joint& joint : model.joints()) tied_.insert(std::minmax(joint.bodyA, joint.bodyB));
  }

  /// Tests the points of the smaller shape against the larger shape. Uses the law of the moving body; if both bodies
  /// move, the law with the shorter relaxation time.
  void addAmongShapes(ContactParts& all, std::size_t first) const {
    for (std::size_t i = 0; i < shapes_.size(); ++i)
      for (std::size_t j = i + 1; j < shapes_.size(); ++j) {
        const BodyShape &a = shapes_[i], &b = shapes_[j];
        if (!mayTouch(a.body, b.body)) continue;
        const bool aMoves = !bodies_[a.body].fixed, bMoves = !bodies_[b.body].fixed;
        contact::PatchLaw law = aMoves ? laws_.on(b.material, a) : laws_.on(a.material, b);
        if (aMoves && bMoves) law.relaxation = std::min(law.relaxation, laws_.on(a.material, b).relaxation);
        const bool swapped = volumeAbout(b.shape) < volumeAbout(a.shape);
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
  const BodyLaws laws(setup, model);
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
                         .material = ofVehicle + s.material,
                         .reach = norm(halfExtent(s.shape)) + norm(s.pose_B.position),
                         .canTouchGround = ground >= 0 && !body.fixed,
                         .fixed = body.fixed,
                         .ofBody = true,
                         .shown = shown + s.body - setup.ofVehicle.bodies});
  }
  all.pointSets += shapes.size();
  all.points = [shapes, firstSet, ofParts = all.points](int set) {
    const auto index = static_cast<std::size_t>(set);
    return index < firstSet ? ofParts(set) : contact::PointTree(surfacePoints(shapes[index - firstSet]));
  };
  all.onObstacle = [laws, ofVehicle, ofParts = all.onObstacle](const ContactPart& part, const Obstacle& o) {
    if (!part.ofBody) return ofParts(part, o);
    return laws.on(laws.foundations.indexOf(o.surface.material), part.shape, part.material - ofVehicle, part.body);
  };
  const PartPairs pairs(setup, model, laws);
  pairs.addAmongShapes(all, first), pairs.addOnVehicle(all, first);
  for (std::size_t b = setup.ofVehicle.bodies; b < bodies.size(); ++b)
    if (!bodies[b].fixed) all.weight += bodies[b].mass * kLoadScale;
  all.weight = std::max(all.weight, 1.0); // fixed bodies have no mass, but loads need a scale
}

} // namespace grouser::coupling
