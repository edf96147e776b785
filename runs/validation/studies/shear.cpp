// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/shear.hpp"

#include "base/counted.hpp"
#include "base/enum_words.hpp"
#include "base/math.hpp"
#include "base/sphere.hpp"
#include "coupling/simulation.hpp"
#include "runs/output/plots.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/support/line_fit.hpp"
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

constexpr double kRest = 0.9;           // [s] time for settling and compression before shearing
constexpr double kLidMass = 0.05;       // [kg]
constexpr double kRow = 0.01;           // [s] time between rows
constexpr double kPlateau = 0.5;        // fraction of the travel after which the strength counts as residual
constexpr double kLatticeSpacing = 2.1; // initial lattice spacing [largest radii]
constexpr double kSampleSolid = 0.6;    // expected solid fraction of the sample; determines only its depth

/// Walls of the shear box; the lower half is fixed, and the upper half moves.
enum class Side { floor, lowerLeft, lowerRight, upperLeft, upperRight, lid };

constexpr bool rests(Side side) { return side == Side::floor || side == Side::lowerLeft || side == Side::lowerRight; }

} // namespace
} // namespace grouser::studies

template <> struct grouser::base::EnumWords<grouser::studies::Side> {
  using E = studies::Side;
  static constexpr EnumWord<E> list[] = {
      {E::floor, "floor"},          {E::lowerLeft, "lower_left"},   {E::lowerRight, "lower_right"},
      {E::upperLeft, "upper_left"}, {E::upperRight, "upper_right"}, {E::lid, "lid"}};
};

namespace grouser::studies {
namespace {

std::string shearScene(const virtual_tests::SampleGrains& material, const ShearBox& box, double stress,
                       std::int64_t seed) {
  const double d = material.diameter(), l = box.length * d, w = box.width * d, depth = box.depth * d;
  const double wall = box.travel * l + 2 * d; // thick enough to cover the gap that opens between the halves
  const double largest = material.radius * (1 + box.spread), cell = kLatticeSpacing * largest;
  const double loose = depth * kSampleSolid * cell * cell * cell / (base::kPi / 6 * d * d * d);
  const double top = loose - 0.5 * depth + d;
  std::string text = fmt::format(
      "version = 1\n[run]\nduration = {:.17g}\nseed = {}\ncontact = \"{}\"\nperiodic = [false, "
      "true]\ndomain_y = [0, {:.17g}]\n{}"
      "[[grains]]\nform = \"lattice\"\nlow = [{:.17g}, 0, {:.17g}]\nhigh = [{:.17g}, {:.17g}, {:.17g}]\n"
      "radius = {:.17g}\nradius_to = {:.17g}\nspacing = {}\njitter = 1.0\nmaterial = \"grain\"\n",
      kRest + box.travel * l / box.speed, seed, base::wordOf(box.contact), w, material.toml("grain"), -0.5 * l,
      -0.5 * depth, 0.5 * l, w, top - d, material.radius * (1 - box.spread), largest, kLatticeSpacing);
  const auto put = [&](Side side, double x, double z, double sizeX, double sizeZ, const std::string& more) {
    text += fmt::format("[[box]]\nname = \"{}\"\nmaterial = \"grain\"\nposition = [{:.17g}, {:.17g}, {:.17g}]\n"
                        "size = [{:.17g}, {:.17g}, {:.17g}]\n{}",
                        base::wordOf(side), x, 0.5 * w, z, sizeX, w + 4 * d, sizeZ, more);
  };
  const std::string drawn = fmt::format("velocity = [{:.17g}, 0, 0]\nstart = {:.17g}\n", box.speed, kRest);
  const double high = top + 2 * d;
  put(Side::floor, 0, -0.5 * depth - 0.5 * wall, l + 2 * wall, wall, "");
  put(Side::lowerLeft, -0.5 * (l + wall), -0.25 * depth, wall, 0.5 * depth, "");
  put(Side::lowerRight, 0.5 * (l + wall), -0.25 * depth, wall, 0.5 * depth, "");
  put(Side::upperLeft, -0.5 * (l + wall), 0.5 * high, wall, high, drawn);
  put(Side::upperRight, 0.5 * (l + wall), 0.5 * high, wall, high, drawn);
  put(Side::lid, 0, top + 0.5 * d, l, d,
      drawn + fmt::format("free = \"z\"\nmass = {}\nload = {:.17g}\nload_ramp = {:.17g}\n", kLidMass, -stress * l * w,
                          0.5 * kRest));
  return text;
}

/// Angle with the tangent `t` [deg].
double degrees(double t) { return std::atan(t) * 180 / base::kPi; }

} // namespace

std::vector<ShearRow> shearSample(const virtual_tests::SampleGrains& material, const ShearBox& box, double stress,
                                  std::int64_t seed) {
  const scene::Scene scene = setup::parseScene(shearScene(material, box, stress, seed), "shear.toml");
  coupling::Simulation simulation(setup::simulationSetup(scene), base::cpuExec(1), [](double, double) {});
  const auto steps = [&](double seconds) { return std::int64_t{std::llround(seconds / simulation.timeStep())}; };
  const std::int64_t every = std::max<std::int64_t>(1, steps(kRow)), all = steps(scene.run.duration);
  std::vector<ShearRow> rows;
  for (std::int64_t step = 1; step <= all; ++step) {
    simulation.step();
    if (step % every != 0) continue;
    jobs::stopStudyOnRequest();
    simulation.checkEnergy();
    const coupling::Surfaces& surfaces = *simulation.surfaces();
    ShearRow row;
    row.displacement = std::max(0.0, simulation.time() - kRest) * box.speed;
    double weightBelow = 0;
    const auto snapshot = simulation.ground().grains->snapshot();
    for (std::size_t g = 0; g < snapshot.position.size(); ++g) {
      const double r = static_cast<double>(snapshot.radius[g]);
      if (snapshot.position[g].z < 0) weightBelow += base::sphereMass(material.density, r) * norm(scene.run.gravity);
    }
    row.normal = -weightBelow;
    for (std::size_t i = 0; i < surfaces.count(); ++i) {
      const Side side = base::valueOf<Side>(surfaces.surface(i).name).value();
      const coupling::Surfaces::Observation o = surfaces.observe(i, step);
      if (rests(side))
        row.normal -= o.force.z;
      else
        row.shear -= o.force.x;
      if (side == Side::lid) row.lid = o.position.z - 0.5 * material.diameter();
    }
    simulation.restartMeans();
    if (simulation.time() > kRest) rows.push_back(row);
  }
  return rows;
}

void studyShearCommand(const ShearCommand& command) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const auto folder = jobs::beginStudy("shear", command.place);
  const support::StopSignals signals;
  ShearBox box = command.box;
  if (command.place.quick) box.length = 10, box.depth = 8, box.speed = 0.05;
  const int seeds = command.seeds;
  const std::vector<double>& stresses = command.stresses;
  virtual_tests::SampleGrains material;
  material.friction = command.friction, material.rollingFriction = command.rollingFriction;
  fmt::print("          spheres of 10 mm diameter (d) +- {:.0f} %, 1e5 N/m, restitution 0.5, friction {}, rolling "
             "friction {};\n"
             "          box {} d long, {} d between periodic boundaries, {} d deep; sheared at {} m/s over a distance "
             "of {} of "
             "its length;\n          {} contacts; {} seeds, +- standard error; one thread\n",
             100 * box.spread, material.friction, material.rollingFriction, box.length, box.width, box.depth, box.speed,
             box.travel, base::wordOf(box.contact), seeds);
  support::Progress progress("shearing");
  std::string csv = "stress [Pa],seed,displacement [m],shear force [N],normal force [N],lid [m]\n";
  std::string table = fmt::format("\n  {:>10} {:>18} {:>18} {:>22} {:>20}\n", "load [Pa]", "peak T/N", "residual T/N",
                                  "residual angle [deg]", "rise of the lid [d]");
  const double area = box.length * box.width * material.diameter() * material.diameter();
  std::vector<double> sigma, tau, angles;
  int done = 0;
  const auto both = [](const std::vector<double>& values, int digits) {
    const jobs::MeanError m = jobs::meanOf(values);
    return fmt::format("{:.{}f} +- {:.{}f}", m.mean, digits, m.error, digits);
  };
  for (const double stress : stresses) {
    std::vector<double> peak, residual, angle, rise;
    for (int seed = 1; seed <= seeds; ++seed) {
      progress.update(static_cast<double>(done++) / static_cast<double>(stresses.size()) / seeds,
                      fmt::format("{:g} Pa, seed {}", stress, seed));
      const std::vector<ShearRow> rows = shearSample(material, box, stress, seed);
      double most = 0, shear = 0, normal = 0;
      const double last = rows.back().displacement;
      for (std::size_t k = 0; k < rows.size(); ++k) {
        const ShearRow& r = rows[k];
        csv += fmt::format("{:g},{},{:.6g},{:.6g},{:.6g},{:.6g}\n", stress, seed, r.displacement, r.shear, r.normal,
                           r.lid);
        // The peak is the maximum of means over five rows, which reduces noise.
        if (k >= 4) {
          double t = 0, n = 0;
          for (std::size_t j = k - 4; j <= k; ++j) t += rows[j].shear, n += rows[j].normal;
          most = std::max(most, t / n);
        }
        if (r.displacement > kPlateau * last) shear += r.shear, normal += r.normal;
      }
      const double count = static_cast<double>(
          std::count_if(rows.begin(), rows.end(), [&](const ShearRow& r) { return r.displacement > kPlateau * last; }));
      peak.push_back(most), residual.push_back(shear / normal), angle.push_back(degrees(shear / normal));
      rise.push_back((rows.back().lid - rows.front().lid) / material.diameter());
      sigma.push_back(normal / count / area), tau.push_back(shear / count / area), angles.push_back(angle.back());
    }
    table += fmt::format("  {:>10g} {:>18} {:>18} {:>22} {:>20}\n", stress, both(peak, 3), both(residual, 3),
                         both(angle, 1), both(rise, 2));
  }
  progress.finish(base::counted(done, "sample"));
  fmt::print("{}\n  friction angle of the bed: {} deg\n", table, both(angles, 1));
  if (const support::LineFit line = support::fitLine(sigma, tau); line.hasError() && stresses.size() > 1)
    fmt::print("  linear fit to all samples: slope {} (95 %), i.e. {:.1f} deg; cohesion {:.0f} +- {:.0f} Pa (95 %)\n",
               line.slopeText(), degrees(line.slope), line.intercept, line.interceptEstimate().halfWidth);
  fmt::print("  T: shear force on the upper half, N: normal force between the halves; residual: mean over the second "
             "half of the travel\n");
  support::writeTextFile(folder / "shear.csv", csv, "--out");
  jobs::writeStudyOrigin(folder, "shear", std::chrono::duration<double>(Clock::now() - begin).count(),
                         {{"friction", material.friction},
                          {"rolling_friction", material.rollingFriction},
                          {"seeds", seeds},
                          {"length_in_diameters", box.length},
                          {"speed_m_s", box.speed},
                          {"contact", base::wordOf(box.contact)},
                          {"threads", 1}});
  output::drawPicture("study_shear.py", {folder / "shear.csv"}, folder / "shear.png");
  fmt::print("tables    {}\n", folder.string());
}

} // namespace grouser::studies
