// SPDX-License-Identifier: BSD-3-Clause
// `grouser study plates`: which plates on which beds, tables and files.
#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/output/plots.hpp"
#include "runs/studies/plates.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::studies {

namespace {

constexpr double kExtentBar = 0.05, kBearingBar = 0.25; // [-]
constexpr double kGravity = 9.81;
constexpr int kSlices = 4;
constexpr double kLatticeSinkage = 0.2; // [breadths] a bed of five layers is no deeper

double radians(double degrees) { return degrees * base::kPi / 180; }

Soil soilOf(const PlatesCommand& c) {
  Soil soil;
  soil.grains.friction = c.friction, soil.grains.rollingFriction = c.rollingFriction;
  soil.grains.restitution = 0.3, soil.preparationFriction = c.preparationFriction;
  if (c.place.quick) soil.grains.stiffness = 2e4;
  return soil;
}

/// A quick pass: small plates on small beds.
PlatesCommand smallOf(PlatesCommand c) {
  if (!c.place.quick) return c;
  c.breadth = 4, c.thickness = 5, c.stripBin = 3, c.stripDepth = 1.5, c.circularBin = 3, c.circularDepth = 1;
  c.sinkage = 0.2, c.inertialNumber = 2e-2, c.seeds = 2;
  if (c.cases.empty()) c.cases = {"base", "old", "circular"};
  return c;
}

nlohmann::ordered_json recipeOf(const PlatesCommand& c, const Soil& soil) {
  return {{"study", "plates"},
          {"friction", soil.grains.friction},
          {"rolling_friction", soil.grains.rollingFriction},
          {"preparation_friction", soil.preparationFriction},
          {"radius_m", soil.grains.radius},
          {"spread", soil.spread},
          {"stiffness_N_m", soil.grains.stiffness},
          {"density_kg_m3", soil.grains.density},
          {"breadth_d", c.breadth},
          {"strip_bin", c.stripBin},
          {"strip_depth", c.stripDepth},
          {"strip_thickness_d", c.thickness},
          {"circular_bin", c.circularBin},
          {"circular_depth", c.circularDepth},
          {"sinkage", c.sinkage},
          {"inertial_number", c.inertialNumber}};
}

std::string nameOf(const PlateCase& c, int seed) { return fmt::format("{}_seed{}", c.name, seed); }

/// Runs of one case that are there, as pressures.
struct CaseRuns {
  const PlateCase* plate;
  double area, breadth; ///< [m2], [m]
  std::vector<Table> runs;

  std::vector<double> pressures(const std::array<double, 2>& slice) const {
    std::vector<double> all;
    for (const Table& run : runs) all.push_back(meanPressure(run, area, slice[0] * breadth, slice[1] * breadth));
    return all;
  }
  double porosity() const {
    double mean = 0;
    for (const Table& run : runs)
      mean += run.rows.front()[run.column("porosity [-]")] / static_cast<double>(runs.size());
    return mean;
  }
  bool reaches(const std::array<double, 2>& slice) const { return slice[1] <= plate->test.sinkage + 1e-9; }
};

std::string sliceText(const std::array<double, 2>& s) { return fmt::format("{:.2f}-{:.2f}", s[0], s[1]); }

std::string pressureTable(const std::vector<CaseRuns>& all, const std::vector<std::array<double, 2>>& slices,
                          std::string& csv) {
  std::string text =
      fmt::format("\npressure [kPa] at sinkage / breadth\n  {:<10} {:>5} {:>8}", "", "seeds", "porosity");
  for (const auto& s : slices) text += fmt::format(" {:>16}", sliceText(s));
  text += "\n";
  csv = "case,seeds,porosity [-],from [breadths],to [breadths],pressure [Pa],half width\n";
  for (const CaseRuns& c : all) {
    text += fmt::format("  {:<10} {:>5} {:>8.3f}", c.plate->name, c.runs.size(), c.porosity());
    for (const auto& s : slices) {
      if (!c.reaches(s)) {
        text += fmt::format(" {:>16}", "-");
        continue;
      }
      const support::Estimate p = interval95(c.pressures(s));
      text += fmt::format(" {:>16}", plusMinus({1e-3 * p.value, 1e-3 * p.halfWidth}, 2));
      csv += fmt::format("{},{},{:.4f},{:g},{:g},{:.5g},{:.3g}\n", c.plate->name, c.runs.size(), c.porosity(), s[0],
                         s[1], p.value, p.halfWidth);
    }
    text += "  " + c.plate->title + "\n";
  }
  return text;
}

std::string extentTable(const std::vector<CaseRuns>& all, const std::vector<std::array<double, 2>>& slices,
                        std::string& csv) {
  const auto base = std::find_if(all.begin(), all.end(), [](const CaseRuns& c) { return c.plate->name == "base"; });
  csv = "case,from [breadths],to [breadths],difference to base [-],half width,verdict\n";
  if (base == all.end()) return "";
  std::string text = fmt::format("\ndifference to the base strip [%] at sinkage / breadth; bar {:g} %\n  {:<10}",
                                 100 * kExtentBar, "");
  for (const auto& s : slices) text += fmt::format(" {:>16}", sliceText(s));
  text += "\n";
  for (const CaseRuns& c : all) {
    if (&c == &*base || c.plate->test.shape != PlateShape::strip) continue;
    text += fmt::format("  {:<10}", c.plate->name);
    std::string verdict = "sinks less deep";
    for (const auto& s : slices) {
      if (!c.reaches(s)) {
        text += fmt::format(" {:>16}", "-");
        continue;
      }
      const support::Estimate difference = relativeDifference(base->pressures(s), c.pressures(s));
      verdict = verdictText(judge(difference, kExtentBar));
      text += fmt::format(" {:>16}", plusMinus({100 * difference.value, 100 * difference.halfWidth}, 1));
      csv += fmt::format("{},{:g},{:g},{:.5f},{:.5f},{}\n", c.plate->name, s[0], s[1], difference.value,
                         difference.halfWidth, verdict);
    }
    text += "  " + verdict + "\n";
  }
  return text;
}

std::string bearingTable(const PlatesCommand& command, const Soil& soil, const std::vector<CaseRuns>& all,
                         const std::vector<std::array<double, 2>>& slices, std::string& csv) {
  csv = "case,from [breadths],to [breadths],measured [Pa],half width,theory [Pa],at the angle's lower end [Pa],at its "
        "upper end [Pa],measured over theory - 1,half width,verdict,angle that theory would need [deg]\n";
  if (command.angle <= 0)
    return "\nno theory of bearing: give the angle that `grouser study shear-angle` has measured, --angle\n";
  std::string text =
      fmt::format("\nbearing at {:g} +- {:g} deg (Vesic's factors; with the bed's own density), bar {:g} %\n"
                  "  {:<10} {:>12} {:>18} {:>28} {:>20} {:>11} {:>14}\n",
                  command.angle, command.angleError, 100 * kBearingBar, "", "sinkage / B", "measured [kPa]",
                  "theory, over the angle [kPa]", "measured/theory - 1", "", "angle of it");
  for (const CaseRuns& c : all) {
    if (c.plate->name != "base" && c.plate->name != "circular") continue;
    const double weight = (1 - c.porosity()) * soil.grains.density * kGravity;
    for (const auto& s : slices) {
      const auto theory = [&](double degrees) {
        return meanBearing(c.plate->test.shape, radians(degrees), weight, c.breadth, s[0] * c.breadth,
                           s[1] * c.breadth);
      };
      const std::vector<double> measured = c.pressures(s);
      const support::Estimate p = interval95(measured);
      const double q = theory(command.angle), low = theory(command.angle - command.angleError),
                   high = theory(command.angle + command.angleError);
      // What is not known of the angle counts as the pressure's own scatter.
      const support::Estimate ratio{p.value / q - 1, std::hypot(p.halfWidth / q, p.value / q * 0.5 * (high - low) / q)};
      const double fits =
          bearingAngle(c.plate->test.shape, p.value, weight, c.breadth, 0.5 * (s[0] + s[1]) * c.breadth) * 180 /
          base::kPi;
      const std::string verdict = verdictText(judge(ratio, kBearingBar));
      text += fmt::format("  {:<10} {:>12} {:>18} {:>12.2f} ({:.2f} to {:.2f}) {:>20} {:>11} {:>12.1f} deg\n",
                          c.plate->name, sliceText(s), plusMinus({1e-3 * p.value, 1e-3 * p.halfWidth}, 2), 1e-3 * q,
                          1e-3 * low, 1e-3 * high, percent(ratio), verdict, fits);
      csv += fmt::format("{},{:g},{:g},{:.5g},{:.3g},{:.5g},{:.5g},{:.5g},{:.4f},{:.4f},{},{:.4g}\n", c.plate->name,
                         s[0], s[1], p.value, p.halfWidth, q, low, high, ratio.value, ratio.halfWidth, verdict, fits);
    }
  }
  return text;
}

void runAll(const PlatesCommand& command, const Soil& soil, const std::vector<PlateCase>& cases, Pieces& pieces) {
  const base::Exec exec =
      support::chooseDevice(support::deviceChoice(command.pieces.device), command.pieces.threads, nullptr);
  support::Progress progress("pushing plates");
  const double all = static_cast<double>(cases.size()) * command.seeds;
  int done = 0;
  for (int seed = 1; seed <= command.seeds; ++seed)
    for (const PlateCase& c : cases) {
      const std::string name = nameOf(c, seed);
      progress.update(done++ / all, name);
      if (!pieces.due(name)) continue;
      const auto folder = pieces.folder() / ("bed_" + name);
      std::filesystem::create_directories(folder);
      const auto keep = command.keepBeds ? pieces.folder() / ("bed_" + name + ".txt") : std::filesystem::path();
      pieces.keep(name, pushPlate(soil, c.test, seed, folder, keep, exec));
      std::filesystem::remove_all(folder);
    }
  progress.finish(fmt::format("{} of {} plates are there", all - pieces.left(), all));
}

} // namespace

std::vector<PlateCase> plateCases(const PlatesCommand& c) {
  PlateTest strip;
  strip.breadth = c.breadth, strip.bin = c.stripBin, strip.depth = c.stripDepth, strip.thickness = c.thickness;
  strip.sinkage = c.sinkage, strip.inertialNumber = c.inertialNumber;
  PlateTest rough = strip, deep = strip, wide = strip, old = strip, circular = strip;
  rough.floor = BedFloor::rough;
  deep.depth *= 2;
  wide.bin *= 2;
  old.floor = BedFloor::plane, old.lattice = true, old.sinkage = std::min(c.sinkage, kLatticeSinkage);
  circular.shape = PlateShape::circular, circular.bin = c.circularBin, circular.depth = c.circularDepth;
  std::vector<PlateCase> all = {{"base", "strip, floor of fixed grains", strip},
                                {"rough", "plane floor with friction 2", rough},
                                {"deep", "depth doubled", deep},
                                {"wide", "width doubled", wide},
                                {"old", "five layers in a lattice on a plane floor", old},
                                {"circular", "circular plate", circular}};
  if (c.cases.empty()) return all;
  std::vector<PlateCase> chosen;
  for (const std::string& name : c.cases) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const PlateCase& p) { return p.name == name; });
    if (found == all.end())
      throw base::InputError(fmt::format("--cases: {} is none of base, rough, deep, wide, old, circular", name));
    chosen.push_back(*found);
  }
  return chosen;
}

std::vector<std::array<double, 2>> sinkageSlices(double sinkage) {
  std::vector<std::array<double, 2>> slices;
  for (int k = 0; k < kSlices; ++k) slices.push_back({sinkage * k / kSlices, sinkage * (k + 1) / kSlices});
  slices.push_back({sinkage / kSlices, sinkage});
  return slices;
}

void studyPlatesCommand(const PlatesCommand& given) {
  const PlatesCommand command = smallOf(given);
  const std::vector<PlateCase> cases = plateCases(command);
  const Soil soil = soilOf(command);
  const nlohmann::ordered_json recipe = recipeOf(command, soil);
  Pieces pieces("plates", command.place, command.pieces, recipe);
  const support::StopSignals signals;
  const auto begin = std::chrono::steady_clock::now();
  fmt::print(
      "          spheres of {:g} mm +- {:g} %, {:g} N/m, friction {:g}, rolling friction {:g}, poured with {:g}; "
      "plate {:g} d; {} seeds, +- 95 %\n",
      2e3 * soil.grains.radius, 100 * soil.spread, soil.grains.stiffness, soil.grains.friction,
      soil.grains.rollingFriction, soil.preparationFriction, command.breadth, command.seeds);
  runAll(command, soil, cases, pieces);
  if (!pieces.whole()) return;
  std::vector<CaseRuns> all;
  for (const PlateCase& c : cases) {
    CaseRuns runs{&c, c.test.area(soil), c.test.breadth * soil.grains.diameter(), {}};
    for (int seed = 1; seed <= command.seeds; ++seed)
      if (const std::string name = nameOf(c, seed); pieces.has(name)) runs.runs.push_back(pieces.read(name));
    if (!runs.runs.empty()) all.push_back(runs);
  }
  const auto slices = sinkageSlices(command.sinkage);
  std::string pressures, extent, bearing;
  fmt::print("{}", pressureTable(all, slices, pressures));
  fmt::print("{}", extentTable(all, slices, extent));
  fmt::print("{}", bearingTable(command, soil, all, slices, bearing));
  if (pieces.left() > 0) fmt::print("{} runs are missing: call again with --resume\n", pieces.left());
  support::writeTextFile(pieces.folder() / "plates.csv", pressures, "--out");
  support::writeTextFile(pieces.folder() / "extent.csv", extent, "--out");
  support::writeTextFile(pieces.folder() / "bearing.csv", bearing, "--out");
  nlohmann::ordered_json more = recipe;
  more["seeds"] = command.seeds, more["angle_deg"] = command.angle;
  writeStudyOrigin(pieces.folder(), "plates",
                   std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), more);
  output::drawPicture("study_plates.py", {pieces.folder() / "plates.csv", pieces.folder() / "runs"},
                      pieces.folder() / "plates.png");
  fmt::print("tables    {}\n", pieces.folder().string());
}

} // namespace grouser::studies
