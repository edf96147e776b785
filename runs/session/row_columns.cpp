// SPDX-License-Identifier: BSD-3-Clause
#include "runs/session/row_columns.hpp"

#include "base/table.hpp"
#include "coupling/fluid_domain.hpp"
#include "runs/output/fluid_output.hpp"
#include "runs/output/mechanism_output.hpp"
#include "vehicle/observation_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace grouser::session {

namespace {

/// Throws InputError if a plot names a column that the rows lack.
void requirePlotted(const std::vector<output::Channel>& channels, const std::vector<setup::PlottedColumn>& plots) {
  std::vector<std::string> known = {"time"};
  for (const output::Channel& c : channels) {
    std::string path = c.path;
    std::replace(path.begin(), path.end(), '/', '.');
    if (c.width == 1) known.push_back(path);
    for (const std::string& column : c.columns) known.push_back(path + "." + column);
  }
  for (const setup::PlottedColumn& p : plots)
    if (std::find(known.begin(), known.end(), p.column) == known.end())
      throw base::InputError(fmt::format("{} names a column that the results lack, \"{}\"; did you mean \"{}\"?",
                                         p.place, p.column, base::nearestWord(p.column, known)));
}

/// Bodies of the vehicle or, without one, of the mechanism.
const coupling::BodiesInContact& bodiesOf(const coupling::Simulation& simulation) {
  if (simulation.vehicle()) return *simulation.vehicle();
  return *simulation.mechanism();
}

} // namespace

RowColumns::RowColumns(coupling::Simulation& simulation, const setup::OutputSetup& output) : simulation_(simulation) {
  const bool grains = simulation.ground().grains != nullptr;
  const coupling::VehicleRig* rig = simulation.vehicle();
  if (simulation.mechanism())
    add(output::mechanismColumns(simulation.mechanism()->model(), simulation.mechanism()->touchingBodies(),
                                 output.record),
        [&s = simulation](const Now&) { return output::MechanismReading(*s.mechanism()); });
  addProbes();
  if (rig) addVehicle(output.shoeForces);
  if (const auto& bodies = simulation.setup().mechanism; rig && bodies)
    add(output::mechanismColumns(rig->model(), rig->touchingBodies(), output.record, bodies->ofVehicle),
        [&s = simulation](const Now&) { return output::MechanismReading(*s.vehicle()); });
  if (grains)
    add(output::terrainColumns(), [&s = simulation](const Now& now) {
      const terrain::Grains& bed = *s.ground().grains;
      return output::TerrainReading{now.ledger, bed.model().radius, s.crushedGrains().grains, bed.system().rebuilds,
                                    s.deepestPartOverlap()};
    });
  addSurfaces();
  if (coupling::FluidDomain* fluid = coupling::fluidOf(simulation))
    add(output::fluidColumns(simulation.setup().fluid->probes, fluid->columns()), [fluid, &s = simulation](const Now&) {
      return output::fluidReading(*fluid, s.vehicle()     ? &s.vehicle()->state()
                                          : s.mechanism() ? &s.mechanism()->state()
                                                          : nullptr);
    });
  if (rig && rig->towing())
    add(output::hitchColumns(), [&s = simulation](const Now& now) {
      return output::HitchReading{s.vehicle()->towing()->observe(), now.vehicle.drawbarPull};
    });
  if (rig && grains && output.gearContacts)
    add(output::gearColumns(), [&s = simulation](const Now&) { return s.granularGround()->onParts()->gearContacts(); });
  // A mechanism without contacts has no contact impulses to balance.
  const coupling::Ground* ground = simulation.actingGround();
  const bool solved = grains && simulation.ground().grains->system().impulses;
  if (solved)
    add(output::solverColumns(), [&s = simulation](const Now&) {
      const terrain::ImpulseSolver& solver = *s.ground().grains->system().impulses;
      return output::SolverReading{solver.report(), solver.totals()};
    });
  add(output::ledgerColumns({.touching = !simulation.mechanism() || simulation.mechanism()->touches(),
                             .deforms = ground && ground->traits().deforms,
                             .wet = coupling::fluidOf(simulation) != nullptr,
                             .solved = solved}),
      [](const Now& now) { return now.ledger; });
  requirePlotted(channels_, output.plots);
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

void RowColumns::addProbes() {
  coupling::Simulation& s = simulation_;
  if (!s.setup().mechanism || !s.ground().grains) return;
  std::vector<std::string> names;
  for (const coupling::BodyProbe& p : s.setup().mechanism->probes)
    names.push_back(bodiesOf(s).model().bodies()[p.body].name);
  if (!names.empty())
    add(output::probeColumns(names), [&s](const Now&) {
      return coupling::grainMassIn(s.setup().mechanism->probes, bodiesOf(s).state(), *s.ground().grains, s.comm());
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
    if (s.vehicle() || s.mechanism())
      add(output::obstacleColumns(obstacles[i].surface.name),
          [&s, i](const Now&) { return bodiesOf(s).meanForceOn(i); });
}

void RowColumns::add(const std::vector<output::Channel>& channels, Append append) {
  channels_.insert(channels_.end(), channels.begin(), channels.end());
  groups_.push_back(std::move(append));
}

} // namespace grouser::session
