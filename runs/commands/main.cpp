// SPDX-License-Identifier: BSD-3-Clause
#include "base/comm.hpp"
#include "base/error.hpp"
#include "runs/bench/bench.hpp"
#include "runs/bench/contacts.hpp"
#include "runs/bench/multibody.hpp"
#include "runs/commands/commands.hpp"
#include "runs/commands/ranks_alike.hpp"
#include "runs/commands/render_command.hpp"
#include "runs/scene/scene.hpp"
#include "runs/studies/multibody.hpp"
#include "runs/studies/options.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/option_checks.hpp"
#include "runs/support/stop_signals.hpp"

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdlib>
#include <fmt/format.h>
#include <unistd.h>

#include <exception>
#include <new>
#include <stdexcept>
#include <string_view>

namespace {

using namespace grouser;

enum ExitCode { kOther = 1, kInput = 2, kSimulation = 3, kDevice = 4 };

const char* const kSetHelp = "override a key of the scene, e.g. driver.sprocket_speed=2; may be repeated";

void addRun(CLI::App& app, commands::RunCommand& c) {
  CLI::App* run = app.add_subcommand("run", "Settle the bed, lower the vehicle, drive, and write the results");
  run->add_option("scene", c.scene, "scene file; `grouser fields` lists its keys")->required();
  run->add_option("--set", c.overrides, kSetHelp)->allow_extra_args(false);
  run->add_option("--device", c.device, "auto, cpu or cuda; default: as the scene says");
  run->add_option("--threads", c.threads, "CPU threads, 0 for all; the answer does not depend on it")
      ->check(support::wholeNumber(0, 1024));
  run->add_option("--out", c.folder, "folder of the results; default: out/NAME of the scene");
  run->add_option("--steps", c.steps, "stop after so many steps of the drive")->check(support::wholeNumber(1));
  run->add_flag("--force", c.force, "overwrite the results in that folder");
  CLI::Option* resume =
      run->add_option("--resume", c.checkpoint,
                      "go on from this checkpoint as if the run had not been stopped; default: that of its folder")
          ->expected(0, 1)
          ->type_name("[FILE]");
  run->add_flag("!--no-cache", c.cache, "settle the bed anew, and do not keep it; as terrain.cache = false");
  run->add_flag("--hash", c.hash, "print the hash of the final state as the last line");
  run->callback([&c, resume] {
    c.resume = resume->count() > 0;
    commands::runCommand(c);
  });
}

void addSweep(CLI::App& app, commands::SweepCommand& c) {
  CLI::App* sweep = app.add_subcommand("sweep", "Many runs of a scene over lists of values, with a summary");
  sweep->add_option("scene", c.scene, "scene file")->required();
  sweep
      ->add_option(
          "--set", c.sets,
          "a key and its values, e.g. driver.sprocket_speed=0.5,1,2; may be repeated: all combinations are run")
      ->allow_extra_args(false);
  sweep->add_option("--jobs", c.jobs, "runs at the same time; default: 1")->check(support::wholeNumber(1, 1024));
  sweep->add_option("--out", c.folder, "folder for the runs' folders and summary.csv; default: out/NAME_sweep");
  sweep->add_option("--device", c.device, "auto, cpu or cuda; default: as the scene says");
  sweep->add_option("--threads", c.threads, "CPU threads of each run; default: all cores shared among the jobs")
      ->check(support::wholeNumber(0, 1024));
  sweep->add_flag("--force", c.force, "run again what has already been run");
  sweep->callback([&c] { commands::sweepCommand(c); });
}

void addBench(CLI::App& app, bench::BenchCommand& c) {
  CLI::App* bench = app.add_subcommand("bench", "Figures of speed, with machine and commit");
  bench->require_subcommand(1);
  const auto addCommon = [&c](CLI::App* sub) {
    sub->add_option("--device", c.device, "auto, cpu or cuda");
    sub->add_option("--threads", c.threads, "CPU threads, 0 for all")->check(support::wholeNumber(0, 1024));
    sub->add_option("--json", c.json, "write the figures to this file");
  };
  bench::BedBench& b = c.bed;
  CLI::App* bed =
      bench->add_subcommand("bed", "Grains alone: five settled layers in a box, the bed that figures are compared on");
  bed->add_option("--grains", b.grains, "number of grains")
      ->check(support::wholeNumber(1, 1'000'000'000))
      ->capture_default_str();
  bed->add_option("--radius", b.radius, "[m]")->check(support::positive("a length in metres"))->capture_default_str();
  bed->add_option("--jitter", b.jitter, "of the lattice, as a share of its free gap [-]")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  bed->add_option("--friction", b.friction, "Coulomb coefficient [-]")
      ->check(support::notNegative("a number"))
      ->capture_default_str();
  bed->add_option("--restitution", b.restitution, "[-], above 0")->check(CLI::Range(1e-3, 1.0))->capture_default_str();
  bed->add_option("--stiffness", b.stiffness, "[N/m]")
      ->check(support::positive("a stiffness in N/m"))
      ->capture_default_str();
  bed->add_option("--lanes", b.lanes, "contacts that a CPU works on side by side, at most: 16, 8, 4 or 1")
      ->check(CLI::IsMember({16, 8, 4, 1}))
      ->capture_default_str();
  bed->add_option("--skin", b.skin, "of the neighbour lists, in radii [-]")
      ->check(CLI::Range(1e-3, 4.0))
      ->capture_default_str();
  bed->add_option("--time-step", b.timeStep, "[s]")
      ->check(support::positive("a time in seconds"))
      ->capture_default_str();
  bed->add_option("--settle", b.settleTime, "simulated time before timing [s]")
      ->check(support::notNegative("a time in seconds"))
      ->capture_default_str();
  bed->add_option("--steps", b.steps, "of one batch; default: about a second's")->check(support::wholeNumber(1));
  bed->add_option("--batches", b.batches, "timed batches")->check(support::wholeNumber(1, 1000))->capture_default_str();
  support::addChoice(
      *bed, "--peer-memory", b.peerMemory,
      "several ranks: GPUs of one machine read each other's memory where they can, never, or not without");
  bed->add_flag("--ledger", b.ledger, "sum dissipation grain by grain, as runs do");
  bed->add_flag("--hash", b.hash, "print the hash of the final state");
  addCommon(bed);
  bed->callback([&c] { bench::benchBedCommand(c); });

  CLI::App* step = bench->add_subcommand("step", "Where each microsecond of a scene's step goes");
  step->add_option("scene", c.scene, "scene file")->required();
  step->add_option("--set", c.overrides, kSetHelp)->allow_extra_args(false);
  step->add_option("--steps", c.step.steps, "of one batch")->check(support::wholeNumber(1))->capture_default_str();
  step->add_option("--batches", c.step.batches, "timed batches")
      ->check(support::wholeNumber(1, 1000))
      ->capture_default_str();
  step->add_option("--after", c.step.after, "simulated time before timing [s]; default: until the drive is up to speed")
      ->check(support::notNegative("a time in seconds"));
  addCommon(step);
  step->callback([&c] { bench::benchStepCommand(c); });
}

void addContactsBench(CLI::App& app, bench::ContactsBench& c) {
  CLI::App* contacts = app.get_subcommand("bench")->add_subcommand(
      "contacts", "Contact detection alone, over the number of contacts, beside sequential Bullet");
  contacts
      ->add_option("--contacts", c.contacts,
                   "about so many, each pair once: a list such as 1e5,1e6,1e7; default: 3e4 to 1e7 on the CPU, 1e6 to "
                   "6e9 on a GPU")
      ->delimiter(',')
      ->check(CLI::Range(1.0, 6.4e9));
  contacts->add_flag("--count-only", c.countOnly, "count the pairs, do not store them");
  contacts->add_option("--at-a-time", c.atATime, "spheres sorted at a time; default: all on the CPU, 2.5e8 on a GPU")
      ->check(support::wholeNumber(1));
  contacts->add_option("--repeats", c.repeats, "of each search; the median is reported")
      ->check(support::wholeNumber(1, 1000))
      ->capture_default_str();
  contacts->add_option("--bullet", c.bulletSpheres, "compare with Bullet up to so many spheres; 0: not at all")
      ->check(support::wholeNumber(0, 10'000'000))
      ->capture_default_str();
  contacts->add_option("--device", c.device, "auto, cpu or cuda")->capture_default_str();
  contacts->add_option("--threads", c.threads, "CPU threads, 0 for all")->check(support::wholeNumber(0, 1024));
  contacts->add_option("--json", c.json, "write the figures to this file");
  contacts->add_option("--plot", c.plot, "draw them into this PNG file");
  contacts->callback([&c] { bench::benchContactsCommand(c); });
}

void addMultibodyBench(CLI::App& app, bench::MultibodyBench& c) {
  CLI::App* multibody = app.get_subcommand("bench")->add_subcommand(
      "multibody", "The multibody solver alone, on one core: the vehicle's graph, and rings of 46, 92 and 184 shoes");
  multibody->add_option("--vehicle", c.vehicle, "spec file; default: the light tracked vehicle");
  multibody->add_option("--speed", c.speed, "of the sprockets [rad/s]")
      ->check(CLI::Range(-20.0, 20.0))
      ->capture_default_str();
  multibody->add_option("--time-step", c.timeStep, "[s]")->check(CLI::Range(1e-6, 1e-4))->capture_default_str();
  multibody->add_option("--steps", c.steps, "of one batch")->check(support::wholeNumber(1))->capture_default_str();
  multibody->add_option("--batches", c.batches, "timed batches")
      ->check(support::wholeNumber(1, 1000))
      ->capture_default_str();
  multibody->add_option("--json", c.json, "write the figures to this file");
  multibody->callback([&c] { bench::benchMultibodyCommand(c); });
}

void addRender(CLI::App& app, commands::RenderCommand& c) {
  CLI::App* render = app.add_subcommand("render", "Pictures and a film of a run's frames, without a display");
  render->add_option("frames", c.frames, "frames.h5 of a run")->required();
  render->add_option("--out", c.folder, "folder of the pictures; default: pictures/ beside the file");
  render->add_option("--film", c.film, "make the pictures into this film: .mp4, .mkv or .mov; needs ffmpeg");
  render->add_option("--fps", c.framesPerSecond, "pictures a second of the film")
      ->check(support::positive("a number"))
      ->capture_default_str();
  render->add_option("--color", c.color, "of the grains: depth, speed, subdomain, role or white")
      ->capture_default_str();
  render->add_option("--range", c.range, "values at the ends of the colours [m or m/s]; default: from the file")
      ->expected(2)
      ->type_name("LOW HIGH");
  render->add_option("--borders", c.borders, "between subdomains [m], e.g. x=0.5 or y=-1,1; default: those in the file")
      ->allow_extra_args(false);
  render->add_option(
      "--look-at", c.lookAt,
      "vehicle (moves with it), all (whatever there is) or a place X,Y,Z [m]; default: vehicle, or all where "
      "there is none");
  render->add_option("--azimuth", c.azimuth, "of the camera about the vertical, 0 is +x [deg]")
      ->check(CLI::Range(-360.0, 360.0))
      ->capture_default_str();
  render
      ->add_option("--elevation", c.elevation,
                   "of the camera above the horizon [deg]; default: 14, 30 for a bed, 60 for what lies flat")
      ->check(CLI::Range(-90.0, 90.0));
  render->add_option("--distance", c.distance, "of the camera from what it looks at [m]; default: it fills the picture")
      ->check(support::positive("a length in metres"));
  render->add_option("--size", c.size, "of a picture in pixels")->type_name("WIDTHxHEIGHT")->capture_default_str();
  CLI::Option* frame = render->add_option("--frame", c.frame, "only the frame of this number; may be repeated")
                           ->check(support::wholeNumber(0))
                           ->allow_extra_args(false);
  CLI::Option* every = render->add_option("--every", c.every, "only each so-manieth frame")
                           ->check(support::wholeNumber(1))
                           ->capture_default_str();
  CLI::Option* from = render->add_option("--from", c.from, "leave out the frames before this time [s]")
                          ->check(support::notNegative("a time in seconds"));
  CLI::Option* to = render->add_option("--to", c.to, "leave out the frames after this time [s]")
                        ->check(support::notNegative("a time in seconds"));
  frame->excludes(every)->excludes(from)->excludes(to);
  render->add_flag("!--no-labels", c.labels, "leave out time and colour scale");
  render->add_option("--processes", c.processes, "that share the frames")
      ->check(support::wholeNumber(1, 1024))
      ->capture_default_str();
  render->add_option("--threads", c.threads, "CPU threads of each process; default: all cores shared among them")
      ->check(support::wholeNumber(0, 1024));
  render->add_flag("--force", c.force, "overwrite pictures and film");
  render->callback([&c] { commands::renderCommand(c); });
}

void addStudy(CLI::App& app, studies::StudyCommand& c, studies::GrainStudies& grains) {
  CLI::App* study = app.add_subcommand("study", "Error against run time, stable steps, precision: tables and plots");
  study->require_subcommand(1);
  CLI::App* multibody = study->add_subcommand(
      "multibody", "Mechanisms whose motion is known: error, order, drift and CPU time of each integrator and step");
  std::string names;
  for (const studies::StudyCase& known : studies::studyCases()) names += (names.empty() ? "" : ", ") + known.name;
  multibody->add_option("--cases", c.cases, "names, separated by commas, of " + names + "; default: all")
      ->delimiter(',');
  multibody->add_flag("--stability", c.stability, "instead: which steps are stable, against what theory says");
  multibody->add_flag("--quick", c.quick, "three long steps only, and none of the cases that take minutes");
  multibody->add_option("--budget", c.budget, "runs that would take more CPU time are left out [s]")
      ->check(support::positive("a time in seconds"))
      ->capture_default_str();
  multibody->add_option("--out", c.folder, "folder of the tables and the plot; default: out/study_multibody");
  multibody->add_flag("--force", c.force, "overwrite what is in that folder");
  multibody->callback([&c] { studies::studyMultibodyCommand(c); });
  studies::addGrainStudies(*study, grains);
}

void addHash(CLI::App& app, commands::HashCommand& c) {
  CLI::App* hash = app.add_subcommand("hash", "Hash of the state in a checkpoint, as run --hash prints it");
  hash->add_option("checkpoint", c.checkpoint, "checkpoint.h5 of a run")->required();
  hash->callback([&c] { commands::hashCommand(c); });
}

void addOthers(CLI::App& app, commands::SinkageCommand& s, commands::PlanCommand& p, commands::SpheresCommand& d) {
  CLI::App* sinkage = app.add_subcommand("sinkage", "Sinkage of every shoe over time [m], as CSV and as a plot");
  sinkage->add_option("results", s.results, "results.h5 of a run")->required();
  sinkage->add_option("--out", s.folder, "folder; default: beside the results");
  sinkage->callback([&s] { commands::sinkageCommand(s); });

  CLI::App* plan =
      app.add_subcommand("plan", "What a scene switches on, its size, time step, memory and cost; runs nothing");
  plan->add_option("scene", p.scene, "scene file")->required();
  plan->add_option("--set", p.overrides, kSetHelp)->allow_extra_args(false);
  plan->add_option("--ranks", p.ranks, "also how so many ranks (mpirun -np) would share the grains")
      ->check(support::wholeNumber(1, 100'000));
  plan->callback([&p] { commands::planCommand(p); });

  CLI::App* spheres = app.add_subcommand("spheres", "Cut a closed mesh into spheres, and say how well they fit");
  spheres->add_option("mesh", d.mesh, "OBJ, STL, PLY... in metres")->required();
  CLI::Option* radius =
      spheres->add_option("--radius", d.radius, "sphere radius [m]")->check(support::positive("a length in metres"));
  CLI::Option* count = spheres->add_option("--count", d.count, "wanted number of spheres, instead of a radius")
                           ->check(support::wholeNumber(1));
  radius->excludes(count);
  spheres->add_option("--csv", d.csv, "write the spheres to this file: x, y, z, radius [m]");
  spheres->add_flag("--force", d.force, "overwrite that file");
  spheres->callback([=, &d] {
    if (!*radius && !*count) throw CLI::RequiredError("spheres: one of --radius and --count");
    commands::spheresCommand(d);
  });

  app.add_subcommand("fields", "All keys of a scene file with unit, default, range and meaning")->callback([] {
    fmt::print("{}", scene::fieldHelp());
  });
}

/// What several ranks would only hinder each other at.
void refuseRanks(CLI::App& app, const char* name, const base::Comm& comm, const std::string& instead) {
  app.get_subcommand(name)->preparse_callback([=](std::size_t) {
    if (!comm.alone())
      throw base::InputError(
          fmt::format("grouser {} is no work for {} ranks: start it without mpirun{}", name, comm.size(), instead));
  });
}

/// Commands that ranks share; all others are done by the first alone.
bool isShared(const char* command) {
  const std::string_view name = command;
  return name == "run" || name == "bench" || name == "render";
}

/// "run", "bench bed": what ranks must do alike from the beginning.
std::string commandOf(int argc, char** argv) {
  const std::string command = argc > 1 ? argv[1] : "";
  return command == "bench" && argc > 2 ? command + " " + argv[2] : command;
}

/// Says why, and ends the other ranks too. What all ranks find out alike is said by the first; the others wait a moment
/// for it to end them.
int fail(const base::Ranks& ranks, int code, const char* message) {
  std::fflush(stdout);
  if (!ranks.comm().first()) sleep(2);
  const std::string who = ranks.comm().alone() ? "" : fmt::format("rank {}: ", ranks.comm().rank());
  std::fputs(fmt::format("grouser: error: {}{}\n", who, message).c_str(),
             stderr); // no throw where it cannot be written
  std::fflush(stderr);
  ranks.abort(code);
  return code;
}

} // namespace

namespace {

/// Threads that wait for each other spin for milliseconds by default; on a machine that is busy with other work too
/// that makes a step many times slower. The OpenMP library reads its settings when it is loaded, so the program starts
/// itself again with a short spin, unless the user has chosen.
void waitBriefly(char** argv) {
  if (std::getenv("GOMP_SPINCOUNT") || std::getenv("OMP_WAIT_POLICY")) return;
  setenv("GOMP_SPINCOUNT", "5000", 1);
  execv("/proc/self/exe", argv); // returns only if it failed: then the default will do
}

} // namespace

int main(int argc, char** argv) {
  waitBriefly(argv);
  // A limit to the size of files is met as a full disk is: by a message, not by the signal's silent end.
  std::signal(SIGXFSZ, SIG_IGN);
  const base::Ranks ranks(argc, argv);
  const auto stop = [&ranks](ExitCode code, const char* message) { return fail(ranks, code, message); };
  // One rank speaks for all.
  if (!ranks.comm().first() && !std::freopen("/dev/null", "w", stdout)) return kOther;
  CLI::App app("grouser drives a tracked vehicle over granular terrain, and says how wrong its answer is.", "grouser");
  app.require_subcommand(1);
  app.set_version_flag("--version", support::versionText());
  app.footer(
      "Exit codes: 0 sound result, 2 wrong input, 3 the simulation became unsound or its results could not be written, "
      "4 device, 130 and 143 stopped by SIGINT and SIGTERM, 1 anything else.\nSettled beds are kept in GROUSER_CACHE, "
      "or else in "
      "$XDG_CACHE_HOME/grouser, or else in ~/.cache/grouser, up to GROUSER_CACHE_GIB (2) GiB.");
  commands::RunCommand run;
  run.ranks = &ranks;
  commands::SweepCommand sweep;
  bench::BenchCommand bench;
  commands::HashCommand hash;
  studies::StudyCommand study;
  studies::GrainStudies grainStudies;
  commands::RenderCommand render;
  bench::ContactsBench contacts;
  bench::MultibodyBench multibody;
  render.comm = ranks.comm(), contacts.ranks = &ranks, bench.ranks = &ranks, multibody.comm = ranks.comm();
  commands::SinkageCommand sinkage;
  commands::PlanCommand plan;
  commands::SpheresCommand spheres;
  for (int i = 0; i < argc; ++i) run.commandLine += (i ? " " : "") + std::string(argv[i]);
  addRun(app, run);
  addSweep(app, sweep);
  addBench(app, bench);
  addContactsBench(app, contacts);
  addMultibodyBench(app, multibody);
  addHash(app, hash);
  addStudy(app, study, grainStudies);
  addRender(app, render);
  addOthers(app, sinkage, plan, spheres);
  refuseRanks(app, "sweep", ranks.comm(), "; --jobs lets several runs go at the same time");
  refuseRanks(app, "study", ranks.comm(), "");
  try {
    commands::requireSameCommand(commandOf(argc, argv), ranks.comm());
  } catch (const base::InputError& e) {
    return stop(kInput, e.what());
  }
  if (!ranks.comm().first() && argc > 1 && !isShared(argv[1])) return 0; // the first ends all where it fails
  if (const std::string unknown = support::unknownCommand(app, argc, argv); !unknown.empty())
    return stop(kInput, unknown.c_str());
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::Success& e) {
    return app.exit(e); // --help and --version
  } catch (const CLI::ParseError& e) {
    return stop(kInput, fmt::format("{}; see grouser --help, or grouser COMMAND --help", e.what()).c_str());
  } catch (const base::InputError& e) {
    return stop(kInput, e.what());
  } catch (const base::SimulationError& e) {
    return stop(kSimulation, e.what());
  } catch (const support::Stopped& e) {
    std::fflush(stdout);
    if (ranks.comm().first()) std::fputs(fmt::format("grouser: {}\n", e.what()).c_str(), stderr);
    return 128 + e.signal();
  } catch (const base::DeviceError& e) {
    return stop(kDevice, e.what());
  } catch (const std::runtime_error& e) {
    return stop(kSimulation, e.what()); // what could not be written
  } catch (const std::bad_alloc&) {
    return stop(kDevice, "out of host memory; use larger or fewer grains, or more ranks on "
                         "several hosts (grouser plan says what a scene needs)");
  } catch (const std::exception& e) {
    return stop(kOther, e.what());
  }
}
