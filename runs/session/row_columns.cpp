// SPDX-License-Identifier: BSD-3-Clause
#include "runs/session/row_columns.hpp"

#include "runs/output/mechanism_output.hpp"
#include "vehicle/observation_table.hpp"

#include <utility>

namespace grouser::session {

RowColumns::RowColumns(coupling::Simulation& simulation, const setup::OutputSetup& output) : simulation_(simulation) {
  const bool grains = simulation.ground().grains != nullptr;
  const coupling::VehicleRig* rig = simulation.vehicle();
  if (simulation.mechanism())
    add(output::mechanismColumns(simulation.mechanism()->model(), simulation.mechanism()->touchingBodies(),
                                 output.record),
        [&s = simulation](const Now&) { return output::MechanismReading(*s.mechanism()); });
  if (rig) addVehicle(output.shoeForces);
  if (const auto& bodies = simulation.setup().mechanism; rig && bodies)
    add(output::mechanismColumns(rig->model(), rig->touchingBodies(), output.record, bodies->ofVehicle),
        [&s = simulation](const Now&) { return output::MechanismReading(*s.vehicle()); });
  if (grains)
    add(output::terrainColumns(), [&s = simulation](const Now& now) {
      const terrain::Grains& bed = *s.ground().grains;
      return output::TerrainReading{now.ledger, bed.model().radius, s.takenOut().grains, bed.system().rebuilds,
                                    s.pressedMost()};
    });
  addSurfaces();
  if (rig && rig->towing())
    add(output::hitchColumns(), [&s = simulation](const Now& now) {
      return output::HitchReading{s.vehicle()->towing()->observe(), now.vehicle.drawbarPull};
    });
  if (rig && grains && output.gearContacts)
    add(output::gearColumns(), [&s = simulation](const Now&) { return s.granularGround()->onParts()->gearContacts(); });
  // A mechanism without contacts has no contact impulses to balance.
  add(output::ledgerColumns(!simulation.mechanism() || simulation.mechanism()->touches()),
      [](const Now& now) { return now.ledger; });
}

output::Row RowColumns::row() const {
  Now now;
  if (simulation_.vehicle()) now.vehicle = simulation_.vehicle()->observe();
  now.ledger = simulation_.ledger();
  output::Row row{simulation_.steps(), simulation_.time(), {}};
  for (const Append& append : groups_) append(now, row.values);
  return row;
}

void RowColumns::addVehicle(bool shoeForces) {
  std::vector<output::Channel> channels;
  for (const vehicle::Quantity& q : vehicle::quantities(simulation_.vehicle()->assembly(), shoeForces))
    channels.push_back(output::channelOf(q));
  add(channels, [shoeForces](const Now& now, std::vector<double>& values) {
    const std::vector<double> numbers = vehicle::flatten(now.vehicle, shoeForces);
    values.insert(values.end(), numbers.begin(), numbers.end());
  });
}

void RowColumns::addSurfaces() {
  coupling::Simulation& s = simulation_;
  if (const coupling::Surfaces* surfaces = s.surfaces())
    for (std::size_t i = 0; i < surfaces->count(); ++i)
      add(output::surfaceColumns(surfaces->surface(i).name, surfaces->surface(i).hasPivot),
          [&s, i](const Now&) { return s.surfaces()->observe(i, s.steps()); });
  const std::vector<coupling::Obstacle>& obstacles = s.setup().ground.obstacles;
  for (std::size_t i = 0; i < obstacles.size(); ++i)
    add(output::obstacleColumns(obstacles[i].surface.name),
        [&s, i](const Now&) { return s.touching()->meanForceOn(i); });
}

void RowColumns::add(const std::vector<output::Channel>& channels, Append append) {
  channels_.insert(channels_.end(), channels.begin(), channels.end());
  groups_.push_back(std::move(append));
}

} // namespace grouser::session
