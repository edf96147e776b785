// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/channels.hpp"

#include "base/math.hpp"

namespace grouser::output {

Columns<TerrainReading> terrainColumns() {
  using T = TerrainReading;
  Columns<T> c("terrain/");
  c.add("contacts", "-", "grain-grain contacts", [](const T& t) { return t.ledger.grainContacts; });
  c.add("boundary_contacts", "-", "contacts of grains with planes, floor and surfaces",
        [](const T& t) { return t.ledger.boundaryContacts; });
  c.add("part_contacts", "-", "contacts of grains with parts of a vehicle and meshes",
        [](const T& t) { return t.ledger.partContacts; });
  c.add("max_overlap", "-", "largest overlap over the grain radius",
        [](const T& t) { return t.ledger.deepestOverlap / t.radius; });
  c.add("squeezed", "-", "grain-grain contacts with overlap above 0.2 of the smaller radius",
        [](const T& t) { return t.ledger.deepPairs; });
  c.add("squeezed_at_boundaries", "-",
        "contacts of grains with planes, floor and surfaces with overlap above 0.2 grain radius",
        [](const T& t) { return t.ledger.deepAtBoundaries; });
  c.add("squeezed_by_parts", "-", "contacts of grains with parts and meshes with overlap above 0.2 grain radius",
        [](const T& t) { return t.ledger.deepByParts; });
  c.add("part_overlap", "-", "largest overlap with a part or mesh since the last row, over the grain radius",
        [](const T& t) { return t.deepestPartOverlap ? t.deepestPartOverlap->share : base::kNaN; });
  c.add("part_overlap_by", "-", "index of the part of part_overlap in the root attribute \"parts\"; -1 if none",
        [](const T& t) { return t.deepestPartOverlap ? t.deepestPartOverlap->part : base::kNaN; });
  c.add("capped", "-", "contacts of grains with parts in which the force has reached the crushing force",
        [](const T& t) { return t.ledger.cappedNow; });
  c.add("crushed", "-", "number of grains removed because a part crushed them to their centre, since the start",
        &T::crushed);
  c.add("cut_impulse", "N s", "contact impulse removed by the crushing limit, since the start",
        [](const T& t) { return t.ledger.cutImpulse; });
  c.add("max_speed", "m/s", "speed of the fastest grain", [](const T& t) { return t.ledger.fastestGrain; });
  c.add("rebuilds", "-", "number of neighbour-list rebuilds since the start", &T::rebuilds);
  return c;
}

Columns<coupling::Surfaces::Observation> surfaceColumns(const std::string& name, bool hasPivot) {
  using S = coupling::Surfaces::Observation;
  Columns<S> c("surfaces/" + name + "/");
  c.add("force", "N", "force of the grains on the surface, mean since the last row", &S::force);
  c.add("torque", "N m", "torque of the grains on the surface about its centre, mean since the last row", &S::torque);
  c.add("power", "W", "power of the surface's drive, mean since the last row", &S::power);
  c.add("position", "m", "position of the surface's centre", &S::position);
  if (hasPivot)
    c.add("pivot_torque", "N m", "torque of the grains on the surface about its pivot, mean since the last row",
          &S::pivotTorque);
  return c;
}

Columns<base::Vec3d> obstacleColumns(const std::string& name) {
  Columns<base::Vec3d> c("obstacles/" + name + "/");
  c.add("force", "N", "force of vehicle and bodies on the surface, mean since the last row",
        [](const base::Vec3d& force) { return force; });
  return c;
}

Columns<HitchReading> hitchColumns() {
  using H = HitchReading;
  Columns<H> c("hitch/");
  c.add("force", "N", "force of the hitch on the vehicle, mean since the last row",
        [](const H& h) { return h.hitch.force; }, {"forward", "left", "up"});
  c.add("pull", "N",
        "drawbar pull: force of the vehicle on the hitch in the direction of motion, mean since the last row",
        &H::drawbarPull);
  c.add("speed", "m/s", "speed of the hitch point along the heading, mean since the last row",
        [](const H& h) { return h.hitch.speed; });
  c.add("power", "W", "power from the vehicle to the hitch, mean since the last row",
        [](const H& h) { return h.hitch.power; });
  c.add("work", "J", "work of the hitch on the vehicle since the start, included in ledger/drive_work",
        [](const H& h) { return h.hitch.work; });
  c.add("towed_way", "m", "distance of sled or carriage since the hitch engaged",
        [](const H& h) { return h.hitch.towedWay; });
  c.add("towed_speed", "m/s", "speed of sled or carriage", [](const H& h) { return h.hitch.towedSpeed; });
  return c;
}

Columns<coupling::GearContacts> gearColumns() {
  using G = coupling::GearContacts;
  Columns<G> c("gear/");
  c.add("grains_on_shoes", "-", "contacts of grains with shoes", &G::shoes);
  c.add("grains_on_sprockets", "-", "contacts of grains with sprockets", &G::sprockets);
  c.add("grains_on_road_wheels", "-", "contacts of grains with road wheels", &G::roadWheels);
  c.add("grains_on_rollers", "-", "contacts of grains with rollers", &G::rollers);
  c.add("grains_on_idlers", "-", "contacts of grains with idlers", &G::idlers);
  c.add("grains_on_hull", "-", "contacts of grains with the hull", &G::hull);
  c.add("stones", "-", "grains that touch a sprocket, road wheel, roller or idler", &G::stones);
  c.add("pinched_stones", "-", "grains that touch a shoe and also a sprocket, road wheel, roller or idler",
        &G::pinched);
  return c;
}

Columns<SolverReading> solverColumns() {
  using S = SolverReading;
  Columns<S> c("solver/");
  c.add("residual", "m/s", "largest velocity error of a contact in the last step",
        [](const S& s) { return s.last.residual; });
  c.add("residual_rms", "m/s", "root mean square velocity error of the contacts in the last step",
        [](const S& s) { return s.last.rms; });
  c.add("iterations", "-", "iterations of the last step", [](const S& s) { return s.last.iterations; });
  c.add("contacts", "-", "contacts in the last step, including open ones", [](const S& s) { return s.last.rows; });
  c.add("all_iterations", "-", "iterations since the start", [](const S& s) { return s.all.iterations; });
  c.add("missed_steps", "-", "steps with a residual above run.residual since the start",
        [](const S& s) { return s.all.missed; });
  c.add("relaxed_steps", "-", "steps solved by the convex relaxation, since the start",
        [](const S& s) { return s.all.relaxed; });
  c.add("worst_residual", "m/s", "largest residual since the start", [](const S& s) { return s.all.worst; });
  return c;
}

Columns<coupling::Ledger> ledgerColumns(const LedgerParts& parts) {
  using L = coupling::Ledger;
  Columns<L> c("ledger/");
  c.add("drive_work", "J", "work of drives, moving surfaces and the hitch", &L::driveWork);
  c.add("kinetic", "J", "kinetic energy of grains, vehicle and bodies", &L::kinetic);
  c.add("potential", "J", "potential energy in the field of gravity", &L::potential);
  c.add("elastic", "J", "elastic energy of contacts and springs", &L::elastic);
  c.add("dissipated", "J", "dissipated energy: sum of the datasets dissipated_*",
        [](const L& l) { return l.dissipated.total(); });
  for (const coupling::DissipationCause& cause : coupling::kDissipationCauses)
    c.add(std::string("dissipated_") + cause.word, "J", cause.help,
          [heat = cause.heat](const L& l) { return l.dissipated.*heat; });
  if (parts.deforms) {
    c.add("dissipated_soil", "J",
          "dissipation in deformable soil: compaction, shear, slip sinkage, damping, edges and coupling",
          [](const L& l) { return l.dissipated.soil; });
    for (const coupling::SoilEnergyEntry& entry : coupling::kSoilEnergies)
      c.add(std::string("soil_") + entry.word, "J", entry.help,
            [energy = entry.energy](const L& l) { return l.soil.*energy; });
  }
  if (parts.solved)
    c.add("dissipated_stabilisation", "J",
          "dissipation by the correction of overlaps in rigid contacts; negative: energy input",
          [](const L& l) { return l.dissipated.stabilisation; });
  if (parts.wet)
    c.add("dissipated_fluid", "J", "dissipation by viscosity, density diffusion and walls of the fluid",
          [](const L& l) { return l.dissipated.fluid; });
  c.add("integration_error", "J",
        "time-integration error: drive work minus kinetic, potential, elastic and dissipated energy; negative: energy "
        "gain",
        &L::integrationError);
  c.add("residual", "J", "energy residual (rounding): kinetic energy minus work of all forces on the bodies",
        &L::residual);
  c.add("turnover", "J", "turnover: sum over bodies and steps of the absolute work", &L::turnover);
  c.add("momentum", "N s", "momentum of grains, vehicle and bodies", &L::momentum);
  c.add("angular_momentum", "N m s", "angular momentum of grains, vehicle and bodies about the world's origin",
        &L::angularMomentum);
  c.add("momentum_residual", "N s",
        "momentum residual (rounding): momentum minus impulses of gravity, ground and surfaces", &L::momentumResidual);
  c.add("angular_residual", "N m s",
        "angular momentum residual (rounding): angular momentum minus moments of the impulses of gravity, ground and "
        "surfaces; undefined with periodic boundaries",
        &L::angularResidual);
  if (parts.touching)
    c.add("impulse_residual", "N s", "sum of the impulses on vehicle and bed; zero except for rounding",
          &L::impulseResidual);
  return c;
}

} // namespace grouser::output
