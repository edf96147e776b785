// SPDX-License-Identifier: BSD-3-Clause
#include "runs/study_options.hpp"

#include "runs/option_checks.hpp"

namespace grouser::runs {

namespace {

void addPlace(CLI::App& app, StudyPlace& place, const std::string& name, const std::string& quick) {
  app.add_flag("--quick", place.quick, quick);
  app.add_option("--out,--output", place.folder, "folder of the tables and the plot; default: out/study_" + name);
  app.add_flag("--force", place.force, "overwrite what is in that folder");
}

void addImpact(CLI::App& study, ImpactCommand& c) {
  CLI::App* impact = study.add_subcommand(
      "impact", "One collision against its closed form: errors, orders and wall time over the step (4 min, one core)");
  impact->add_option("--phases", c.phases.touching, "of first touch within a step, side by side")
      ->check(wholeNumber(1, 1000))
      ->capture_default_str();
  impact->add_option("--leaving", c.phases.leaving, "contacts made longer by parts of a step: phases of leaving")
      ->check(wholeNumber(1, 100))
      ->capture_default_str();
  impact->add_option("--collisions", c.collisions, "at once where time is taken")
      ->check(wholeNumber(1, 100'000))
      ->capture_default_str();
  impact->add_option("--repeats", c.repeats, "of each timing; the median is reported")
      ->check(wholeNumber(1, 1000))
      ->capture_default_str();
  addPlace(*impact, c.place, "impact", "four damping ratios and steps down to 1/160 of a contact only, in seconds");
  impact->callback([&c] { studyImpactCommand(c); });
}

} // namespace

void addGrainStudies(CLI::App& study, GrainStudies& studies) { addImpact(study, studies.impact); }

} // namespace grouser::runs
