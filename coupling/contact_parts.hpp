// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "base/sphere_set.hpp"
#include "contact/part_motion.hpp"
#include "contact/patch_law.hpp"
#include "contact/point_tree.hpp"
#include "contact/surface_geometry.hpp"
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

/// A rigid contact surface fixed to a body: a part of a vehicle, or a shape of a [[body]].
struct ContactPart {
  std::string name;                 ///< in messages: "left shoe 12"
  std::size_t body{};               ///< index of its body in the multibody model
  base::Pose pose_B;                ///< pose of the surface's frame P in the body's frame: X_BP
  int surface{};                    ///< index into ContactParts::surfaces; -1: the closed-form `shape`
  contact::SurfaceGeometry shape{}; ///< geometry of a [[body.shape]]; its bounding box if `surface` >= 0
  std::shared_ptr<const spheredecomp::MeshQuery> mesh{}; ///< of a [[body.shape]]; null for closed-form shapes
  int points{-1};                 ///< index of its surface points for contact with rigid surfaces; -1: none
  contact::PatchLaw foundation{}; ///< on rigid ground
  int material{};                 ///< index of its material among those of all parts
  double reach{};                 ///< farthest point of the surface from its body's centre of mass [m]
  bool meetsGrains = true;        ///< whether it touches grains
  bool meetsGround{};             ///< whether it touches rigid ground as a foot; a hull touches it with the obstacles
  bool fixed{};                   ///< its body never moves, so it touches no resting surface
  bool ofBody{};                  ///< belongs to a [[body]], not to the vehicle
  bool isHull{};                  ///< whether it touches rigid ground with the obstacles
  std::size_t shown{};            ///< its place among the parts of the results' frames
};

/// Acceleration that turns a total mass into the scale of loads, whatever the scene's gravity is [m/s2].
inline constexpr double kLoadScale = 9.81;

struct Obstacle;

/// All parts with contacts, and their surfaces. Must outlive the contacts made from it.
struct ContactParts {
  /// A part whose points touch the closed-form shape or the spheres of another.
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
  /// Elastic foundation of a part on an obstacle.
  std::function<contact::PatchLaw(const ContactPart&, const Obstacle&)> onObstacle;
  double contactSize{}; ///< smallest feature at which parts and obstacles meet [m]
  double weight{};      ///< total weight [N], which scales the load quanta

  std::size_t count() const { return parts.size(); }
  /// [part] index of its surface.
  std::vector<int> surfaceOfPart() const;
  /// [part] index of its surface points.
  std::vector<int> pointsOfPart() const;
  /// [set] points of those that a part of `touching` has; the others are empty.
  std::vector<contact::PointTree> pointsOf(const std::vector<int>& touching) const;
  contact::PartMotion motionOf(std::size_t part, const multibody::State& state) const;
};

} // namespace grouser::coupling
