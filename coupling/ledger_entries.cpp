// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/ledger_entries.hpp"

#include "fluid/fluid.hpp"

namespace grouser::coupling {

void enterGrains(Ledger& l, const terrain::GrainLedger& g) {
  l.kinetic += g.kinetic + g.rotational, l.potential += g.potential;
  l.elastic += g.elastic, l.grainElastic += g.elastic;
  l.dissipated.damping += g.damped, l.dissipated.friction += g.rubbed, l.dissipated.microSlip += g.slipped;
  l.dissipated.rolling += g.rolled, l.dissipated.yielding += g.yielded;
  l.dissipated.stabilisation -= g.stabilised;
  l.work += g.work, l.turnover += g.turnover;
  l.momentum += g.momentum, l.angularMomentum += g.angularMomentum;
  l.momentumResidual += g.momentum - g.impulse, l.angularResidual += g.angularMomentum - g.angularImpulse;
  l.grainContacts += g.contacts, l.boundaryContacts += g.boundaryContacts;
  l.deepPairs += g.squeezed, l.deepAtBoundaries += g.deepAtBoundaries;
  l.deepestOverlap = g.deepestOverlap, l.fastestGrain = g.fastest;
}

void enterGrainParts(Ledger& l, const contact::GrainPartContacts::Ledger& c) {
  l.dissipated.damping += c.damped, l.dissipated.friction += c.rubbed, l.dissipated.microSlip += c.slipped;
  l.dissipated.rolling += c.rolled, l.dissipated.crushing += c.crushed;
  l.partContacts += c.contacts, l.deepByParts += c.squeezed;
  l.cappedNow += c.capped, l.cutImpulse += c.cutImpulse;
}

void enterFluid(Ledger& l, const fluid::FluidTotals& f) {
  l.kinetic += f.kinetic, l.work += f.kinetic, l.potential += f.potential, l.elastic += f.internal;
  l.dissipated.fluid += f.viscousLoss + f.diffusionLoss + f.wallLoss;
}

void enterBodies(Ledger& l, const multibody::Balance& b) {
  l.kinetic += b.now.kinetic, l.work += b.now.kinetic - b.leftOver, l.turnover += b.turnover;
  l.driveWork += b.driveWork, l.dissipated.joints += b.dissipated();
  l.momentum += b.now.linearMomentum, l.angularMomentum += b.now.angularMomentum;
  l.momentumResidual += b.linearRemainder, l.angularResidual += b.angularRemainder;
}

} // namespace grouser::coupling
