// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <grouser/scene.hpp>
#include <grouser/types.hpp>
#include <grouser/vehicle.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grouser {

namespace detail {
struct RanksData;
} // namespace detail

/// The connection with the other ranks, where mpirun has started this program with several: one for the life of the
/// program, made first in main(). Alone it does nothing.
class Ranks {
public:
  Ranks(int& argc, char**& argv);
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  int rank() const;
  int size() const;
  /// Ends all ranks with this exit code, where one cannot go on and the others would wait for it.
  void abort(int code) const;

private:
  friend struct detail::Run;
  std::unique_ptr<detail::RanksData> data_;
};

/// How a simulation is run. No option changes the answer.
struct Options {
  std::string device;           ///< "auto", "cpu" or "cuda"; empty: as the scene says
  int threads = -1;             ///< of the CPU, 0 for all; -1: as the scene says
  std::filesystem::path folder; ///< for results as `grouser run` leaves them; empty: nothing is written
  bool overwrite = false;       ///< a folder that holds results
  bool cache = true;            ///< take settled beds and cut meshes from earlier runs, and keep them
  /// That share the scene: all make the simulation, step, read, set and save alike, from the thread that made it.
  const Ranks* ranks = nullptr;
  /// Called while a bed settles, with its time [s] and its kinetic energy ratio. What it throws ends the settling.
  std::function<void(double time, double energy)> settling;
};

/// A scene that runs in this process; several may run at a time, each used by one thread at a time. Built settled.
/// Everything that is set from outside acts from the next step on, is kept with its step in checkpoints and results
/// (`grouser run --replay FOLDER` repeats the run without its controller), and gives the same bits on a CPU, on a GPU
/// and on any number of threads.
class Simulation {
public:
  /// Lays and settles the bed, sets the vehicle down. Throws InputError, SimulationError, DeviceError.
  explicit Simulation(const Scene& scene, const Options& options = {});
  /// Goes on from a checkpoint of the same scene, in the checkpoint's folder as if it had not been stopped, or in another
  /// one. [driver] and [hitch] may differ where `options.folder` is another one, or none.
  static Simulation resumed(const Scene& scene, const std::filesystem::path& checkpoint, const Options& options = {});
  ~Simulation(); ///< an unfinished folder says that the run was left
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Takes `count` steps, or fewer where what the scene's [stop] names comes to pass; see ended(). Throws
  /// SimulationError where the simulation becomes unsound, InputError behind such an end, and behind a failed step.
  /// `keepGoing`, where given, is asked some ten times a second; false ends the call after the step it is at.
  void step(std::int64_t count = 1, const std::function<bool()>& keepGoing = {});
  /// As many steps as are nearest to `seconds` > 0, at least one.
  void stepFor(double seconds);
  std::string ended() const; ///< why the scene's [stop] has ended the run; empty while it goes on

  double time() const;         ///< since the bed has settled [s]
  double timeStep() const;     ///< [s]
  std::int64_t steps() const;  ///< taken
  std::string device() const;  ///< in words

  bool hasVehicle() const;
  Vehicle vehicle();           ///< throws InputError where the scene has none
  std::size_t grainCount() const; ///< of all ranks
  Grains grains() const;
  std::size_t ownGrainCount() const; ///< of which this rank returns values; alone all
  /// The positions of grains() in one pass into memory of the caller, for ownGrainCount() of them. Throws InputError on
  /// another size.
  void readPositions(std::span<Vec3> positions) const;
  std::vector<Body> bodies() const;
  Energies energies() const;

  void setGravity(const Vec3& gravity); ///< [m/s2], each within +-1000
  void releaseGravity();
  /// Force [N] and torque about the centre of mass [N m] on a body of vehicle or mechanism, in world axes.
  void setLoad(std::string_view body, const Vec3& force, const Vec3& torque = {});
  void releaseLoad(std::string_view body);

  /// Writes a checkpoint, with which resumed() and `grouser run --resume` go on. The former file stays whole if that
  /// fails.
  void save(const std::filesystem::path& checkpoint) const;
  /// Goes back, or on, to a checkpoint, as resumed(). Not while a folder is written: rows would come twice.
  void restore(const std::filesystem::path& checkpoint);
  std::string hash() const; ///< of the state, 16 hexadecimal digits: equal bits, equal hash
  /// Ends the run: last row, checkpoint, plots and summary of the folder. Nothing may be stepped behind it. Behind a
  /// failed step it does nothing: the folder says why the run has failed.
  void finish();

private:
  explicit Simulation(std::unique_ptr<detail::Run> run);
  std::unique_ptr<detail::Run> run_;
};

} // namespace grouser
