// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/rigid_ground.hpp"

#include "coupling/contact_parts.hpp"
#include "coupling/contacts_state.hpp"
#include "coupling/ledger_entries.hpp"
#include "coupling/obstacle_contacts.hpp"

namespace grouser::coupling {

GroundTraits RigidGround::traits() const {
  GroundTraits traits;
  traits.hullGround = &*laid_.rigid;
  traits.onHost = true;
  return traits;
}

LoadQuanta RigidGround::meet(const PartsOnGround& on) {
  using Contacts = terrain::RigidContacts;
  const Contacts::Surface field{Contacts::Surface::Kind::field, {}, -1, -1};
  std::vector<Contacts::Pair> pairs;
  std::vector<int> feet;
  parts_ = &on.parts;
  for (std::size_t c = 0; c < on.parts.count(); ++c)
    if (const ContactPart& part = on.parts.parts[c]; part.canTouchGround)
      feet.push_back(static_cast<int>(c)), pairs.push_back({feet.back(), 0, part.foundation});
  feet_ = std::make_unique<Contacts>(Contacts::Model{on.quanta, on.timeStep, on.parts.massOfParts()},
                                     on.parts.pointsOf(feet), on.parts.pointsOfPart(), std::vector{field}, pairs,
                                     std::vector<const base::SphereSet*>{}, &*laid_.rigid);
  return {on.quanta.force, on.quanta.torque};
}

void RigidGround::collect(const contact::PartLoad&) {
  if (feet_->tooDeep()) failTooDeep(*parts_, *feet_->tooDeep(), "the ground");
}

void RigidGround::addContactsTo(ContactLedger& ledger) const { ledger.rigid += feet_->ledger(); }

void RigidGround::saveContacts(ContactsState& state) const { state.ground = feet_->save(); }
void RigidGround::restoreContacts(const ContactsState& state) { feet_->restore(state.ground); }

} // namespace grouser::coupling
