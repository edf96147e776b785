// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/grains_on_vehicle.hpp"

#include "coupling/grain_part_model.hpp"
#include "coupling/ledger_entries.hpp"
#include "coupling/vehicle_parts.hpp"
#include "coupling/vehicle_state.hpp"

namespace grouser::coupling {

namespace {

std::vector<contact::GrainPart> partsThatMeet(const PartsOnGround& on) {
  std::vector<contact::GrainPart> parts;
  const std::vector<int> sets = on.parts.setOfContactPart();
  for (std::size_t c = 0; c < sets.size(); ++c)
    parts.push_back(
        {sets[c], {}, {}, !on.shoesOnly || on.assembly.parts[on.parts.partOf(c)].kind == vehicle::PartKind::kShoe});
  return parts;
}

} // namespace

GrainsOnVehicle::GrainsOnVehicle(const PartsOnGround& on, const GrainsSetup& setup, terrain::Grains& grains,
                                 const base::Exec& exec)
    : assembly_(on.assembly), parts_(on.parts), grains_(grains),
      contacts_(exec, grainPartModel(setup, grains, on.margin), on.parts.sets(), partsThatMeet(on),
                grains.system().comm, setup.partLaws) {
  const contact::GrainPartModel model = grainPartModel(setup, grains, on.margin);
  quanta_ = {model.force, model.torque};
  if (auto* ranks = grains.distribution())
    ranks->onMigrate([this](const std::uint32_t* destination) { contacts_.migrate(destination); });
}

std::size_t GrainsOnVehicle::partOf(int contactPart) const {
  return parts_.partOf(static_cast<std::size_t>(contactPart));
}

void GrainsOnVehicle::refresh(const base::Array<contact::PartMotion>& motion) {
  contacts_.refresh(grains_.view(), motion);
  loads_ = contacts_.grainLoads();
}

std::vector<std::pair<std::string, double>> GrainsOnVehicle::pressing(std::uint32_t grain) const {
  std::vector<std::pair<std::string, double>> named;
  for (const contact::GrainPartContacts::Press& p : contacts_.pressing(grain))
    named.emplace_back("the " + assembly_.parts[partOf(p.part)].name, static_cast<double>(p.overlap));
  return named;
}

std::vector<std::uint32_t> GrainsOnVehicle::endedGrains() const {
  return ended_ == 0 ? std::vector<std::uint32_t>{} : contacts_.ended();
}

GearContacts GrainsOnVehicle::gearContacts() const {
  std::vector<TouchedPart> touches;
  for (const contact::GrainPartContacts::Touch& t : contacts_.touching())
    touches.push_back({t.grain, assembly_.parts[partOf(t.part)].kind});
  return countGear(touches);
}

PressedMost GrainsOnVehicle::pressedMost() const {
  const auto most = contacts_.mostPressed();
  return most ? PressedMost{static_cast<int>(partOf(most->part)), most->grain, most->share} : PressedMost{};
}

void GrainsOnVehicle::addTo(ContactLedger& ledger) const { ledger.bed = contacts_.ledger(); }

void GrainsOnVehicle::save(VehicleState& state) const { state.bed = contacts_.save(); }
void GrainsOnVehicle::restore(const VehicleState& state) { contacts_.restore(state.bed); }

} // namespace grouser::coupling
