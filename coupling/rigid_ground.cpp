// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/rigid_ground.hpp"

#include "coupling/ledger_entries.hpp"
#include "coupling/vehicle_parts.hpp"
#include "coupling/vehicle_state.hpp"

namespace grouser::coupling {

GroundTraits RigidGround::traits() const {
  GroundTraits traits;
  traits.hullMeets = &*laid_.rigid;
  return traits;
}

LoadQuanta RigidGround::meet(const PartsOnGround& on) {
  const vehicle::ContactSpec& spec = on.assembly.spec.contact;
  const contact::PatchLaw law{spec.foundationModulus, spec.relaxationTime, spec.frictionGround, spec.tangentialRatio};
  std::vector<int> shoes;
  for (const int part : on.assembly.groundParts) shoes.push_back(on.parts.contactIndex(part));
  shoes_ = std::make_unique<terrain::GroundContacts>(
      exec_, terrain::GroundContacts::Model{law, on.quanta, on.timeStep, on.margin}, *laid_.rigid, on.parts.sets(),
      on.parts.setOfContactPart(), shoes);
  return {on.quanta.force, on.quanta.torque};
}

/// Few samples touch: not on a stream of their own.
void RigidGround::compute(const base::Exec&, const base::Array<contact::PartMotion>& motion, const double* travelled,
                          contact::PartLoad* loads) {
  shoes_->compute(motion, travelled, loads);
}

void RigidGround::addContactsTo(ContactLedger& ledger) const { ledger.rigid += shoes_->ledger(); }

void RigidGround::saveContacts(VehicleState& state) const { state.ground = shoes_->save(); }
void RigidGround::restoreContacts(const VehicleState& state) { shoes_->restore(state.ground); }

} // namespace grouser::coupling
