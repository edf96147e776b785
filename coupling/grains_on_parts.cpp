// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/grains_on_parts.hpp"

#include "coupling/contacts_state.hpp"
#include "coupling/grain_part_model.hpp"
#include "coupling/ledger_entries.hpp"

namespace grouser::coupling {

namespace {

std::vector<contact::GrainPart> partsThatMeet(const ContactParts& parts, const GrainsSetup& setup) {
  const int grainMaterials = static_cast<int>(setup.partLaws.massPerCube.size());
  std::vector<contact::GrainPart> all;
  for (const ContactPart& part : parts.parts)
    all.push_back({part.surface, {}, {}, part.canTouchGrains, part.material * grainMaterials, part.shape});
  return all;
}

} // namespace

GrainsOnParts::GrainsOnParts(const PartsOnGround& on, const GrainsSetup& setup, terrain::Grains& grains,
                             const base::Exec& exec)
    : vehicle_(on.vehicle), parts_(on.parts), grains_(grains),
      contacts_(exec, grainPartModel(setup, grains, on.margin), on.parts.surfaces, partsThatMeet(on.parts, setup),
                grains.system().comm, setup.partLaws) {
  const contact::GrainPartModel model = grainPartModel(setup, grains, on.margin);
  quanta_ = {model.force, model.torque};
  if (auto* ranks = grains.distribution())
    ranks->onMigrate([this](const std::uint32_t* destination) { contacts_.migrate(destination); });
}

void GrainsOnParts::refresh(const base::Array<contact::PartMotion>& motion) {
  contacts_.refresh(grains_.view(), motion);
  loads_ = contacts_.grainLoads();
}

std::vector<std::pair<std::string, double>> GrainsOnParts::pressing(std::uint32_t grain) const {
  std::vector<std::pair<std::string, double>> named;
  for (const contact::GrainPartContacts::Press& p : contacts_.pressing(grain))
    named.emplace_back("the " + part(p.part).name, static_cast<double>(p.overlap));
  return named;
}

std::vector<std::uint32_t> GrainsOnParts::endedGrains() const {
  return ended_ == 0 ? std::vector<std::uint32_t>{} : contacts_.ended();
}

GearContacts GrainsOnParts::gearContacts() const {
  std::vector<TouchedPart> touches;
  for (const contact::GrainPartContacts::Touch& t : contacts_.touching())
    if (vehicle_ && !part(t.part).ofBody) touches.push_back({t.grain, vehicle_->parts[part(t.part).shown].kind});
  return countGear(touches);
}

DeepestPartOverlap GrainsOnParts::deepestPartOverlap() const {
  const auto most = contacts_.mostPressed();
  return most ? DeepestPartOverlap{static_cast<int>(part(most->part).shown), most->grain, most->share}
              : DeepestPartOverlap{};
}

void GrainsOnParts::addTo(ContactLedger& ledger) const { ledger.bed = contacts_.ledger(); }

void GrainsOnParts::save(ContactsState& state) const { state.bed = contacts_.save(); }
void GrainsOnParts::restore(const ContactsState& state) { contacts_.restore(state.bed); }

} // namespace grouser::coupling
