// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/packing.hpp"

#include "base/counted.hpp"
#include "base/math.hpp"
#include "base/sphere.hpp"
#include "runs/output/plots.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace grouser::studies {

namespace {

constexpr double kRestEnergy = 1e-7;         // kinetic energy per grain / (m g d) below which grains are at rest [-]
constexpr double kPatience = 4.0;            // [s] maximum settling time
constexpr double kOffFloor = 4, kOffTop = 3; // [d] excluded layers: ordered grains on the floor, loose top

/// Volume that two spheres with this overlap have in common.
double sharedVolume(double overlap, double r) {
  const double half = 0.5 * overlap; // height of each cap
  return 2 * base::kPi * half * half * (3 * r - half) / 3;
}

} // namespace

Packing pourPacking(const virtual_tests::SampleGrains& material, int grains, double width, std::int64_t seed) {
  const double d = material.diameter(), side = width * d;
  const double height = static_cast<double>(grains) * base::kPi / 6 * d * d * d * 7 / (side * side);
  // The random fill places whole grains inside the box, so that one diameter stays empty at the periodic boundaries.
  virtual_tests::Sample sample = virtual_tests::buildSample(
      fmt::format(
          "version = 1\n[run]\nduration = 1\nperiodic = [true, true]\ndomain_x = [0, {0}]\ndomain_y = [0, {0}]\n"
          "seed = {1}\n{2}[[plane]]\nmaterial = \"grain\"\n[[grains]]\nform = \"random\"\nlow = [0, 0, 0]\n"
          "high = [{0}, {0}, {3:.6g}]\nnumber = {4}\nradius = {5:.17g}\nmaterial = \"grain\"\n",
          side, seed, material.toml("grain"), height, grains, material.radius),
      base::cpuExec(1));
  Packing packing;
  packing.rest = virtual_tests::bringToRest(sample, kRestEnergy, kPatience);

  const terrain::GrainState state = sample.grains().state();
  std::vector<double> z;
  double mean = 0;
  for (const base::Position& p : state.position) {
    z.push_back(sample.grains().scale().toMetres(p).z);
    mean += z.back() / static_cast<double>(state.rows());
  }
  const double low = kOffFloor * d, high = 2 * mean - kOffTop * d, r = material.radius;
  const auto inside = [&](std::size_t g) { return z[g] >= low && z[g] <= high; };

  double volume = 0, shared = 0, contacts = 0, overlaps = 0;
  std::size_t c = 0;
  std::vector<std::vector<std::size_t>> touching(state.rows());
  const base::Period& period = sample.grains().system().constants.period;
  for (std::size_t g = 0; g < state.rows(); ++g) {
    volume += base::sphereVolumeBelow(high, z[g], r) - base::sphereVolumeBelow(low, z[g], r);
    for (const std::size_t end = c + state.contacts[g]; c < end; ++c) {
      const std::size_t other = state.neighbour[c];
      touching[g].push_back(other);
      if (!inside(g)) continue;
      const double distance =
          norm(period.apart(state.position[g], state.position[other]).as<double>()) * sample.grains().scale().unit;
      overlaps += d - distance, ++contacts;
      shared += 0.5 * sharedVolume(d - distance, r); // the loop visits each contact twice
    }
  }
  packing.solidFraction = (volume - shared) / (side * side * (high - low));
  double count = 0;
  for (std::size_t g = 0; g < state.rows(); ++g) count += inside(g);
  packing.coordination = contacts / count;
  packing.overlap = contacts > 0 ? overlaps / contacts / d : 0;

  // The removal of a rattler may turn its neighbours into rattlers.
  const std::size_t least = material.friction > 0 ? 2 : 4;
  std::vector<bool> held(state.rows(), true);
  const auto holding = [&](std::size_t g) {
    return static_cast<std::size_t>(
        std::count_if(touching[g].begin(), touching[g].end(), [&](std::size_t other) { return held[other]; }));
  };
  for (bool again = true; again;) {
    again = false;
    for (std::size_t g = 0; g < state.rows(); ++g)
      if (inside(g) && held[g] && holding(g) < least) held[g] = false, again = true;
  }
  double kept = 0, keptContacts = 0;
  for (std::size_t g = 0; g < state.rows(); ++g)
    if (inside(g) && held[g]) ++kept, keptContacts += static_cast<double>(holding(g));
  packing.coordinationWithoutRattlers = keptContacts / kept;
  packing.rattlers = 1 - kept / count;
  return packing;
}

void studyPackingCommand(const PackingCommand& command) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const auto folder = jobs::beginStudy("packing", command.place);
  const support::StopSignals signals;
  const int grains = command.grains, seeds = command.seeds;
  const double width = command.width;
  const std::vector<double> frictions =
      command.place.quick ? std::vector<double>{0, 0.5} : std::vector<double>{0, 0.05, 0.1, 0.2, 0.5, 1.0};
  fmt::print(
      "          {} spheres of 10 mm diameter (d), 1e5 N/m, restitution 0.5, poured between periodic boundaries {} d "
      "apart; "
      "{} seeds, +- standard error\n          measured from {} d above the floor to {} d below the top; one thread\n",
      grains, width, seeds, kOffFloor, kOffTop);
  support::Progress progress("pouring");
  std::string csv = "friction [-],seed,solid fraction [-],coordination [-],coordination without rattlers [-],"
                    "rattlers [-],overlap [d],rest after [s]\n";
  std::string table = fmt::format("\n  {:>8} {:>18} {:>16} {:>18} {:>9} {:>10}\n", "friction", "solid fraction",
                                  "coordination", "without rattlers", "rattlers", "overlap/d");
  int done = 0, restless = 0;
  for (const double friction : frictions) {
    std::vector<double> fraction, all, held, rattlers, overlap;
    for (int seed = 1; seed <= seeds; ++seed) {
      progress.update(static_cast<double>(done++) / static_cast<double>(frictions.size()) / seeds,
                      fmt::format("friction {:g}, seed {}", friction, seed));
      virtual_tests::SampleGrains material;
      material.friction = friction;
      const Packing p = pourPacking(material, grains, width, seed);
      csv += fmt::format("{:g},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.4g},{:.3f}\n", friction, seed, p.solidFraction,
                         p.coordination, p.coordinationWithoutRattlers, p.rattlers, p.overlap, p.rest);
      restless += p.rest < 0;
      fraction.push_back(p.solidFraction), all.push_back(p.coordination), rattlers.push_back(p.rattlers);
      held.push_back(p.coordinationWithoutRattlers), overlap.push_back(p.overlap);
    }
    const auto both = [](const std::vector<double>& values, int digits) {
      const jobs::MeanError m = jobs::meanOf(values);
      return fmt::format("{:.{}f} +- {:.{}f}", m.mean, digits, m.error, digits);
    };
    table += fmt::format("  {:>8g} {:>18} {:>16} {:>18} {:>9.3f} {:>10.2g}\n", friction, both(fraction, 4),
                         both(all, 2), both(held, 2), jobs::meanOf(rattlers).mean, jobs::meanOf(overlap).mean);
  }
  progress.finish(base::counted(done, "sample"));
  fmt::print("{}\n  literature: without friction 0.634 to 0.64 (random close packing) and 6 contacts (isostatic); "
             "poured with\n"
             "  friction 0.58 to 0.62; loosest packings about 0.55, and 4 contacts at infinite friction\n",
             table);
  if (restless > 0)
    fmt::print("  {} of {} samples did not come to rest within {} s (their time is negative in packing.csv)\n",
               restless, done, kPatience);
  support::writeTextFile(folder / "packing.csv", csv, "--out");
  jobs::writeStudyOrigin(folder, "packing", std::chrono::duration<double>(Clock::now() - begin).count(),
                         {{"grains", grains}, {"seeds", seeds}, {"width_in_diameters", width}, {"threads", 1}});
  output::drawPicture("study_packing.py", {folder / "packing.csv"}, folder / "packing.png");
  fmt::print("tables    {}\n", folder.string());
}

} // namespace grouser::studies
