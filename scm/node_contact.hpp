// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scm/loaded_nodes.hpp"
#include "scm/number_stream.hpp"
#include "scm/soil_energy.hpp"

#include <utility>
#include <vector>

namespace grouser::scm {

inline constexpr double kNear = 5e-3;    ///< [m] nodes are listed up to this height of a body above them
inline constexpr double kSteepest = 0.2; ///< minimum cosine between the normal of a body's surface and the vertical

/// Contact of a body with a node from one step to the next.
struct NodeContact {
  std::int32_t i{}, j{};
  Node* node{};
  int loaded{};     ///< index among the loaded nodes of this step
  double depth{};   ///< below the undisturbed surface, along its normal [m]; negative above it
  double area{};    ///< of soil in contact, on the undisturbed surface [m2]; energies refer to it
  double face{};    ///< of the body in contact [m2]
  double offset{};  ///< as LoadedNode
  double elastic{}; ///< elastic energy per area [J/m2]
  bool onLoose{};   ///< as LoadedNode
};

/// Stress under a body at a node, as a mean over the square of the node.
struct NodeStress {
  std::int32_t i{}, j{};
  double depth{};    ///< of the body below the undisturbed surface [m], vertical
  double pressure{}; ///< [Pa] without damping
  base::Vec3d shear; ///< on the soil [Pa]
};

/// Pressure of the soil on a contact [Pa]. Completes the contact with its elastic energy and adds the energies of the
/// step. `former`: the same contact in the last step; null if there was none.
double press(NodeContact& contact, const NodeContact* former, const LoadedNodes& loaded, SoilEnergy& energy);
/// Adds the loss of a contact that ended.
inline void release(const NodeContact& former, SoilEnergy& energy) { energy.edges += former.area * former.elastic; }

/// Adds the energies of a shear force to those of the step. Its strength, tau_m times area, was `before` and is
/// `strength` [N]; `square`: |s|^2 now; `loss`: as ShearWork [m].
inline void addShear(SoilEnergy& energy, double K, double before, double strength, double square, double loss) {
  energy.shear += before * loss;
  energy.coupling -= 0.5 * K * square * (strength - before);
  energy.elasticShear += 0.5 * K * square * strength;
}
/// Adds the loss of a shear force whose contact ended.
inline void releaseShear(SoilEnergy& energy, double K, double strength, double square) {
  energy.edges += 0.5 * K * square * strength;
}

/// Contacts of the last step, by row and column of their nodes, in step with those of this one.
template <class Contact> class FormerContacts {
public:
  explicit FormerContacts(const std::vector<Contact>& all) : at_(all.begin()), end_(all.end()) {}

  /// The former contact of the same node, or null. Calls ended() for contacts that come before.
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

/// Writes or reads the contacts of a body. `rest`: of what a contact has in addition.
template <class Contact, class Rest>
void streamContacts(NumberStream& numbers, std::vector<Contact>& contacts, SoilMap& map, const Rest& rest) {
  numbers.size(contacts);
  for (Contact& c : contacts) {
    numbers(c.i, c.j, c.depth, c.area, c.face, c.offset, c.elastic, c.onLoose), rest(c);
    c.node = &map.at(c.i, c.j);
  }
}

} // namespace grouser::scm
