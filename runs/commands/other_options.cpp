// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/command_entry.hpp"

#include "runs/commands/commands.hpp"
#include "runs/support/option_checks.hpp"

#include <memory>

namespace grouser::commands {

void addSpheres(CLI::App& app, const Invocation&) {
  const auto command = std::make_shared<SpheresCommand>();
  SpheresCommand& d = *command;
  CLI::App* spheres = app.add_subcommand("spheres", "Convert a closed mesh to spheres, and report their fit");
  spheres->add_option("mesh", d.mesh, "OBJ, STL, PLY... in metres")->required();
  CLI::Option* radius =
      spheres->add_option("--radius", d.radius, "sphere radius [m]")->check(support::positive("a length in metres"));
  CLI::Option* count = spheres->add_option("--count", d.count, "target number of spheres, instead of a radius")
                           ->check(support::wholeNumber(1));
  radius->excludes(count);
  spheres->add_option("--csv", d.csv, "write the spheres to this file: x, y, z, radius [m]")
      ->check(support::writableFile("--csv"));
  spheres->add_flag("--force", d.force, "overwrite the file of --csv");
  spheres->callback([=] {
    if (!*radius && !*count) throw CLI::RequiredError("spheres: one of --radius and --count");
    spheresCommand(*command);
  });
}

void addFields(CLI::App& app, const Invocation&) {
  const auto command = std::make_shared<FieldsCommand>();
  CLI::App* fields = app.add_subcommand("fields", "All keys of a scene file with unit, default, range and meaning");
  CLI::Option* soil = fields->add_flag("--soil", command->soil, "keys of a soil file instead");
  CLI::Option* vehicle = fields->add_flag("--vehicle", command->vehicle, "keys of a vehicle file instead");
  CLI::Option* markdown =
      fields->add_flag("--markdown", command->markdown, "keys of all three files, as in docs/keys.md");
  CLI::Option* files = fields->add_flag("--files", command->files,
                                        "contents of results.h5, frames.h5 and checkpoint.h5, as in docs/files.md");
  markdown->excludes(vehicle), markdown->excludes(soil), vehicle->excludes(soil);
  files->excludes(markdown), files->excludes(vehicle), files->excludes(soil);
  fields->callback([=] { fieldsCommand(*command); });
}

void addSoils(CLI::App& app, const Invocation&) {
  const auto command = std::make_shared<SoilsCommand>();
  CLI::App* soils = app.add_subcommand(
      "soils", "Soils that scenes can use by name: published constants, and whether they are calibrated");
  CLI::Option* name = soils->add_option("soil", command->soil, "name or file of a soil, to print all its data");
  CLI::Option* markdown = soils->add_flag("--markdown", command->markdown, "the table of docs/soils.md");
  markdown->excludes(name);
  soils->callback([=] { soilsCommand(*command); });
}

} // namespace grouser::commands
