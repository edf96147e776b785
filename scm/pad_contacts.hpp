// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/part_motion.hpp"
#include "scm/shear.hpp"
#include "scm/soil_map.hpp"

#include <array>
#include <vector>

namespace grouser::scm {

using base::Vec3d;

/// A flat rectangle of a part that presses on the soil: the plate of a track shoe.
struct Pad {
  int part{};                    ///< that it belongs to
  Vec3d centre;                  ///< in the part's frame [m]
  Vec3d along, across;           ///< unit vectors of its sides in that frame; `along` x `across` points out of the soil
  double halfLength{}, halfWidth{}; ///< along, across [m]
  double breadth{};              ///< b of Bekker's relation while it touches alone [m]
};

/// Energies since the start, and those that the soil holds now [J].
struct SoilEnergy {
  double elastic{};      ///< held by pressure
  double elasticShear{}; ///< held by shear
  double compaction{};   ///< lost in plastic sinkage
  double shear{};        ///< lost in plastic shear
  double damping{};
  double edges{};        ///< of soil that came under a pad, or from under it, sideways: less than nothing where it brought
  double coupling{};     ///< of shear that the soil holds while the pressure on it changes

  double lost() const { return compaction + shear + damping + edges + coupling; }
};

/// Loads of one pad on its part.
struct PadLoad {
  Vec3d force, torque; ///< [N], [N m] about the part's centre of mass
  double pressed{};    ///< normal force [N]
  double area{};       ///< that bears [m2]
  double sinkage{};    ///< greatest [m]
};

/// Pads on deformable soil: pressure of each node under a pad by its memory, along the pad's normal, and shear of eight
/// pieces of each pad. Loads of a step follow from poses; memory advances once a step, from one pose to the next.
///
/// A node counts with the share of its square that the pad covers, clamp((half - |u|) / spacing + 1/2) along each side: the
/// area of a pad does not depend on how it lies on the grid, and forces are continuous.
class PadContacts {
public:
  static constexpr int kAlong = 2, kAcross = 4; ///< pieces of a pad

  PadContacts(const SoilConstants& soil, double deepest, SoilMap& map, std::vector<Pad> pads);

  /// Moves all pads to these poses ([part] of the pads), advances the soil's memory, and computes the loads.
  void step(const contact::PartMotion* motion, double timeStep);

  const std::vector<PadLoad>& loads() const { return loads_; } ///< one a pad
  const SoilEnergy& energy() const { return energy_; }
  const std::vector<Pad>& pads() const { return pads_; }

  /// All that later steps depend on, as numbers: energies, soil that has been loaded, pads.
  std::vector<double> save() const;
  /// Puts back what save() returned of the same pads. False where it is of others.
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
  /// A pad at rest between two steps.
  struct Last {
    Vec3d u, v;             ///< its sides [-]
    Vec3d centre;           ///< [m]
    std::array<Shear, kAlong * kAcross> shear;
    std::array<double, kAlong * kAcross> strength{}; ///< tau_m times area [N]
    std::vector<Pair> pairs;
    bool isThere = false;
  };
  /// A node in this step: its memory before, and how deep the deepest pad on it goes.
  struct Touched {
    Node* node;
    Compaction before;
    double deepest;
    double modulus;
  };

  void gather(std::size_t pad, const contact::PartMotion& motion);
  void advanceMemory();
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
