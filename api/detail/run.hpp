// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/session/preparation.hpp"
#include "runs/session/run_session.hpp"
#include "runs/support/not_written.hpp"
#include "runs/support/stopwatch.hpp"

#include <grouser/errors.hpp>
#include <grouser/simulation.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grouser {

namespace detail {

struct SceneData {
  std::string text;
  std::filesystem::path file; ///< for messages, and for what the scene names
  std::vector<std::string> overrides;
  scene::Scene scene;
};

struct RanksData {
  base::Ranks ranks;
  RanksData(int& argc, char**& argv) : ranks(argc, argv) {}
};

/// What errors inside become outside.
template <class Call> auto translated(const Call& call) -> decltype(call()) {
  try {
    return call();
  } catch (const base::InputError& error) {
    throw InputError(error.what());
  } catch (const base::SimulationError& error) {
    throw SimulationError(error.what());
  } catch (const support::NotWritten& error) {
    throw SimulationError(error.what());
  } catch (const base::DeviceError& error) {
    throw DeviceError(error.what());
  }
}

/// A simulation and, where it has a folder, its session.
struct Run {
  Run(const Scene& scene, const Options& options, const std::optional<std::filesystem::path>& resume);
  ~Run();

  /// The vehicle's rig; throws InputError without one.
  const coupling::VehicleRig& rig() const;
  /// Throws InputError where nothing more may be done, which `what` names.
  void requireOpen(const char* what) const;
  /// Checks these. They act once act() is called, since a rank may be the only one that sets them.
  void set(const std::vector<coupling::Input>& inputs);
  /// Left and right, where the scene has both.
  void setTracks(coupling::InputKind kind, double left, double right);
  /// Back to what the scene says; all targets where none is given.
  void release(std::initializer_list<coupling::InputKind> kinds, const std::optional<std::int32_t>& target = {});
  /// Gives the simulation what was set. Called by all ranks; throws InputError naming the rank that has set otherwise
  /// than rank 0, or wants to take another number of steps.
  void act(std::int64_t steps = 0);
  /// Makes the simulation of the request's checkpoint, which may be one with another [driver] or [hitch]; returns that.
  std::unique_ptr<storage::Checkpoint> goOn();
  /// Throws InputError where a failed restore() has left none.
  coupling::Simulation& now() const;
  void step(std::int64_t count, const std::function<bool()>& keepGoing);
  void advance(std::int64_t count, const std::function<bool()>& keepGoing);
  void finish();
  base::Comm comm() const { return request.comm(); }
  static const SceneData& dataOf(const Scene& scene) { return *scene.data_; }
  static const base::Ranks* ranksOf(const Options& options) {
    return options.ranks ? &options.ranks->data_->ranks : nullptr;
  }

  scene::Scene scene;
  Options options;
  session::RunRequest request;
  setup::RecordSetup record;
  base::Exec exec;
  session::Caches kept;
  std::unique_ptr<coupling::Simulation> simulation;
  std::optional<session::RunSession> session; ///< empty without a folder, and behind finish()
  support::FileLock lock;                     ///< of a folder in which it goes on
  std::vector<coupling::Input> pending;       ///< set, and not yet with the simulation
  bool finished = false;
  std::string failed;      ///< why, of a step; its folder says so
  bool isStepping = false; ///< within step(), also while keepGoing is called
  std::int64_t stepsAtATime = 1; ///< between two questions whether to go on
  support::Stopwatch since;
};

} // namespace detail
} // namespace grouser
