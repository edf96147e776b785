// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "runs/commands/command_entry.hpp"
#include "runs/support/option_checks.hpp"
#include "runs/virtual_tests/bevameter.hpp"
#include "runs/virtual_tests/calibration.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <functional>
#include <memory>
#include <type_traits>
#include <vector>

namespace grouser::commands {

namespace {

using virtual_tests::PlanOptions;

/// Options of the plan. An option on the command line keeps its value with --quick.
class PlanKeys {
public:
  explicit PlanKeys(PlanOptions& plan) : plan_(plan) {}

  template <class T> void add(CLI::App& app, const std::string& name, T PlanOptions::*member, CLI::Validator check,
                              const std::string& help) {
    const PlanOptions coarse = virtual_tests::coarsePlan();
    std::string quick;
    if constexpr (std::is_arithmetic_v<T>)
      if (coarse.*member != plan_.*member) quick = fmt::format("; {} with --quick", coarse.*member);
    CLI::Option* option =
        app.add_option(name, plan_.*member, help + quick)->check(std::move(check))->capture_default_str();
    given_.push_back([option, member](const PlanOptions& user, PlanOptions& taken) {
      if (option->count() > 0) taken.*member = user.*member;
    });
  }
  bool& wide() { return plan_.wide; } ///< false with --quick
  void takeQuick() {
    PlanOptions taken = virtual_tests::coarsePlan();
    for (const auto& given : given_) given(plan_, taken);
    plan_ = taken;
  }

private:
  PlanOptions& plan_;
  std::vector<std::function<void(const PlanOptions&, PlanOptions&)>> given_;
};

void addPlanOptions(CLI::App& soil, PlanKeys& keys) {
  keys.add(soil, "--seeds", &PlanOptions::seeds, support::wholeNumber(1, 1000),
           "number of beds for the small plate, and number of samples per shear load");
  keys.add(soil, "--large-seeds", &PlanOptions::largeSeeds, support::wholeNumber(1, 1000),
           "number of beds for the large plate");
  keys.add(soil, "--plate-grains", &PlanOptions::plateGrains, support::between(4, 1000),
           "width of the small plate [mean grain diameters]");
  keys.add(soil, "--plate-ratio", &PlanOptions::plateRatio, support::between(1.2, 20),
           "ratio of the plate widths, large / small [-]");
  keys.add(soil, "--bin", &PlanOptions::bin, support::between(2, 100),
           "bed width between the periodic boundaries [plate widths]");
  keys.add(soil, "--depth", &PlanOptions::depth, support::between(0.5, 100), "bed depth [plate widths]");
  keys.add(soil, "--thickness", &PlanOptions::thickness, support::between(3.5, 1000),
           "bed thickness along the strip [mean grain diameters]");
  keys.add(soil, "--pressure", &PlanOptions::maxPressure, support::between(1e3, 1e7),
           "maximum plate pressure [Pa]; the test ends earlier if the sinkage reaches 0.3 plate widths");
  keys.add(soil, "--inertial-number", &PlanOptions::inertialNumber, support::between(1e-6, 0.1),
           "inertial number of the plate tests: (speed / width) d sqrt(density / pressure) [-]");
  keys.add(soil, "--plate-waves", &PlanOptions::plateWaves, support::between(1e-4, 10),
           "maximum stress-wave pressure (density x wave speed x plate speed) of a moving plate, relative to the track "
           "pressure [-]; limits the plate speed in firm soil");
  keys.add(soil, "--shear-inertial-number", &PlanOptions::shearInertialNumber, support::between(1e-6, 0.1),
           "inertial number of the shear tests: rate d sqrt(density/stress) [-]");
  keys.add(soil, "--shear-strain", &PlanOptions::shearStrain, support::between(0.05, 5),
           "final shear strain of the layers [-]");
  keys.add(soil, "--shear-loads", &PlanOptions::loads, support::between(100.0, 1e7),
           "normal stresses of the shear tests [Pa]");
  keys.add(soil, "--steps-per-contact", &PlanOptions::stepsPerContact, support::between(6, 600),
           "number of time steps during the shortest contact; increased automatically after an unsound test");
  keys.add(soil, "--shear-height", &PlanOptions::shearHeight, support::between(0.01, 10),
           "height of the sheared layer [m]; at least ten grain diameters");
  soil.add_flag("!--no-wide", keys.wide(),
                "skip the small-plate tests on beds of twice the width (--calibrate always skips them)");
}

void doSoil(const virtual_tests::SoilCommand& c, const std::string& targets, const std::string& words) {
  if (c.soil.empty() == targets.empty())
    throw base::InputError("soil: specify either a soil to test, or --calibrate with a file of targets");
  if (c.fitScm && !targets.empty())
    throw base::InputError("soil: --fit-scm requires the name of a soil and is incompatible with --calibrate");
  if (targets.empty())
    virtual_tests::soilCommand(c);
  else
    virtual_tests::calibrateCommand({targets, c.grainRadius, c.place, c.pieces, c.jobs, c.plan, words});
}

} // namespace

void addSoil(CLI::App& app, const Invocation& invocation) {
  const auto command = std::make_shared<virtual_tests::SoilCommand>();
  virtual_tests::SoilCommand& c = *command;
  const auto targets = std::make_shared<std::string>();
  CLI::App* soil = app.add_subcommand(
      "soil",
      "Measure the constants of a soil (Bekker, Mohr-Coulomb, Janosi) in a virtual bevameter, with 95 % intervals");
  soil->add_option("soil", c.soil, "name of a soil, or a soil file (.toml)");
  soil->add_option("--calibrate", *targets,
                   "find contact parameters that reproduce the target constants in this file, and write a soil file");
  soil->add_option(
          "--grain-radius", c.grainRadius,
          "mean grain radius in the tests [m]; stiffness and cohesion are scaled to it; default: that of the soil file")
      ->check(support::positive("a length in metres"));
  const auto keys = std::make_shared<PlanKeys>(c.plan);
  addPlanOptions(*soil, *keys);
  jobs::addPieceOptions(*soil, c.pieces);
  soil->add_option("--jobs", c.jobs, "number of concurrent tests (processes); they share --threads")
      ->check(support::wholeNumber(1, 256))
      ->capture_default_str();
  soil->add_flag("--quick", c.place.quick,
                 "run a coarse test in minutes: narrow plates (in grain diameters), high speed");
  soil->add_flag(
      "--fit-scm", c.fitScm,
      "also fit the constants of [scm] (terrain.kind = \"scm\") to the tests, and report the residual of the fit");
  support::addOut(*soil, c.place.folder, "results folder; default: out/soil_NAME, or out/calibrate_NAME");
  soil->add_flag("--force", c.place.force, "overwrite existing results in the results folder");
  soil->callback([command, keys, targets, words = invocation.words] {
    if (command->place.quick) keys->takeQuick();
    doSoil(*command, *targets, words);
  });
}

} // namespace grouser::commands
