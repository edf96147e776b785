// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/fixed_point.hpp"
#include "base/position.hpp"
#include "base/vec.hpp"
#include "contact/contact_law.hpp"
#include "contact/surface_geometry.hpp"

#include <algorithm>
#include <vector>

/// Parameters and history of contacts of grains with rigid parts.
namespace grouser::contact {

/// Maximum number of patches per grain and part. Contacts merge into one patch per cluster of surface normals: one on a
/// face, two in a corner or between two teeth.
inline constexpr int kPatches = 3;

/// Tangential spring of a patch, in the part frame so that it rotates with the part. A zero normal marks an unused
/// entry.
struct PatchMemory {
  base::Vec3f normal, shear;
};

/// A rigid part, for contacts with grains.
struct GrainPart {
  int surface{};               ///< index of its unique sphere set; -1 for a closed-form shape
  base::Vec3d boxLow, boxHigh; ///< bounding box of the set, in its frame [m]; far away if grains do not contact it
  bool meets{true};            ///< true: grains contact it
  int firstLaw{};              ///< index of the law of the first grain material against the part
  SurfaceGeometry shape{};     ///< closed-form shape, if it has no sphere set
};

/// Sums over the contacts of grains with parts, as integers: energies and forces in quanta.
enum PartSum : int {
  kPatchesNow,      ///< patches in contact in this step
  kElasticNow,      ///< elastic energy
  kDeepOverlapsNow, ///< pairs of grain and part with overlap / radius above kDeepOverlap
  kCappedNow,       ///< patches at the crushing force
  kDampedByParts,   ///< cumulative, like all sums below
  kSumsOfStep = kDampedByParts,
  kSlidingLossByParts,
  kRolledByParts,
  kSlippedByParts,
  kCrushedByParts,   ///< dissipated by crushing
  kCutByCrushing,    ///< force removed by the cap, summed over steps
  kReceivedByGrains, ///< x, y, z: force, summed over steps
  kPartSums = kReceivedByGrains + 3
};

/// Constants of the contacts between grains and parts. Kernels take a copy. Forces are computed in single precision.
struct GrainPartModel {
  double radius{}, mass{}; ///< radius and mass of the grains, or of the largest grain [m], [kg]
  double timeStep{};       ///< [s]
  double margin{};         ///< maximum motion of parts relative to the grains before the pairs are listed again [m]
  ContactLaw law;
  base::PositionScale scale;
  base::FixedPoint force, torque, energy; ///< quanta of the sums
  bool manyRadii{false};                  ///< each grain has its own radius in velocity.w and material in spin.w
  double gap{0};                          ///< maximum gap of PartPatches [m]; 0 with penalty contacts
  std::size_t searchFrom{0}; ///< minimum number of pairs for a search of near pairs; 0: 8192 on a GPU, never on a CPU
};

/// Parameters by grain material, if grains differ: laws against the parts (replace GrainPartModel::law), and masses.
struct GrainPartMaterials {
  std::vector<ContactLaw> laws;    ///< all grain materials against the first part material, then the second...
  std::vector<double> massPerCube; ///< mass / radius^3 [kg/m3]
  std::vector<double> crushing{};  ///< crushing strength [Pa], 0: does not crush; empty: no material crushes

  bool crush() const {
    return std::any_of(crushing.begin(), crushing.end(), [](double strength) { return strength > 0; });
  }
};

} // namespace grouser::contact
