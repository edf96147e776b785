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

struct Scene::Impl {
  std::optional<std::string> text; ///< empty: the file's
  std::filesystem::path file;      ///< for messages, and for what the scene names
  std::vector<std::string> overrides;
  scene::Scene scene;
};

struct Ranks::Impl {
  base::Ranks ranks;
  Impl(int& argc, char**& argv) : ranks(argc, argv) {}
};

namespace detail {

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

  /// The vehicle's rig; throws InputError without one.
  const coupling::VehicleRig& rig() const;
  void set(const std::vector<coupling::Input>& inputs) const;
  /// Left and right, where the scene has both.
  void setTracks(coupling::InputKind kind, double left, double right) const;
  /// Back to what the scene says; all targets where none is given.
  void release(std::initializer_list<coupling::InputKind> kinds, const std::optional<std::int32_t>& target = {}) const;
  /// Throws InputError naming the rank whose inputs differ from those of rank 0.
  void requireAlike() const;
  void step(std::int64_t count, const std::function<bool()>& keepGoing);
  void finish();
  base::Comm comm() const { return request.comm(); }

  scene::Scene scene;
  Options options;
  session::RunRequest request;
  setup::RecordSetup record;
  base::Exec exec;
  session::Caches kept;
  std::unique_ptr<storage::Checkpoint> former; ///< that it goes on from; null from the start
  std::unique_ptr<coupling::Simulation> simulation;
  std::optional<session::RunSession> session; ///< empty without a folder, and behind finish()
  bool finished = false;
  bool failed = false; ///< by a step; its folder says so
  support::Stopwatch since;
};

} // namespace detail
} // namespace grouser
