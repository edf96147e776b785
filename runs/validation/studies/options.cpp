// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/options.hpp"

#include "base/error.hpp"
#include "runs/support/option_checks.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/validation/studies/fluid_cases.hpp"
#include "runs/validation/studies/option_parts.hpp"

#include <fmt/ranges.h>

namespace grouser::studies {

namespace {

void addImpact(CLI::App& study, ImpactCommand& c) {
  CLI::App* impact = study.add_subcommand("impact", "Compare a single collision with its closed-form solution: error, "
                                                    "order and CPU time over the time step (3 min on one core)");
  impact->add_option("--phases", c.phases.touching, "number of phases of first contact within a step")
      ->check(support::wholeNumber(1, 1000))
      ->capture_default_str();
  impact->add_option("--leaving", c.phases.leaving, "number of phases of separation within a step")
      ->check(support::wholeNumber(1, 100))
      ->capture_default_str();
  impact->add_option("--collisions", c.collisions, "number of simultaneous collisions in timings")
      ->check(support::wholeNumber(1, 100'000))
      ->capture_default_str();
  impact->add_option("--repeats", c.repeats, "number of repetitions of each timing; the median is reported")
      ->check(support::wholeNumber(1, 1000))
      ->capture_default_str();
  addPlace(*impact, c.place, "impact", "use four damping ratios and steps down to 1/160 of a contact (takes seconds)");
  impact->callback([&c] { studyImpactCommand(c); });
}

/// Rejects options that apply only to the other kind of map.
void checkStabilityWords(const CLI::App& stability, bool random, const std::string& scene) {
  const bool vehicle = scene == "vehicle";
  const auto only = [&](const char* name, bool may, const char* with) {
    if (!may && stability.count(name) > 0)
      throw base::InputError(fmt::format("{} requires {}; add that option, or remove this one", name, with));
  };
  for (const char* name : {"--maps", "--part", "--seconds", "--device", "--threads"})
    only(name, vehicle, "--scene vehicle");
  only("--resume", vehicle || random, "--scene vehicle or --random");
  for (const char* name : {"--random", "--grains", "--column"}) only(name, !vehicle, "--scene grains");
}

void addVehicleStability(CLI::App& stability, std::string& scene, VehicleStability& c) {
  stability
      .add_option("--scene", scene,
                  "grains, or vehicle (maps of the tracked vehicle over tension, grains, stiffness, drop height, "
                  "gravity, masses, inertias, speed, reversed drives, bumps and ledges; compares each run with a run "
                  "at a quarter of its step; exit code 3 if a run is wrong without an error message or stops with a "
                  "wrong cause; one hour on one core, some minutes with --quick)")
      ->check(CLI::IsMember({"grains", "vehicle"}))
      ->capture_default_str();
  stability
      .add_option("--maps", c.maps,
                  fmt::format("run only these vehicle maps, separated by commas: {}; default: all",
                              fmt::join(vehicleMapNames(), ", ")))
      ->delimiter(',');
  jobs::addPieceOptions(stability, c.pieces);
}

void addStability(CLI::App& study, GrainStudies& studies) {
  GrainStabilityCommand& c = studies.stability;
  RandomStability& random = studies.randomStability;
  CLI::App* stability = study.add_subcommand(
      "stability",
      "Map the stable time steps of grains over stiffness and damping (one contact, a column, random beds), with "
      "predicted limits (half a minute on one core), or of a vehicle; for mechanisms, use multibody --stability");
  addVehicleStability(*stability, studies.stabilityScene, studies.vehicleStability);
  QuickValues quick;
  quick.instead(stability->add_option("--grains", c.bedGrains, "number of grains in the random beds")
                    ->check(support::wholeNumber(8, 100'000))
                    ->capture_default_str(),
                c.bedGrains, 60);
  stability->add_option("--column", c.columnGrains, "number of grains in the column")
      ->check(support::wholeNumber(1, 1000))
      ->capture_default_str();
  addPlace(*stability, c.place, "stability (vehicle: out/study_stability_vehicle)",
           "use one stiffness and three damping ratios (takes seconds); for a vehicle, a few points of each map");
  CLI::Option* scenes =
      stability
          ->add_option(
              "--random", random.scenes,
              "instead of the maps, run this number of random scenes at the automatic step and at the step "
              "limit, and find the longest sound step by bisection; exit code 3 if a scene raises an alarm at the "
              "automatic step or blows up at the step limit (200 scenes: 7 min on one core)")
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
      "Run random tracked vehicles on rigid ground and small beds: each run must be sound, be rejected, or stop with a "
      "correct cause; exit code 3 if a run is wrong without an error message or stops with a wrong cause (100 "
      "vehicles: "
      "half an hour or more on one core)");
  QuickValues quick;
  quick.instead(vehicles->add_option("--vehicles", c.vehicles, "number of random vehicles")
                    ->check(support::wholeNumber(1, 1'000'000))
                    ->capture_default_str(),
                c.vehicles, 3);
  vehicles->add_option("--seed", c.seed, "seed of the vehicles")
      ->check(support::wholeNumber(0, 1'000'000'000))
      ->capture_default_str();
  jobs::addPieceOptions(*vehicles, c.pieces);
  addPlace(*vehicles, c.place, "random_vehicles", "use three vehicles (takes half a minute)");
  doStudy(*vehicles, c, studyRandomVehicles, quick);
}

void addPrecision(CLI::App& study, PrecisionCommand& c) {
  CLI::App* precision = study.add_subcommand(
      "precision", "Compare single with double precision: contact decisions, drift between two runs, "
                   "and differences in macroscopic quantities (8 min on one core)");
  QuickValues quick;
  quick.instead(precision->add_option("--grains", c.touch.grains, "number of grains in the bed for contact decisions")
                    ->check(support::wholeNumber(10, 100'000'000))
                    ->capture_default_str(),
                c.touch.grains, 2000);
  quick.instead(precision
                    ->add_option("--configurations", c.touch.configurations,
                                 "number of configurations in which contacts are decided")
                    ->check(support::wholeNumber(1, 1'000'000))
                    ->capture_default_str(),
                c.touch.configurations, 5);
  precision->add_option("--every", c.touch.every, "number of steps between configurations")
      ->check(support::wholeNumber(1, 1'000'000'000))
      ->capture_default_str();
  quick.instead(precision->add_option("--drift-grains", c.drift.grains, "number of grains in the runs for the drift")
                    ->check(support::wholeNumber(10, 100'000'000))
                    ->capture_default_str(),
                c.drift.grains, 200);
  quick.instead(precision->add_option("--gas-time", c.drift.gasTime, "duration of the gas run [s]")
                    ->check(support::positive("a time in seconds"))
                    ->capture_default_str(),
                c.drift.gasTime, 0.1);
  quick.instead(precision->add_option("--bed-time", c.drift.bedTime, "duration of the dropped-bed run [s]")
                    ->check(support::positive("a time in seconds"))
                    ->capture_default_str(),
                c.drift.bedTime, 0.1);
  quick.instead(precision->add_option("--runs", c.drift.runs, "number of runs of the dropped bed per precision")
                    ->check(support::wholeNumber(2, 10'000))
                    ->capture_default_str(),
                c.drift.runs, 3);
  precision
      ->add_option(
          "--threads", c.threads,
          "number of CPU threads; 0: all available cores, at most OMP_NUM_THREADS; the results do not depend on it")
      ->check(support::wholeNumber(0, 1024));
  addPlace(*precision, c.place, "precision", "use few grains, configurations and runs (takes seconds)");
  doStudy(*precision, c, studyPrecisionCommand, quick);
}

void addPacking(CLI::App& study, PackingCommand& c) {
  CLI::App* packing = study.add_subcommand("packing", "Measure the solid fraction of poured spheres over friction, and "
                                                      "compare it with random packings (10 min on one core)");
  QuickValues quick;
  quick.instead(packing->add_option("--grains", c.grains, "number of grains per sample")
                    ->check(support::wholeNumber(300, 1'000'000))
                    ->capture_default_str(),
                c.grains, 600);
  quick.instead(addSeeds(*packing, c.seeds, "number of samples per friction coefficient"), c.seeds, 2);
  quick.instead(addNumber(*packing, "--width", c.width, 5.0, 1000.0,
                          "spacing between opposite periodic boundaries [grain diameters]"),
                c.width, 7);
  addPlace(*packing, c.place, "packing", "use two friction coefficients, two seeds and 600 grains (takes seconds)");
  doStudy(*packing, c, studyPackingCommand, quick);
}

void addCollapse(CLI::App& study, CollapseCommand& c) {
  CLI::App* collapse = study.add_subcommand("collapse", "Measure the run-out of a collapsing column of grains, and "
                                                        "compare it with experiments in channels (30 min on one "
                                                        "core)");
  QuickValues quick;
  quick.instead(addNumber(*collapse, "--length", c.length, 5.0, 1000.0, "length of the column [grain diameters]"),
                c.length, 10);
  addNumber(*collapse, "--width", c.width, 5.0, 1000.0,
            "spacing between opposite periodic boundaries [grain diameters]");
  quick.instead(collapse->add_option("--aspects", c.aspects, "aspect ratio (height / length) of the columns [-]")
                    ->check(support::between(0.2, 20.0))
                    ->capture_default_str(),
                c.aspects, {1});
  support::addChoice(*collapse, "--contact", c.contact,
                     "contact method of the collapse (settling always uses penalty contacts)");
  quick.instead(addSeeds(*collapse, c.seeds, "number of columns per aspect ratio"), c.seeds, 2);
  addPlace(*collapse, c.place, "collapse", "use one aspect ratio and two columns of 10 diameters (takes seconds)");
  doStudy(*collapse, c, studyCollapseCommand, quick);
}

void addShear(CLI::App& study, ShearCommand& c) {
  CLI::App* shear = study.add_subcommand(
      "shear", "Measure the friction angle of a bed in a direct shear box under several loads (10 min on one core)");
  addNumber(*shear, "--friction", c.friction, 0.0, 5.0, "friction between grains, and between grains and box [-]");
  addNumber(*shear, "--rolling-friction", c.rollingFriction, 0.0, 5.0, "rolling friction of the same contacts [-]");
  QuickValues quick;
  quick.instead(shear->add_option("--stresses", c.stresses, "normal stress on the lid [Pa]")
                    ->check(support::between(10.0, 1e5))
                    ->capture_default_str(),
                c.stresses, {2000});
  support::addChoice(*shear, "--contact", c.box.contact, "contact method of the grains");
  quick.instead(addSeeds(*shear, c.seeds, "number of samples per load"), c.seeds, 2);
  addPlace(*shear, c.place, "shear", "use one load and two samples of 10 diameters (takes seconds)");
  doStudy(*shear, c, studyShearCommand, quick);
}

void addFeatures(CLI::App& study, FeaturesCommand& c) {
  CLI::App* app =
      study.add_subcommand("features", "Measure time and memory of each feature by alternating runs with and "
                                       "without it, and check that disabled features cost nothing (3 min)");
  app->add_option("--features", c.features,
                  "measure only these features, separated by commas, e.g. rolling,hertz,off_rolling; default: all")
      ->delimiter(',');
  QuickValues quick;
  quick.instead(app->add_option("--grains", c.grains, "approximate number of grains")
                    ->check(support::wholeNumber(864, 100'000'000))
                    ->capture_default_str(),
                c.grains, 864);
  quick.instead(app->add_option("--pairs", c.pairs, "number of pairs of measurements with and without the feature")
                    ->check(support::wholeNumber(2, 1000))
                    ->capture_default_str(),
                c.pairs, 5);
  quick.instead(app->add_option("--turn", c.turn, "duration of one measurement [s]")
                    ->check(support::positive("a time in seconds"))
                    ->capture_default_str(),
                c.turn, 0.01);
  jobs::addPieceOptions(*app, c.pieces);
  addPlace(*app, c.place, "features", "use 864 grains and short measurements (takes seconds)");
  doStudy(*app, c, studyFeaturesCommand, quick);
}

void addFluid(CLI::App& study, FluidCommand& c) {
  CLI::App* app = study.add_subcommand(
      "fluid",
      "Compare the particle fluid with known solutions: error over spacing and run time, and order in the spacing");
  std::string names;
  for (const FluidCase& known : fluidCases()) names += (names.empty() ? "" : ", ") + known.name;
  app->add_option("--cases", c.cases, "run only these cases, separated by commas: " + names + "; default: all")
      ->delimiter(',');
  jobs::addDeviceOptions(*app, c.device, c.threads);
  addPlace(*app, c.place, "fluid", "omit the finest spacing");
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
