// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "base/sphere_set.hpp"
#include "contact/part_motion.hpp"
#include "contact/patch_law.hpp"
#include "contact/point_tree.hpp"
#include "contact/surface_geometry.hpp"
#include "contact/whole_contact.hpp"
#include "multibody/state.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace grouser::spheredecomp {
class MeshQuery;
}

namespace grouser::coupling {

/// Rigid contact surface fixed to a body: a part of a vehicle, or a shape of a [[body]].
struct ContactPart {
  std::string name;                 ///< name in messages: "left shoe 12"
  std::size_t body{};               ///< index of its body in the multibody model
  base::Pose pose_B;                ///< pose of the surface frame P in the body frame: X_BP
  int surface{};                    ///< index into ContactParts::surfaces; -1: the closed-form `shape`
  contact::SurfaceGeometry shape{}; ///< geometry of a [[body.shape]]; its bounding box if `surface` >= 0
  std::shared_ptr<const spheredecomp::MeshQuery> mesh{}; ///< mesh of a [[body.shape]]; null for closed-form shapes
  int points{-1};                 ///< index of its surface points for contact with rigid surfaces; -1: none
  contact::PatchLaw foundation{}; ///< law of contacts with rigid ground
  contact::PartBody massOf{};     ///< mass and closed form, in scenes with bodies
  double largestOverlap{};        ///< limit of the overlaps of a [[body.shape]] [m]
  int material{};                 ///< index of its material in the list for all parts
  double reach{};                 ///< bounding radius of the surface about its body's centre of mass [m]
  bool canTouchGrains = true;     ///< true: in contact with grains
  bool canTouchGround{};          ///< true: in contact with rigid ground as a foot; a hull touches it as an obstacle
  bool fixed{};                   ///< immovable body: no contact with surfaces at rest
  bool ofBody{};                  ///< belongs to a [[body]], not to the vehicle
  bool isHull{};                  ///< true: in contact with rigid ground as an obstacle
  std::size_t shown{};            ///< index among the parts in the frames of the results
};

/// Acceleration that converts total mass to the scale of the loads, independent of the scene's gravity [m/s2].
inline constexpr double kLoadScale = 9.81;

struct Obstacle;

/// All parts with contacts, and their surfaces. Must outlive the contacts created from it.
struct ContactParts {
  /// Pair of parts: surface points of one against the closed-form shape or spheres of the other.
  struct Pair {
    int part{}, other{};
    contact::PatchLaw law;
  };

  std::vector<ContactPart> parts;
  std::vector<const base::SphereSet*> surfaces;
  std::size_t pointSets{}; ///< number of values of ContactPart::points
  /// Surface points of a set, for contact with rigid ground, obstacles and shapes.
  std::function<contact::PointTree(int set)> points;
  std::vector<Pair> pairs;
  /// Elastic foundation between a part and an obstacle.
  std::function<contact::PatchLaw(const ContactPart&, const Obstacle&)> onObstacle;
  double contactSize{}; ///< smallest contact feature of parts and obstacles [m]
  double weight{};      ///< total weight [N], which sets the scale of the load quanta

  std::size_t count() const { return parts.size(); }
  std::vector<contact::PartBody> massOfParts() const;
  /// [part] index of its surface.
  std::vector<int> surfaceOfPart() const;
  /// [part] index of its surface points.
  std::vector<int> pointsOfPart() const;
  /// [set] surface points used by the parts in `touching`; the other sets are empty.
  std::vector<contact::PointTree> pointsOf(const std::vector<int>& touching) const;
  contact::PartMotion motionOf(std::size_t part, const multibody::State& state) const;
};

} // namespace grouser::coupling
