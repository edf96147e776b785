// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/command_entry.hpp"

#include "runs/commands/commands.hpp"
#include "runs/support/option_checks.hpp"

#include <memory>

namespace grouser::commands {

void addSpheres(CLI::App& app, const Invocation&) {
  const auto command = std::make_shared<SpheresCommand>();
  SpheresCommand& d = *command;
  CLI::App* spheres = app.add_subcommand("spheres", "Cut a closed mesh into spheres, and say how well they fit");
  spheres->add_option("mesh", d.mesh, "OBJ, STL, PLY... in metres")->required();
  CLI::Option* radius =
      spheres->add_option("--radius", d.radius, "sphere radius [m]")->check(support::positive("a length in metres"));
  CLI::Option* count = spheres->add_option("--count", d.count, "wanted number of spheres, instead of a radius")
                           ->check(support::wholeNumber(1));
  radius->excludes(count);
  spheres->add_option("--csv", d.csv, "write the spheres to this file: x, y, z, radius [m]")
      ->check(support::writableFile("--csv"));
  spheres->add_flag("--force", d.force, "overwrite that file");
  spheres->callback([=] {
    if (!*radius && !*count) throw CLI::RequiredError("spheres: one of --radius and --count");
    spheresCommand(*command);
  });
}

void addFields(CLI::App& app, const Invocation&) {
  const auto command = std::make_shared<FieldsCommand>();
  CLI::App* fields = app.add_subcommand("fields", "All keys of a scene file with unit, default, range and meaning");
  CLI::Option* soil = fields->add_flag("--soil", command->soil, "those of a soil's file instead");
  CLI::Option* vehicle = fields->add_flag("--vehicle", command->vehicle, "those of a vehicle file instead");
  CLI::Option* markdown =
      fields->add_flag("--markdown", command->markdown, "of all three files, as docs/keys.md has them");
  CLI::Option* files = fields->add_flag("--files", command->files,
                                        "what results.h5, frames.h5 and checkpoint.h5 hold, as docs/files.md has it");
  markdown->excludes(vehicle), markdown->excludes(soil), vehicle->excludes(soil);
  files->excludes(markdown), files->excludes(vehicle), files->excludes(soil);
  fields->callback([=] { fieldsCommand(*command); });
}

void addSoils(CLI::App& app, const Invocation&) {
  const auto command = std::make_shared<SoilsCommand>();
  CLI::App* soils = app.add_subcommand(
      "soils", "The soils that scenes can take by name: what is published of them, and whether they are calibrated");
  CLI::Option* name = soils->add_option("soil", command->soil, "all of one: its name, or the path of its file");
  CLI::Option* markdown = soils->add_flag("--markdown", command->markdown, "the table of docs/soils.md");
  markdown->excludes(name);
  soils->callback([=] { soilsCommand(*command); });
}

} // namespace grouser::commands
