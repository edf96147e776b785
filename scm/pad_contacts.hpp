// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/part_motion.hpp"
#include "scm/node_contact.hpp"
#include "scm/passive_pressure.hpp"
#include "scm/shear.hpp"

#include <array>
#include <optional>
#include <vector>

namespace grouser::scm {

using base::Vec3d;

/// Flat rectangle of a part in contact with the soil: the plate of a track shoe.
struct Pad {
  int part{};                       ///< index of its part
  Vec3d centre;                     ///< centre in the part's frame [m]
  Vec3d along, across;              ///< unit vectors of its sides; along x across points out of the soil
  double halfLength{}, halfWidth{}; ///< along, across [m]
  double breadth{};                 ///< b of Bekker's relation [m]; in a track its maximum, for a long run of shoes
  /// Pads of one track are in the order of the closed loop; b depends on the run of pads in contact.
  int track = -1;                     ///< -1: no track
  double pitch{};                     ///< distance of neighbouring pads in the track [m]
  std::optional<Grousers> grousers{}; ///< empty: a rough plate, with the soil's own shear strength
};

/// Soil load of one pad on its part.
struct PadLoad {
  Vec3d force, torque; ///< [N], [N m] about the part's centre of mass
  double pressed{};    ///< normal force [N]
  double area{};       ///< contact area [m2]
  double sinkage{};    ///< maximum sinkage [m]
};

/// Contacts of pads with deformable soil. Each node under a pad has a pressure along the pad normal; each of the eight
/// pieces of a pad has a shear stress, and each lateral side a bulldozing resistance. Loads are evaluated at the step's
/// poses; node states and shear advance once per step, from the previous poses.
///
/// A node is weighted by the fraction of its square covered by the pad, clamp((half - |u|) / width + 1/2) along each
/// side, so that area and forces vary continuously with the position on the grid.
class PadContacts {
public:
  static constexpr int kAlong = 2, kAcross = 4; ///< pieces of a pad

  PadContacts(SoilMap& map, LoadedNodes& loaded, std::vector<Pad> pads);

  // One step, in this order; `motion`: indexed by part.
  void gather(const contact::PartMotion* motion); ///< adds the nodes under the pads to the loaded nodes
  void press(const contact::PartMotion* motion, double timeStep, SoilEnergy& energy); ///< computes the loads
  /// Calls move(node, x, y, dx, dy) for the nodes under pads: (x, y) is outside the pad side nearest to the node, (dx,
  /// dy) the unit vector away from the pad.
  template <class Move> void pushAside(const Move& move) const;

  const std::vector<PadLoad>& loads() const { return loads_; } ///< one per pad
  const std::vector<Pad>& pads() const { return pads_; }

  /// Calls look(NodeStress) for each node pressed by a pad, pad by pad.
  template <class Look> void forEachLoaded(const Look& look) const;

  void save(NumberStream& numbers) const;
  void restore(NumberStream& numbers);

private:
  static constexpr int kPieces = kAlong * kAcross;
  struct Contact : NodeContact {
    int piece{};       ///< index of the piece of the pad
    double u{}, v{};   ///< position on the pad [m]
    double pressure{}; ///< [Pa]
  };
  struct Pose {
    Vec3d u, v;   ///< unit vectors of the sides, world
    Vec3d centre; ///< [m]
    Vec3d up() const { return cross(u, v); }
  };
  /// Normal loads of the pieces of a pad.
  struct Pieces {
    std::array<double, kPieces> pressed{};  ///< [N]
    std::array<double, kPieces> touching{}; ///< contact areas [m2]
    std::array<Vec3d, kPieces>
        moment{}; ///< first moments of the forces about the centre, in the plane of the pad [N m]
  };
  /// State of a pad at the end of a step.
  struct Last {
    Pose pose;
    std::array<Shear, kPieces> shear;
    std::array<double, kPieces> strength{}; ///< tau_m times area [N]
    std::array<double, kPieces> area{};     ///< contact area [m2]
    std::array<double, 2> side{};           ///< mobilised fraction of the resistance at +v, -v [-]
    std::array<double, 2> sideStrength{};   ///< [N]
    std::vector<Contact> contacts;
    bool touches = false;
  };

  void updateBreadths();
  void gather(std::size_t pad, const contact::PartMotion& motion);
  void press(std::size_t pad, const contact::PartMotion& motion, double timeStep, SoilEnergy& energy);
  void stream(NumberStream& numbers, std::vector<Last>& all) const;
  Pieces pressNodes(std::size_t pad, const contact::PartMotion& motion, const Pose& pose, double timeStep,
                    SoilEnergy& energy);
  void shearPieces(std::size_t pad, const contact::PartMotion& motion, const Pose& pose, const Pieces& pieces,
                   double timeStep, SoilEnergy& energy);
  void resistAside(std::size_t pad, const contact::PartMotion& motion, const Pose& pose, SoilEnergy& energy);

  SoilMap& map_;
  LoadedNodes& loaded_;
  SideResistance sides_;
  std::vector<Pad> pads_;
  std::vector<ShoeStrength> strengths_; ///< one per pad
  std::vector<double> moduli_;          ///< k of each pad in this step [N/m^(n+2)]
  std::vector<Last> last_;
  std::vector<std::vector<Contact>> now_;
  std::vector<PadLoad> loads_;
};

template <class Move> void PadContacts::pushAside(const Move& move) const {
  for (std::size_t k = 0; k < pads_.size(); ++k) {
    const Last& last = last_[k];
    for (const Contact& c : last.contacts) {
      const double side = c.v < 0 ? -1 : 1;
      const Pose& pose = last.pose;
      const Vec3d place = pose.centre + pose.u * c.u + pose.v * (side * pads_[k].halfWidth), out = pose.v * side;
      const double size = ::sqrt(out.x * out.x + out.y * out.y);
      move(*c.node, place.x, place.y, out.x / size, out.y / size);
    }
  }
}

template <class Look> void PadContacts::forEachLoaded(const Look& look) const {
  const double square = map_.spacing() * map_.spacing();
  for (const Last& last : last_)
    for (const Contact& c : last.contacts) {
      if (!(c.pressure > 0)) continue;
      const auto k = static_cast<std::size_t>(c.piece);
      const double share = c.area * c.node->cosine / square, stress = share * last.strength[k] / last.area[k];
      look(NodeStress{c.i, c.j, c.depth / c.node->cosine, share * c.pressure,
                      (last.pose.u * last.shear[k].x + last.pose.v * last.shear[k].y) * stress});
    }
}

} // namespace grouser::scm
