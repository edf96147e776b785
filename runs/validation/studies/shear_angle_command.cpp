// SPDX-License-Identifier: BSD-3-Clause
// `grouser study shear-angle`: samples, tables and files.
#include "base/counted.hpp"
#include "base/math.hpp"
#include "runs/output/plots.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/text_file.hpp"
#include "runs/validation/studies/shear_angle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::studies {

namespace {

constexpr double kBar = 1;         // [deg] target half width of the interval of the angle
constexpr double kInertial = 1e-3; // [-] maximum inertial number of a quasi-static test

double inDegrees(double radians) { return radians * 180 / base::kPi; }

struct Samples {
  virtual_tests::Soil soil;
  virtual_tests::ShearCell cell;
  std::vector<double> stresses, rollingFrictions;
  int seeds;
};

Samples samplesOf(const ShearAngleCommand& command) {
  Samples s;
  s.soil.grains.friction = command.friction, s.soil.grains.restitution = 0.3;
  s.soil.preparationFriction = command.preparationFriction;
  s.stresses = command.stresses, s.rollingFrictions = command.rollingFrictions, s.seeds = command.seeds;
  if (command.place.quick) {
    s.soil.grains.stiffness = 1e4;
    s.cell.length = 8, s.cell.width = 6, s.cell.depth = 6, s.cell.inertialNumber = 2e-2, s.cell.strain = 0.15;
    s.cell.rows = 30;
  }
  return s;
}

std::string nameOf(double rolling, double stress, int seed) {
  return fmt::format("rolling{:g}_stress{:g}_seed{}", rolling, stress, seed);
}

nlohmann::ordered_json recipeOf(const Samples& s) {
  return {{"study", "shear-angle"},
          {"friction", s.soil.grains.friction},
          {"preparation_friction", s.soil.preparationFriction},
          {"radius_m", s.soil.grains.radius},
          {"spread", s.soil.spread},
          {"stiffness_N_m", s.soil.grains.stiffness},
          {"length_d", s.cell.length},
          {"width_d", s.cell.width},
          {"depth_d", s.cell.depth},
          {"strain", s.cell.strain},
          {"inertial_number", s.cell.inertialNumber}};
}

void runAll(const Samples& s, jobs::Pieces& pieces, const jobs::PieceOptions& options) {
  const base::Exec exec = support::chooseDevice(support::deviceChoice(options.device), options.threads, nullptr);
  support::Progress progress("shearing");
  const double all = static_cast<double>(s.rollingFrictions.size() * s.stresses.size()) * s.seeds;
  int done = 0;
  for (int seed = 1; seed <= s.seeds; ++seed)
    for (const double rolling : s.rollingFrictions)
      for (const double stress : s.stresses) {
        const std::string name = nameOf(rolling, stress, seed);
        progress.update(done++ / all, name);
        if (!pieces.due(name)) continue;
        const auto folder = pieces.folder() / ("cell_" + name);
        std::filesystem::create_directories(folder);
        virtual_tests::Soil soil = s.soil;
        soil.grains.rollingFriction = rolling;
        pieces.keep(name, virtual_tests::shearCell(soil, s.cell, stress, seed, folder, exec));
        std::filesystem::remove_all(folder);
      }
  progress.finish(fmt::format("{} of {} samples finished", all - pieces.left(), all));
}

std::string stressTable(const Samples& s, const jobs::Pieces& pieces, double rolling,
                        std::vector<std::vector<virtual_tests::ShearStrength>>& runs, std::string& csv) {
  std::string text =
      fmt::format("\nrolling friction {:g}\n  {:>10} {:>16} {:>16} {:>16} {:>14} {:>14} {:>9}\n", rolling, "load [Pa]",
                  "peak tau/sigma", "residual", "core angle [deg]", "porosity", "final", "I");
  for (int seed = 1; seed <= s.seeds; ++seed) {
    std::vector<virtual_tests::ShearStrength> row;
    for (const double stress : s.stresses)
      if (const std::string name = nameOf(rolling, stress, seed); pieces.has(name))
        row.push_back(virtual_tests::shearStrength(pieces.read(name)));
    if (row.size() == s.stresses.size()) runs.push_back(row);
  }
  for (std::size_t k = 0; k < s.stresses.size(); ++k) {
    const auto over = [&](const auto& value) {
      std::vector<double> values;
      for (const auto& seed : runs) values.push_back(value(seed[k]));
      return jobs::interval95(values);
    };
    const support::Estimate peak = over([](const virtual_tests::ShearStrength& r) { return r.peak; });
    const support::Estimate residual = over([](const virtual_tests::ShearStrength& r) { return r.residual; });
    const support::Estimate core = over([](const virtual_tests::ShearStrength& r) { return inDegrees(r.mohrCoulomb); });
    const support::Estimate before = over([](const virtual_tests::ShearStrength& r) { return r.porosityBefore; });
    const support::Estimate after = over([](const virtual_tests::ShearStrength& r) { return r.porosityAfter; });
    const support::Estimate inertial = over([](const virtual_tests::ShearStrength& r) { return r.inertialNumber; });
    text += fmt::format("  {:>10g} {:>16} {:>16} {:>16} {:>14} {:>14} {:>9.1e}\n", s.stresses[k],
                        jobs::plusMinus(peak, 3), jobs::plusMinus(residual, 3), jobs::plusMinus(core, 1),
                        jobs::plusMinus(before, 3), jobs::plusMinus(after, 3), inertial.value);
    csv += fmt::format("{:g},{:g},{},{:.5g},{:.3g},{:.5g},{:.3g},{:.5g},{:.3g},{:.5g},{:.3g},{:.5g},{:.3g},{:.3g}\n",
                       rolling, s.stresses[k], runs.size(), peak.value, peak.halfWidth, residual.value,
                       residual.halfWidth, core.value, core.halfWidth, before.value, before.halfWidth, after.value,
                       after.halfWidth, inertial.value);
    if (inertial.value > kInertial)
      text += "             WARNING: the test is not quasi-static (inertial number I > 1e-3); reduce the shear speed\n";
  }
  return text;
}

} // namespace

ShearAngle shearAngle(const std::vector<std::vector<virtual_tests::ShearStrength>>& runs) {
  std::vector<double> residual, peak, core, cohesion;
  for (const std::vector<virtual_tests::ShearStrength>& seed : runs) {
    std::vector<double> sigma, tau, high;
    double angle = 0;
    for (const virtual_tests::ShearStrength& r : seed) {
      sigma.push_back(r.normal), tau.push_back(r.shear), high.push_back(r.peak * r.normal);
      angle += r.mohrCoulomb / static_cast<double>(seed.size());
    }
    core.push_back(inDegrees(angle));
    const support::LineFit line = support::fitLine(sigma, tau), peaks = support::fitLine(sigma, high);
    const bool through = line.points < 2; // a single stress: the line passes through the origin
    residual.push_back(inDegrees(std::atan(through ? tau.front() / sigma.front() : line.slope)));
    peak.push_back(inDegrees(std::atan(through ? high.front() / sigma.front() : peaks.slope)));
    cohesion.push_back(through ? 0 : line.intercept);
  }
  return {jobs::interval95(residual), jobs::interval95(peak), jobs::interval95(core), jobs::interval95(cohesion)};
}

void studyShearAngleCommand(const ShearAngleCommand& command) {
  const Samples s = samplesOf(command);
  jobs::Pieces pieces("shear-angle", command.place, command.pieces, recipeOf(s));
  const support::StopSignals signals;
  const auto begin = std::chrono::steady_clock::now();
  fmt::print("          spheres of {:g} mm diameter (d) +- {:g} %, {:g} N/m, friction {:g}, {:g} during pouring; {:g} "
             "x {:g} d "
             "between periodic boundaries, {:g} d deep; {} seeds, +-: 95 % interval\n",
             2e3 * s.soil.grains.radius, 100 * s.soil.spread, s.soil.grains.stiffness, s.soil.grains.friction,
             s.soil.preparationFriction, s.cell.length, s.cell.width, s.cell.depth, s.seeds);
  runAll(s, pieces, command.pieces);
  if (!pieces.whole()) return;
  std::string csv =
      "rolling friction [-],load [Pa],seeds,peak [-],half width of peak,residual [-],half width of residual,"
      "core angle [deg],half width of core angle,porosity [-],half width of porosity,porosity at the end [-],"
      "half width at the end,inertial number [-]\n";
  std::string angles = "rolling friction [-],seeds,angle [deg],half width of angle,peak angle [deg],half width of peak "
                       "angle,core angle [deg],half width of core angle,cohesion [Pa],half width of cohesion\n";
  for (const double rolling : s.rollingFrictions) {
    std::vector<std::vector<virtual_tests::ShearStrength>> runs;
    const std::string text = stressTable(s, pieces, rolling, runs, csv);
    if (runs.empty()) continue;
    const ShearAngle a = shearAngle(runs);
    fmt::print("{}  line fit: residual angle {} deg, peak angle {} deg; cohesion {} Pa; core angle {} deg\n"
               "  half width of the residual angle {} {:g} deg: {}\n",
               text, jobs::plusMinus(a.angle, 2), jobs::plusMinus(a.peakAngle, 2), jobs::plusMinus(a.cohesion, 0),
               jobs::plusMinus(a.mohrCoulomb, 2), a.angle.halfWidth < kBar ? "below" : "not below", kBar,
               a.angle.halfWidth < kBar ? "conclusive" : "inconclusive");
    angles += fmt::format("{:g},{},{:.4g},{:.3g},{:.4g},{:.3g},{:.4g},{:.3g},{:.4g},{:.3g}\n", rolling, runs.size(),
                          a.angle.value, a.angle.halfWidth, a.peakAngle.value, a.peakAngle.halfWidth,
                          a.mohrCoulomb.value, a.mohrCoulomb.halfWidth, a.cohesion.value, a.cohesion.halfWidth);
  }
  fmt::print(
      "  tau, sigma: mean of both plates; residual: mean over the second half of the strain; core angle: sine = "
      "(s1 - s3)/(s1 + s3)\n  of the stress in the shear plane, from contacts more than two grains away from the "
      "plates; it is the Mohr-Coulomb angle for bearing theories\n");
  if (pieces.left() > 0)
    fmt::print("{} missing; repeat the command with --resume\n", base::counted(pieces.left(), "run is", "runs are"));
  support::writeTextFile(pieces.folder() / "shear_angle.csv", csv, "--out");
  support::writeTextFile(pieces.folder() / "angles.csv", angles, "--out");
  nlohmann::ordered_json more = recipeOf(s);
  more["seeds"] = s.seeds;
  jobs::writeStudyOrigin(pieces.folder(), "shear-angle",
                         std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), more);
  output::drawPicture("study_shear_angle.py", {pieces.folder() / "shear_angle.csv", pieces.folder() / "runs"},
                      pieces.folder() / "shear_angle.png");
  fmt::print("tables    {}\n", pieces.folder().string());
}

} // namespace grouser::studies
