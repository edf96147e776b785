// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/grain_part_contacts.hpp"
#include "contact/patch_contacts.hpp"
#include "coupling/ledger.hpp"
#include "multibody/readings.hpp"
#include "terrain/grain_model.hpp"

/// What the rooms below measure of their own, as entries of the ledger of all.
namespace grouser::fluid {
struct FluidTotals;
}

namespace grouser::coupling {

/// What the contacts of a vehicle's parts hold and have lost.
struct ContactLedger {
  contact::PatchBuffers::Ledger rigid;    ///< of parts with each other and with what is no grain
  contact::GrainPartContacts::Ledger bed; ///< of parts with grains
  scm::SoilEnergy soil;                   ///< of parts with deformable soil
  base::Vec3d impulseOnParts;             ///< since the start, from a ground that has momentum of its own [N s]
  base::Vec3d angularOnParts;             ///< about the origin of the world, from such a ground since the start [N m s]
  double elastic() const { return rigid.elastic + bed.elastic + soil.held(); } ///< held now [J]
};

void enterGrains(Ledger& ledger, const terrain::GrainLedger& grains);
/// Contacts of grains with parts, but for the elastic energy that they hold.
void enterGrainParts(Ledger& ledger, const contact::GrainPartContacts::Ledger& contacts);
/// A fluid. Its kinetic energy is entered as work too: it keeps no record of its own of the work on its particles.
void enterFluid(Ledger& ledger, const fluid::FluidTotals& fluid);
/// Bodies, but for their potential and elastic energies: who adds them says since when these count.
void enterBodies(Ledger& ledger, const multibody::Balance& bodies);

} // namespace grouser::coupling
