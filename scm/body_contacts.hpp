// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scm/node_contact.hpp"
#include "scm/underside.hpp"

#include <array>
#include <vector>

namespace grouser::scm {

/// Soil load on a body.
struct BodyLoad {
  Vec3d force, torque; ///< [N], [N m] about the part's centre of mass
  double area{};       ///< contact area [m2]
  double sinkage{};    ///< maximum sinkage [m]
};

/// Contacts of rigid bodies of any shape with deformable soil: wheels, plates, stones. The underside of a body is
/// sampled along the vertical through each node. Pressure acts along the normal of the body; each contact of body and
/// node has its own shear stress, initially zero. Node squares partly covered by the body are weighted by the covered
/// fraction of 16 sample points.
class BodyContacts {
public:
  BodyContacts(SoilMap& map, LoadedNodes& loaded, std::vector<Solid> solids);

  // Stages of a step, as in PadContacts.
  void gather(const contact::PartMotion* motion);
  void press(const contact::PartMotion* motion, double timeStep, SoilEnergy& energy);
  template <class Move> void pushAside(const Move& move) const;
  template <class Look> void forEachLoaded(const Look& look) const;
  void save(NumberStream& numbers) const;
  void restore(NumberStream& numbers);

  const std::vector<BodyLoad>& loads() const { return loads_; } ///< one per solid
  const std::vector<Solid>& solids() const { return solids_; }

private:
  struct Contact : NodeContact {
    double z{};        ///< height of the contact point [m]
    Vec3d up;          ///< unit normal into the body, world
    double pressure{}; ///< [Pa]
    double strength{}; ///< tau_m [Pa]
    Vec3d shear;       ///< direction and mobilised fraction, world, in the tangent plane [-]
  };
  struct Last {
    contact::PartMotion motion;
    std::vector<Contact> contacts;
  };

  void gather(std::size_t body, const contact::PartMotion& motion);
  void press(std::size_t body, const contact::PartMotion& motion, double timeStep, SoilEnergy& energy);
  void stream(NumberStream& numbers, std::vector<Last>& all) const;

  SoilMap& map_;
  LoadedNodes& loaded_;
  std::vector<Solid> solids_;
  std::vector<Last> last_;
  std::vector<std::vector<Contact>> now_;
  std::vector<BodyLoad> loads_;
};

template <class Move> void BodyContacts::pushAside(const Move& move) const {
  for (const Last& last : last_)
    for (const Contact& c : last.contacts) {
      const double x = map_.spacing() * c.i, y = map_.spacing() * c.j;
      const double dx = x - last.motion.origin.x, dy = y - last.motion.origin.y, size = ::sqrt(dx * dx + dy * dy);
      if (size > 0) move(*c.node, x, y, dx / size, dy / size);
    }
}

template <class Look> void BodyContacts::forEachLoaded(const Look& look) const {
  const double square = map_.spacing() * map_.spacing();
  for (const Last& last : last_)
    for (const Contact& c : last.contacts) {
      if (!(c.pressure > 0)) continue;
      const double share = c.area * c.node->cosine / square;
      look(NodeStress{c.i, c.j, c.depth / c.node->cosine, share * c.pressure, c.shear * (share * c.strength)});
    }
}

} // namespace grouser::scm
