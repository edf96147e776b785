// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/options.hpp"

#include "base/error.hpp"
#include "runs/support/option_checks.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/validation/studies/fluid_cases.hpp"
#include "runs/validation/studies/option_parts.hpp"

namespace grouser::studies {

namespace {

void addImpact(CLI::App& study, ImpactCommand& c) {
  CLI::App* impact = study.add_subcommand(
      "impact", "One collision against its closed form: errors, orders and CPU time over the step (3 min, one core)");
  impact->add_option("--phases", c.phases.touching, "of first touch within a step, side by side")
      ->check(support::wholeNumber(1, 1000))
      ->capture_default_str();
  impact->add_option("--leaving", c.phases.leaving, "contacts made longer by parts of a step: phases of leaving")
      ->check(support::wholeNumber(1, 100))
      ->capture_default_str();
  impact->add_option("--collisions", c.collisions, "at once where time is taken")
      ->check(support::wholeNumber(1, 100'000))
      ->capture_default_str();
  impact->add_option("--repeats", c.repeats, "of each timing; the median is reported")
      ->check(support::wholeNumber(1, 1000))
      ->capture_default_str();
  addPlace(*impact, c.place, "impact", "four damping ratios and steps down to 1/160 of a contact only, in seconds");
  impact->callback([&c] { studyImpactCommand(c); });
}

/// Words of which each is of one kind of map alone.
void checkStabilityWords(const CLI::App& stability, bool random, const std::string& scene) {
  const bool vehicle = scene == "vehicle";
  const auto only = [&](const char* name, bool may, const char* with) {
    if (!may && stability.count(name) > 0)
      throw base::InputError(fmt::format("{} is of {} alone; leave it out, or add that", name, with));
  };
  for (const char* name : {"--maps", "--part", "--seconds", "--device", "--threads"})
    only(name, vehicle, "--scene vehicle");
  only("--resume", vehicle || random, "--scene vehicle and --random");
  for (const char* name : {"--random", "--grains", "--column"}) only(name, !vehicle, "--scene grains");
}

void addVehicleStability(CLI::App& stability, std::string& scene, VehicleStability& c) {
  stability
      .add_option("--scene", scene,
                  "grains, or vehicle: maps of the tracked vehicle over tension, grains, stiffness, drop, gravity, "
                  "masses, inertias, speed, reversed drives, bumps and ledges, each point against a quarter of its "
                  "step; exit code 3 if one is silently wrong "
                  "or stopped for a wrong cause (an hour on one core; with --quick some minutes)")
      ->check(CLI::IsMember({"grains", "vehicle"}))
      ->capture_default_str();
  stability
      .add_option(
          "--maps", c.maps,
          fmt::format("of the vehicle, separated by commas: {}; default: all", fmt::join(vehicleMapNames(), ", ")))
      ->delimiter(',');
  jobs::addPieceOptions(stability, c.pieces);
}

void addStability(CLI::App& study, GrainStudies& studies) {
  GrainStabilityCommand& c = studies.stability;
  RandomStability& random = studies.randomStability;
  CLI::App* stability = study.add_subcommand(
      "stability", "Maps of stable steps of grains over stiffness and damping: one contact, a column, random beds, "
                   "beside predicted limits (half a minute, one core), or of a vehicle; of mechanisms: multibody "
                   "--stability");
  addVehicleStability(*stability, studies.stabilityScene, studies.vehicleStability);
  QuickValues quick;
  quick.instead(stability->add_option("--grains", c.bedGrains, "of the random beds")
                    ->check(support::wholeNumber(8, 100'000))
                    ->capture_default_str(),
                c.bedGrains, 60);
  stability->add_option("--column", c.columnGrains, "grains of the column")
      ->check(support::wholeNumber(1, 1000))
      ->capture_default_str();
  addPlace(*stability, c.place, "stability (of a vehicle: out/study_stability_vehicle)",
           "one stiffness and three damping ratios only, in seconds; of a vehicle a few points of each map");
  CLI::Option* scenes =
      stability
          ->add_option(
              "--random", random.scenes,
              "instead: so many random scenes, each at its automatic step and its limit, and by bisection at the "
              "longest that is sound; exit code 3 if one is not at the former (200: 7 min, one core)")
          ->check(support::wholeNumber(1, 1'000'000));
  stability->add_option("--seed", random.seed, "of the random scenes")
      ->check(support::wholeNumber(0, 1'000'000'000))
      ->capture_default_str()
      ->needs(scenes);
  stability->callback([&c, &random, &studies, stability, quick] {
    checkStabilityWords(*stability, random.scenes > 0, studies.stabilityScene);
    if (c.place.quick) quick.take();
    random.resume = studies.vehicleStability.pieces.resume;
    if (studies.stabilityScene == "vehicle")
      studyVehicleStability(studies.vehicleStability, c.place);
    else if (random.scenes > 0)
      studyRandomStability(random, c.place);
    else
      try {
        studyGrainStabilityCommand(c);
      } catch (const support::Stopped& stopped) {
        throw support::Stopped(stopped.signal(), stopped.what(), support::Stopped::Left::nothing);
      }
  });
}

void addRandomVehicles(CLI::App& study, RandomVehicles& c) {
  CLI::App* vehicles = study.add_subcommand(
      "random-vehicles",
      "Random tracked vehicles on rigid ground and small beds: each ends sound, is refused, or is "
      "stopped with a cause; exit code 3 if one is silently wrong (100: half an hour or more, one core)");
  QuickValues quick;
  quick.instead(vehicles->add_option("--vehicles", c.vehicles, "how many, from the first on")
                    ->check(support::wholeNumber(1, 1'000'000))
                    ->capture_default_str(),
                c.vehicles, 3);
  vehicles->add_option("--seed", c.seed, "of the vehicles")
      ->check(support::wholeNumber(0, 1'000'000'000))
      ->capture_default_str();
  jobs::addPieceOptions(*vehicles, c.pieces);
  addPlace(*vehicles, c.place, "random_vehicles", "three vehicles, in half a minute");
  doStudy(*vehicles, c, studyRandomVehicles, quick);
}

void addPrecision(CLI::App& study, PrecisionCommand& c) {
  CLI::App* precision = study.add_subcommand(
      "precision", "Single against double precision: who touches whom, how far runs drift apart, and what is measured "
                   "after (8 min, one core)");
  QuickValues quick;
  quick.instead(precision->add_option("--grains", c.touch.grains, "of the bed whose touch decisions are judged")
                    ->check(support::wholeNumber(10, 100'000'000))
                    ->capture_default_str(),
                c.touch.grains, 2000);
  quick.instead(precision->add_option("--configurations", c.touch.configurations, "of that bed along its run")
                    ->check(support::wholeNumber(1, 1'000'000))
                    ->capture_default_str(),
                c.touch.configurations, 5);
  precision->add_option("--every", c.touch.every, "steps from one configuration to the next")
      ->check(support::wholeNumber(1, 1'000'000'000))
      ->capture_default_str();
  quick.instead(precision->add_option("--drift-grains", c.drift.grains, "of the runs that drift apart")
                    ->check(support::wholeNumber(10, 100'000'000))
                    ->capture_default_str(),
                c.drift.grains, 200);
  quick.instead(precision->add_option("--gas-time", c.drift.gasTime, "of the gas [s]")
                    ->check(support::positive("a time in seconds"))
                    ->capture_default_str(),
                c.drift.gasTime, 0.1);
  quick.instead(precision->add_option("--bed-time", c.drift.bedTime, "of the dropped bed [s]")
                    ->check(support::positive("a time in seconds"))
                    ->capture_default_str(),
                c.drift.bedTime, 0.1);
  quick.instead(precision->add_option("--runs", c.drift.runs, "of the dropped bed in each precision")
                    ->check(support::wholeNumber(2, 10'000))
                    ->capture_default_str(),
                c.drift.runs, 3);
  precision->add_option("--threads", c.threads, "CPU threads, 0 for all; the answer does not depend on it")
      ->check(support::wholeNumber(0, 1024));
  addPlace(*precision, c.place, "precision", "few grains, configurations and runs, in seconds");
  doStudy(*precision, c, studyPrecisionCommand, quick);
}

void addPacking(CLI::App& study, PackingCommand& c) {
  CLI::App* packing = study.add_subcommand(
      "packing", "How densely poured spheres lie over their friction, against random packings (10 min, one core)");
  QuickValues quick;
  quick.instead(packing->add_option("--grains", c.grains, "of a sample")
                    ->check(support::wholeNumber(300, 1'000'000))
                    ->capture_default_str(),
                c.grains, 600);
  quick.instead(addSeeds(*packing, c.seeds, "samples of each friction"), c.seeds, 2);
  quick.instead(addNumber(*packing, "--width", c.width, 5.0, 1000.0, "between periodic boundaries, in diameters"),
                c.width, 7);
  addPlace(*packing, c.place, "packing", "two frictions, two seeds, 600 grains: in seconds");
  doStudy(*packing, c, studyPackingCommand, quick);
}

void addCollapse(CLI::App& study, CollapseCommand& c) {
  CLI::App* collapse = study.add_subcommand(
      "collapse", "How far a column of grains runs when its gate is gone, against channels (30 min, one core)");
  QuickValues quick;
  quick.instead(addNumber(*collapse, "--length", c.length, 5.0, 1000.0, "of the column, in diameters"), c.length, 10);
  addNumber(*collapse, "--width", c.width, 5.0, 1000.0, "between periodic boundaries, in diameters");
  quick.instead(collapse->add_option("--aspects", c.aspects, "heights of the columns over their length")
                    ->check(support::between(0.2, 20.0))
                    ->capture_default_str(),
                c.aspects, {1});
  addContact(*collapse, c.contact, "of the column without its gate; it settles with penalty contacts");
  quick.instead(addSeeds(*collapse, c.seeds, "columns of each aspect"), c.seeds, 2);
  addPlace(*collapse, c.place, "collapse", "one aspect, two columns of 10 d: in seconds");
  doStudy(*collapse, c, studyCollapseCommand, quick);
}

void addShear(CLI::App& study, ShearCommand& c) {
  CLI::App* shear = study.add_subcommand(
      "shear", "A direct shear box under several loads: the friction angle of a bed (10 min, one core)");
  addNumber(*shear, "--friction", c.friction, 0.0, 5.0, "between grains, and between grains and box [-]");
  addNumber(*shear, "--rolling-friction", c.rollingFriction, 0.0, 5.0, "the same of rolling [-]");
  QuickValues quick;
  quick.instead(shear->add_option("--stresses", c.stresses, "of the lid on the sample [Pa]")
                    ->check(support::between(10.0, 1e5))
                    ->capture_default_str(),
                c.stresses, {2000});
  addContact(*shear, c.box.contact, "of grains");
  quick.instead(addSeeds(*shear, c.seeds, "samples of each load"), c.seeds, 2);
  addPlace(*shear, c.place, "shear", "one load, two samples of 10 d: in seconds");
  doStudy(*shear, c, studyShearCommand, quick);
}

void addFeatures(CLI::App& study, FeaturesCommand& c) {
  CLI::App* app = study.add_subcommand(
      "features", "What each feature costs in time and memory when it is on, in turns with a bed without it, and that "
                  "it costs nothing when it is off (3 min)");
  app->add_option("--features", c.features,
                  "names, separated by commas, such as rolling,hertz,off_rolling; default: all")
      ->delimiter(',');
  QuickValues quick;
  quick.instead(app->add_option("--grains", c.grains, "of the bed, about")
                    ->check(support::wholeNumber(864, 100'000'000))
                    ->capture_default_str(),
                c.grains, 864);
  quick.instead(app->add_option("--pairs", c.pairs, "of turns without and with a feature")
                    ->check(support::wholeNumber(2, 1000))
                    ->capture_default_str(),
                c.pairs, 5);
  quick.instead(app->add_option("--turn", c.turn, "length of a turn [s]")
                    ->check(support::positive("a time in seconds"))
                    ->capture_default_str(),
                c.turn, 0.01);
  jobs::addPieceOptions(*app, c.pieces);
  addPlace(*app, c.place, "features", "864 grains and short turns: in seconds");
  doStudy(*app, c, studyFeaturesCommand, quick);
}

void addFluid(CLI::App& study, FluidCommand& c) {
  CLI::App* app = study.add_subcommand(
      "fluid", "Flows of the particle fluid whose solution is known: error and order in spacing against run time");
  std::string names;
  for (const FluidCase& known : fluidCases()) names += (names.empty() ? "" : ", ") + known.name;
  app->add_option("--cases", c.cases, "names, separated by commas, of " + names + "; default: all")->delimiter(',');
  jobs::addDeviceOptions(*app, c.device, c.threads);
  addPlace(*app, c.place, "fluid", "without the finest spacing");
  doStudy(*app, c, studyFluidCommand, {});
}

} // namespace

void addGrainStudies(CLI::App& study, GrainStudies& studies) {
  addImpact(study, studies.impact);
  addStability(study, studies);
  addRandomVehicles(study, studies.randomVehicles);
  addPrecision(study, studies.precision);
  addPacking(study, studies.packing);
  addCollapse(study, studies.collapse);
  addShear(study, studies.shear);
  addFeatures(study, studies.features);
  addFluid(study, studies.fluid);
}

} // namespace grouser::studies
