// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scm/loaded_nodes.hpp"
#include "scm/number_stream.hpp"
#include "scm/soil_energy.hpp"

#include <utility>
#include <vector>

namespace grouser::scm {

inline constexpr double kNear = 5e-3;    ///< [m] maximum height of a body above the nodes listed under it
inline constexpr double kSteepest = 0.2; ///< minimum cosine between the normal of a body's surface and the vertical

/// Contact of a body with a node, stored from one step to the next.
struct NodeContact {
  std::int32_t i{}, j{};
  Node* node{};
  int loaded{};     ///< index among the loaded nodes of the step
  double depth{};   ///< depth below the undisturbed surface, along its normal [m]; negative above it
  double area{};    ///< soil area in contact, on the undisturbed surface [m2]; reference of energies per area
  double face{};    ///< body area in contact [m2]
  double offset{};  ///< see LoadedNode
  double elastic{}; ///< elastic energy per area [J/m2]
  bool onLoose{};   ///< see LoadedNode
};

/// Stress under a body at a node, averaged over the node's square.
struct NodeStress {
  std::int32_t i{}, j{};
  double depth{};    ///< depth of the body below the undisturbed surface [m], vertical
  double pressure{}; ///< [Pa] without damping
  base::Vec3d shear; ///< shear stress on the soil [Pa]
};

/// Returns the soil pressure on a contact [Pa]. Completes the contact with its elastic energy and adds the energies of
/// the step. `former`: the same contact in the last step; null for a new contact.
double press(NodeContact& contact, const NodeContact* former, const LoadedNodes& loaded, SoilEnergy& energy);
/// Adds the loss of a contact that ended.
inline void release(const NodeContact& former, SoilEnergy& energy) { energy.edges += former.area * former.elastic; }

/// Adds the energies of a shear force to the step's sums. Its strength, tau_m times area, was `before` and is now
/// `strength` [N]; `square`: current |s|^2; `loss`: as in ShearWork [m].
inline void addShear(SoilEnergy& energy, double K, double before, double strength, double square, double loss) {
  energy.shear += before * loss;
  energy.coupling -= 0.5 * K * square * (strength - before);
  energy.elasticShear += 0.5 * K * square * strength;
}
/// Adds the loss of the shear force of an ended contact.
inline void releaseShear(SoilEnergy& energy, double K, double strength, double square) {
  energy.edges += 0.5 * K * square * strength;
}

/// Contacts of the last step by node row and column, for parallel traversal with the current contacts.
template <class Contact> class FormerContacts {
public:
  explicit FormerContacts(const std::vector<Contact>& all) : at_(all.begin()), end_(all.end()) {}

  /// Returns the former contact of the same node, or null. Calls ended() for each former contact skipped before it.
  template <class Ended> const Contact* match(const Contact& now, const Ended& ended) {
    while (at_ != end_ && std::pair(at_->j, at_->i) < std::pair(now.j, now.i)) ended(*at_++);
    return at_ != end_ && at_->j == now.j && at_->i == now.i ? &*at_++ : nullptr;
  }
  template <class Ended> void finish(const Ended& ended) {
    while (at_ != end_) ended(*at_++);
  }

private:
  typename std::vector<Contact>::const_iterator at_, end_;
};

/// Writes or reads the contacts of a body. `rest`: does the same for additional data of a contact.
template <class Contact, class Rest>
void streamContacts(NumberStream& numbers, std::vector<Contact>& contacts, SoilMap& map, const Rest& rest) {
  numbers.size(contacts);
  for (Contact& c : contacts) {
    numbers(c.i, c.j, c.depth, c.area, c.face, c.offset, c.elastic, c.onLoose), rest(c);
    c.node = &map.at(c.i, c.j);
  }
}

} // namespace grouser::scm
