// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/channels.hpp"

#include "base/math.hpp"

namespace grouser::output {

Columns<TerrainReading> terrainColumns() {
  using T = TerrainReading;
  Columns<T> c("terrain/");
  c.add("contacts", "-", "pairs of grains in touch", [](const T& t) { return t.ledger.grainContacts; });
  c.add("boundary_contacts", "-", "contacts of grains with planes, floor and surfaces",
        [](const T& t) { return t.ledger.boundaryContacts; });
  c.add("part_contacts", "-", "contacts of grains with parts of a vehicle and meshes",
        [](const T& t) { return t.ledger.partContacts; });
  c.add("max_overlap", "-", "largest overlap in grain radii",
        [](const T& t) { return t.ledger.deepestOverlap / t.radius; });
  c.add("squeezed", "-", "pairs of grains that overlap by more than 0.2 of the smaller radius",
        [](const T& t) { return t.ledger.squeezedPairs; });
  c.add("squeezed_at_boundaries", "-", "contacts of grains with planes, floor and surfaces, as deep",
        [](const T& t) { return t.ledger.squeezedAtBoundaries; });
  c.add("squeezed_by_parts", "-", "contacts of grains with parts and meshes, as deep",
        [](const T& t) { return t.ledger.squeezedByParts; });
  c.add("part_overlap", "-", "greatest overlap with a part or mesh since the last row, in radii of its grain",
        [](const T& t) { return t.pressedMost ? t.pressedMost->share : base::kNaN; });
  c.add("part_overlap_by", "-", "that part's place among the names of the attribute parts of /; -1: none",
        [](const T& t) { return t.pressedMost ? t.pressedMost->part : base::kNaN; });
  c.add("capped", "-", "contacts of grains with parts at the force at which they crush",
        [](const T& t) { return t.ledger.cappedNow; });
  c.add("crushed", "-", "grains crushed to their middle by parts and taken out, since the start", &T::crushed);
  c.add("cut_impulse", "N s", "that springs of these would have given more without crushing, since the start",
        [](const T& t) { return t.ledger.cutImpulse; });
  c.add("max_speed", "m/s", "fastest grain", [](const T& t) { return t.ledger.fastestGrain; });
  c.add("rebuilds", "-", "neighbour lists built so far", &T::rebuilds);
  return c;
}

Columns<coupling::Surfaces::Observation> surfaceColumns(const std::string& name, bool hasPivot) {
  using S = coupling::Surfaces::Observation;
  Columns<S> c("surfaces/" + name + "/");
  c.add("force", "N", "of the grains on it, mean since the last row", &S::force);
  c.add("torque", "N m", "of the grains on it about its centre, mean since the last row", &S::torque);
  c.add("power", "W", "of what moves it, mean since the last row", &S::power);
  c.add("position", "m", "of its centre", &S::position);
  if (hasPivot)
    c.add("pivot_torque", "N m", "of the grains on it about its pivot, mean since the last row", &S::pivotTorque);
  return c;
}

Columns<base::Vec3d> obstacleColumns(const std::string& name) {
  Columns<base::Vec3d> c("obstacles/" + name + "/");
  c.add("force", "N", "of vehicle and bodies on it, mean since the last row",
        [](const base::Vec3d& force) { return force; });
  return c;
}

Columns<HitchReading> hitchColumns() {
  using H = HitchReading;
  Columns<H> c("hitch/");
  c.add("force", "N", "of the hitch on the vehicle, mean since the last row", [](const H& h) { return h.hitch.force; },
        {"forward", "left", "up"});
  c.add("pull", "N", "drawbar pull: of the vehicle on the hitch in the direction of motion, mean since the last row",
        &H::drawbarPull);
  c.add("speed", "m/s", "of the hitch point along the heading, mean since the last row",
        [](const H& h) { return h.hitch.speed; });
  c.add("power", "W", "that the hitch takes from the vehicle, mean since the last row",
        [](const H& h) { return h.hitch.power; });
  c.add("work", "J", "by the hitch on the vehicle since the start, part of ledger/drive_work",
        [](const H& h) { return h.hitch.work; });
  c.add("towed_way", "m", "of sled or carriage since the hitch took hold", [](const H& h) { return h.hitch.towedWay; });
  c.add("towed_speed", "m/s", "of sled or carriage", [](const H& h) { return h.hitch.towedSpeed; });
  return c;
}

Columns<coupling::GearContacts> gearColumns() {
  using G = coupling::GearContacts;
  Columns<G> c("gear/");
  c.add("grains_on_shoes", "-", "pairs of grain and shoe in touch", &G::shoes);
  c.add("grains_on_sprockets", "-", "the same of sprockets", &G::sprockets);
  c.add("grains_on_road_wheels", "-", "the same of road wheels", &G::roadWheels);
  c.add("grains_on_rollers", "-", "the same of rollers", &G::rollers);
  c.add("grains_on_idlers", "-", "the same of idlers", &G::idlers);
  c.add("grains_on_hull", "-", "the same of the hull", &G::hull);
  c.add("stones", "-", "grains that touch a sprocket, road wheel, roller or idler", &G::stones);
  c.add("pinched_stones", "-", "those of them that touch a shoe too", &G::pinched);
  return c;
}

Columns<SolverReading> solverColumns() {
  using S = SolverReading;
  Columns<S> c("solver/");
  c.add("residual", "m/s", "largest velocity error of a contact in the last step",
        [](const S& s) { return s.last.residual; });
  c.add("residual_rms", "m/s", "root mean square over its contacts", [](const S& s) { return s.last.rms; });
  c.add("iterations", "-", "of the last step", [](const S& s) { return s.last.iterations; });
  c.add("contacts", "-", "in the last step, including open ones", [](const S& s) { return s.last.rows; });
  c.add("all_iterations", "-", "since the start", [](const S& s) { return s.all.iterations; });
  c.add("missed_steps", "-", "since the start, whose residual exceeded run.residual",
        [](const S& s) { return s.all.missed; });
  c.add("relaxed_steps", "-", "since the start, finished with the convex relaxation",
        [](const S& s) { return s.all.relaxed; });
  c.add("worst_residual", "m/s", "of all steps since the start", [](const S& s) { return s.all.worst; });
  return c;
}

Columns<coupling::Ledger> ledgerColumns(const LedgerParts& parts) {
  using L = coupling::Ledger;
  Columns<L> c("ledger/");
  c.add("drive_work", "J", "done by drives, moving surfaces and the hitch", &L::driveWork);
  c.add("kinetic", "J", "of grains, vehicle and bodies", &L::kinetic);
  c.add("potential", "J", "in the field of gravity", &L::potential);
  c.add("elastic", "J", "in contacts and springs", &L::elastic);
  c.add("dissipated", "J",
        parts.deforms || parts.wet || parts.solved ? "sum of the nine causes below" : "sum of the eight below",
        [](const L& l) { return l.dissipated.total(); });
  for (const coupling::DissipationCause& cause : coupling::kDissipationCauses)
    c.add(std::string("dissipated_") + cause.word, "J", cause.help,
          [heat = cause.heat](const L& l) { return l.dissipated.*heat; });
  if (parts.deforms) {
    c.add("dissipated_soil", "J", "by deformable soil: compaction, shear, slip sinkage, damping, edges and coupling",
          [](const L& l) { return l.dissipated.soil; });
    for (const coupling::SoilEnergyEntry& entry : coupling::kSoilEnergies)
      c.add(std::string("soil_") + entry.word, "J", entry.help,
            [energy = entry.energy](const L& l) { return l.soil.*energy; });
  }
  if (parts.solved)
    c.add("dissipated_stabilisation", "J", "by contacts that push overlaps apart; put in where negative",
          [](const L& l) { return l.dissipated.stabilisation; });
  if (parts.wet)
    c.add("dissipated_fluid", "J", "by viscosity, density diffusion and walls of the fluid",
          [](const L& l) { return l.dissipated.fluid; });
  c.add("integration_error", "J",
        "lost (or, where negative, made) by steps of finite length: drive work less kinetic, potential, elastic and "
        "dissipated",
        &L::integrationError);
  c.add("residual", "J", "kinetic energy less the work of all forces on the bodies: rounding", &L::residual);
  c.add("turnover", "J", "sum of the absolute work on each body in each step", &L::turnover);
  c.add("momentum", "N s", "of grains, vehicle and bodies", &L::momentum);
  c.add("angular_momentum", "N m s", "the same about the world's origin", &L::angularMomentum);
  c.add("momentum_residual", "N s", "momentum less the impulses of gravity, ground and surfaces: rounding",
        &L::momentumResidual);
  c.add("angular_residual", "N m s",
        "angular momentum less the same impulses' moments: rounding; none with periodic boundaries",
        &L::angularResidual);
  if (parts.touching) c.add("impulse_residual", "N s", "impulse on vehicle plus impulse on bed", &L::impulseResidual);
  return c;
}

} // namespace grouser::output
