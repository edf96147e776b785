// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scm/facets.hpp"
#include "scm/node_contact.hpp"
#include "scm/underside.hpp"

#include <cstddef>
#include <vector>

namespace grouser::scm {

/// Soil load on a body.
struct BodyLoad {
  Vec3d force, torque; ///< [N], [N m] about the part's centre of mass
  double area{};       ///< contact area [m2]
  double sinkage{};    ///< maximum sinkage [m]
};

/// Contacts of rigid bodies of any shape with deformable soil: wheels, plates, stones. The underside of a body is cut
/// by the squares of the nodes. A facet at the angle alpha to the soil surface is pressed along its normal, with the
/// pressure that its node has at the mean depth of the body in the square. Two corrections apply to steep facets:
/// - The pressure is at most f max(1, n) cos(alpha) times that of Bekker's relation, because a vertical sinkage z moves
///   the soil by z cos(alpha) along the facet's normal, and its pressure is at most k_u z cos(alpha) (Compaction). It
///   vanishes on vertical facets.
/// - Facets steeper than 60 degrees span a range of depths within a square. They become flanks, fully beyond 78
/// degrees:
///   their pressure is the integral of Bekker's relation over the depth, times the mean ratio of pressure to virgin
///   pressure of the body's other facets. A flank that moves away from the soil loses its pressure along the unloading
///   line of its mean depth.
/// All of these are continuous in the tilt. Each contact of body and node has its own shear stress, initially zero.
class BodyContacts {
public:
  BodyContacts(SoilMap& map, LoadedNodes& loaded, std::vector<Solid> solids);

  // Stages of a step, as in PadContacts; solids of one body must be adjacent.
  void gather(const contact::PartMotion* motion);
  void press(const contact::PartMotion* motion, double timeStep, SoilEnergy& energy);
  template <class Move> void pushAside(const Move& move) const;
  template <class Look> void forEachLoaded(const Look& look) const;
  void save(NumberStream& numbers) const;
  void restore(NumberStream& numbers);

  const std::vector<BodyLoad>& loads() const { return loads_; } ///< one per solid; the first of a body has all
  const std::vector<Solid>& solids() const { return solids_; }

private:
  struct Contact : NodeContact {
    Vec3d place;       ///< contact point [m]
    Vec3d up;          ///< unit normal into the body, world
    double pressure{}; ///< mean over `face` [Pa]
    double retreat{};  ///< flank: distance by which it has moved away from the soil [m]; see pressFlank()
    double cohesive{}; ///< share of the face with cohesion [-]
    double strength{}; ///< tau_m [Pa]
    Vec3d shear;       ///< direction and mobilised fraction, world, in the tangent plane [-]
  };
  struct Last {
    contact::PartMotion motion;
    std::vector<Contact> contacts, flanks;
  };
  /// Solids of one body.
  struct Body {
    std::size_t first{}, count{};
  };
  struct Step; // data of a body's step

  void gather(std::size_t body, const contact::PartMotion* motion);
  void gather(std::size_t body, const Cell& cell, double k);
  void press(std::size_t body, const contact::PartMotion& motion, double timeStep, SoilEnergy& energy);
  /// Reduces the pressure of a flank that moves away from the soil, and adds the work of the flank to the losses.
  void pressFlank(Contact& contact, const Contact* before, const Step& step) const;
  /// Adds the load of a contact with a known pressure, and returns its shear displacement in the step [m].
  double add(Contact& contact, const Contact* before, const Step& step) const;
  void stream(NumberStream& numbers, std::vector<Last>& all) const;

  SoilMap& map_;
  LoadedNodes& loaded_;
  std::vector<Solid> solids_;
  std::vector<Body> bodies_;
  Underside underside_;
  std::vector<Last> last_;
  std::vector<std::vector<Contact>> now_, flanksNow_;
  std::vector<BodyLoad> loads_;
  Polygon wet_;
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
