// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/grain_part_contacts.hpp"
#include "contact/patch_contacts.hpp"
#include "coupling/ledger.hpp"
#include "multibody/readings.hpp"
#include "terrain/grain_model.hpp"

/// Ledger entries of the coupled components of a simulation.
namespace grouser::fluid {
struct FluidTotals;
}

namespace grouser::coupling {

/// Elastic energy and dissipation of the contacts of parts.
struct ContactLedger {
  contact::PatchBuffers::Ledger rigid;    ///< contacts of parts with each other and with rigid surfaces
  contact::GrainPartContacts::Ledger bed; ///< contacts of parts with grains
  scm::SoilEnergy soil;                   ///< contacts of parts with deformable soil
  base::Vec3d impulseOnParts;             ///< cumulative impulse from a ground with momentum [N s]
  base::Vec3d angularOnParts;             ///< cumulative angular impulse from it about the world origin [N m s]
  double elastic() const { return rigid.elastic + bed.elastic + soil.held(); } ///< current elastic energy [J]
};

void enterGrains(Ledger& ledger, const terrain::GrainLedger& grains);
/// Adds contacts of grains with parts, without their elastic energy.
void enterGrainParts(Ledger& ledger, const contact::GrainPartContacts::Ledger& contacts);
/// Adds a fluid. Its kinetic energy also counts as work, since the work on particles is not recorded.
void enterFluid(Ledger& ledger, const fluid::FluidTotals& fluid);
/// Adds bodies without their potential and elastic energies: the caller adds these with another reference.
void enterBodies(Ledger& ledger, const multibody::Balance& bodies);

} // namespace grouser::coupling
