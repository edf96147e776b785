// SPDX-License-Identifier: BSD-3-Clause
// The one table of fields of a scene file, with those of surfaces and mechanisms beside it: it drives parsing, checks,
// `grouser fields` and the resolved copy.
#include "runs/scene/detail/scene_tables.hpp"

#include "multibody/solver.hpp"

#include <fmt/format.h>

namespace grouser::scene::detail {

using base::Table;

namespace {

/// A default as a person writes it: 0.25, 1e6.
std::string brief(double x) {
  std::string text = fmt::format("{:g}", x);
  if (const std::size_t at = text.find("e+0"); at != std::string::npos) text.erase(at + 1, 2);
  return text;
}

} // namespace

Table<RunSettings> runTable() {
  using S = RunSettings;
  Table<S> t("run", "Time, gravity, and the machine to run on");
  t.add("duration", &S::duration, "s", "simulated time, after the bed has settled")
      .atLeast(1e-12)
      .atMost(1e5)
      .required();
  t.add("time_step", &S::timeStep, "s", "\"auto\" is the largest step the stability rule allows")
      .atLeast(1e-12)
      .atMost(0.1)
      .orWord("auto");
  t.add("gravity", &S::gravity, "m/s2", "acceleration of free fall").atLeast(-1000).atMost(1000);
  t.add("output_interval", &S::outputInterval, "s", "between rows of the time series").above(0);
  t.add("frame_interval", &S::frameInterval, "s", "between frames for ParaView").above(0);
  t.add("checkpoint_interval", &S::checkpointInterval, "s",
        "between checkpoints for --resume, simulated; 0: only where the run ends or is stopped")
      .atLeast(0)
      .atMost(1e5);
  t.add("seed", &S::seed, "-", "of every random number").atLeast(0);
  t.add("device", &S::device, "", "where grains are computed; \"auto\" is the GPU where there is one");
  t.add("precision", &S::precision, "", "of the grains' forces; each gives the same bits everywhere");
  t.add("impact_speed", &S::impactSpeed, "m/s",
        "fastest impact that the time step of hertz materials is chosen and checked for")
      .above(0)
      .atMost(1e4);
  t.add("threads", &S::threads, "-", "CPU threads; 0 takes all; the answer is the same for any number")
      .atLeast(0)
      .atMost(1024);
  t.add("integrator", &S::integrator, "",
        "of mechanisms: symplectic Euler (order 1, springs implicit) or RATTLE (order 2 and higher)");
  t.add("integrator_order", &S::integratorOrder, "-", "of rattle: 2, or 4, 6, 8 by 5, 9, 17 stages a step")
      .atLeast(1)
      .atMost(8);
  t.add("springs", &S::springs, "", "of rattle: explicit needs a step below 2 / omega, implicit takes any");
  t.add("constraint_tolerance", &S::constraintTolerance, "m or rad",
        fmt::format(
            "to which joints of a mechanism are closed; \"auto\": {:g} for symplectic_euler, {:g} (round-off) for "
            "rattle",
            multibody::kEulerTolerance, multibody::kRattleTolerance))
      .atLeast(multibody::kRattleTolerance)
      .atMost(1e-3)
      .orWord("auto");
  t.add("skin", &S::skin, "-", "range added to the neighbour search, in grain radii").above(0).atMost(2);
  t.add("max_overlap", &S::maxOverlap, "-", "overlap in grain radii beyond which the run stops as unsound")
      .above(0)
      .atMost(1);
  t.add("periodic", &S::periodic, "",
        "whether opposite sides along x, y are joined: grains that leave through one enter through the other");
  t.add("domain_x", &S::domainX, "m",
        "where periodic boundaries stand along x; without it at the borders of the terrain");
  t.add("domain_y", &S::domainY, "m", "the same along y");
  return t;
}

Table<Material> materialTable() {
  using S = Material;
  Table<S> t("material.NAME", "A material; NAME is what other sections call it");
  t.add("density", &S::density, "kg/m3", "of the solid").atLeast(1e-3).atMost(1e5);
  t.add("law", &S::law, "", "contact law: linear springs, or Hertz-Mindlin; both with dashpots and Coulomb friction");
  t.add("stiffness", &S::stiffness, "N/m",
        fmt::format("linear: normal stiffness k of a contact; {} where not given", brief(S::kStiffness)))
      .atLeast(1e-3)
      .atMost(1e12);
  t.add("young", &S::young, "Pa", "hertz: Young's modulus of the solid; required").atLeast(1).atMost(1e13);
  t.add("poisson", &S::poisson, "-",
        fmt::format("hertz: Poisson's ratio of the solid; {} where not given", brief(S::kPoisson)))
      .atLeast(0)
      .atMost(0.5);
  t.add("restitution", &S::restitution, "-",
        fmt::format("rebound over impact speed; {} where damping is not given either", brief(S::kRestitution)))
      .atLeast(1e-6)
      .atMost(1);
  t.add("damping", &S::damping, "1/s", "linear: gamma of F_n = k overlap - gamma m_eff v_n, instead of restitution")
      .atLeast(0)
      .atMost(1e9);
  t.add("attraction", &S::attraction, "", "whether the damping force may pull two parting surfaces together");
  t.add("friction", &S::friction, "-", "Coulomb coefficient").atLeast(0).atMost(10);
  t.add("tangential_stiffness_ratio", &S::tangentialStiffnessRatio, "-",
        fmt::format("linear: tangential over normal stiffness; {}/{} where not given",
                    S::kTangentialStiffnessRatio.numerator, S::kTangentialStiffnessRatio.denominator))
      .above(0)
      .atMost(1);
  t.add("tangential_damping_ratio", &S::tangentialDampingRatio, "-",
        fmt::format(
            "linear: tangential over normal damping, {} where not given; hertz: over the damping 2 beta sqrt(k_t "
            "m_eff), {} where not given",
            brief(S::kLinearTangentialDampingRatio), brief(S::kHertzTangentialDampingRatio)))
      .atLeast(0)
      .atMost(2);
  t.add("rolling_friction", &S::rollingFriction, "-",
        "torque of rolling resistance over R F_n, with an elastic-plastic spring (type C); 0 leaves it out")
      .atLeast(0)
      .atMost(2);
  t.add("rolling_damping_ratio", &S::rollingDampingRatio, "-", "of the rolling spring's critical damping")
      .atLeast(0)
      .atMost(1);
  t.add("cohesion", &S::cohesion, "J/m2",
        "energy of adhesion w: touching surfaces pull with 2 pi w R_eff (DMT); 0 leaves it out")
      .atLeast(0)
      .atMost(1e6);
  return t;
}

Table<ContactPair> contactTable() {
  using S = ContactPair;
  Table<S> t("contact.\"a|b\"", "What materials a and b have against each other, otherwise than the mixing rule gives");
  t.add("stiffness", &S::stiffness, "N/m", "normal stiffness of the pair").atLeast(1e-3).atMost(1e12);
  t.add("restitution", &S::restitution, "-", "rebound over impact speed of the pair").atLeast(1e-6).atMost(1);
  t.add("damping", &S::damping, "1/s", "gamma of the pair, instead of restitution").atLeast(0).atMost(1e9);
  t.add("friction", &S::friction, "-", "Coulomb coefficient of the pair").atLeast(0).atMost(10);
  t.add("rolling_friction", &S::rollingFriction, "-", "of the pair").atLeast(0).atMost(2);
  t.add("cohesion", &S::cohesion, "J/m2", "energy of adhesion of the pair").atLeast(0).atMost(1e6);
  return t;
}

Table<Grain> grainTable() {
  using S = Grain;
  Table<S> t("[grain]", "A single grain, for small scenes");
  t.add("position", &S::position, "m", "of the centre").required();
  t.add("velocity", &S::velocity, "m/s", "at the start").atLeast(-1e4).atMost(1e4);
  t.add("spin", &S::spin, "rad/s", "angular velocity at the start").atLeast(-1e6).atMost(1e6);
  t.add("radius", &S::radius, "m", "of the sphere").above(0).atMost(1e3).required();
  t.add("material", &S::material, "", "name of its material").required();
  return t;
}

Table<GrainFill> fillTable() {
  using S = GrainFill;
  Table<S> t("[grains]", "Many grains at once: a lattice, a random fill of a box, or a file of places and radii");
  t.add("form", &S::form, "", "lattice and random fill a box, file reads lines of x, y, z, r [m]");
  t.add("low", &S::low, "m", "corner of the box that holds the grains whole; not of a file");
  t.add("high", &S::high, "m", "the opposite corner");
  t.add("radius", &S::radius, "m", "of each, or of the smallest where radius_to is given; not of a file")
      .above(0)
      .atMost(1e3);
  t.add("radius_to", &S::radiusTo, "m", "of the largest: radii are uniform between").above(0).atMost(1e3);
  t.add("spacing", &S::spacing, "-", "of a lattice, in largest radii").atLeast(2).atMost(100);
  t.add("jitter", &S::jitter, "-", "random shift in a lattice, as a share of its free gap").atLeast(0).atMost(1);
  t.add("number", &S::number, "-", "of grains of a random fill").atLeast(1).atMost(1e8);
  t.add("file", &S::file, "", "text with a grain a line, relative to the scene");
  t.add("velocity", &S::velocity, "m/s", "at the start").atLeast(-1e4).atMost(1e4);
  t.add("spin", &S::spin, "rad/s", "at the start").atLeast(-1e6).atMost(1e6);
  t.add("material", &S::material, "", "name of their material").required();
  return t;
}

Table<Source> sourceTable() {
  using S = Source;
  Table<S> t("[source]", "Grains that enter while the run goes, at random places in a box");
  t.add("low", &S::low, "m", "corner of the box in which their centres start").required();
  t.add("high", &S::high, "m", "the opposite corner").required();
  t.add("velocity", &S::velocity, "m/s", "at which they enter").atLeast(-1e4).atMost(1e4);
  t.add("spin", &S::spin, "rad/s", "at which they enter").atLeast(-1e6).atMost(1e6);
  t.add("radius", &S::radius, "m", "of each").above(0).atMost(10).required();
  t.add("material", &S::material, "", "name of its material").required();
  t.add("number", &S::number, "-", "of grains that enter together").atLeast(1).atMost(1e6);
  t.add("every", &S::every, "s", "time between those").above(0).required();
  t.add("start", &S::start, "s", "time of the first").atLeast(0);
  t.add("total", &S::total, "-", "of grains in all").atLeast(1).atMost(1e8).required();
  return t;
}

Table<Terrain> terrainTable() {
  using S = Terrain;
  Table<S> t("terrain", "Ground from a height-map image: a bed of grains, or rigid");
  t.add("heightmap", &S::heightmap, "", "PNG, 8 or 16 bit; row 0 is the far edge (largest y), pixels are points")
      .required();
  t.add("size", &S::size, "m", "extent in x, from 0, and in y, to both sides of 0").above(0).atMost(1e5).required();
  t.add("height_range", &S::heightRange, "m", "height of black and of white").atLeast(-1e4).atMost(1e4).required();
  t.add("kind", &S::kind, "", "a bed of grains or rigid ground");
  t.add("material", &S::material, "", "of the grains, or of the rigid ground").required();
  t.add("ground_material", &S::groundMaterial, "", "of floor and walls; the bed's own where not given");
  t.add("grain_radius", &S::grainRadius, "m", "of every grain; required for a granular bed").above(0).atMost(10);
  t.add("layers", &S::layers, "-", "grain layers above the floor; this or depth").atLeast(1).atMost(10000);
  t.add("depth", &S::depth, "m", "of the bed; this or layers").above(0).atMost(1e3);
  t.add("spacing", &S::spacing, "-", "of the lattice that the grains start on, in radii").above(2).atMost(10);
  t.add("jitter", &S::jitter, "-", "random shift at the start, as a share of the lattice's free gap")
      .atLeast(0)
      .atMost(1);
  t.add("packing", &S::packing, "-", "solid fraction expected once settled").atLeast(0.3).atMost(0.74);
  t.add("tile", &S::tile, "m",
        "x, y of a piece that is settled alone, with periodic boundaries, and copied over the terrain; needs a level "
        "floor")
      .above(0);
  t.add("floor", &S::floor, "", "rigid floor: follows the surface below the bed, or flat");
  t.add("walls", &S::walls, "", "upright walls along the edges of the map, that hold the bed");
  t.add("settle_time_limit", &S::settleTimeLimit, "s", "the bed must be at rest by then; 0 leaves settling out")
      .atLeast(0)
      .atMost(1e4);
  t.add("settle_kinetic_energy", &S::settleKineticEnergy, "-", "at rest: mean kinetic energy a grain over m g radius")
      .above(0)
      .atMost(1e3);
  t.add("settle_force_ratio", &S::settleForceRatio, "-",
        "at rest also: mean resultant force on a grain over its weight; \"none\" asks for the energy alone")
      .above(0)
      .atMost(1e3)
      .orWord("none");
  t.add("cache", &S::cache, "", "keep the settled bed for later runs, and take it from an earlier one; same bits");
  return t;
}

Table<Vehicle> vehicleTable() {
  using S = Vehicle;
  Table<S> t("vehicle", "A tracked vehicle");
  t.add("spec", &S::spec, "", "vehicle file, relative to the scene or to the assets folder").required();
  t.add("position", &S::position, "m",
        "x and y of the point between the sprockets; \"auto\" is on the terrain's near end")
      .atLeast(-1e6)
      .atMost(1e6)
      .orWord("auto");
  t.add("heading", &S::heading, "deg", "from the x axis, counter-clockwise seen from above").atLeast(-360).atMost(360);
  t.add("clearance", &S::clearance, "m", "between lowest grouser and highest ground below at the start")
      .atLeast(0)
      .atMost(10);
  t.add("sphere_radius", &S::sphereRadius, "m", "of the parts' sphere sets").above(0).atMost(1);
  t.add("material", &S::material, "", "of the parts against the ground; the contact data of the spec where not given");
  t.add("chassis", &S::chassis, "", "free to move, or held in place as on a bench");
  return t;
}

Table<Driver> driverTable() {
  using S = Driver;
  Table<S> t("driver", "Sprocket speeds and the order of the start: tension, weight, drive");
  t.add("sprocket_speed", &S::sprocketSpeed, "rad/s", "of both sprockets; positive drives forward")
      .atLeast(-100)
      .atMost(100);
  t.add("left", &S::left, "rad/s", "of the left sprocket, together with right").atLeast(-100).atMost(100);
  t.add("right", &S::right, "rad/s", "of the right sprocket, together with left").atLeast(-100).atMost(100);
  t.add("tension_ramp", &S::tensionRamp, "s", "over which the idlers' springs come on").atLeast(0).atMost(1e3);
  t.add("weight_ramp", &S::weightRamp, "s", "over which gravity and the arms' preload come on, then")
      .atLeast(0)
      .atMost(1e3);
  t.add("drive_start", &S::driveStart, "s", "\"auto\" is the end of the weight's ramp")
      .atLeast(0)
      .atMost(1e5)
      .orWord("auto");
  t.add("drive_ramp", &S::driveRamp, "s", "over which the sprockets come up to speed").atLeast(0).atMost(1e3);
  return t;
}

Table<SpeedTable> speedTable() {
  using S = SpeedTable;
  Table<S> t("driver.table", "Sprocket speeds over time, instead of fixed ones; linear between the points");
  t.add("time", &S::time, "s", "from the start of the drive, increasing").atLeast(0).required();
  t.add("left", &S::left, "rad/s", "left sprocket at these times").atLeast(-100).atMost(100).required();
  t.add("right", &S::right, "rad/s", "right sprocket at these times").atLeast(-100).atMost(100).required();
  return t;
}

Table<Output> outputTable() {
  using S = Output;
  Table<S> t("output", "What a run leaves; intervals stand in [run]");
  t.add("folder", &S::folder, "", "of the results, from where grouser is called; out/NAME where not given");
  t.add("record", &S::record, "", "names of what of a mechanism goes into the time series; all where empty");
  t.add("frames", &S::frames, "", "frames.h5 and frames.xdmf for ParaView");
  t.add("grains_csv", &S::grainsCsv, "",
        "grains.csv with every grain at every output time; \"auto\": up to 1000 grains and 1e6 lines")
      .orWord("auto");
  t.add("picture", &S::picture, "", "picture.png of vehicle and bed at the end");
  t.add("picture_width", &S::pictureWidth, "px", "width of that picture").atLeast(64).atMost(8192);
  t.add("plots", &S::plots, "", "plots of the time series, by Python and matplotlib");
  return t;
}

Table<Parallel> parallelTable() {
  using S = Parallel;
  Table<S> t("parallel", "Runs on several ranks (mpirun -np N); the answer is the same for any number of them");
  t.add("subdomains", &S::subdomains, "-",
        "lattice of subdomains along x, y and z, whose product is the number of ranks; 0 leaves an axis free")
      .atLeast(0)
      .atMost(64)
      .orWord("auto");
  t.add("cuts_x", &S::cutsX, "m", "where the planes between subdomains stand at first, across x; chosen where empty");
  t.add("cuts_y", &S::cutsY, "m", "the same across y");
  t.add("cuts_z", &S::cutsZ, "m", "the same across z");
  t.add("rebalance", &S::rebalance, "", "move the cuts when one rank has clearly more work than the mean");
  t.add("peer_memory", &S::peerMemory, "",
        "GPUs of one machine read each other's memory instead of sending messages: where they can, never, or not "
        "without (then ranks on CPUs share memory too)");
  return t;
}

} // namespace grouser::scene::detail
