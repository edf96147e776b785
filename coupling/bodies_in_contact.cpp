// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/bodies_in_contact.hpp"

#include "coupling/ledger_entries.hpp"
#include "coupling/mechanism_setup.hpp"

#include <algorithm>

namespace grouser::coupling {

using base::Vec3d;

void BodiesInContact::addBodies(const MechanismSetup& setup, const multibody::Model& model, const GroundTraits& ground,
                                SphereSets* kept) {
  double size = ground.smallestGrain;
  if (!contactParts_.parts.empty()) size = std::min(size, contactParts_.contactSize); // the vehicle's parts
  addBodyParts(contactParts_, setup, model);
  bodySets_ = cutParts(meshCuts(setup.shapes, model.bodies(), size), kept, ground.comm, &bodyCuts_);
  for (const base::SphereSet& set : bodySets_) contactParts_.surfaces.push_back(&set);
}

BodiesInContact::DriveReading BodiesInContact::drive(int index) const {
  return {model().drives()[static_cast<std::size_t>(index)].law.value(state_.time),
          multibody::driveForce(model(), state_, index), multibody::drivePower(model(), state_, index)};
}

double BodiesInContact::axisSpringForce(int index) const {
  const multibody::AxisSpring& s = model().axisSprings()[static_cast<std::size_t>(index)];
  const multibody::AxisReading axis = multibody::axisReading(model(), state_, s.joint, s.axis);
  return s.preload - s.stiffness * (axis.position - s.freePosition) - s.damping * axis.rate;
}

std::vector<bool> BodiesInContact::touchingBodies() const {
  std::vector<bool> all(model().bodies().size());
  for (const ContactPart& part : contactParts_.parts) all[part.body] = true;
  return all;
}

void BodiesInContact::collectLoads() {
  contacts_->collect(loads_);
  if (!contacts_->solves()) addToMeans();
}

void BodiesInContact::solveContacts() {
  if (!contacts_ || !contacts_->solves()) return;
  if (!jointed_) jointed_ = std::make_unique<JointedBodies>(contactParts_, model(), stepSolver(), replicated_);
  jointed_->begin(state_, loads_, timeStep());
  contacts_->solve(*jointed_, loads_);
  addToMeans();
}

void BodiesInContact::addToMeans() {
  for (ForceMeans* means : means()) {
    if (!means) continue;
    means->sums.resize(contactParts_.count() + contacts_->surfaces());
    for (std::size_t c = 0; c < means->sums.size(); ++c) means->sums[c] += contacts_->groundForce(c);
    ++means->steps;
  }
}

std::vector<Vec3d> BodiesInContact::meanForces(const ForceMeans& means, std::size_t bodies) const {
  std::vector<Vec3d> forces(bodies);
  const double share = means.steps > 0 ? 1 / static_cast<double>(means.steps) : 0.0;
  for (std::size_t c = 0; c < std::min(means.sums.size(), contactParts_.count()); ++c)
    forces[contactParts_.parts[c].body] += contacts_->groundForceQuantum().value(means.sums[c]) * share;
  return forces;
}

Vec3d BodiesInContact::meanForceOn(std::size_t obstacle) const {
  const std::size_t place = contactParts_.count() + obstacle;
  if (rowMeans_.steps == 0 || place >= rowMeans_.sums.size()) return {};
  return contacts_->groundForceQuantum().value(rowMeans_.sums[place]) * (1 / static_cast<double>(rowMeans_.steps));
}

void BodiesInContact::enter(Ledger& ledger, multibody::Balance bodies, double potential, double elastic) const {
  const ContactLedger contacts = contacts_ ? contacts_->ledger() : ContactLedger{};
  // The momentum residual of the grains does not include the impulse of the parts.
  bodies.linearRemainder -= contacts.bed.impulseOnGrains, bodies.angularRemainder += contacts.angularOnParts;
  enterBodies(ledger, bodies);
  enterGrainParts(ledger, contacts.bed);
  ledger.potential += potential, ledger.elastic += elastic + contacts.elastic();
  ledger.dissipated.parts += contacts.rigid.dissipated, ledger.patches += contacts.rigid.patches;
  ledger.soil = contacts.soil, ledger.dissipated.soil += contacts.soil.lost();
  ledger.impulseResidual += contacts.impulseOnParts + contacts.bed.impulseOnGrains;
}

} // namespace grouser::coupling
