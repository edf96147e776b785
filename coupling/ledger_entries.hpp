// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/grain_part_contacts.hpp"
#include "contact/patch_contacts.hpp"
#include "coupling/ledger.hpp"
#include "multibody/readings.hpp"
#include "terrain/grain_model.hpp"

/// Entries of the ledger from the rooms below.
namespace grouser::fluid {
struct FluidTotals;
}

namespace grouser::coupling {

/// Elastic energy and dissipation of the contacts of parts.
struct ContactLedger {
  contact::PatchBuffers::Ledger rigid;    ///< of parts with each other and with rigid surfaces
  contact::GrainPartContacts::Ledger bed; ///< of parts with grains
  scm::SoilEnergy soil;                   ///< of parts with deformable soil
  base::Vec3d impulseOnParts;             ///< since the start, from a ground with momentum [N s]
  base::Vec3d angularOnParts;             ///< about the origin of the world, from such a ground since the start [N m s]
  double elastic() const { return rigid.elastic + bed.elastic + soil.held(); } ///< held now [J]
};

void enterGrains(Ledger& ledger, const terrain::GrainLedger& grains);
/// Enters contacts of grains with parts, without their elastic energy.
void enterGrainParts(Ledger& ledger, const contact::GrainPartContacts::Ledger& contacts);
/// Enters a fluid. Its kinetic energy is entered as work too, since it keeps no record of the work on its particles.
void enterFluid(Ledger& ledger, const fluid::FluidTotals& fluid);
/// Enters bodies without their potential and elastic energies, which the caller adds from its own start.
void enterBodies(Ledger& ledger, const multibody::Balance& bodies);

} // namespace grouser::coupling
