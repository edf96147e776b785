// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/soil_bed.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "base/random.hpp"
#include "base/sphere.hpp"
#include "runs/jobs/study_place.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/support/file_hash.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>

namespace grouser::virtual_tests {

namespace {

using base::Vec3d;

constexpr double kFloorScatter = 0.15; // [d] scatter of the heights of rough-floor grains
constexpr double kCloud = 0.22;        // solid fraction of the initial cloud
constexpr double kPoured = 0.59;       // expected solid fraction; determines only the number of grains
constexpr double kAgitation = 1e-5;    // [m g r] kinetic energy per grain below which the bed is at rest
/// Higher limit [m g r] at the end of the settling time, because single grains may keep vibrating. As for plate beds.
constexpr double kLastAgitation = 1e-4;
constexpr double kSettlingPatience = 6; // [s] maximum settling time; if depth > 0.25 m: times sqrt(depth / 0.25 m)
constexpr double kLook = 0.02;          // [s] time between energy checks
constexpr std::size_t kCalmLooks = 3;

/// Coordinate wrapped into [0, length).
double wrapped(double x, double length) {
  const double y = x - length * std::floor(x / length);
  return y < length ? y : 0.0;
}

} // namespace

double Soil::meanVolume() const {
  // For a uniform distribution of radii, the mean of r^3 is (mean r)^3 (1 + spread^2).
  return base::kPi / 6 * grains.diameter() * grains.diameter() * grains.diameter() * (1 + spread * spread);
}

Soil Soil::prepared() const {
  Soil soil = *this;
  soil.grains.friction = preparationFriction;
  if (!preparationLaw.empty()) soil.grains.law = preparationLaw;
  return soil;
}

std::string Soil::toml(double friction) const {
  SampleGrains g = grains;
  g.friction = friction;
  return g.toml("grain");
}

std::string Soil::scene(double duration, std::int64_t seed, double friction, const Vec3d& gravity,
                        const std::string& run) const {
  const std::string speed = impactSpeed > 0 && run.find("impact_speed") == std::string::npos
                                ? fmt::format("impact_speed = {:.17g}\n", impactSpeed)
                                : "";
  return fmt::format("version = 1\n[run]\nduration = {:.17g}\nseed = {}\nsteps_per_contact = {}\ngravity = [{}, {}, "
                     "{}]\n{}{}{}",
                     duration, seed, stepsPerContact, gravity.x, gravity.y, gravity.z, run, speed, toml(friction));
}

std::string BedSize::run() const {
  return fmt::format("periodic = [true, true]\ndomain_x = [0, {:.17g}]\ndomain_y = [0, {:.17g}]\n", length, width);
}

namespace {

constexpr auto kKeptName = "poured_"; // prefix of the files of pourBed(); the hash of the scene follows

/// Empty if the file is missing or incomplete, because another call may be removing it.
std::optional<BedGrains> keptSample(const std::filesystem::path& file, std::int64_t number) {
  if (file.empty() || !std::filesystem::exists(file)) return {};
  try {
    BedGrains grains = readBed(file);
    if (static_cast<std::int64_t>(grains.size()) == number) return grains;
  } catch (const base::InputError&) {}
  return {};
}

} // namespace

BedGrains pourBed(const Soil& soil, const BedSize& size, const std::string& below, std::int64_t seed,
                  const std::filesystem::path& folder, const base::Exec& exec, const std::filesystem::path& kept) {
  const double d = soil.grains.diameter(), r = soil.grains.radius, area = size.length * size.width;
  const auto number = static_cast<std::int64_t>(std::llround(kPoured * area * size.depth / soil.meanVolume()));
  // No grain of the cloud crosses a periodic boundary; this leaves a gap of one grain diameter.
  const double largest = 2 * r * (1 + soil.spread);
  const double cloud =
      static_cast<double>(number) * soil.meanVolume() / (kCloud * (size.length - largest) * (size.width - largest));
  const std::string text =
      soil.prepared().scene(1, seed, soil.preparationFriction, {0, 0, -9.81}, size.run()) + below +
      fmt::format("[[grains]]\nform = \"random\"\nlow = [0, 0, {0:.17g}]\nhigh = [{1:.17g}, {2:.17g}, {3:.17g}]\n"
                  "number = {4}\nradius = {5:.17g}\nradius_to = {6:.17g}\nmaterial = \"grain\"\n",
                  d, size.length, size.width, d + cloud, number, r * (1 - soil.spread), r * (1 + soil.spread));
  const std::filesystem::path file = kept.empty() ? kept : kept / (kKeptName + support::hashOfText(text) + ".txt");
  if (std::optional<BedGrains> sample = keptSample(file, number)) return std::move(*sample);
  coupling::Simulation simulation(setup::simulationSetup(setup::parseScene(text, folder / "pour.toml")), exec,
                                  [](double, double) {});
  const double limit = kSettlingPatience * std::max(1.0, std::sqrt(size.depth / 0.25));
  const terrain::Grains& grains = *simulation.ground().grains;
  const terrain::GrainModel& model = grains.model();
  const double unit = model.mass * norm(model.gravity) * model.radius * static_cast<double>(grains.count());
  if (const double left = kAgitation * comeToRest(simulation, kAgitation * unit, limit); !(left <= kLastAgitation))
    failRestless(seed, limit, left);
  if (file.empty()) return grainsOf(simulation, size);
  // Read the grains from the file, as the next call will do. Concurrent calls write identical files.
  const std::filesystem::path own = folder / file.filename();
  writeBed(own, grainsOf(simulation, size));
  BedGrains made = readBed(own);
  std::error_code error; // ignored: without the file, the next call pours again
  std::filesystem::rename(own, file, error);
  return made;
}

void removePoured(const std::filesystem::path& kept) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(kept))
    if (entry.path().filename().string().rfind(kKeptName, 0) == 0) files.push_back(entry.path());
  for (const std::filesystem::path& file : files) std::filesystem::remove(file);
}

double roughFloorDepth(const Soil& soil) { return (1 + soil.spread + kFloorScatter) * soil.grains.diameter(); }

BedGrains roughFloor(const Soil& soil, const BedSize& size, std::int64_t seed) {
  constexpr std::uint64_t kPurpose = base::purpose("study.rough_floor");
  const double d = soil.grains.diameter();
  // A spacing of 0.9 diameters avoids holes.
  const auto nx = static_cast<std::int64_t>(std::ceil(size.length / (0.9 * d)));
  const auto ny = static_cast<std::int64_t>(std::ceil(size.width / (0.9 * d)));
  BedGrains floor;
  for (std::int64_t k = 0; k < nx * ny; ++k) {
    const auto random = [&](std::uint64_t n) {
      return 2 * base::uniform(static_cast<std::uint64_t>(seed), kPurpose, static_cast<std::uint64_t>(k), n) - 1;
    };
    const double radius = soil.grains.radius * (1 + soil.spread * random(0));
    const double x = (static_cast<double>(k % nx) + 0.5 + 0.3 * random(1)) * size.length / static_cast<double>(nx);
    const double y = (static_cast<double>(k / nx) + 0.5 + 0.3 * random(2)) * size.width / static_cast<double>(ny);
    floor.push_back({{x, y, -radius + kFloorScatter * d * random(3)}, radius});
  }
  return floor;
}

void writeBed(const std::filesystem::path& file, const BedGrains& grains, const std::string& more) {
  std::string text = "# x, y, z, r [m]" + more + "\n";
  for (const BedGrain& g : grains)
    text += fmt::format("{:.12g} {:.12g} {:.12g} {:.9g}\n", g.position.x, g.position.y, g.position.z, g.radius);
  support::replaceTextFile(file, text);
}

BedGrains readBed(const std::filesystem::path& file) {
  BedGrains grains;
  for (const scene::Grain& g : scene::readGrainFile(file.string(), {})) grains.push_back({g.position, g.radius});
  return grains;
}

BedGrains grainsOf(const coupling::Simulation& simulation, const BedSize& size) {
  const terrain::Grains& grains = *simulation.ground().grains;
  const terrain::GrainSnapshot s = grains.snapshot();
  BedGrains all;
  for (std::size_t g = 0; g < s.position.size(); ++g) {
    Vec3d p = s.position[g];
    p.x = wrapped(p.x, size.length), p.y = wrapped(p.y, size.width);
    all.push_back({p, s.radius.empty() ? grains.model().radius : std::fabs(static_cast<double>(s.radius[g]))});
  }
  return all;
}

void failRestless(std::int64_t seed, double limit, double energy) {
  throw base::SimulationError(
      fmt::format(
          "the bed with seed {} did not come to rest within {:.1f} s: the mean kinetic energy per grain is still "
          "{:.2g} m g r (mass x gravity x radius); reduce the rolling friction, or raise the preparation friction or "
          "the steps per contact",
          seed, limit, energy),
      base::Cause::unsettledBed);
}

double comeToRest(coupling::Simulation& simulation, double energy, double limit) {
  terrain::Grains& grains = *simulation.ground().grains;
  const auto every = std::max<std::int64_t>(1, std::llround(kLook / simulation.timeStep()));
  const double start = simulation.time();
  std::array<double, kCalmLooks> last;
  last.fill(INFINITY);
  const auto most = [&last] { return *std::max_element(last.begin(), last.end()); };
  for (std::size_t look = 0; !(most() < 1) && simulation.time() - start < limit; ++look) {
    jobs::stopStudyOnRequest();
    for (std::int64_t left = every; left > 0;) left -= simulation.advance(left);
    const terrain::GrainLedger ledger = grains.ledger();
    last[look % kCalmLooks] = (ledger.kinetic + ledger.rotational) / energy;
  }
  return most();
}

double solidFraction(const BedGrains& grains, const BedSize& size, double low, double high) {
  double volume = 0;
  for (const BedGrain& g : grains)
    volume +=
        base::sphereVolumeBelow(high, g.position.z, g.radius) - base::sphereVolumeBelow(low, g.position.z, g.radius);
  return volume / (size.length * size.width * (high - low));
}

double surfaceHeight(const BedGrains& grains, const BedSize& size, double diameter) {
  const auto nx = std::max<std::int64_t>(1, static_cast<std::int64_t>(size.length / (2 * diameter)));
  const auto ny = std::max<std::int64_t>(1, static_cast<std::int64_t>(size.width / (2 * diameter)));
  std::vector<double> top(static_cast<std::size_t>(nx * ny), -1e300);
  for (const BedGrain& g : grains) {
    const auto x = std::min(nx - 1, static_cast<std::int64_t>(g.position.x / size.length * static_cast<double>(nx)));
    const auto y = std::min(ny - 1, static_cast<std::int64_t>(g.position.y / size.width * static_cast<double>(ny)));
    double& t = top[static_cast<std::size_t>(y * nx + x)];
    t = std::max(t, g.position.z + g.radius);
  }
  double sum = 0;
  int columns = 0;
  for (const double t : top)
    if (t > -1e299) sum += t, ++columns;
  return sum / std::max(1, columns);
}

} // namespace grouser::virtual_tests
