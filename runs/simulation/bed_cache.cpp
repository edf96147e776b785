// SPDX-License-Identifier: BSD-3-Clause
#include "runs/simulation/bed_cache.hpp"

#include "base/error.hpp"
#include "base/hash.hpp"
#include "runs/simulation/checkpoint.hpp"
#include "runs/simulation/energy_guard.hpp"
#include "runs/simulation/ledger.hpp"
#include "runs/support/file_lock.hpp"
#include "runs/support/shared_folder.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <thread>
#include <unistd.h>
#include <vector>

namespace grouser::simulation {

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kPrefix = "bed-";
constexpr double kBytesPerGrain = 400;                 // of a file, at most, but for beds of unusually many contacts
constexpr auto kAbandoned = std::chrono::hours(24);    // a part of a file that no run goes on writing
constexpr auto kLook = std::chrono::milliseconds(200); // between two looks at another run's lock

void warn(const base::Comm& comm, const std::string& message) {
  if (comm.first()) fmt::print(stderr, "grouser: warning: {}; going on without it\n", message);
}

/// The first rank's answer, on all.
bool agreed(const base::Comm& comm, bool answer) { return comm.maximumOf(comm.first() && answer ? 1 : 0) != 0; }
bool allOf(const base::Comm& comm, bool answer) { return comm.maximumOf(answer ? 0 : 1) == 0; }

/// Empty where nothing is to be kept.
std::string folderOfUser() {
  if (const char* set = std::getenv("GROUSER_CACHE")) return set;
  if (const char* set = std::getenv("XDG_CACHE_HOME"); set && *set) return (fs::path(set) / "grouser").string();
  if (const char* set = std::getenv("HOME"); set && *set) return (fs::path(set) / ".cache/grouser").string();
  return "";
}

} // namespace

std::optional<BedCache> BedCache::ofUser(const base::Comm& comm) {
  std::uint64_t limit = kDefaultLimit;
  if (const char* set = std::getenv("GROUSER_CACHE_GIB"); set && *set && comm.first()) {
    double gib = 0;
    const auto [end, error] = std::from_chars(set, set + std::strlen(set), gib);
    if (error != std::errc() || *end || !(gib >= 0 && gib <= 1e6))
      throw base::InputError(
          fmt::format("GROUSER_CACHE_GIB = {} [GiB] is no number in [0, 1e6]; correct or unset it", set));
    limit = static_cast<std::uint64_t>(gib * 1073741824.0);
  }
  const std::string folder = comm.broadcast(folderOfUser());
  limit = comm.gatherValue(limit).front();
  return folder.empty() ? std::nullopt : std::optional(BedCache(folder, limit));
}

fs::path BedCache::fileOf(const std::string& origin) const {
  base::StateHash key;
  for (const char c : origin) key.add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
  return folder_ / (kPrefix + key.hex() + ".h5");
}

std::optional<SettleReport> BedCache::find(const std::string& origin) const {
  const fs::path file = fileOf(origin);
  try {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return {};
    checkStateFile(file, kBedFile);
    const support::Hdf5File open = support::Hdf5File::open(file);
    if (open.text("/", "scene") != origin) return {};
    return readSettled(open);
  } catch (const std::exception&) {
    return {}; // a run says what is wrong with it
  }
}

SettleReport BedCache::settle(const setup::BedSetup& bed, const Ground& ground, const SettleProgress& progress,
                              const base::Comm& comm) {
  terrain::Grains& grains = *ground.grains;
  const Clock::time_point start = Clock::now();
  const auto seconds = [start] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  const std::string& made = bed.origin;
  const fs::path file = comm.broadcast(fileOf(made).string());

  SettleReport report;
  const auto taken = [&] {
    if (!reuse(file, made, grains, report, comm)) return false;
    summary_ = fmt::format("taken from {}, in {:.2f} s", file.string(), seconds());
    return true;
  };
  if (taken()) return report;

  std::error_code error;
  if (comm.first()) fs::create_directories(folder_, error);
  const bool fits = kBytesPerGrain * static_cast<double>(grains.count()) <= static_cast<double>(limit_);
  const bool usable = agreed(comm, !error && ::access(folder_.c_str(), W_OK) == 0) &&
                      !support::rankNotSeeing(folder_, comm).has_value();
  if (!usable) warn(comm, fmt::format("{}: settled beds cannot be kept in this folder", folder_.string()));
  // Of several runs that want one bed the first settles it.
  support::FileLock lock;
  if (usable && fits) {
    const fs::path name = file.string() + ".lock";
    for (bool told = false; !agreed(comm, comm.first() && lock.take(name)); told = true) {
      if (!told && comm.first()) fmt::print(stderr, "waiting for another run that settles the same bed\n");
      progress(0, 0);
      std::this_thread::sleep_for(kLook);
    }
    if (taken()) return report;
  }
  report = simulation::settle(bed, ground, progress);
  const double settledIn = seconds();
  const bool kept = usable && fits && keep(file, made, grains, report, comm);
  summary_ = fmt::format("settled in {:.2f} s; {}", settledIn,
                         kept    ? "kept in " + file.string()
                         : !fits ? "not kept, since it is larger than what GROUSER_CACHE_GIB allows"
                                 : "not kept");
  return report;
}

bool BedCache::reuse(const fs::path& file, const std::string& origin, terrain::Grains& grains, SettleReport& report,
                     const base::Comm& comm) const {
  std::error_code error;
  if (!allOf(comm, fs::is_regular_file(file, error))) return false;
  std::string damage;
  try {
    checkStateFile(file, kBedFile); // of each rank's own copy, where the folder is not shared
  } catch (const std::exception& e) {
    damage = e.what();
  }
  for (const std::vector<char>& found : comm.gatherAll(std::vector<char>(damage.begin(), damage.end())))
    if (!found.empty()) damage.assign(found.begin(), found.end());
  Checkpoint bed;
  if (damage.empty()) {
    // Another run may delete it just now: then all ranks settle.
    bool good = true;
    std::optional<support::Hdf5File> open;
    try {
      open = support::Hdf5File::open(file);
    } catch (const std::exception&) {
      good = false;
    }
    if (!allOf(comm, good)) return false;
    bed = readState(*open, comm);
    if (bed.scene != origin || !bed.state.grains ||
        bed.state.grains->total != static_cast<std::int64_t>(grains.count()))
      damage = fmt::format("{}: holds another bed than its name says", file.string());
  }
  if (!damage.empty()) {
    warn(comm, damage);
    return false;
  }
  grains.restore(*bed.state.grains);
  report = bed.state.settled;
  if (comm.first()) fs::last_write_time(file, fs::file_time_type::clock::now(), error); // now it is the newest
  return true;
}

bool BedCache::keep(const fs::path& file, const std::string& origin, const terrain::Grains& grains,
                    const SettleReport& report, const base::Comm& comm) const {
  Checkpoint bed;
  bed.scene = origin, bed.timeStep = grains.model().timeStep;
  bed.state.settled = report, bed.state.ledgerAtStart = Ledger{}.counted();
  bed.state.guard = EnergyGuard{}.save();
  bed.state.grains = grains.state();
  // Written under a name of its own and renamed: another machine that shares the folder may write the same bed.
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  const fs::path fresh = comm.broadcast(fmt::format("{}.{}.{}", file.string(), host.data(), ::getpid()));
  try {
    writeState(fresh, kBedFile, bed, comm);
  } catch (const std::exception& e) {
    if (!comm.alone()) throw; // the other ranks may wait within writeState(): only an error ends them
    warn(comm, e.what());
    return false;
  }
  if (!comm.first()) return true;
  std::error_code error;
  fs::rename(fresh, file, error);
  deleteOldest(file);
  return !error;
}

/// Of one's own files only; what other programs keep there stays.
void BedCache::deleteOldest(const fs::path& except) const {
  struct Entry {
    fs::file_time_type time;
    std::uint64_t bytes;
    fs::path path;
  };
  std::vector<Entry> beds;
  std::uint64_t total = 0;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, error)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(kPrefix, 0) != 0 || !entry.is_regular_file(error)) continue;
    const auto time = entry.last_write_time(error);
    if (entry.path().extension() == ".h5") {
      beds.push_back({time, entry.file_size(error), entry.path()});
      total += beds.back().bytes;
    } else if (fs::file_time_type::clock::now() - time > kAbandoned) {
      fs::remove(entry.path(), error);
    }
  }
  std::sort(beds.begin(), beds.end(), [](const Entry& a, const Entry& b) { return a.time < b.time; });
  for (const Entry& bed : beds) {
    if (total <= limit_) break;
    if (bed.path == except) continue;
    fs::remove(bed.path, error);
    total -= bed.bytes;
  }
}

} // namespace grouser::simulation
