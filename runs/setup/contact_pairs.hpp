// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/setup/grain_kinds.hpp"
#include "runs/setup/scene_surfaces.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace grouser::setup {

/// A contact partner of grains.
struct ContactPartner {
  /// surface: planes that move or have a name, boxes, cylinders and meshes.
  enum class Kind { grains, bedWalls, plane, surface, floor, vehicle, body };
  Kind kind{};
  std::string material;             ///< empty: the grain's material (vehicle without a material)
  std::string name;                 ///< "the floor", "box drum"; grains: their material
  std::size_t number = 0;           ///< plane, body: index in the scene; surface: index into `surfaces`
  std::optional<double> friction{}; ///< replaces the friction of the materials [-]

  const std::string& materialAgainst(const std::string& grain) const { return material.empty() ? grain : material; }
  /// Effective mass / grain mass in a contact with this partner [-], likewise for the radius: half for equal grains.
  double share() const { return kind == Kind::grains ? 0.5 : 1; }
};

/// The kinds of grains of a scene and all their possible contact partners. All lists of laws, contacts and materials in
/// contact are based on this struct.
struct ContactPairs {
  GrainKinds kinds;
  std::vector<SceneSurface> surfaces;
  /// Grains by their kind, walls of the bed, planes in the order of the file, the other surfaces, floor, vehicle,
  /// bodies with shapes.
  std::vector<ContactPartner> partners;

  explicit ContactPairs(const scene::Scene& scene);
  /// Returns true for a plane, moving or not.
  bool isPlane(const ContactPartner& partner) const;
};

} // namespace grouser::setup
