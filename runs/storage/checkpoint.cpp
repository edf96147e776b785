// SPDX-License-Identifier: BSD-3-Clause
#include "runs/storage/checkpoint.hpp"

#include "base/error.hpp"
#include "base/hash.hpp"
#include "runs/support/hdf5_file.hpp"
#include "runs/support/sealed_file.hpp"
#include "vehicle/spec.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <type_traits>

namespace grouser::storage {

namespace fs = std::filesystem;

namespace {

constexpr int kVersion = 16; // checkpoint file layout

/// Layout of a record in a dataset: [n, width] numbers.
template <class T> struct Layout { using Number = T; };
template <> struct Layout<base::Position> { using Number = std::uint32_t; };
template <> struct Layout<terrain::Remainders> { using Number = std::uint32_t; };
template <> struct Layout<terrain::Crossings> { using Number = std::int32_t; };
template <class T> struct Layout<base::Vec3<T>> { using Number = T; };
template <> struct Layout<std::uint64_t> { using Number = std::uint32_t; };
template <> struct Layout<terrain::GrainLayout> { using Number = std::int64_t; };
template <> struct Layout<coupling::CrushedGrains> { using Number = double; };
template <> struct Layout<coupling::SurfaceState> { using Number = double; };
template <> struct Layout<fluid::SavedParticle> { using Number = double; };
template <> struct Layout<contact::PatchState> { using Number = double; };
template <> struct Layout<contact::PatchSums> { using Number = std::int64_t; };

template <class Archive, class Settled> void exchangeSettled(Archive& archive, Settled& s) {
  archive("/settled/time", s.time);
  archive("/settled/agitation", s.energyRatio);
  archive("/settled/steps", s.steps);
  archive("/settled/friction", s.friction);
  archive("/settled/highest", s.highest);
  archive("/settled/mean_height", s.meanHeight);
}

template <class Archive, class State> void exchangeContacts(Archive& archive, const std::string& where, State& s) {
  const auto each = [&](const char* name, auto& field) { archive((where + name).c_str(), field); };
  each("/track/states", s.track.states), each("/track/sums", s.track.sums);
  each("/ground/states", s.ground.states), each("/ground/sums", s.ground.sums);
  each("/surfaces/states", s.surfaces.states), each("/surfaces/sums", s.surfaces.sums);
  each("/bed/memories", s.bed.memories), each("/bed/angles", s.bed.angles), each("/bed/dents", s.bed.dents);
  each("/bed/sums", s.bed.sums), each("/bed/deepest", s.bed.deepest);
  each("/impulse_on_parts", s.impulseOnParts), each("/angular_on_parts", s.angularOnParts);
}

/// The list of stored data and their names; the columns of grains have a separate list. `archive` writes or reads. On
/// several ranks, all data are equal except grains and contacts: each rank has a block of their rows.
template <class Archive, class State> void exchange(Archive& archive, State& s) {
  archive("/steps", s.steps);
  archive("/ledger_at_start", s.ledgerAtStart);
  archive("/energy_guard", s.guard);
  exchangeSettled(archive, s.settled);
  archive("/taken_out", s.taken);
  if (archive.present("/bed", s.bed)) {
    auto& b = *s.bed;
    archive("/bed/porosity", b.porosity), archive("/bed/porosity_error", b.porosityError);
    archive("/bed/coordination", b.coordination), archive("/bed/rattlers", b.rattlers);
    archive("/bed/order", b.order), archive("/bed/mean_diameter", b.meanDiameter);
    archive("/bed/settled_height", b.settledHeight), archive("/bed/thickness", b.thickness);
    archive("/bed/highest", b.highest), archive("/bed/lowest", b.lowest), archive("/bed/grains", b.grains);
    archive("/bed/distance", b.distance), archive("/bed/radial_distribution", b.radialDistribution);
    archive("/bed/depth", b.depth), archive("/bed/porosity_at_depth", b.porosityAtDepth);
  }
  archive("/undisturbed_surface", s.surface);
  archive("/lifts", s.lifts);
  archive("/inputs", s.inputs);
  if (archive.present("/ground", s.ground)) archive("/ground/state", *s.ground);
  if (archive.present("/mechanism", s.mechanism)) {
    archive("/mechanism/bodies", s.mechanism->bodies);
    archive("/mechanism/worst", s.mechanism->worst);
    archive("/mechanism/judged", s.mechanism->judged);
    archive("/mechanism/control", s.mechanism->control);
    if (archive.present("/mechanism/touching", s.mechanism->touching)) {
      auto& t = *s.mechanism->touching;
      exchangeContacts(archive, "/mechanism/touching", t.contacts);
      archive("/mechanism/touching/forces", t.forces), archive("/mechanism/touching/mean_steps", t.meanSteps);
      archive("/mechanism/touching/applied_work", t.appliedWork);
    }
  }
  if (archive.present("/fluid", s.fluid)) {
    archive("/fluid/steps", s.fluid->fluid.steps);
    archive("/fluid/particles", s.fluid->fluid.particles);
    archive("/fluid/body_loads", s.fluid->fluid.bodyLoads);
    archive("/fluid/bodies", s.fluid->bodies), archive("/fluid/waited", s.fluid->waited);
  }
  if (archive.present("/grains", s.grains)) {
    auto& g = *s.grains;
    archive("/grains/total", g.total);
    archive("/grains/gone", g.gone);
    archive("/grains/layout", g.layout);
    const auto path = [](const char* column) { return std::string("/grains/") + column; };
    terrain::GrainState::visitColumns(
        g, [&](const char* name, auto& column) { archive.perGrain(path(name).c_str(), column, g.total); },
        [&](const char* name, auto& column) { archive.perContact(path(name).c_str(), column, g.contacts); });
    archive("/grains/skin", g.skin);
    archive("/grains/rebuilds", g.rebuilds);
    archive("/grains/books", g.ledgerSums);
  }
  if (archive.present("/surfaces", s.surfaces)) {
    archive("/surfaces/states", s.surfaces->surfaces);
    archive("/surfaces/mean_steps", s.surfaces->meanSteps);
    archive("/surfaces/patches/memories", s.surfaces->patches.memories);
    archive("/surfaces/patches/angles", s.surfaces->patches.angles);
    archive("/surfaces/patches/dents", s.surfaces->patches.dents);
    archive("/surfaces/patches/sums", s.surfaces->patches.sums);
    archive("/surfaces/patches/deepest", s.surfaces->patches.deepest);
  }
  if (archive.present("/vehicle", s.vehicle)) {
    auto& v = *s.vehicle;
    archive("/vehicle/lift", v.lift);
    archive("/vehicle/bodies", v.bodies);
    archive("/vehicle/observers", v.observers);
    archive("/vehicle/driver", v.driver);
    archive("/vehicle/asked", v.asked);
    archive("/vehicle/hitch", v.hitch);
    archive("/vehicle/hitch_books", v.hitchSums);
    archive("/vehicle/applied_work", v.appliedWork);
    exchangeContacts(archive, "/vehicle", v.contacts);
    archive("/vehicle/ground_forces", v.groundForces);
    archive("/vehicle/mean_steps", v.meanSteps);
    archive("/vehicle/alarm_forces", v.alarmForces);
    archive("/vehicle/alarm_steps", v.alarmSteps);
    archive("/vehicle/judged", v.judged);
    archive("/vehicle/stalled_steps", v.stalledSteps);
  }
}

template <class T> constexpr std::size_t widthOf() {
  using Number = typename Layout<T>::Number;
  constexpr std::size_t kRecord = sizeof(T), kNumber = sizeof(Number);
  static_assert(std::is_trivially_copyable_v<T> && kRecord % kNumber == 0);
  return kRecord / kNumber;
}

template <class T> auto numbersOf(const std::vector<T>& records) {
  std::vector<typename Layout<T>::Number> numbers(records.size() * widthOf<T>());
  if (!records.empty()) std::memcpy(numbers.data(), records.data(), records.size() * sizeof(T));
  return numbers;
}

template <class T> std::vector<T> recordsOf(const std::vector<typename Layout<T>::Number>& numbers) {
  std::vector<T> records(numbers.size() / widthOf<T>());
  for (std::size_t i = 0; i < records.size(); ++i)
    std::memcpy(static_cast<void*>(&records[i]), &numbers[i * widthOf<T>()], sizeof(T));
  return records;
}

/// Counts the rows of each dataset that the ranks share, over all ranks.
class RowCounter {
public:
  explicit RowCounter(const base::Comm& comm) : comm_(comm) {}
  template <class T> bool present(const char*, const std::optional<T>& part) { return part.has_value(); }
  template <class T> void operator()(const char*, const T&) {}
  template <class T> void perGrain(const char* name, const std::vector<T>& rows, std::int64_t) {
    counts[name] = static_cast<std::uint64_t>(comm_.sumOf(static_cast<std::int64_t>(rows.size())));
  }
  template <class T, class Counts> void perContact(const char* name, const std::vector<T>& rows, const Counts&) {
    perGrain(name, rows, 0);
  }
  std::map<std::string, std::uint64_t> counts;

private:
  base::Comm comm_;
};

/// Writes data common to all ranks, and creates the datasets that they share.
class Writer {
public:
  Writer(support::Hdf5File& file, const RowCounter& counter) : file_(file), counter_(counter) {}
  template <class T> bool present(const char*, const std::optional<T>& part) { return part.has_value(); }
  template <class T> void operator()(const char* name, const std::vector<T>& records) {
    file_.write(name, numbersOf(records), {records.size(), widthOf<T>()});
  }
  template <class T> void operator()(const char* name, const T& one) { (*this)(name, std::vector<T>{one}); }
  template <class T> void perGrain(const char* name, const std::vector<T>&, std::int64_t) {
    file_.reserve<typename Layout<T>::Number>(name, {counter_.counts.at(name), widthOf<T>()});
  }
  template <class T, class Counts> void perContact(const char* name, const std::vector<T>& rows, const Counts&) {
    perGrain(name, rows, 0);
  }

private:
  support::Hdf5File& file_;
  const RowCounter& counter_;
};

/// Writes this rank's rows.
class RowWriter {
public:
  RowWriter(support::Hdf5File& file, const base::Comm& comm) : file_(file), comm_(comm) {}
  template <class T> bool present(const char*, const std::optional<T>& part) { return part.has_value(); }
  template <class T> void operator()(const char*, const T&) {}
  template <class T> void perGrain(const char* name, const std::vector<T>& rows, std::int64_t) {
    const auto first = static_cast<std::uint64_t>(comm_.sumBelow(static_cast<std::int64_t>(rows.size())));
    file_.writeRows(name, first, numbersOf(rows));
  }
  template <class T, class Counts> void perContact(const char* name, const std::vector<T>& rows, const Counts&) {
    perGrain(name, rows, 0);
  }

private:
  support::Hdf5File& file_;
  base::Comm comm_;
};

class Reader {
public:
  Reader(const support::Hdf5File& file, const base::Comm& comm) : file_(file), comm_(comm) {}
  template <class T> bool present(const char* name, std::optional<T>& part) {
    if (file_.has(name)) part.emplace();
    return part.has_value();
  }
  template <class T> void operator()(const char* name, std::vector<T>& records) {
    records = recordsOf<T>(file_.readRows<typename Layout<T>::Number>(name, 0, rowsOf<T>(name)));
  }
  template <class T> void operator()(const char* name, T& one) {
    std::vector<T> records;
    (*this)(name, records);
    if (records.size() != 1)
      throw base::InputError(fmt::format("{}: {} must be a single record", file_.path().string(), name));
    one = records.front();
  }
  /// This rank's block of grains; fields may have several rows per grain or none.
  template <class T> void perGrain(const char* name, std::vector<T>& rows, std::int64_t total) {
    const std::uint64_t all = rowsOf<T>(name), grains = static_cast<std::uint64_t>(total);
    const std::uint64_t each = grains > 0 ? all / grains : 0;
    if (each * grains != all)
      throw base::InputError(
          fmt::format("{}: size of {} does not match {} grains", file_.path().string(), name, total));
    const std::uint64_t first = terrain::blockStart(comm_, total, comm_.rank()),
                        last = terrain::blockStart(comm_, total, comm_.rank() + 1);
    rows = recordsOf<T>(file_.readRows<typename Layout<T>::Number>(name, first * each, (last - first) * each));
  }
  template <class T>
  void perContact(const char* name, std::vector<T>& rows, const std::vector<std::uint32_t>& contacts) {
    std::int64_t mine = 0;
    for (const std::uint32_t n : contacts) mine += n;
    const auto first = static_cast<std::uint64_t>(comm_.sumBelow(mine)), all = rowsOf<T>(name);
    if (all > 0 && all != static_cast<std::uint64_t>(comm_.sumOf(mine)))
      throw base::InputError(
          fmt::format("{}: size of {} does not match the number of contacts", file_.path().string(), name));
    rows = recordsOf<T>(file_.readRows<typename Layout<T>::Number>(name, all > 0 ? first : 0,
                                                                   all > 0 ? static_cast<std::uint64_t>(mine) : 0));
  }

private:
  template <class T> std::uint64_t rowsOf(const char* name) const {
    const std::vector<std::uint64_t> shape = file_.shape(name);
    if (shape.size() != 2 || shape[1] != widthOf<T>())
      throw base::InputError(
          fmt::format("{}: shape of {} differs from that in this program version", file_.path().string(), name));
    return shape[0];
  }

  const support::Hdf5File& file_;
  base::Comm comm_;
};

template <class Number> constexpr const char* typeName() {
  if constexpr (std::is_same_v<Number, double>) return "float64";
  if constexpr (std::is_same_v<Number, float>) return "float32";
  if constexpr (std::is_same_v<Number, std::int64_t>) return "int64";
  if constexpr (std::is_same_v<Number, std::int32_t>) return "int32";
  if constexpr (std::is_same_v<Number, std::uint32_t>) return "uint32";
}

/// Lists all fields.
class Lister {
public:
  template <class T> bool present(const char*, std::optional<T>& part) {
    part.emplace();
    return true;
  }
  template <class T> void operator()(const char* name, const std::vector<T>&) { add<T>(name, "n"); }
  template <class T> void operator()(const char* name, const T&) { add<T>(name, "1"); }
  template <class T> void perGrain(const char* name, const std::vector<T>&, std::int64_t) { add<T>(name, "grains"); }
  template <class T, class Counts> void perContact(const char* name, const std::vector<T>&, const Counts&) {
    add<T>(name, "contacts");
  }
  std::vector<StoredField> fields;

private:
  template <class T> void add(const char* name, const char* rows) {
    fields.push_back({name + 1, typeName<typename Layout<T>::Number>(), rows, widthOf<T>()});
  }
};

} // namespace

GrainLengths lengthsOf(const terrain::Grains& grains) { return {grains.scale().unit, grains.model().radius}; }

void writeState(const fs::path& path, const char* kind, const Checkpoint& checkpoint, const base::Comm& comm) {
  const auto write = [&](const fs::path& part) {
    RowCounter counter(comm);
    exchange(counter, checkpoint.state);
    if (comm.first()) {
      support::Hdf5File file = support::Hdf5File::create(part, support::kSealBytes);
      file.attribute("/", "scene", checkpoint.scene);
      file.attribute("/", "inputs", checkpoint.inputs);
      file.attribute("/", "commit", checkpoint.commit);
      if (const auto& from = checkpoint.branchedFrom) {
        file.attribute("/", "branched_from", from->file);
        file.attribute("/", "branched_at_step", static_cast<double>(from->step));
        file.attribute("/", "branched_at_hash", from->hash);
      }
      Writer writer(file, counter);
      writer("/time_step", checkpoint.timeStep);
      writer("/rows", checkpoint.rows);
      writer("/frames", checkpoint.frames);
      exchange(writer, checkpoint.state);
      if (checkpoint.lengths && checkpoint.state.grains) {
        file.attribute("/grains", "unit", checkpoint.lengths->unit);
        file.attribute("/grains", "radius", checkpoint.lengths->radius);
      }
      file.flush();
    }
    if (!checkpoint.state.grains) return;
    comm.wait();
    support::Hdf5File file = support::Hdf5File::openShared(part, comm);
    RowWriter rows(file, comm);
    exchange(rows, checkpoint.state);
    file.flush();
  };
  support::writeSealed(path, kind, kVersion, write, comm);
}

void checkStateFile(const fs::path& path, const char* kind) { support::checkSeal(path, kind, kVersion); }

coupling::SettleReport readSettled(const support::Hdf5File& file) {
  coupling::SettleReport settled;
  Reader reader(file, {});
  exchangeSettled(reader, settled);
  return settled;
}

Checkpoint readState(const support::Hdf5File& file, const base::Comm& comm) {
  Checkpoint checkpoint;
  checkpoint.scene = file.text("/", "scene");
  checkpoint.inputs = file.text("/", "inputs");
  checkpoint.commit = file.text("/", "commit");
  if (const std::string from = file.text("/", "branched_from"); !from.empty())
    checkpoint.branchedFrom =
        BranchPoint{from, std::llround(file.number("/", "branched_at_step")), file.text("/", "branched_at_hash")};
  Reader reader(file, comm);
  reader("/time_step", checkpoint.timeStep);
  reader("/rows", checkpoint.rows);
  reader("/frames", checkpoint.frames);
  exchange(reader, checkpoint.state);
  if (const double unit = checkpoint.state.grains ? file.number("/grains", "unit") : 0; unit > 0)
    checkpoint.lengths = GrainLengths{unit, file.number("/grains", "radius")};
  if (auto& grains = checkpoint.state.grains) {
    grains->id = terrain::idsFrom(grains->gone, terrain::blockStart(comm, grains->total, comm.rank()), grains->rows());
  }
  return checkpoint;
}

std::vector<StoredField> storedFields() {
  Lister lister;
  Checkpoint checkpoint;
  lister("/time_step", checkpoint.timeStep);
  lister("/rows", checkpoint.rows);
  lister("/frames", checkpoint.frames);
  exchange(lister, checkpoint.state);
  return lister.fields;
}

void writeCheckpoint(const fs::path& path, const Checkpoint& checkpoint, const base::Comm& comm) {
  writeState(path, kCheckpointFile, checkpoint, comm);
}

namespace {

/// Checks the checksum before HDF5 opens the file.
support::Hdf5File openedCheckpoint(const fs::path& path, const base::Comm& comm) {
  if (comm.first()) checkStateFile(path, kCheckpointFile);
  comm.wait();
  return support::Hdf5File::open(path);
}

} // namespace

Checkpoint readCheckpoint(const fs::path& path, const base::Comm& comm) {
  return readState(openedCheckpoint(path, comm), comm);
}

Checkpoint readOrigin(const fs::path& path, const base::Comm& comm) {
  const support::Hdf5File file = openedCheckpoint(path, comm);
  Checkpoint checkpoint;
  checkpoint.scene = file.text("/", "scene"), checkpoint.inputs = file.text("/", "inputs");
  checkpoint.commit = file.text("/", "commit");
  return checkpoint;
}

BranchPoint branchPoint(const fs::path& path, const Checkpoint& checkpoint, const base::Comm& comm) {
  return {fs::absolute(path).lexically_normal().string(), checkpoint.state.steps, checkpoint.state.hash(comm)};
}

std::string BranchPoint::text() const { return fmt::format("{}, step {}, state hash {}", file, step, hash); }

} // namespace grouser::storage
