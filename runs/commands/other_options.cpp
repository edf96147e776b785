// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/command_entry.hpp"

#include "runs/commands/commands.hpp"
#include "runs/support/option_checks.hpp"

#include <memory>

namespace grouser::commands {

void addSpheres(CLI::App& app, const Invocation&) {
  const auto command = std::make_shared<SpheresCommand>();
  SpheresCommand& d = *command;
  CLI::App* spheres =
      app.add_subcommand("spheres", "Convert a closed mesh to spheres and report the quality of the fit");
  spheres->add_option("mesh", d.mesh, "closed mesh in metres (OBJ, STL, PLY...)")->required();
  CLI::Option* radius =
      spheres->add_option("--radius", d.radius, "sphere radius [m]")->check(support::positive("a length in metres"));
  CLI::Option* count = spheres->add_option("--count", d.count, "target number of spheres; instead of --radius")
                           ->check(support::wholeNumber(1));
  radius->excludes(count);
  spheres->add_option("--csv", d.csv, "write the spheres to this CSV file: x, y, z, radius [m]")
      ->check(support::writableFile("--csv"));
  spheres->add_flag("--force", d.force, "overwrite an existing --csv file");
  spheres->callback([=] {
    if (!*radius && !*count) throw CLI::RequiredError("spheres: --radius or --count");
    spheresCommand(*command);
  });
}

void addFields(CLI::App& app, const Invocation&) {
  const auto command = std::make_shared<FieldsCommand>();
  CLI::App* fields = app.add_subcommand("fields", "List the keys of scene files with unit, default, range and meaning");
  CLI::Option* soil = fields->add_flag("--soil", command->soil, "list the keys of soil files instead");
  CLI::Option* vehicle = fields->add_flag("--vehicle", command->vehicle, "list the keys of vehicle files instead");
  CLI::Option* markdown = fields->add_flag("--markdown", command->markdown,
                                           "list the keys of all three file types in Markdown, as in docs/keys.md");
  CLI::Option* files =
      fields->add_flag("--files", command->files,
                       "list the contents of results.h5, frames.h5 and checkpoint.h5 in Markdown, as in docs/files.md");
  markdown->excludes(vehicle), markdown->excludes(soil), vehicle->excludes(soil);
  files->excludes(markdown), files->excludes(vehicle), files->excludes(soil);
  fields->callback([=] { fieldsCommand(*command); });
}

void addSoils(CLI::App& app, const Invocation&) {
  const auto command = std::make_shared<SoilsCommand>();
  CLI::App* soils = app.add_subcommand(
      "soils", "List the soils that scenes can use by name, with published constants and calibration status");
  CLI::Option* name = soils->add_option("soil", command->soil, "name or file of a soil; prints all its data");
  CLI::Option* markdown = soils->add_flag("--markdown", command->markdown, "print the table of docs/soils.md");
  markdown->excludes(name);
  soils->callback([=] { soilsCommand(*command); });
}

} // namespace grouser::commands
