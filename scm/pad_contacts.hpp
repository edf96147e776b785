// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/part_motion.hpp"
#include "scm/shear.hpp"
#include "scm/soil_map.hpp"

#include <array>
#include <vector>

namespace grouser::scm {

using base::Vec3d;

/// A flat rectangle on a part that contacts the soil: the plate of a track shoe.
struct Pad {
  int part{};                       ///< index of its part
  Vec3d centre;                  ///< in the part's frame [m]
  Vec3d along, across;              ///< unit vectors of its sides; along x across points away from the soil
  double halfLength{}, halfWidth{}; ///< along, across [m]
  double breadth{};                 ///< b of Bekker's relation [m]
};

/// Elastic energies now, and energies dissipated since the start [J].
struct SoilEnergy {
  double elastic{};      ///< of pressure
  double elasticShear{}; ///< of shear
  double compaction{};   ///< plastic sinkage
  double shear{};        ///< plastic shear
  double damping{};
  double edges{};    ///< elastic energy of soil that leaves a pad sideways or loses contact; negative where soil enters
  double coupling{}; ///< change of elastic shear energy with the pressure

  double lost() const { return compaction + shear + damping + edges + coupling; }
};

/// Load of one pad on its part.
struct PadLoad {
  Vec3d force, torque; ///< [N], [N m] about the part's centre of mass
  double pressed{};    ///< normal force [N]
  double area{};       ///< in contact [m2]
  double sinkage{};    ///< maximum [m]
};

/// Contacts of pads with deformable soil. Each node under a pad has a pressure along the normal of the pad; each of eight
/// pieces of a pad has a shear stress. Loads depend on the poses of the step; node states and shear advance once a step,
/// from the previous poses.
///
/// A node is weighted by the share of its square that the pad covers, clamp((half - |u|) / width + 1/2) along each side, so
/// that area and forces vary continuously with the position on the grid.
class PadContacts {
public:
  static constexpr int kAlong = 2, kAcross = 4; ///< pieces of a pad

  PadContacts(const SoilConstants& soil, double deepest, SoilMap& map, std::vector<Pad> pads);

  /// Advances soil and shear to the poses `motion`, indexed by part, and computes the loads.
  void step(const contact::PartMotion* motion, double timeStep);

  const std::vector<PadLoad>& loads() const { return loads_; } ///< one a pad
  const SoilEnergy& energy() const { return energy_; }
  const std::vector<Pad>& pads() const { return pads_; }

  /// State as numbers: energies, loaded nodes, pads.
  std::vector<double> save() const;
  /// Restores a state that save() returned. Returns false if it belongs to other pads.
  bool restore(const std::vector<double>& saved);

private:
  /// A node near a pad.
  struct Pair {
    std::int32_t i, j;
    Node* node;
    int touched, piece; ///< indices into touched_ and the pad's pieces
    double u, v;     ///< on the pad [m]
    double depth;    ///< along the normal of the undisturbed surface [m]; negative above it
    double share;    ///< of its square under the pad
    double area;     ///< of its square, on the pad [m2]
  };
  /// State of a pad after a step.
  struct Last {
    Vec3d u, v;             ///< its sides [-]
    Vec3d centre;           ///< [m]
    std::array<Shear, kAlong * kAcross> shear;
    std::array<double, kAlong * kAcross> strength{}; ///< tau_m times area [N]
    std::vector<Pair> pairs;
    bool isThere = false;
  };
  /// A node under pads in this step.
  struct Touched {
    Node* node;
    Compaction before; ///< its state before the step
    double deepest;    ///< maximum sinkage under the pads [m]
    double modulus;    ///< maximum k of the pads [N/m^(n+2)]
    bool yields() const { return deepest > before.sinkage; }
  };

  void gather(std::size_t pad, const contact::PartMotion& motion);
  void advanceNodes();
  void press(std::size_t pad, const contact::PartMotion& motion, double timeStep);

  SoilConstants soil_;
  PressureCurve curve_;
  SoilMap& map_;
  std::vector<Pad> pads_;
  std::vector<Last> last_;
  std::vector<std::vector<Pair>> now_;
  std::vector<Touched> touched_;
  std::vector<PadLoad> loads_;
  SoilEnergy energy_;
};

} // namespace grouser::scm
