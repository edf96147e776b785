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
      "impact",
      "Accuracy of one collision against its closed form: errors, orders and CPU time over the step (3 min, one core)");
  impact->add_option("--phases", c.phases.touching, "number of phases of first contact within a step")
      ->check(support::wholeNumber(1, 1000))
      ->capture_default_str();
  impact->add_option("--leaving", c.phases.leaving, "number of phases of separation within a step")
      ->check(support::wholeNumber(1, 100))
      ->capture_default_str();
  impact->add_option("--collisions", c.collisions, "number of simultaneous collisions in timings")
      ->check(support::wholeNumber(1, 100'000))
      ->capture_default_str();
  impact->add_option("--repeats", c.repeats, "repetitions of each timing; the median is reported")
      ->check(support::wholeNumber(1, 1000))
      ->capture_default_str();
  addPlace(*impact, c.place, "impact", "only four damping ratios and steps down to 1/160 of a contact (seconds)");
  impact->callback([&c] { studyImpactCommand(c); });
}

/// Rejects options that apply to the other kind of map only.
void checkStabilityWords(const CLI::App& stability, bool random, const std::string& scene) {
  const bool vehicle = scene == "vehicle";
  const auto only = [&](const char* name, bool may, const char* with) {
    if (!may && stability.count(name) > 0)
      throw base::InputError(fmt::format("{} requires {}; remove it or add that option", name, with));
  };
  for (const char* name : {"--maps", "--part", "--seconds", "--device", "--threads"})
    only(name, vehicle, "--scene vehicle");
  only("--resume", vehicle || random, "--scene vehicle or --random");
  for (const char* name : {"--random", "--grains", "--column"}) only(name, !vehicle, "--scene grains");
}

void addVehicleStability(CLI::App& stability, std::string& scene, VehicleStability& c) {
  stability
      .add_option(
          "--scene", scene,
          "grains, or vehicle: maps of the tracked vehicle over tension, grains, stiffness, drop height, gravity, "
          "masses, inertias, speed, reversed drives, bumps and ledges; each point is compared with a run at a "
          "quarter of its step; exit code 3 if one is silently wrong or stopped for a wrong cause (an hour on "
          "one core; with --quick some minutes)")
      ->check(CLI::IsMember({"grains", "vehicle"}))
      ->capture_default_str();
  stability
      .add_option(
          "--maps", c.maps,
          fmt::format("maps of the vehicle, separated by commas: {}; default: all", fmt::join(vehicleMapNames(), ", ")))
      ->delimiter(',');
  jobs::addPieceOptions(stability, c.pieces);
}

void addStability(CLI::App& study, GrainStudies& studies) {
  GrainStabilityCommand& c = studies.stability;
  RandomStability& random = studies.randomStability;
  CLI::App* stability = study.add_subcommand(
      "stability",
      "Maps of stable time steps of grains over stiffness and damping (one contact, a column, random beds) "
      "with predicted limits (half a minute, one core), or of a vehicle; for mechanisms: multibody "
      "--stability");
  addVehicleStability(*stability, studies.stabilityScene, studies.vehicleStability);
  QuickValues quick;
  quick.instead(stability->add_option("--grains", c.bedGrains, "grains of the random beds")
                    ->check(support::wholeNumber(8, 100'000))
                    ->capture_default_str(),
                c.bedGrains, 60);
  stability->add_option("--column", c.columnGrains, "grains of the column")
      ->check(support::wholeNumber(1, 1000))
      ->capture_default_str();
  addPlace(*stability, c.place, "stability (vehicle: out/study_stability_vehicle)",
           "only one stiffness and three damping ratios (seconds); vehicle: a few points of each map");
  CLI::Option* scenes =
      stability
          ->add_option(
              "--random", random.scenes,
              "number of random scenes, run instead of the maps at the automatic step, at the step limit, and by "
              "bisection at the longest sound step; exit code 3 if one is unsound at the first two (200: 7 min, one "
              "core)")
          ->check(support::wholeNumber(1, 1'000'000));
  stability->add_option("--seed", random.seed, "seed of the random scenes")
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
      "Random tracked vehicles on rigid ground and small beds: each run must be sound, rejected, or "
      "stopped with a cause; exit code 3 if one is silently wrong (100: half an hour or more, one core)");
  QuickValues quick;
  quick.instead(vehicles->add_option("--vehicles", c.vehicles, "number of vehicles")
                    ->check(support::wholeNumber(1, 1'000'000))
                    ->capture_default_str(),
                c.vehicles, 3);
  vehicles->add_option("--seed", c.seed, "seed of the vehicles")
      ->check(support::wholeNumber(0, 1'000'000'000))
      ->capture_default_str();
  jobs::addPieceOptions(*vehicles, c.pieces);
  addPlace(*vehicles, c.place, "random_vehicles", "three vehicles (half a minute)");
  doStudy(*vehicles, c, studyRandomVehicles, quick);
}

void addPrecision(CLI::App& study, PrecisionCommand& c) {
  CLI::App* precision = study.add_subcommand(
      "precision", "Single against double precision: contact decisions, drift between two runs, and differences of "
                   "macroscopic quantities (8 min, one core)");
  QuickValues quick;
  quick.instead(
      precision->add_option("--grains", c.touch.grains, "grains of the bed whose contact decisions are compared")
          ->check(support::wholeNumber(10, 100'000'000))
          ->capture_default_str(),
      c.touch.grains, 2000);
  quick.instead(
      precision->add_option("--configurations", c.touch.configurations, "number of configurations of that bed")
          ->check(support::wholeNumber(1, 1'000'000))
          ->capture_default_str(),
      c.touch.configurations, 5);
  precision->add_option("--every", c.touch.every, "steps between configurations")
      ->check(support::wholeNumber(1, 1'000'000'000))
      ->capture_default_str();
  quick.instead(precision->add_option("--drift-grains", c.drift.grains, "grains of the runs whose drift is measured")
                    ->check(support::wholeNumber(10, 100'000'000))
                    ->capture_default_str(),
                c.drift.grains, 200);
  quick.instead(precision->add_option("--gas-time", c.drift.gasTime, "duration of the gas run [s]")
                    ->check(support::positive("a time in seconds"))
                    ->capture_default_str(),
                c.drift.gasTime, 0.1);
  quick.instead(precision->add_option("--bed-time", c.drift.bedTime, "duration of the dropped bed run [s]")
                    ->check(support::positive("a time in seconds"))
                    ->capture_default_str(),
                c.drift.bedTime, 0.1);
  quick.instead(precision->add_option("--runs", c.drift.runs, "runs of the dropped bed in each precision")
                    ->check(support::wholeNumber(2, 10'000))
                    ->capture_default_str(),
                c.drift.runs, 3);
  precision->add_option("--threads", c.threads, "CPU threads, 0: all; results do not depend on it")
      ->check(support::wholeNumber(0, 1024));
  addPlace(*precision, c.place, "precision", "few grains, configurations and runs (seconds)");
  doStudy(*precision, c, studyPrecisionCommand, quick);
}

void addPacking(CLI::App& study, PackingCommand& c) {
  CLI::App* packing = study.add_subcommand(
      "packing", "Solid fraction of poured spheres over friction, against random packings (10 min, one core)");
  QuickValues quick;
  quick.instead(packing->add_option("--grains", c.grains, "grains of a sample")
                    ->check(support::wholeNumber(300, 1'000'000))
                    ->capture_default_str(),
                c.grains, 600);
  quick.instead(addSeeds(*packing, c.seeds, "samples per friction"), c.seeds, 2);
  quick.instead(addNumber(*packing, "--width", c.width, 5.0, 1000.0, "distance of the periodic boundaries [d]"),
                c.width, 7);
  addPlace(*packing, c.place, "packing", "two frictions, two seeds, 600 grains (seconds)");
  doStudy(*packing, c, studyPackingCommand, quick);
}

void addCollapse(CLI::App& study, CollapseCommand& c) {
  CLI::App* collapse = study.add_subcommand(
      "collapse", "Run-out of a collapsing column of grains, against channel experiments (30 min, one core)");
  QuickValues quick;
  quick.instead(addNumber(*collapse, "--length", c.length, 5.0, 1000.0, "length of the column [d]"), c.length, 10);
  addNumber(*collapse, "--width", c.width, 5.0, 1000.0, "distance of the periodic boundaries [d]");
  quick.instead(collapse->add_option("--aspects", c.aspects, "height / length of the columns [-]")
                    ->check(support::between(0.2, 20.0))
                    ->capture_default_str(),
                c.aspects, {1});
  addContact(*collapse, c.contact, "during the collapse (settling always uses penalty contacts)");
  quick.instead(addSeeds(*collapse, c.seeds, "columns per aspect ratio"), c.seeds, 2);
  addPlace(*collapse, c.place, "collapse", "one aspect ratio, two columns of 10 d (seconds)");
  doStudy(*collapse, c, studyCollapseCommand, quick);
}

void addShear(CLI::App& study, ShearCommand& c) {
  CLI::App* shear =
      study.add_subcommand("shear", "Direct shear box under several loads: friction angle of a bed (10 min, one core)");
  addNumber(*shear, "--friction", c.friction, 0.0, 5.0, "friction between grains, and of grains and box [-]");
  addNumber(*shear, "--rolling-friction", c.rollingFriction, 0.0, 5.0, "rolling friction of the same contacts [-]");
  QuickValues quick;
  quick.instead(shear->add_option("--stresses", c.stresses, "normal stress on the lid [Pa]")
                    ->check(support::between(10.0, 1e5))
                    ->capture_default_str(),
                c.stresses, {2000});
  addContact(*shear, c.box.contact, "of the grains");
  quick.instead(addSeeds(*shear, c.seeds, "samples per load"), c.seeds, 2);
  addPlace(*shear, c.place, "shear", "one load, two samples of 10 d (seconds)");
  doStudy(*shear, c, studyShearCommand, quick);
}

void addFeatures(CLI::App& study, FeaturesCommand& c) {
  CLI::App* app = study.add_subcommand(
      "features", "Time and memory of each feature, measured alternately with a bed without it, and check that "
                  "features that are off cost nothing (3 min)");
  app->add_option("--features", c.features,
                  "names, separated by commas, such as rolling,hertz,off_rolling; default: all")
      ->delimiter(',');
  QuickValues quick;
  quick.instead(app->add_option("--grains", c.grains, "approximate number of grains")
                    ->check(support::wholeNumber(864, 100'000'000))
                    ->capture_default_str(),
                c.grains, 864);
  quick.instead(app->add_option("--pairs", c.pairs, "pairs of measurements without and with the feature")
                    ->check(support::wholeNumber(2, 1000))
                    ->capture_default_str(),
                c.pairs, 5);
  quick.instead(app->add_option("--turn", c.turn, "duration of one measurement [s]")
                    ->check(support::positive("a time in seconds"))
                    ->capture_default_str(),
                c.turn, 0.01);
  jobs::addPieceOptions(*app, c.pieces);
  addPlace(*app, c.place, "features", "864 grains, short measurements (seconds)");
  doStudy(*app, c, studyFeaturesCommand, quick);
}

void addFluid(CLI::App& study, FluidCommand& c) {
  CLI::App* app =
      study.add_subcommand("fluid", "Particle fluid against known solutions: error and order in spacing over run time");
  std::string names;
  for (const FluidCase& known : fluidCases()) names += (names.empty() ? "" : ", ") + known.name;
  app->add_option("--cases", c.cases, "names, separated by commas: " + names + "; default: all")->delimiter(',');
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
