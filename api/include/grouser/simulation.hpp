// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <grouser/scene.hpp>
#include <grouser/types.hpp>
#include <grouser/vehicle.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grouser {

namespace detail {
struct RanksData;
} // namespace detail

/// MPI session. Create one object at the start of main() and keep it until main() ends. No effect without mpirun.
class Ranks {
public:
  Ranks(int& argc, char**& argv);
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  int rank() const;
  int size() const;
  /// Terminates all ranks with an exit code. Call it if one rank cannot continue and the others would wait for it.
  void abort(int code) const;

private:
  friend struct detail::Run;
  std::unique_ptr<detail::RanksData> data_;
};

/// Options of a simulation. No option changes the results.
struct Options {
  std::string device; ///< "auto", "cpu" or "cuda"; empty: as in the scene
  std::optional<int>
      threads; ///< number of CPU threads, 0: all available cores, at most OMP_NUM_THREADS; empty: as in the scene
  std::filesystem::path folder; ///< output folder, as of `grouser run`; empty: no output
  bool overwrite = false;       ///< replace existing results in `folder`
  bool cache = true;            ///< reuse settled beds and mesh spheres of earlier runs, and store new ones
  /// MPI ranks that share the scene. All ranks must make the same calls, from the thread that created the simulation.
  const Ranks* ranks = nullptr;
  /// Called while a bed settles, with the settling time [s] and the kinetic energy ratio. If the function throws, the
  /// settling ends.
  std::function<void(double time, double energy)> settling;
};

/// Runs a scene in this process; the constructor settles the bed. Several simulations may exist; only one thread at a
/// time may use each. Inputs take effect at the next step and are stored with their steps in checkpoints and results
/// (`grouser run --replay FOLDER` reproduces the run without its controller). Results are bitwise identical on a CPU,
/// on a GPU and for any number of threads and ranks.
class Simulation {
public:
  /// Creates and settles the bed and places the vehicle. Throws InputError, SimulationError, DeviceError.
  explicit Simulation(const Scene& scene, const Options& options = {});
  /// Continues from a checkpoint of the same scene. With another `options.folder`, or none, the new simulation is a
  /// branch, and its scene may change the drive and the hitch (docs/large_runs.md#stop-and-resume).
  static Simulation resumed(const Scene& scene, const std::filesystem::path& checkpoint, const Options& options = {});
  ~Simulation(); ///< without finish(), the manifest reports the run as stopped
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Advances by `count` steps, or by fewer if a [stop] condition of the scene is met; see ended(). Throws
  /// SimulationError if the simulation becomes invalid, and InputError if the run has already ended or failed. About
  /// ten times a second, step() calls `keepGoing` (if given), and returns if the function returns false or throws.
  /// `keepGoing` may read state and set inputs, but not call step(). The scene's run.duration has no effect on step().
  void step(std::int64_t count = 1, const std::function<bool()>& keepGoing = {});
  /// Advances by `seconds` > 0, rounded to a whole number of steps, at least one.
  void stepFor(double seconds);
  std::string ended() const; ///< reason why a [stop] condition ended the run; empty until then

  double time() const;        ///< simulation time from the end of settling [s]
  double timeStep() const;    ///< length of a step [s]
  std::int64_t steps() const; ///< number of steps since settling
  std::string device() const; ///< name of the device

  bool hasVehicle() const;
  Vehicle vehicle();              ///< throws InputError if the scene has no vehicle
  std::size_t grainCount() const; ///< number of grains on all ranks
  Grains grains() const;
  std::size_t ownGrainCount() const; ///< number of grains in grains() on this rank; all without MPI
  /// Copies the positions of grains() to the caller's buffer. Throws InputError unless its size is ownGrainCount().
  void readPositions(std::span<Vec3> positions) const;
  std::vector<Body> bodies() const;
  Energies energies() const;

  void setGravity(const Vec3& gravity); ///< [m/s2], each component within +-1000
  void releaseGravity();
  /// Applies a force [N] and a torque about the centre of mass [N m], in world axes, to a body of vehicle or mechanism.
  void setLoad(std::string_view body, const Vec3& force, const Vec3& torque = {});
  void releaseLoad(std::string_view body);

  /// Writes a checkpoint for resumed() and `grouser run --resume`. If writing fails, an existing file is unchanged.
  /// Throws InputError after a failed step.
  void save(const std::filesystem::path& checkpoint) const;
  /// Restores the state from a checkpoint, as resumed() does, also after finish() or a failure. Not supported with an
  /// output folder, since rows would be duplicated. Means over a step() call are unknown until the next call.
  void restore(const std::filesystem::path& checkpoint);
  std::string hash() const; ///< state hash, 16 hexadecimal digits; equal states have equal hashes
  /// Ends the run: writes the last row, checkpoint, plots and summary to the folder; step() then throws. Does nothing
  /// after a failed step, since the manifest already names the cause.
  void finish();

private:
  friend std::vector<std::string> warningsOf(const Simulation& simulation);
  explicit Simulation(std::unique_ptr<detail::Run> run);
  std::unique_ptr<detail::Run> run_;
};

/// Warnings and notes on the scene and the built simulation, as `grouser run` prints them.
std::vector<std::string> warningsOf(const Simulation& simulation);

} // namespace grouser
