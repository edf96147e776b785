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

/// MPI session. Create one object, first in main(), for the life of the program. Without mpirun it does nothing.
class Ranks {
public:
  Ranks(int& argc, char**& argv);
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  int rank() const;
  int size() const;
  /// Terminates all ranks with this exit code, if one cannot continue and the others would hang.
  void abort(int code) const;

private:
  friend struct detail::Run;
  std::unique_ptr<detail::RanksData> data_;
};

/// Options of a simulation. No option changes the answer.
struct Options {
  std::string device;           ///< "auto", "cpu" or "cuda"; empty: as in the scene
  std::optional<int> threads;   ///< number of CPU threads, 0: all cores; empty: as in the scene
  std::filesystem::path folder; ///< output folder, as for `grouser run`; empty: no output
  bool overwrite = false;       ///< replace existing results in `folder`
  bool cache = true;            ///< reuse settled beds and cut meshes from earlier runs, and store new ones
  /// MPI ranks that share the scene. All must make the same calls, from the thread that created the simulation.
  const Ranks* ranks = nullptr;
  /// Called while a bed settles, with its time [s] and its kinetic energy ratio. An exception from it ends the
  /// settling.
  std::function<void(double time, double energy)> settling;
};

/// Runs a scene in this process; the constructor settles the bed. Several simulations may coexist, each used by one
/// thread at a time. Inputs take effect at the next step and are stored with their steps in checkpoints and results
/// (`grouser run --replay FOLDER` reproduces the run without its controller). Results are bitwise identical on a CPU,
/// on a GPU and for any number of threads and ranks.
class Simulation {
public:
  /// Lays and settles the bed, sets the vehicle down. Throws InputError, SimulationError, DeviceError.
  explicit Simulation(const Scene& scene, const Options& options = {});
  /// Continues from a checkpoint of the same scene. If `options.folder` is another folder, or empty, this is a branch,
  /// which may change the drive and the hitch (docs/large_runs.md#stop-and-resume).
  static Simulation resumed(const Scene& scene, const std::filesystem::path& checkpoint, const Options& options = {});
  ~Simulation(); ///< without finish(), the manifest says that the run was stopped
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Takes `count` steps, or fewer if a [stop] condition of the scene is met; see ended(). Throws SimulationError if
  /// the simulation becomes unsound, and InputError if the run has already ended or failed. `keepGoing`, if given, is
  /// called about ten times a second; if it returns false, or throws, step() returns after the current step. It may
  /// read and set, but not step. The scene's run.duration does not end the simulation.
  void step(std::int64_t count = 1, const std::function<bool()>& keepGoing = {});
  /// Advances by `seconds` > 0, rounded to whole steps, at least one.
  void stepFor(double seconds);
  std::string ended() const; ///< why a [stop] condition ended the run; empty while it continues

  double time() const;        ///< simulation time from the end of settling [s]
  double timeStep() const;    ///< length of a step [s]
  std::int64_t steps() const; ///< steps taken
  std::string device() const; ///< name of the device

  bool hasVehicle() const;
  Vehicle vehicle();              ///< throws InputError if the scene has none
  std::size_t grainCount() const; ///< number of grains on all ranks
  Grains grains() const;
  std::size_t ownGrainCount() const; ///< grains that this rank returns; all grains without MPI
  /// Copies the positions of grains() to the caller's buffer. Throws InputError unless its size is ownGrainCount().
  void readPositions(std::span<Vec3> positions) const;
  std::vector<Body> bodies() const;
  Energies energies() const;

  void setGravity(const Vec3& gravity); ///< [m/s2], each within +-1000
  void releaseGravity();
  /// Force [N] and torque about the centre of mass [N m] on a body of vehicle or mechanism, in world axes.
  void setLoad(std::string_view body, const Vec3& force, const Vec3& torque = {});
  void releaseLoad(std::string_view body);

  /// Writes a checkpoint for resumed() and `grouser run --resume`. If writing fails, an existing file is kept intact.
  /// Throws InputError after a failed step.
  void save(const std::filesystem::path& checkpoint) const;
  /// Restores the state of a checkpoint, as resumed(), also after finish() or a failure. Not allowed with an output
  /// folder: rows would be duplicated. Means over steps are unknown until the next step().
  void restore(const std::filesystem::path& checkpoint);
  std::string hash() const; ///< state hash, 16 hexadecimal digits; equal states have equal hashes
  /// Ends the run: writes the last row, checkpoint, plots and summary to the folder. No step() after it. After a failed
  /// step it does nothing: the manifest names the cause.
  void finish();

private:
  friend std::vector<std::string> warningsOf(const Simulation& simulation);
  explicit Simulation(std::unique_ptr<detail::Run> run);
  std::unique_ptr<detail::Run> run_;
};

/// Warnings and notes on the scene and the built simulation, as `grouser run` prints them.
std::vector<std::string> warningsOf(const Simulation& simulation);

} // namespace grouser
