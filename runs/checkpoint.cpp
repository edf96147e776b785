// SPDX-License-Identifier: BSD-3-Clause
#include "runs/checkpoint.hpp"

#include "base/error.hpp"
#include "base/hash.hpp"
#include "runs/hdf5_file.hpp"
#include "runs/sealed_file.hpp"
#include "vehicle/spec.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <sstream>
#include <type_traits>

namespace grouser::runs {

namespace fs = std::filesystem;

namespace {

constexpr const char* kKind = "checkpoint";
constexpr int kVersion = 1; // of the layout below

/// How a record lies in a dataset: [n, width] numbers.
template <class T> struct Layout { using Number = T; };
template <> struct Layout<base::Position> { using Number = std::uint32_t; };
template <> struct Layout<terrain::Remainders> { using Number = std::uint32_t; };
template <class T> struct Layout<base::Vec3<T>> { using Number = T; };
template <> struct Layout<contact::PatchState> { using Number = double; };
template <> struct Layout<contact::PatchSums> { using Number = std::int64_t; };

/// The one list of what is stored, and under which name. `archive` writes or reads.
template <class Archive, class State> void exchange(Archive& archive, State& s) {
  archive("/steps", s.steps);
  archive("/energy_at_start", s.energyAtStart);
  archive("/most_put_in", s.mostPutIn);
  archive("/settled/time", s.settled.time);
  archive("/settled/agitation", s.settled.agitation);
  archive("/settled/steps", s.settled.steps);
  archive("/undisturbed_surface", s.surface);
  if (archive.present("/mechanism", s.mechanism)) {
    archive("/mechanism/bodies", s.mechanism->bodies);
    archive("/mechanism/worst", s.mechanism->worst);
  }
  if (archive.present("/grains", s.grains)) {
    auto& g = *s.grains;
    archive("/grains/position", g.position);
    archive("/grains/velocity", g.velocity);
    archive("/grains/spin", g.spin);
    archive("/grains/remainders", g.remainders);
    archive("/grains/dissipated", g.dissipated);
    archive("/grains/wall_bits", g.wallBits);
    archive("/grains/wall_shear", g.wallShear);
    archive("/grains/contacts", g.contacts);
    archive("/grains/neighbour", g.neighbour);
    archive("/grains/contact_shear", g.contactShear);
    archive("/grains/travelled", g.travelled);
    archive("/grains/skin", g.skin);
    archive("/grains/rebuilds", g.rebuilds);
  }
  if (archive.present("/vehicle", s.vehicle)) {
    auto& v = *s.vehicle;
    archive("/vehicle/bodies", v.bodies);
    archive("/vehicle/observers", v.observers);
    archive("/vehicle/track/states", v.track.states);
    archive("/vehicle/track/sums", v.track.sums);
    archive("/vehicle/ground/states", v.ground.states);
    archive("/vehicle/ground/sums", v.ground.sums);
    archive("/vehicle/bed/memories", v.bed.memories);
    archive("/vehicle/bed/sums", v.bed.sums);
    archive("/vehicle/ground_forces", v.groundForces);
    archive("/vehicle/mean_steps", v.meanSteps);
    archive("/vehicle/alarm_forces", v.alarmForces);
    archive("/vehicle/alarm_steps", v.alarmSteps);
    archive("/vehicle/impulse_on_parts", v.impulseOnParts);
  }
}

class Writer {
public:
  explicit Writer(Hdf5File& file) : file_(file) {}
  template <class T> bool present(const char*, const std::optional<T>& part) { return part.has_value(); }
  template <class T> void operator()(const char* name, const std::vector<T>& records) {
    using Number = typename Layout<T>::Number;
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(Number) == 0);
    constexpr std::size_t width = sizeof(T) / sizeof(Number);
    std::vector<Number> numbers(records.size() * width);
    if (!records.empty()) std::memcpy(numbers.data(), records.data(), records.size() * sizeof(T));
    file_.write(name, numbers, {records.size(), width});
  }
  template <class T> void operator()(const char* name, const T& one) { (*this)(name, std::vector<T>{one}); }

private:
  Hdf5File& file_;
};

class Reader {
public:
  explicit Reader(const Hdf5File& file) : file_(file) {}
  template <class T> bool present(const char* name, std::optional<T>& part) {
    if (file_.has(name)) part.emplace();
    return part.has_value();
  }
  template <class T> void operator()(const char* name, std::vector<T>& records) {
    using Number = typename Layout<T>::Number;
    constexpr std::size_t width = sizeof(T) / sizeof(Number);
    const std::string dataset = name;
    const std::vector<std::uint64_t> shape = file_.shape(dataset);
    if (shape.size() != 2 || shape[1] != width)
      throw base::InputError(
          fmt::format("{}: {} has another shape than this program writes", file_.path().string(), dataset));
    const std::vector<Number> numbers = file_.read<Number>(dataset);
    records.resize(shape[0]);
    for (std::size_t i = 0; i < records.size(); ++i)
      std::memcpy(static_cast<void*>(&records[i]), &numbers[i * width], sizeof(T));
  }
  template <class T> void operator()(const char* name, T& one) {
    std::vector<T> records;
    (*this)(name, records);
    if (records.size() != 1)
      throw base::InputError(fmt::format("{}: {} is not one record", file_.path().string(), name));
    one = records.front();
  }

private:
  const Hdf5File& file_;
};

std::string hashOfFile(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw base::InputError(fmt::format("{}: cannot be read", path.string()));
  base::StateHash hash;
  for (char c; file.get(c);) hash.add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
  return hash.hex();
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Keys that have no part in how the state came about, or are compared by what the file holds.
bool isFree(const std::string& key) {
  constexpr const char* kFree[] = {
      "run.duration",      "run.output_interval", "run.frame_interval", "run.checkpoint_interval",
      "run.device",        "run.threads",         "run.skin",           "run.max_overlap",
      "terrain.heightmap", "vehicle.spec"};
  return key.rfind("output.", 0) == 0 || std::find(std::begin(kFree), std::end(kFree), key) != std::end(kFree);
}

/// "section.key" and value of a resolved scene, in its order; the sections of a list are numbered.
std::vector<std::pair<std::string, std::string>> entriesOf(const std::string& resolved) {
  std::vector<std::pair<std::string, std::string>> entries;
  std::map<std::string, int> count;
  std::string section;
  for (const std::string& line : linesOf(resolved)) {
    if (line.rfind("[[", 0) == 0) {
      const std::string name = line.substr(2, line.size() - 4);
      section = fmt::format("{}[{}].", name, count[name]++);
    } else if (line.rfind('[', 0) == 0) {
      section = line.substr(1, line.size() - 2) + ".";
    } else if (const std::size_t equals = line.find(" = "); equals != std::string::npos) {
      const std::string key = section + line.substr(0, equals);
      if (!isFree(key)) entries.emplace_back(key, line.substr(equals + 3));
    }
  }
  return entries;
}

} // namespace

std::string inputsOf(const Scene& scene) {
  std::string text;
  if (scene.terrain) text += fmt::format("terrain.heightmap {}\n", hashOfFile(scene.terrain->heightmap));
  if (!scene.vehicle) return text;
  text += fmt::format("vehicle.spec {}\n", hashOfFile(scene.vehicle->spec));
  const vehicle::VehicleSpec spec = vehicle::readVehicleSpec(scene.vehicle->spec);
  for (const std::string& mesh :
       {spec.chassis.mesh, spec.shoe.mesh, spec.sprocket.mesh, spec.roadWheel.mesh, spec.roller.mesh, spec.idler.mesh})
    text += fmt::format("mesh:{} {}\n", mesh, hashOfFile(fs::path(spec.meshFolder) / mesh));
  return text;
}

void writeCheckpoint(const fs::path& path, const Checkpoint& checkpoint) {
  writeSealed(path, kKind, kVersion, [&](const fs::path& part) {
    Hdf5File file = Hdf5File::create(part, kSealBytes);
    file.attribute("/", "scene", checkpoint.scene);
    file.attribute("/", "inputs", checkpoint.inputs);
    file.attribute("/", "commit", checkpoint.commit);
    Writer writer(file);
    writer("/time_step", checkpoint.timeStep);
    writer("/rows", checkpoint.rows);
    writer("/frames", checkpoint.frames);
    exchange(writer, checkpoint.state);
    file.flush();
  });
}

Checkpoint readCheckpoint(const fs::path& path) {
  // Only what has every bit as it was written is handed to HDF5.
  checkSeal(path, kKind, kVersion);
  const Hdf5File file = Hdf5File::open(path);
  Checkpoint checkpoint;
  checkpoint.scene = file.text("/", "scene");
  checkpoint.inputs = file.text("/", "inputs");
  checkpoint.commit = file.text("/", "commit");
  Reader reader(file);
  reader("/time_step", checkpoint.timeStep);
  reader("/rows", checkpoint.rows);
  reader("/frames", checkpoint.frames);
  exchange(reader, checkpoint.state);
  return checkpoint;
}

void checkSameScene(const Checkpoint& checkpoint, const fs::path& path, const Scene& scene) {
  const auto was = entriesOf(checkpoint.scene), is = entriesOf(resolvedToml(scene));
  const auto refuse = [&](const std::string& what) {
    throw base::InputError(
        fmt::format("{}: {}; set it back, or start anew without --resume", scene.file.string(), what));
  };
  const std::map<std::string, std::string> then(was.begin(), was.end()), now(is.begin(), is.end());
  for (const auto& [key, value] : is) {
    const auto old = then.find(key);
    if (old == then.end())
      refuse(fmt::format("{} = {} does not stand in the scene that {} is of", key, value, path.string()));
    if (old->second != value)
      refuse(fmt::format("{} = {} was {} when {} was written", key, value, old->second, path.string()));
  }
  for (const auto& [key, value] : was)
    if (!now.contains(key))
      refuse(fmt::format("{} = {} is missing, with which {} was written", key, value, path.string()));
  const auto filesThen = linesOf(checkpoint.inputs), filesNow = linesOf(inputsOf(scene));
  for (const std::string& file : filesNow)
    if (std::find(filesThen.begin(), filesThen.end(), file) == filesThen.end())
      refuse(fmt::format("the file of {} is another than the one that {} was written with",
                         file.substr(0, file.find(' ')), path.string()));
}

} // namespace grouser::runs
