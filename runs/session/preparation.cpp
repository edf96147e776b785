// SPDX-License-Identifier: BSD-3-Clause
#include "runs/session/preparation.hpp"

#include "base/error.hpp"
#include "runs/session/failed_run.hpp"
#include "runs/session/signal_watch.hpp"
#include "runs/storage/scene_changes.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/print_stderr.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stopwatch.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <utility>

namespace grouser::session {

const coupling::PreparationSetup* preparationOf(const coupling::GroundSetup& ground) {
  if (!ground.grains || !ground.grains->bed) return nullptr;
  const coupling::BedSetup& bed = *ground.grains->bed;
  if (bed.alone) return preparationOf(*bed.alone);
  if (bed.tile) return preparationOf(*bed.tile->ground);
  return bed.preparation ? &*bed.preparation : nullptr;
}

Caches cachesOf(bool beds, const RunRequest& request) {
  Caches kept;
  const std::optional<support::KeptFiles> files =
      request.cache ? support::KeptFiles::ofUser(request.comm()) : std::nullopt;
  if (!files && request.cache && !std::getenv("GROUSER_CACHE") && request.comm().first())
    support::printStderr("WARNING: no cache of beds and sphere sets, because this user has no home folder; set "
                         "GROUSER_CACHE to a folder, or to nothing to hide this warning\n");
  if (!files) return kept;
  if (beds) kept.beds.emplace(*files);
  kept.spheres.emplace(*files);
  return kept;
}

std::unique_ptr<storage::Checkpoint> formerRun(const setup::Provenance& provenance, const RunRequest& request) {
  if (!request.resume) return nullptr;
  auto former = std::make_unique<storage::Checkpoint>(storage::readCheckpoint(*request.resume, request.comm()));
  const storage::BranchChanges changes =
      storage::checkSameScene(*former, *request.resume, provenance, request.names.resume);
  if (changes.any() && !request.branch)
    throw base::InputError(
        fmt::format("{}: [{}] differs from the run in {}; choose another folder for the branch with --out",
                    provenance.file.string(), changes.driver ? "driver" : "hitch", request.folder.string()));
  if (former->commit != support::buildInfo().commit && request.comm().first())
    support::printStderr(
        "WARNING: {} was written by commit {}, but this program is commit {}; results are bitwise identical "
        "only if both commits compute the same physics\n",
        request.resume->string(), former->commit, support::buildInfo().commit);
  return former;
}

void requireSameStep(const storage::Checkpoint& former, double timeStep, const setup::Provenance& provenance,
                     const RunRequest& request) {
  if (former.timeStep != timeStep)
    throw base::InputError(fmt::format("{}: run.time_step = \"auto\" is {:g} s with these keys, but {} was written "
                                       "with {:g} s; set run.time_step to a number in both runs",
                                       provenance.file.string(), timeStep, request.resume->string(), former.timeStep));
}

std::unique_ptr<coupling::Simulation> makeSimulation(coupling::SimulationSetup setup, const setup::RecordSetup& record,
                                                     const base::Exec& exec, const storage::Checkpoint* former,
                                                     const RunRequest& request, Caches& kept) {
  const base::Comm comm = request.comm();
  storage::BedCache* beds = kept.beds ? &*kept.beds : nullptr;
  storage::SphereCache* spheres = kept.spheres ? &*kept.spheres : nullptr;
  if (former) requireSameStep(*former, setup.timeStep, record.provenance, request);
  if (former) return std::make_unique<coupling::Simulation>(std::move(setup), exec, former->state, comm, spheres);
  const bool hasBed = setup.ground.grains && setup.ground.grains->bed;
  // A prepared bed settles twice: with the friction of its preparation, and with its own.
  const coupling::PreparationSetup* const preparation = preparationOf(setup.ground);
  const double limit = hasBed ? (preparation ? 2 : 1) * setup.ground.grains->bed->settle.timeLimit : 0;
  const std::string severalBeds =
      preparation ? fmt::format("settling  for terrain.porosity = {:g}, samples of the bed settle first, to find the "
                                "friction of its preparation by trials; each starts at 0 s, and the bed comes last",
                                preparation->porosity)
                  : "settling  several beds, one after another; each starts at 0 s";
  std::unique_ptr<support::Progress> settling;
  std::optional<support::Stopwatch> begun;
  double reached = 0; // simulated time of the bed that settles now [s]
  int restarts = 0;   // number of beds that have settled before it
  FailedBed failed(setup.ground, record, request, exec);
  coupling::SettleProgress settle = [&](double time, double energyRatio) {
    if (const int signal = SignalWatch(comm).receivedAt(0))
      throw support::Stopped(
          signal,
          fmt::format("stopped by {} while the bed settled; nothing was written", support::StopSignals::name(signal)),
          support::Stopped::Left::nothing);
    if (!settling)
      settling = std::make_unique<support::Progress>("settling", comm.first(), 0, support::Progress::End::limit);
    if (time > 0 && !begun) begun.emplace(); // at time 0, it may wait for another run
    if (begun) kept.settling = begun->seconds();
    if (time < reached) {
      if (++restarts == 1) settling->note(severalBeds);
      settling->restart(fmt::format("settling, bed {}", restarts + 1));
    }
    reached = time;
    settling->update(time / limit, fmt::format("t {:.2f} s, kinetic energy ratio {:.2g}", time, energyRatio));
  };
  settle.failed = [&](const terrain::Grains& bed, const std::string& message, base::Cause cause) {
    failed.leave(&bed, message, cause);
  };
  try {
    auto simulation = std::make_unique<coupling::Simulation>(std::move(setup), exec, settle, comm, beds, spheres);
    if (settling) settling->finish("at rest");
    return simulation;
  } catch (const base::SimulationError& error) {
    failed.leave(nullptr, error.what(), error.cause());
    throw;
  }
}

} // namespace grouser::session
