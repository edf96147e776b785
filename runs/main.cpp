// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "runs/build_info.hpp"
#include "runs/commands.hpp"
#include "runs/scene.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <exception>

namespace {

using namespace grouser;

enum ExitCode { kOther = 1, kInput = 2, kSimulation = 3, kDevice = 4 };

const char* const kSetHelp = "override a key of the scene, e.g. driver.sprocket_speed=2; may be repeated";

void addRun(CLI::App& app, runs::RunCommand& c) {
  CLI::App* run = app.add_subcommand("run", "Settle the bed, lower the vehicle, drive, and write the results");
  run->add_option("scene", c.scene, "scene file; `grouser fields` lists its keys")->required();
  run->add_option("--set", c.overrides, kSetHelp)->allow_extra_args(false);
  run->add_option("--device", c.device, "auto, cpu or cuda; default: as the scene says");
  run->add_option("--threads", c.threads, "CPU threads, 0 for all; the answer does not depend on it");
  run->add_option("--out", c.folder, "folder of the results; default: out/NAME of the scene");
  run->add_option("--steps", c.steps, "stop after so many steps of the drive")->check(CLI::PositiveNumber);
  run->add_flag("--force", c.force, "overwrite the results in that folder");
  run->add_flag("--hash", c.hash, "print the hash of the final state as the last line");
  run->callback([&c] { runs::runCommand(c); });
}

void addOthers(CLI::App& app, runs::SinkageCommand& s, runs::PlanCommand& p, runs::SpheresCommand& d) {
  CLI::App* sinkage = app.add_subcommand("sinkage", "Sinkage of every shoe over time [m], as CSV and as a plot");
  sinkage->add_option("results", s.results, "results.h5 of a run")->required();
  sinkage->add_option("--out", s.folder, "folder; default: beside the results");
  sinkage->callback([&s] { runs::sinkageCommand(s); });

  CLI::App* plan =
      app.add_subcommand("plan", "What a scene switches on, its size, time step, memory and cost; runs nothing");
  plan->add_option("scene", p.scene, "scene file")->required();
  plan->add_option("--set", p.overrides, kSetHelp)->allow_extra_args(false);
  plan->callback([&p] { runs::planCommand(p); });

  CLI::App* spheres = app.add_subcommand("spheres", "Cut a closed mesh into spheres, and say how well they fit");
  spheres->add_option("mesh", d.mesh, "OBJ, STL, PLY... in metres")->required();
  CLI::Option* radius = spheres->add_option("--radius", d.radius, "sphere radius [m]")->check(CLI::PositiveNumber);
  CLI::Option* count = spheres->add_option("--count", d.count, "wanted number of spheres, instead of a radius")
                           ->check(CLI::PositiveNumber);
  radius->excludes(count);
  spheres->add_option("--csv", d.csv, "write the spheres to this file: x, y, z, radius [m]");
  spheres->callback([=, &d] {
    if (!*radius && !*count) throw CLI::RequiredError("spheres: one of --radius and --count");
    runs::spheresCommand(d);
  });

  app.add_subcommand("fields", "All keys of a scene file with unit, default, range and meaning")->callback([] {
    fmt::print("{}", runs::fieldHelp());
  });
}

int fail(ExitCode code, const char* message) {
  std::fflush(stdout);
  fmt::print(stderr, "grouser: error: {}\n", message);
  return code;
}

} // namespace

int main(int argc, char** argv) {
  CLI::App app("grouser drives a tracked vehicle over granular terrain, and says how wrong its answer is.", "grouser");
  app.require_subcommand(1);
  app.set_version_flag("--version", runs::versionText());
  app.footer("Exit codes: 0 sound result, 2 wrong input, 3 the simulation became unsound, 4 device, 1 anything else.");
  runs::RunCommand run;
  runs::SinkageCommand sinkage;
  runs::PlanCommand plan;
  runs::SpheresCommand spheres;
  for (int i = 0; i < argc; ++i) run.commandLine += (i ? " " : "") + std::string(argv[i]);
  addRun(app, run);
  addOthers(app, sinkage, plan, spheres);
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::Success& e) {
    return app.exit(e); // --help and --version
  } catch (const CLI::ParseError& e) {
    return fail(kInput, fmt::format("{}; see grouser --help, or grouser COMMAND --help", e.what()).c_str());
  } catch (const base::InputError& e) {
    return fail(kInput, e.what());
  } catch (const base::SimulationError& e) {
    return fail(kSimulation, e.what());
  } catch (const base::DeviceError& e) {
    return fail(kDevice, e.what());
  } catch (const std::exception& e) {
    return fail(kOther, e.what());
  }
}
