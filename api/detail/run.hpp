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

#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grouser {

namespace detail {

struct SceneData {
  std::string text;
  std::filesystem::path file; ///< file name in messages; relative paths start from its folder
  std::vector<std::string> overrides;
  scene::Scene scene;
};

struct RanksData {
  base::Ranks ranks;
  RanksData(int& argc, char**& argv) : ranks(argc, argv) {}
};

/// Calls a function and translates internal errors into the public exceptions.
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

/// A simulation and, if it has an output folder, its session.
struct Run {
  Run(const Scene& scene, const Options& options, const std::optional<std::filesystem::path>& resume);
  ~Run();

  /// The vehicle's rig; throws InputError if the scene has no vehicle.
  const coupling::VehicleRig& rig() const;
  /// Throws InputError with `what` (the refused call) if the simulation is finished or has failed.
  void requireOpen(const char* what) const;
  /// Validates inputs and queues them for act(). set() is not a collective call over the ranks; act() is.
  void set(const std::vector<coupling::Input>& inputs);
  /// Sets the inputs of the left track and, if there is one, the right track.
  void setTracks(coupling::InputKind kind, double left, double right);
  /// Resets inputs to the values of the scene, for `target` or for all targets.
  void release(std::initializer_list<coupling::InputKind> kinds, const std::optional<std::int32_t>& target = {});
  /// Applies the queued inputs. Collective. Throws InputError if inputs or number of steps differ from those of rank 0;
  /// the message names the rank that differs.
  void act(std::int64_t steps = 0);
  /// Builds the simulation from the request's checkpoint, as a branch if requested. Returns the checkpoint.
  std::unique_ptr<storage::Checkpoint> goOn();
  /// The simulation; throws InputError if a failed restore() has left no simulation.
  coupling::Simulation& now() const;
  void step(std::int64_t count, const std::function<bool()>& keepGoing);
  /// Returns the exception that keepGoing has thrown, or null.
  std::exception_ptr advance(std::int64_t count, const std::function<bool()>& keepGoing);
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
  std::optional<session::RunSession> session; ///< empty without an output folder, and after finish()
  support::FileLock lock;                     ///< lock of the folder of a resumed run
  std::vector<coupling::Input> pending;       ///< inputs queued for act()
  bool finished = false;
  std::string failed;            ///< message of the failed step
  bool isStepping = false;       ///< true during step(), including keepGoing
  std::int64_t stepsAtATime = 1; ///< steps between two calls of keepGoing
  support::Stopwatch since;
};

} // namespace detail
} // namespace grouser
