// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/bench/multibody.hpp"

#include "base/exec.hpp"
#include "multibody/linear_system.hpp"
#include "runs/support/locations.hpp"
#include "runs/validation/bench/report.hpp"
#include "vehicle/driver.hpp"
#include "vehicle/spec_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>

namespace grouser::bench {

using base::Vec3d;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

namespace {

const Vec3d kGravityVector{0, 0, -9.81};
constexpr double kTensionRamp = 0.05, kWeightRamp = 0.1, kDriveRamp = 0.2; // [s]
constexpr double kGoal = 20;                                               // target time per step of the vehicle [us]
constexpr double kLoose = 1e-8, kTight = 1e-13;                            // [m, rad] tolerances of the joint errors
constexpr double kGrowth = 2.2;                                            // maximum time ratio for twice the shoes

double microsecondsSince(Clock::time_point start) {
  return 1e6 * std::chrono::duration<double>(Clock::now() - start).count();
}

/// Median and range of the times of several calls. `f` returns the time of one call [us].
template <class F> BatchTimes timed(int batches, std::int64_t calls, F f) {
  BatchTimes times;
  times.steps = calls;
  for (int k = 0; k < batches; ++k) {
    double sum = 0;
    for (std::int64_t i = 0; i < calls; ++i) sum += f();
    times.microseconds.push_back(sum / static_cast<double>(calls));
  }
  return times;
}

template <class F> double microsecondsOf(F f) {
  const Clock::time_point start = Clock::now();
  f();
  return microsecondsSince(start);
}

vehicle::DriverOptions driverOptions(double speed) {
  vehicle::DriverOptions options;
  options.tensionRamp = kTensionRamp, options.weightRamp = kWeightRamp, options.driveRamp = kDriveRamp;
  options.driveStart = 1.01 * (kTensionRamp + kWeightRamp);
  options.speeds = {{0}, {speed}, {speed}};
  return options;
}

void timeParts(const multibody::Model& model, const multibody::State& state, const multibody::Loads& loads,
               const MultibodyBench& bench, VehicleGraphFigures& f) {
  multibody::LinearSystem system(model);
  system.place(state);
  f.rows = system.hardRows(), f.batches = system.batches(), f.loops = system.loops();
  f.linearise = timed(bench.batches, bench.steps, [&] { return microsecondsOf([&] { system.factor(); }); });
  f.solve = timed(bench.batches, bench.steps, [&] { return microsecondsOf([&] { system.solve(); }); });

  // At the same state, the two tolerances require different numbers of iterations.
  const auto stepped = [&](double tolerance, double& iterations) {
    multibody::SolverOptions options;
    options.positionTolerance = tolerance;
    multibody::Solver solver(model, options);
    multibody::State copy;
    BatchTimes times = timed(bench.batches, bench.steps, [&] {
      copy = state;
      return microsecondsOf([&] { solver.step(copy, loads, bench.timeStep); });
    });
    iterations = solver.lastStep().iterations;
    return times;
  };
  double few = 0, many = 0;
  const double quick = stepped(kLoose, few).least(), slow = stepped(kTight, many).least();
  f.iteration = many > few ? (slow - quick) / (many - few) : 0;
  f.rest = quick - f.linearise.least() - few * f.iteration;
}

Json summaryOf(const BatchTimes& times) {
  return {{"median", times.median()}, {"min", times.least()}, {"max", times.most()}, {"steps_a_batch", times.steps}};
}

Json report(const VehicleGraphFigures& f) {
  fmt::print("vehicle   {} bodies, {} joints, {} constraint rows, {} loops, {} SIMD batches of four bodies\n", f.bodies,
             f.joints, f.rows, f.loops, f.batches);
  fmt::print("drive     hull speed {:.2f} m/s; {:.2f} iterations per step (maximum {:.0f}); joint errors up to {:.1e} "
             "m or rad\n",
             f.hullSpeed, f.iterations, f.mostIterations, f.positionError);
  fmt::print("step      {:.2f} us (median of {} batches of {} steps; {:.2f} to {:.2f}); goal {:g}\n", f.step.median(),
             f.step.microseconds.size(), f.step.steps, f.step.least(), f.step.most(), kGoal);
  fmt::print("parts of a step, measured separately (minimum times):\n");
  fmt::print("  {:<42} {:7.2f} us\n", "rows, inertias, factorisation", f.linearise.least());
  fmt::print("  {:<42} {:7.2f} us\n", "each iteration: solve, poses, joint errors", f.iteration);
  fmt::print("  {:<42} {:7.2f} us\n", "  solve only", f.solve.least());
  fmt::print("  {:<42} {:7.2f} us\n", "loads, first joint errors, readings", f.rest);
  return {{"bodies", f.bodies},
          {"joints", f.joints},
          {"hard_rows", f.rows},
          {"loops", f.loops},
          {"batches_of_four", f.batches},
          {"hull_speed_m_s", f.hullSpeed},
          {"iterations_mean", f.iterations},
          {"iterations_most", f.mostIterations},
          {"largest_gap", f.positionError},
          {"microseconds_a_step", summaryOf(f.step)},
          {"microseconds_linearise_and_factor", summaryOf(f.linearise)},
          {"microseconds_a_solution", summaryOf(f.solve)},
          {"microseconds_an_iteration", f.iteration},
          {"microseconds_rest", f.rest}};
}

} // namespace

VehicleGraphFigures benchVehicleGraph(const MultibodyBench& bench) {
  const std::string file =
      bench.vehicle.empty() ? (support::shareFolder() / "assets/vehicles/light_tracked.toml").string() : bench.vehicle;
  const vehicle::VehicleSpec spec = vehicle::readVehicleSpec(file);
  vehicle::AssemblyOptions options;
  options.pose_W = vehicle::placeOnGround(spec, 0, 0, 0, 0.002, 0);
  const vehicle::Assembly assembly = vehicle::assemble(spec, options);
  multibody::Solver solver(assembly.model);
  multibody::State state = multibody::makeState(assembly.model);
  multibody::Loads loads = multibody::makeLoads(assembly.model);
  const vehicle::Driver driver(driverOptions(bench.speed));
  const TrackGuide guide(assembly);

  // The times do not include the guiding forces.
  const auto step = [&] {
    vehicle::applyControls(assembly, driver.at(state.time), kGravityVector, loads);
    guide.apply(state, loads);
    return microsecondsOf([&] { solver.step(state, loads, bench.timeStep); });
  };
  while (state.time < driver.options().driveStart + kDriveRamp) step();

  VehicleGraphFigures f;
  f.bodies = static_cast<int>(assembly.model.bodies().size());
  f.joints = static_cast<int>(assembly.model.joints().size());
  double iterations = 0;
  f.step = timed(bench.batches, bench.steps, [&] {
    const double microseconds = step();
    const multibody::StepReport& last = solver.lastStep();
    iterations += last.iterations;
    f.mostIterations = std::max<double>(f.mostIterations, last.iterations);
    f.positionError = std::max(f.positionError, last.maxPositionError);
    return microseconds;
  });
  f.iterations = iterations / static_cast<double>(bench.steps * bench.batches);
  f.hullSpeed = norm(state.twist[static_cast<std::size_t>(assembly.chassis)].v);
  timeParts(assembly.model, state, loads, bench, f);
  return f;
}

RingFigures benchRings(int shoes, const MultibodyBench& bench) {
  RingFigures f;
  f.shoes = shoes;
  const multibody::Model model = ringsAndHull(shoes);
  f.bodies = static_cast<int>(model.bodies().size());
  f.multiplications = multibody::LinearSystem(model).multiplications();
  multibody::Solver solver(model);
  multibody::State state = multibody::makeState(model);
  const multibody::Loads loads = multibody::makeLoads(model);
  double iterations = 0;
  f.step = timed(bench.batches, bench.steps, [&] {
    const double microseconds = microsecondsOf([&] { solver.step(state, loads, bench.timeStep); });
    iterations += solver.lastStep().iterations;
    return microseconds;
  });
  f.iterations = iterations / static_cast<double>(bench.steps * bench.batches);
  return f;
}

void benchMultibodyCommand(const MultibodyBench& bench) {
  Json json = benchOrigin("multibody", base::cpuExec(1));
  json["time_step_s"] = bench.timeStep;
  json["sprocket_speed_rad_s"] = bench.speed;
  json["vehicle"] = report(benchVehicleGraph(bench));
  json["goal_microseconds"] = kGoal;

  fmt::print("\ngrowth: two spinning rings of shoes, and a hull with wheels, arms and idlers; goal: twice the shoes in "
             "at most {:g} times the time\n",
             kGrowth);
  fmt::print("  {:>5} {:>7} {:>15} {:>11} {:>12} {:>9} {:>9} {:>7}\n", "shoes", "bodies", "multiplications",
             "iterations", "median [us]", "min [us]", "us/body", "ratio");
  json["growth"] = Json::array();
  double before = 0;
  for (const int shoes : {46, 92, 184}) {
    const RingFigures f = benchRings(shoes, bench);
    const double ratio = before > 0 ? f.step.least() / before : 0;
    fmt::print("  {:>5} {:>7} {:>15} {:>11.2f} {:>12.2f} {:>9.2f} {:>9.3f} {:>7}\n", f.shoes, f.bodies,
               f.multiplications, f.iterations, f.step.median(), f.step.least(), f.step.least() / f.bodies,
               ratio > 0 ? fmt::format("{:.2f}", ratio) : "");
    json["growth"].push_back({{"shoes", f.shoes},
                              {"bodies", f.bodies},
                              {"multiplications", f.multiplications},
                              {"iterations_mean", f.iterations},
                              {"microseconds_a_step", summaryOf(f.step)}});
    if (ratio > 0) json["growth"].back()["times_the_one_before"] = ratio;
    before = f.step.least();
  }
  writeBench(json, bench.json, bench.comm);
}

} // namespace grouser::bench
