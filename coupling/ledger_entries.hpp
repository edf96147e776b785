// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/grain_part_contacts.hpp"
#include "coupling/ledger.hpp"
#include "multibody/readings.hpp"
#include "terrain/grain_model.hpp"

/// What the rooms below measure of their own, as entries of the ledger of all.
namespace grouser::coupling {

void enterGrains(Ledger& ledger, const terrain::GrainLedger& grains);
/// Contacts of grains with parts, but for the elastic energy that they hold.
void enterGrainParts(Ledger& ledger, const contact::GrainPartContacts::Ledger& contacts);
/// Bodies, but for their potential and elastic energies: who adds them says since when these count.
void enterBodies(Ledger& ledger, const multibody::Balance& bodies);

} // namespace grouser::coupling
