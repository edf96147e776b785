// SPDX-License-Identifier: BSD-3-Clause
#include "runs/storage/bed_cache.hpp"

#include "coupling/energy_guard.hpp"
#include "coupling/ledger.hpp"
#include "coupling/placed_on_bed.hpp"
#include "runs/storage/checkpoint.hpp"
#include "runs/storage/kept_frictions.hpp"
#include "runs/support/file_lock.hpp"
#include "runs/support/print_stderr.hpp"
#include "runs/support/shared_folder.hpp"

#include <chrono>
#include <fmt/format.h>
#include <thread>
#include <vector>

namespace grouser::storage {

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kKind = support::KeptFiles::Kind::bed;
constexpr double kBytesPerGrain = 400; // maximum file size, except for beds with unusually many contacts
constexpr auto kLook = std::chrono::milliseconds(200); // polling interval for the lock of another run

void warn(const base::Comm& comm, const std::string& message) {
  if (comm.first()) support::printStderr("WARNING: {}; continuing without it\n", message);
}

/// Returns the `answer` of the first rank on all ranks.
bool agreed(const base::Comm& comm, bool answer) { return comm.maximumOf(comm.first() && answer ? 1 : 0) != 0; }
bool allOf(const base::Comm& comm, bool answer) { return comm.maximumOf(answer ? 0 : 1) == 0; }

} // namespace

std::optional<BedCache> BedCache::ofUser(const base::Comm& comm) {
  const std::optional<support::KeptFiles> files = support::KeptFiles::ofUser(comm);
  return files ? std::optional(BedCache(*files)) : std::nullopt;
}

std::optional<coupling::SettleReport> BedCache::find(const std::string& origin) const {
  const fs::path file = files_.fileOf(kKind, origin);
  try {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return {};
    checkStateFile(file, kBedFile);
    const support::Hdf5File open = support::Hdf5File::open(file);
    if (open.text("/", "scene") != origin) return {};
    return readSettled(open);
  } catch (const std::exception&) {
    return {}; // the run reports the error
  }
}

coupling::SettledGround BedCache::settle(const coupling::GroundSetup& setup, const base::Exec& exec,
                                         const coupling::SettleProgress& progress, const base::Comm& comm) {
  const Clock::time_point start = Clock::now();
  const auto seconds = [start] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  const std::string& made = setup.grains->bed->origin;
  const fs::path file = comm.broadcast(files_.fileOf(kKind, made).string());

  const auto taken = [&] {
    std::optional<coupling::SettledGround> kept = reuse(file, setup, exec, comm);
    if (kept) summary_ = fmt::format("read from {} in {:.2f} s", file.string(), seconds());
    return kept;
  };
  if (std::optional<coupling::SettledGround> kept = taken()) return std::move(*kept);

  const fs::path& folder = files_.folder();
  const bool usable =
      agreed(comm, comm.first() && files_.writable()) && !support::rankNotSeeing(folder, comm).has_value();
  if (!usable) warn(comm, fmt::format("{}: cannot cache settled beds in this folder", folder.string()));
  // If several runs need the same bed, the first run settles it, including its tile and all preparation trials.
  support::FileLock lock;
  if (usable) {
    const fs::path name = support::KeptFiles::lockOf(file);
    for (bool announced = false; !agreed(comm, comm.first() && lock.take(name)); announced = true) {
      if (!announced && comm.first()) support::printStderr("waiting for another run that is settling the same bed\n");
      progress(0, 0);
      std::this_thread::sleep_for(kLook);
    }
    if (std::optional<coupling::SettledGround> kept = taken()) return std::move(*kept);
  }
  // Cached frictions only on one rank: with different caches, ranks would communicate differently.
  const KeptFrictions frictions(files_);
  const KeptFrictions* const found = comm.alone() ? &frictions : nullptr;
  coupling::SettledGround settled{coupling::buildGround(setup, exec, comm, progress, found), {}};
  const terrain::Grains& grains = *settled.ground.grains;
  const bool fits = files_.fits(kBytesPerGrain * static_cast<double>(grains.count()));
  if (!fits) lock.release(); // so that other runs do not wait
  settled.report = coupling::settle(*setup.grains->bed, settled.ground, progress, found);
  const double settledIn = seconds();
  const bool kept = usable && fits && keep(file, made, grains, settled.report, comm);
  summary_ = fmt::format("settled in {:.2f} s; {}", settledIn,
                         kept    ? "cached in " + file.string()
                         : !fits ? "not cached: larger than GROUSER_CACHE_GIB"
                                 : "not cached");
  return settled;
}

std::optional<coupling::SettledGround> BedCache::reuse(const fs::path& file, const coupling::GroundSetup& setup,
                                                       const base::Exec& exec, const base::Comm& comm) const {
  std::error_code error;
  if (!allOf(comm, fs::is_regular_file(file, error))) return {};
  std::string damage;
  try {
    checkStateFile(file, kBedFile); // every rank: its copy may differ if the folder is not shared
  } catch (const std::exception& e) {
    damage = e.what();
  }
  for (const std::vector<char>& found : comm.gatherAll(std::vector<char>(damage.begin(), damage.end())))
    if (!found.empty()) damage.assign(found.begin(), found.end());
  Checkpoint bed;
  if (damage.empty()) {
    // Another run may have deleted the file in the meantime; then all ranks settle.
    bool good = true;
    std::optional<support::Hdf5File> open;
    try {
      open = support::Hdf5File::open(file);
    } catch (const std::exception&) {
      good = false;
    }
    if (!allOf(comm, good)) return {};
    bed = readState(*open, comm);
    if (bed.scene != setup.grains->bed->origin || !bed.state.grains)
      damage = fmt::format("{}: contents do not match the file name", file.string());
  }
  if (!damage.empty()) {
    warn(comm, damage);
    return {};
  }
  coupling::SettledGround kept{coupling::groundAt(setup, *bed.state.grains, exec, comm), bed.state.settled};
  kept.ground.grains->restore(*bed.state.grains);
  if (comm.first()) support::KeptFiles::noteUse(file);
  return kept;
}

bool BedCache::keep(const fs::path& file, const std::string& origin, const terrain::Grains& grains,
                    const coupling::SettleReport& report, const base::Comm& comm) const {
  Checkpoint bed;
  bed.scene = origin, bed.timeStep = grains.model().timeStep;
  bed.lengths = lengthsOf(grains);
  bed.state.settled = report, bed.state.ledgerAtStart = coupling::Ledger{}.counted();
  bed.state.guard = coupling::EnergyGuard{}.save();
  bed.state.grains = grains.state();
  // Written under a unique name, then renamed: another machine that shares the folder may write the same bed.
  const fs::path fresh = comm.broadcast(support::KeptFiles::freshName(file).string());
  try {
    writeState(fresh, kBedFile, bed, comm);
  } catch (const std::exception& e) {
    if (!comm.alone()) throw; // other ranks may wait in writeState(); only an error ends them
    warn(comm, e.what());
    return false;
  }
  return !comm.first() || files_.put(fresh, file);
}

} // namespace grouser::storage
