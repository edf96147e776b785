// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/rigid_ground.hpp"

#include "coupling/ledger_entries.hpp"
#include "coupling/vehicle_parts.hpp"
#include "coupling/vehicle_state.hpp"

namespace grouser::coupling {

GroundTraits RigidGround::traits() const {
  GroundTraits traits;
  traits.hullMeets = &*laid_.rigid;
  traits.onHost = true;
  return traits;
}

LoadQuanta RigidGround::meet(const PartsOnGround& on) {
  const vehicle::ContactSpec& spec = on.assembly.spec.contact;
  const contact::PatchLaw law{spec.foundationModulus, spec.relaxationTime, 0, spec.tangentialRatio};
  using Contacts = terrain::RigidContacts;
  const Contacts::Surface field{Contacts::Surface::Kind::field, {}, -1, -1, spec.frictionGround};
  std::vector<Contacts::Pair> pairs;
  for (const int part : on.assembly.groundParts) pairs.push_back({on.parts.contactIndex(part), 0});
  shoes_ = std::make_unique<Contacts>(Contacts::Model{law, on.quanta, on.timeStep}, on.parts.points(pairs),
                                      on.parts.setOfContactPart(), std::vector{field}, pairs,
                                      std::vector<const base::SphereSet*>{}, &*laid_.rigid);
  return {on.quanta.force, on.quanta.torque};
}

void RigidGround::addContactsTo(ContactLedger& ledger) const { ledger.rigid += shoes_->ledger(); }

void RigidGround::saveContacts(VehicleState& state) const { state.ground = shoes_->save(); }
void RigidGround::restoreContacts(const VehicleState& state) { shoes_->restore(state.ground); }

} // namespace grouser::coupling
