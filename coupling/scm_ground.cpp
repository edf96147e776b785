// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/scm_ground.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "coupling/contact_parts.hpp"
#include "coupling/ledger_entries.hpp"
#include "coupling/simulation_state.hpp"
#include "vehicle/assembly.hpp"

namespace grouser::coupling {

double ScmSetup::stiffest(double breadth) const {
  const auto slope = [&](double z) {
    return scm::unloadingStiffness(soil, z, soil.modulusAt(breadth) * base::pow(z, soil.exponent));
  };
  return std::max(slope(1e-4), slope(0.1));
}

ScmGround::ScmGround(const ScmSetup& setup, const terrain::HeightField& surface)
    : setup_(setup), laid_(surface),
      map_(setup.spacing, [view = surface.view()](double x, double y) { return view.jet(x, y); }) {}

std::function<double(double, double)> ScmGround::surface() const {
  return [view = laid_.view()](double x, double y) { return view.jet(x, y).h; };
}

GroundTraits ScmGround::traits() const {
  GroundTraits traits;
  traits.hullMeets = &laid_;
  traits.onHost = true;
  return traits;
}

LoadQuanta ScmGround::meet(const PartsOnGround& on) {
  std::vector<scm::Pad> pads;
  if (on.vehicle) {
    const vehicle::ShoeSpec& shoe = on.vehicle->spec.shoe;
    for (std::size_t c = 0; c < on.parts.count(); ++c)
      if (const ContactPart& part = on.parts.parts[c]; part.meetsGround && !part.ofBody)
        pads.push_back({static_cast<int>(c),
                        {0, 0, shoe.padBottom},
                        {1, 0, 0},
                        {0, 1, 0},
                        shoe.halfLength,
                        shoe.padHalfWidth,
                        2 * shoe.padHalfWidth});
  }
  contacts_ = std::make_unique<scm::PadContacts>(setup_.soil, setup_.deepest, map_, std::move(pads));
  if (!saved_.empty() && !contacts_->restore(saved_))
    throw base::InputError("the saved state belongs to another vehicle; resume it with its own scene");
  saved_.clear();
  timeStep_ = on.timeStep;
  return quanta_ = {on.quanta.force, on.quanta.torque};
}

void ScmGround::computeOnHost(const contact::PartMotion* motion, contact::PartLoad* loads) {
  contacts_->step(motion, timeStep_);
  for (std::size_t k = 0; k < contacts_->pads().size(); ++k) {
    contact::PartLoad& load = loads[contacts_->pads()[k].part];
    load.force += quanta_.force.quantise(contacts_->loads()[k].force);
    load.torque += quanta_.torque.quantise(contacts_->loads()[k].torque);
  }
}

void ScmGround::addContactsTo(ContactLedger& ledger) const {
  const scm::SoilEnergy& energy = contacts_->energy();
  ledger.rigid.elastic += energy.elastic + energy.elasticShear, ledger.rigid.dissipated += energy.lost();
}

std::vector<double> ScmGround::surfaceNow() const {
  const terrain::HeightFieldView map = laid_.view();
  std::vector<double> heights;
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column)
      heights.push_back(map.heights[static_cast<std::size_t>(row) * static_cast<std::size_t>(map.columns) +
                                    static_cast<std::size_t>(column)] -
                        map_.rutAt(map.xMin + column * map.dx, map.yMin + row * map.dy));
  return heights;
}

void ScmGround::restore(const SimulationState& state) {
  if (!state.ground)
    throw base::InputError("the saved state contains no deformable soil; resume it with its own scene");
  saved_ = *state.ground;
}

void ScmGround::save(SimulationState& state) const {
  if (contacts_) state.ground = contacts_->save();
}

} // namespace grouser::coupling
