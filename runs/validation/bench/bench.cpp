// SPDX-License-Identifier: BSD-3-Clause
// Output of the benchmarks.
#include "runs/validation/bench/bench.hpp"

#include "base/error.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/progress.hpp"
#include "runs/validation/bench/report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

namespace grouser::bench {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

namespace {

constexpr int kCountsTaken = 20; // number of contact counts in the instrumented pass

Json jsonOf(const BatchTimes& times) {
  return {{"steps_a_batch", times.steps},
          {"batches", times.microseconds},
          {"median", times.median()},
          {"min", times.least()},
          {"max", times.most()}};
}

/// Drive of the timed vehicle.
struct Drive {
  std::optional<double> start; ///< start of the drive [s]; empty: not started
  double ramp = 0;             ///< [s]
};

/// Start of the timing [s]; empty until the start of the drive is known.
std::optional<double> timedFrom(const StepBenchOptions& o, const coupling::Simulation& simulation, double ramp) {
  const bool waits = simulation.vehicle() && (o.fromDrive || !o.after);
  if (!waits) return o.after.value_or(0);
  const std::optional<double> start = simulation.vehicle()->driveStart();
  if (!start) return std::nullopt;
  return *start + o.after.value_or(ramp);
}

/// Steps until the timing starts, and shows the progress; returns the time of this start [s].
double advance(coupling::Simulation& simulation, const StepBenchOptions& o, double ramp) {
  support::Progress progress("warming up", simulation.comm().first());
  while (true) {
    const std::optional<double> from = timedFrom(o, simulation, ramp);
    const std::int64_t end = from ? std::llround(*from / simulation.timeStep()) : simulation.steps() + 1;
    if (simulation.steps() >= end) return simulation.time();
    simulation.advance(std::min(end - simulation.steps(), coupling::VehicleRig::kAlarmInterval));
    if (progress.due())
      progress.update(
          from ? simulation.time() / *from : 0,
          fmt::format("t {:.3f} s{}", simulation.time(), from ? "" : ", waiting for the vehicle to come to rest"));
  }
}

/// Describes the motion of the vehicle between two times: keyword and text.
std::array<std::string, 2> phaseOf(const Drive& drive, double from, double to) {
  constexpr double kStep = 1e-9; // [s] tolerance for rounding of times
  if (!drive.start || *drive.start >= to)
    return {"standing", "the vehicle is at rest; use --after drive to time driving"};
  if (*drive.start > from + kStep)
    return {"driving off",
            fmt::format(
                "the vehicle starts to drive at t = {:g} s, during the timing; use --after drive to time driving only",
                *drive.start)};
  const std::string since = fmt::format("the vehicle has been driving since t = {:g} s", *drive.start);
  if (from < *drive.start + drive.ramp - kStep)
    return {"speeding up", fmt::format("{}; its sprockets accelerate until {:g} s", since, *drive.start + drive.ramp)};
  return {"driving", since};
}

/// Contacts by kind, and listed neighbours, per step: means over counts in the instrumented pass.
struct Contacts {
  double grainGrain = 0, grainBoundary = 0, grainPart = 0, partPart = 0, pairsListed = 0, samplesListed = 0;
  int counts = 0;
  void count(coupling::Simulation& simulation) {
    const coupling::Ledger l = simulation.ledger();
    grainGrain += static_cast<double>(l.grainContacts), grainBoundary += static_cast<double>(l.boundaryContacts);
    grainPart += static_cast<double>(l.partContacts), partPart += static_cast<double>(l.patches);
    if (const coupling::VehicleRig* rig = simulation.vehicle()) {
      pairsListed +=
          static_cast<double>(simulation.comm().sumOf(static_cast<std::int64_t>(rig->contacts().listed().grainPairs)));
      samplesListed += static_cast<double>(rig->contacts().listed().samples);
    }
    ++counts;
  }
  double mean(double sum) const { return counts ? sum / counts : 0; }
};

Json printParts(const coupling::StageTimer& timer) {
  const double n = static_cast<double>(timer.steps());
  double sum = 0;
  for (const coupling::StageTimer::Part& part : timer.parts()) sum += part.microseconds / n;
  fmt::print("\ninstrumented pass of {} steps; it synchronises after each part, so that parts cannot overlap and their "
             "sum exceeds the time of a step\n",
             timer.steps());
  Json json = Json::object();
  for (const coupling::StageTimer::Part& part : timer.parts()) {
    const double each = part.microseconds / n;
    fmt::print("  {:<18} {:10.2f} us  {:5.1f} %\n", part.name, each, 100 * each / sum);
    json[part.name] = each;
  }
  fmt::print("  {:<18} {:10.2f} us\n", "sum", sum);
  json["sum"] = sum;
  return json;
}

/// Particle-steps per second for a given time per step [us].
double rate(const BedBench& bench, double microseconds) {
  return static_cast<double>(bench.grains) / (1e-6 * microseconds);
}

void printBed(const BedBench& b, const BedFigures& f, int ranks) {
  const double share = f.rebuildMicroseconds / f.stepsBetweenRebuilds;
  fmt::print("settling  {:.2f} s wall time; kinetic energy per grain {:.2g} m g radius\n", f.settleSeconds,
             f.kineticPerGrain);
  fmt::print("features  {}\n", f.features);
  fmt::print("speed     {:.3e} particle-steps/s (median of {} batches of {} steps; {:.3e} to {:.3e})\n",
             rate(b, f.times.median()), f.times.microseconds.size(), f.times.steps, rate(b, f.times.most()),
             rate(b, f.times.least()));
  fmt::print("step      {:.2f} us (median; {:.2f} to {:.2f})\n", f.times.median(), f.times.least(), f.times.most());
  fmt::print("contacts  {:.3f} per grain (each pair counted once); {:.2f} listed neighbours per grain\n",
             f.contactsPerGrain, f.listLength);
  fmt::print("rebuild   {:.1f} us, {}\n", f.rebuildMicroseconds,
             std::isfinite(f.stepsBetweenRebuilds)
                 ? fmt::format("every {:.0f} steps: {:.2f} us per step", f.stepsBetweenRebuilds, share)
                 : std::string("none during the timing"));
  fmt::print("memory    {:.0f} bytes per grain; {:.0f} at the peak of a rebuild ({:.0f} reserved)\n", f.bytesPerGrain,
             f.peakBytesPerGrain, f.reservedPerGrain);
  if (ranks > 1)
    fmt::print(
        "ranks     {}: subdomains {} x {} x {}, {:.2f} % ghosts, at most {:.0f} bytes sent per step and rank ({}); "
        "MPI wait time {:.1f} to {:.1f} %\n",
        ranks, f.subdomains[0], f.subdomains[1], f.subdomains[2], 100 * f.ghostShare, f.bytesAStep, f.way,
        100 * f.minWait, 100 * f.maxWait);
  if (!f.stateHash.empty()) fmt::print("state-hash {} step {}\n", f.stateHash, f.stepsTaken);
}

void addBed(Json& json, const BedBench& b, const BedFigures& f, int ranks) {
  json["grains"] = b.grains;
  json["radius_m"] = b.radius;
  json["jitter"] = b.jitter;
  json["skin_radii"] = b.skin;
  json["friction"] = b.friction;
  json["restitution"] = b.restitution;
  json["stiffness_N_m"] = b.stiffness;
  json["hertz"] = b.hertz;
  json["normal_stiffness"] = f.law.stiffness;
  json["tangential_stiffness"] = f.law.tangentialStiffness;
  json["damping"] = b.hertz ? f.law.rootDamping : f.law.damping;
  json["tangential_damping"] = b.hertz ? f.law.tangentialRootDamping : f.law.tangentialDamping;
  json["density_kg_m3"] = b.density;
  json["box_edge_m"] = f.edge;
  json["time_step_s"] = b.timeStep;
  json["settle_time_s"] = b.settleTime;
  json["ledger"] = b.ledger;
  json["radii_spread"] = b.radiiSpread;
  json["rolling_friction"] = b.rolling;
  json["rolling_damping"] = f.law.rollingDamping;
  json["features"] = f.features;
  json["settling_wall_s"] = f.settleSeconds;
  json["kinetic_energy_a_grain_over_mgr"] = f.kineticPerGrain;
  json["microseconds_a_step"] = jsonOf(f.times);
  json["particle_steps_per_second"] = {
      {"median", rate(b, f.times.median())}, {"min", rate(b, f.times.most())}, {"max", rate(b, f.times.least())}};
  json["contacts_a_grain"] = f.contactsPerGrain;
  json["neighbours_listed_a_grain"] = f.listLength;
  json["steps_between_rebuilds"] = std::isfinite(f.stepsBetweenRebuilds) ? Json(f.stepsBetweenRebuilds) : Json(nullptr);
  json["rebuild_microseconds"] = f.rebuildMicroseconds;
  json["bytes_a_grain"] = f.bytesPerGrain;
  json["peak_bytes_a_grain"] = f.peakBytesPerGrain;
  json["reserved_bytes_a_grain"] = f.reservedPerGrain;
  json["steps_taken"] = f.stepsTaken;
  json["ranks"] = ranks;
  json["subdomains"] = f.subdomains;
  json["way"] = f.way;
  json["ghost_share"] = f.ghostShare;
  json["bytes_a_step"] = f.bytesAStep;
  json["waiting_share"] = {{"least", f.minWait}, {"most", f.maxWait}};
  if (!f.stateHash.empty()) json["state_hash"] = f.stateHash;
}

/// Simulation of the scene with a settled bed, and the wall time of settling [s].
std::unique_ptr<coupling::Simulation> prepare(const scene::Scene& scene, const base::Exec& exec, const base::Comm& comm,
                                              double& seconds) {
  std::unique_ptr<support::Progress> settling;
  const Clock::time_point start = Clock::now();
  const auto settle = [&](double time, double) {
    if (!settling)
      settling = std::make_unique<support::Progress>("settling", comm.first(), 0, support::Progress::End::limit);
    settling->update(time / scene.terrain->settleTimeLimit, fmt::format("t {:.2f} s", time));
  };
  auto simulation =
      std::make_unique<coupling::Simulation>(setup::simulationSetup(scene, comm.size()), exec, settle, comm);
  if (settling) settling->finish("at rest");
  seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return simulation;
}

/// Prints the timed scene.
Json describeScene(const scene::Scene& scene, const coupling::Simulation& simulation, double preparation) {
  const std::size_t grains = simulation.ground().grains ? simulation.ground().grains->count() : 0;
  const std::size_t spheres = simulation.vehicle() ? simulation.vehicle()->parts().totalSpheres() : 0;
  fmt::print("scene     {}: {} grains, {} spheres on the vehicle, step {:g} s; {:.1f} s preparation\n",
             scene.file.string(), grains, spheres, simulation.timeStep(), preparation);
  std::fflush(stdout);
  return {{"ranks", simulation.comm().size()}, {"scene", scene.file.string()},
          {"overrides", scene.overrides},      {"grains", grains},
          {"vehicle_spheres", spheres},        {"time_step_s", simulation.timeStep()}};
}

/// Times batches of steps without internal timers.
BatchTimes timeBatches(coupling::Simulation& simulation, const StepBenchOptions& o, const base::Exec& exec) {
  BatchTimes times;
  times.steps = o.steps;
  for (int k = 0; k < o.batches; ++k) {
    base::synchronize(exec);
    const Clock::time_point begin = Clock::now();
    for (std::int64_t i = 0; i < o.steps;) i += simulation.advance(o.steps - i);
    base::synchronize(exec);
    times.microseconds.push_back(1e6 * std::chrono::duration<double>(Clock::now() - begin).count() /
                                 static_cast<double>(o.steps));
  }
  return times;
}

/// Runs the same number of steps with a timer for each part, and counts contacts in some of them.
Contacts instrument(coupling::StageTimer& timer, coupling::Simulation& simulation, std::int64_t steps) {
  Contacts contacts;
  const std::int64_t countEvery = std::max<std::int64_t>(1, steps / kCountsTaken);
  for (std::int64_t i = 0; i < steps; ++i) {
    timer.step();
    if ((i + 1) % countEvery == 0) contacts.count(simulation);
  }
  return contacts;
}

void printTimes(const BatchTimes& times, const StepBenchOptions& o, double from, int ranks) {
  fmt::print("step      {:.2f} us (median of {} batches of {} steps without internal timers; {:.2f} to {:.2f}), timed "
             "from t = {:g} s on\n",
             times.median(), o.batches, o.steps, times.least(), times.most(), from);
  if (ranks > 1) fmt::print("ranks     {}: times of the first rank, including MPI wait time\n", ranks);
}

void printRebuilds(const coupling::StageTimer& timer) {
  const double rebuild = timer.part(coupling::Stage::neighbourList).microseconds;
  fmt::print("  neighbour lists rebuilt {} times{}\n", timer.rebuilds(),
             timer.rebuilds() ? fmt::format(", {:.1f} us each", rebuild / static_cast<double>(timer.rebuilds())) : "");
}

Json printContacts(const Contacts& contacts) {
  Json json;
  const struct {
    const char *text, *key;
    double sum;
  } kinds[] = {{"grain on grain", "grain_grain", contacts.grainGrain},
               {"grain on wall and floor", "grain_boundary", contacts.grainBoundary},
               {"grain on part, patches", "grain_part_patches", contacts.grainPart},
               {"part on part and ground, patches", "part_patches", contacts.partPart},
               {"listed pairs of grain and part", "grain_part_pairs_listed", contacts.pairsListed},
               {"listed surface points", "probes_listed", contacts.samplesListed}};
  fmt::print("\ncontacts in a step (mean of {} counts)\n", contacts.counts);
  for (const auto& kind : kinds) {
    fmt::print("  {:<34} {:10.1f}\n", kind.text, contacts.mean(kind.sum));
    json[kind.key] = contacts.mean(kind.sum);
  }
  return json;
}

void printMemory(Json& json, const base::Exec& exec) {
  const double bytes = static_cast<double>(base::usedMemory(exec));
  const double host = static_cast<double>(base::usedMemory(base::cpuExec()));
  fmt::print("\nmemory    host {:.0f} MiB peak", host / 1048576);
  if (!exec.onCpu()) fmt::print(", device {:.0f} MiB in use by all programs", bytes / 1048576);
  fmt::print("\n");
  json["host_peak_bytes"] = host;
  if (!exec.onCpu()) json["device_bytes_taken"] = bytes;
}

} // namespace

void benchBedCommand(const BenchCommand& command) {
  const base::Exec exec = support::chooseDevice(support::deviceChoice(command.device.empty() ? "auto" : command.device),
                                                command.threads, command.ranks);
  Json json = benchOrigin("bed", exec);
  const BedBench& b = command.bed;
  fmt::print("bed       {} grains of radius {:g} m in five layers, friction {:g}, skin {:g} radii, step {:g} s, "
             "settled {:g} s\n",
             b.grains, b.radius, b.friction, b.skin, b.timeStep, b.settleTime);
  std::fflush(stdout);
  const BedFigures f = benchBed(b, exec, command.comm());
  printBed(b, f, command.comm().size());
  addBed(json, b, f, command.comm().size());
  writeBench(json, command.json, command.comm());
}

void benchStepCommand(const BenchCommand& command) {
  const scene::Scene scene = setup::loadScene(command.scene, command.overrides);
  if (command.comm().first()) scene::printNotes(scene);
  const support::DeviceChoice device =
      command.device.empty() ? scene.run.device : support::deviceChoice(command.device);
  const base::Exec exec =
      support::chooseDevice(device, command.threads ? command.threads : scene.run.threads, command.ranks);
  const StepBenchOptions& o = command.step;
  Json json = benchOrigin("step", exec);

  double preparation = 0;
  const std::unique_ptr<coupling::Simulation> simulation = prepare(scene, exec, command.comm(), preparation);
  json.update(describeScene(scene, *simulation, preparation));
  if (o.fromDrive && !simulation->vehicle())
    throw base::InputError(
        fmt::format("--after drive: {} has no driven [vehicle]; set a time in seconds", scene.file.string()));
  const double ramp = scene.driver.rampOfDrive(), from = advance(*simulation, o, ramp);
  const BatchTimes times = timeBatches(*simulation, o, exec);
  coupling::StageTimer timer(*simulation, exec);
  const Contacts contacts = instrument(timer, *simulation, o.steps);

  printTimes(times, o, from, command.comm().size());
  json["timed_from_s"] = from;
  if (const coupling::VehicleRig* rig = simulation->vehicle()) {
    const Drive drive{rig->driveStart(), ramp};
    const auto [word, words] = phaseOf(drive, from, simulation->time());
    fmt::print("timed     {}\n", words);
    json["timed"] = word;
    json["drive_start_s"] = drive.start ? Json(*drive.start) : Json(nullptr);
  }
  json["preparation_wall_s"] = preparation;
  json["microseconds_a_step"] = jsonOf(times);
  json["instrumented_microseconds_a_step"] = printParts(timer);
  json["rebuilds_while_instrumented"] = timer.rebuilds();
  printRebuilds(timer);
  json["contacts_a_step"] = printContacts(contacts);
  printMemory(json, exec);
  writeBench(json, command.json, command.comm());
}

} // namespace grouser::bench
