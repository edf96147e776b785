// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/command_entry.hpp"

#include "runs/support/option_checks.hpp"
#include "runs/validation/studies/cases.hpp"
#include "runs/validation/studies/multibody_command.hpp"
#include "runs/validation/studies/option_parts.hpp"
#include "runs/validation/studies/options.hpp"
#include "runs/validation/studies/soil_options.hpp"

#include <memory>

namespace grouser::commands {

void addStudy(CLI::App& app, const Invocation&) {
  const auto command = std::make_shared<studies::StudyCommand>();
  studies::StudyCommand& c = *command;
  CLI::App* study = app.add_subcommand(
      "study", "Run accuracy studies: error over run time, stable time steps, precision; writes tables and plots");
  study->require_subcommand(1);
  CLI::App* multibody = study->add_subcommand(
      "multibody",
      "Compare mechanisms with their exact motion: error, order, drift and CPU time of each integrator and time step");
  std::string names;
  for (const studies::StudyCase& known : studies::studyCases()) names += (names.empty() ? "" : ", ") + known.name;
  multibody->add_option("--cases", c.cases, "run only these cases, separated by commas: " + names + "; default: all")
      ->delimiter(',');
  multibody->add_flag("--stability", c.stability, "measure stable time steps instead, and compare them with theory");
  studies::addPlace(*multibody, c.place, "multibody",
                    "use only three long time steps, and skip cases that run for minutes");
  studies::QuickValues quick;
  quick.instead(multibody->add_option("--budget", c.budget, "maximum CPU time of a run [s]; longer runs are skipped")
                    ->check(support::positive("a time in seconds"))
                    ->capture_default_str(),
                c.budget, 0.5);
  multibody->callback([command, quick] {
    if (command->place.quick) quick.take();
    studies::studyMultibodyCommand(*command);
  });
  const auto grains = std::make_shared<studies::GrainStudies>();
  studies::addGrainStudies(*study, *grains);
  const auto soils = std::make_shared<studies::SoilStudies>();
  studies::addSoilStudies(*study, *soils);
  study->callback([grains, soils] {}); // keeps the option values alive
}

} // namespace grouser::commands
