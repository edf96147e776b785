// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/command_entry.hpp"

#include "runs/campaigns/sweeps/overrides.hpp"
#include "runs/commands/ranks_alike.hpp"
#include "runs/support/option_checks.hpp"
#include "runs/validation/bench/bench.hpp"
#include "runs/validation/bench/contacts.hpp"
#include "runs/validation/bench/multibody.hpp"

#include <memory>
#include <string>

namespace grouser::commands {

namespace {

/// Options common to the benchmarks of beds and steps.
void addCommon(CLI::App& sub, bench::BenchCommand& c) {
  sub.add_option("--device", c.device, "auto, cpu or cuda");
  sub.add_option("--threads", c.threads, "number of CPU threads; 0: all available cores, at most OMP_NUM_THREADS")
      ->check(support::wholeNumber(0, 1024));
  sub.add_option("--json", c.json, "write the results to this file")->check(support::writableFile("--json"));
}

/// Options of the grains of the bed.
void addGrains(CLI::App& bed, bench::BedBench& b) {
  bed.add_option("--grains", b.grains, "number of grains")
      ->check(support::wholeNumber(1, 1'000'000'000))
      ->capture_default_str();
  bed.add_option("--radius", b.radius, "grain radius [m]")
      ->check(support::positive("a length in metres"))
      ->capture_default_str();
  bed.add_option("--jitter", b.jitter,
                 "random initial displacement from the lattice sites, as a fraction of the gap between grains [-]")
      ->check(support::between(0.0, 1.0))
      ->capture_default_str();
  bed.add_option("--friction", b.friction, "Coulomb friction coefficient [-]")
      ->check(support::notNegative("a number"))
      ->capture_default_str();
  bed.add_option("--restitution", b.restitution, "coefficient of restitution [-]")
      ->check(support::between(1e-3, 1.0))
      ->capture_default_str();
  bed.add_option("--stiffness", b.stiffness, "contact stiffness [N/m]")
      ->check(support::positive("a stiffness in N/m"))
      ->capture_default_str();
  CLI::Option* const spread = bed.add_option("--radii-spread", b.radiiSpread,
                                             "half width of the uniform radius distribution / mean radius [-]; the "
                                             "mean grain volume equals that of a grain of --radius")
                                  ->check(support::between(0.0, 0.8))
                                  ->capture_default_str();
  bed.add_flag("--hertz", b.hertz, "use the Hertz law; its stiffness is --stiffness at an overlap of 1e-3 radii");
  bed.add_option("--rolling", b.rolling, "coefficient of rolling friction [-]")
      ->check(support::notNegative("a number"))
      ->capture_default_str();
  CLI::Option* const floor =
      bed.add_flag("--fixed-floor", b.fixedFloor, "use a layer of fixed grains as the floor instead of a plane");
  bed.add_flag("--periodic", b.periodic, "use periodic boundaries along x and y instead of walls");
  bed.add_option("--start", b.start,
                 "read the initial grains from this file (written by --save) instead of using the lattice; one line "
                 "per grain: x, y, z, r [m], vx, vy, vz [m/s], wx, wy, wz [rad/s]; the number of lines must equal "
                 "--grains, and all radii must equal --radius")
      ->excludes(floor, spread);
  bed.add_option("--save", b.save, "write the grains to this file after the last batch")
      ->check(support::writableFile("--save"));
}

void addBed(CLI::App& benches, const Invocation& invocation) {
  const auto command = std::make_shared<bench::BenchCommand>();
  command->ranks = &invocation.ranks;
  bench::BedBench& b = command->bed;
  CLI::App* bed = benches.add_subcommand(
      "bed", "Benchmark grains without a vehicle: five settled layers in a box, the reference bed for speed");
  addGrains(*bed, b);
  bed->add_option("--lanes", b.lanes, "maximum number of contacts per SIMD vector on the CPU: 16, 8, 4 or 1")
      ->check(CLI::IsMember({16, 8, 4, 1}))
      ->capture_default_str();
  bed->add_option("--skin", b.skin, "skin distance of the neighbour lists, in grain radii [-]")
      ->check(support::between(1e-3, 4.0))
      ->capture_default_str();
  bed->add_option("--time-step", b.timeStep, "time step [s]")
      ->check(support::positive("a time in seconds"))
      ->capture_default_str();
  bed->add_option("--settle", b.settleTime, "simulated time before the timing starts [s]")
      ->check(support::notNegative("a time in seconds"))
      ->capture_default_str();
  bed->add_option("--steps", b.steps, "number of steps per batch; default: about one second of wall time")
      ->check(support::wholeNumber(1));
  bed->add_option("--batches", b.batches, "number of timed batches")
      ->check(support::wholeNumber(1, 1000))
      ->capture_default_str();
  support::addChoice(*bed, "--peer-memory", b.peerMemory,
                     "direct memory access between the GPUs of one machine: auto (if possible), never, or always (an "
                     "error if it is impossible)");
  bed->add_flag("--ledger", b.ledger, "include the energy accounting of a run");
  bed->add_flag("--hash", b.hash, "print the hash of the final state");
  addCommon(*bed, *command);
  bed->callback([command, words = invocation.words] {
    requireSameWords("bench bed", words, command->ranks->comm());
    bench::benchBedCommand(*command);
  });
}

/// Time part of the value of --after: "0.5" for "drive+0.5", "0" for "drive".
std::string timeIn(const std::string& word) {
  if (word == "drive") return "0";
  return word.rfind("drive+", 0) == 0 ? word.substr(6) : word;
}

/// Error message for a value of --after; "" if it is valid.
std::string startFault(const std::string& word) {
  std::string time = timeIn(word);
  if (support::notNegative("a time in seconds")(time).empty()) return "";
  return word + " is neither a time in seconds (0 or more) nor drive or drive+TIME, e.g. drive+0.5";
}

void setStart(bench::StepBenchOptions& o, const std::string& word) {
  o.fromDrive = word.rfind("drive", 0) == 0;
  o.after = std::stod(timeIn(word));
}

void addStep(CLI::App& benches, const Invocation& invocation) {
  const auto command = std::make_shared<bench::BenchCommand>();
  bench::BenchCommand& c = *command;
  c.ranks = &invocation.ranks;
  CLI::App* step = benches.add_subcommand("step", "Benchmark the time step of a scene: wall time of each part");
  step->add_option("scene", c.scene, "scene file")->required();
  step->add_option("--set", c.overrides, kSetHelp)->allow_extra_args(false);
  step->add_option("--steps", c.step.steps, "number of steps per batch")
      ->check(support::wholeNumber(1))
      ->capture_default_str();
  step->add_option("--batches", c.step.batches, "number of timed batches")
      ->check(support::wholeNumber(1, 1000))
      ->capture_default_str();
  step->add_option_function<std::string>(
          "--after", [command](const std::string& word) { setStart(command->step, word); },
          "simulated time before the timing starts [s]; drive or drive+TIME: TIME seconds after the sprockets start; "
          "default: when the sprockets have reached full speed")
      ->check(CLI::Validator([](const std::string& word) { return startFault(word); }, "TIME|drive|drive+TIME"));
  addCommon(*step, c);
  step->callback([command, words = invocation.words] {
    requireSameWords("bench step", words, command->ranks->comm());
    sweeps::checkGivenOnce(command->overrides);
    bench::benchStepCommand(*command);
  });
}

void addContacts(CLI::App& benches, const Invocation& invocation) {
  const auto command = std::make_shared<bench::ContactsBench>();
  bench::ContactsBench& c = *command;
  c.ranks = &invocation.ranks;
  CLI::App* contacts = benches.add_subcommand(
      "contacts", "Benchmark contact detection for several numbers of contacts, with sequential Bullet as reference");
  contacts
      ->add_option("--contacts", c.contacts,
                   "approximate numbers of contacts, counting each pair once, e.g. 1e5,1e6,1e7; default: 3e4 to 1e7 on "
                   "the CPU, 1e6 to 6e9 on a GPU")
      ->delimiter(',')
      ->check(support::between(1.0, 6.4e9));
  contacts->add_flag("--count-only", c.countOnly, "count the pairs without storing them");
  contacts
      ->add_option("--at-a-time", c.atATime,
                   "number of spheres sorted per batch; default: all on the CPU, 2.5e8 on a GPU")
      ->check(support::wholeNumber(1));
  contacts->add_option("--repeats", c.repeats, "number of repetitions of each search; the median is reported")
      ->check(support::wholeNumber(1, 1000))
      ->capture_default_str();
  contacts
      ->add_option("--bullet", c.bulletSpheres,
                   "maximum number of spheres for the comparison with Bullet; 0: no comparison")
      ->check(support::wholeNumber(0, 10'000'000))
      ->capture_default_str();
  contacts->add_option("--device", c.device, "auto, cpu or cuda")->capture_default_str();
  contacts->add_option("--threads", c.threads, "number of CPU threads; 0: all available cores, at most OMP_NUM_THREADS")
      ->check(support::wholeNumber(0, 1024));
  contacts->add_option("--json", c.json, "write the results to this file")->check(support::writableFile("--json"));
  contacts->add_option("--plot", c.plot, "plot the results to this PNG file");
  contacts->callback([command, words = invocation.words] {
    requireSameWords("bench contacts", words, command->ranks->comm());
    bench::benchContactsCommand(*command);
  });
}

void addMultibody(CLI::App& benches, const base::Comm& comm) {
  const auto command = std::make_shared<bench::MultibodyBench>();
  bench::MultibodyBench& c = *command;
  c.comm = comm;
  CLI::App* multibody = benches.add_subcommand(
      "multibody",
      "Benchmark the multibody solver on one core: a vehicle, and closed rings of 46, 92 and 184 track shoes");
  multibody->add_option("--vehicle", c.vehicle, "vehicle file; default: the light tracked vehicle");
  multibody->add_option("--speed", c.speed, "sprocket speed [rad/s]")
      ->check(support::between(-20.0, 20.0))
      ->capture_default_str();
  multibody->add_option("--time-step", c.timeStep, "time step [s]")
      ->check(support::between(1e-6, 1e-4))
      ->capture_default_str();
  multibody->add_option("--steps", c.steps, "number of steps per batch")
      ->check(support::wholeNumber(1))
      ->capture_default_str();
  multibody->add_option("--batches", c.batches, "number of timed batches")
      ->check(support::wholeNumber(1, 1000))
      ->capture_default_str();
  multibody->add_option("--json", c.json, "write the results to this file")->check(support::writableFile("--json"));
  multibody->callback([command] { bench::benchMultibodyCommand(*command); });
}

} // namespace

void addBench(CLI::App& app, const Invocation& invocation) {
  CLI::App* benches =
      app.add_subcommand("bench", "Measure the speed of the program; results include machine and commit");
  benches->require_subcommand(1);
  addBed(*benches, invocation);
  addStep(*benches, invocation);
  addContacts(*benches, invocation);
  addMultibody(*benches, invocation.ranks.comm());
}

} // namespace grouser::commands
