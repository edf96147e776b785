// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/grain_part_contacts.hpp"
#include "coupling/contact_parts.hpp"
#include "coupling/gear_contacts.hpp"
#include "coupling/ground.hpp"
#include "coupling/ground_setup.hpp"
#include "coupling/pressed_grain.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace grouser::coupling {

/// Contacts of grains with the parts of a vehicle and of bodies. Each rank computes the contacts of its own grains.
class GrainsOnParts {
public:
  /// `grains` must outlive this object, and this object must outlive all steps of `grains`: on several ranks it
  /// registers with the grain migration, like MeshContacts.
  GrainsOnParts(const PartsOnGround& parts, const GrainsSetup& setup, terrain::Grains& grains, const base::Exec& exec);
  GrainsOnParts(const GrainsOnParts&) = delete;
  GrainsOnParts& operator=(const GrainsOnParts&) = delete;

  contact::GrainPartContacts& contacts() { return contacts_; }
  const LoadQuanta& quanta() const { return quanta_; }
  void refresh(const base::Array<contact::PartMotion>& motion);
  /// Loads for the grain step; valid until the next refresh().
  const contact::GrainLoadsView& loads() const { return loads_; }

  /// Names of the parts that overlap a grain, with the overlap [m]; collective.
  std::vector<std::pair<std::string, double>> pressing(std::uint32_t grain) const;
  /// Sets the number of pairs with a grain crushed to its centre in this step, over all ranks.
  void countEnded(std::int64_t pairs) { ended_ = pairs; }
  /// Ids of the grains crushed to their centre in this step, over all ranks; collective.
  std::vector<std::uint32_t> endedGrains() const;
  void takeOut(const std::vector<std::uint32_t>& grains) { contacts_.takeOut(grains); }
  GearContacts gearContacts() const; ///< counts of the last step, over all ranks, for output rows; collective
  /// Deepest overlap since resetDeepestOverlap(), over all ranks; collective.
  DeepestPartOverlap deepestPartOverlap() const;
  void resetDeepestOverlap() { contacts_.resetDeepestOverlap(); }

  void addTo(ContactLedger& ledger) const;
  void save(ContactsState& state) const;
  void restore(const ContactsState& state);

private:
  const ContactPart& part(int index) const { return parts_.parts[static_cast<std::size_t>(index)]; }

  const vehicle::Assembly* vehicle_; ///< null in scenes without a vehicle
  const ContactParts& parts_;
  terrain::Grains& grains_;
  LoadQuanta quanta_;
  contact::GrainPartContacts contacts_;
  contact::GrainLoadsView loads_;
  std::int64_t ended_{0};
};

} // namespace grouser::coupling
