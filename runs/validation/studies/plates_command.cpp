// SPDX-License-Identifier: BSD-3-Clause
// `grouser study plates`: plates and beds, tables and files.
#include "base/counted.hpp"
#include "base/error.hpp"
#include "runs/output/plots.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/text_file.hpp"
#include "runs/validation/studies/plates_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::studies {

namespace {

constexpr int kSlices = 4;
constexpr double kLatticeSinkage = 0.2; // [breadths] maximum sinkage in a bed of five layers

virtual_tests::Soil soilOf(const PlatesCommand& c) {
  virtual_tests::Soil soil;
  soil.grains.friction = c.friction, soil.grains.rollingFriction = c.rollingFriction;
  soil.grains.restitution = 0.3, soil.preparationFriction = c.preparationFriction;
  if (c.place.quick) soil.grains.stiffness = 2e4;
  return soil;
}

nlohmann::ordered_json recipeOf(const PlatesCommand& c, const virtual_tests::Soil& soil) {
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
          {"fine_breadth_d", c.fineBreadth},
          {"fine_thickness_d", c.fineThickness},
          {"fine_depth", c.fineDepth},
          {"coarsening", c.coarsening},
          {"young_Pa", c.young},
          {"circular_bin", c.circularBin},
          {"circular_depth", c.circularDepth},
          {"sinkage", c.sinkage},
          {"inertial_number", c.inertialNumber}};
}

void runAll(const PlatesCommand& command, const virtual_tests::Soil& soil, const std::vector<PlateCase>& cases,
            jobs::Pieces& pieces) {
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
      const auto folder = pieces.begin(name);
      const auto report = [&](double share, const std::string& phase) {
        progress.update((done - 1 + share) / all, name + ", " + phase);
      };
      pieces.keep(name, virtual_tests::pushPlate(soil, c.test, seed, folder, exec, report));
      if (command.keepBeds) std::filesystem::rename(folder / "bed.txt", pieces.folder() / ("bed_" + name + ".txt"));
      std::filesystem::remove_all(folder);
    }
  progress.finish(fmt::format("{} of {} plates finished", all - pieces.left(), all));
}

} // namespace

std::vector<PlateCase> plateCases(const PlatesCommand& c) {
  virtual_tests::PlateTest strip;
  strip.breadth = c.breadth, strip.bin = c.stripBin, strip.depth = c.stripDepth, strip.thickness = c.thickness;
  strip.sinkage = c.sinkage, strip.inertialNumber = c.inertialNumber;
  virtual_tests::PlateTest rough = strip, deep = strip, wide = strip, old = strip, circular = strip, fine = strip;
  rough.floor = virtual_tests::BedFloor::rough;
  deep.depth *= 2;
  wide.bin *= 2;
  old.floor = virtual_tests::BedFloor::plane, old.lattice = true, old.sinkage = std::min(c.sinkage, kLatticeSinkage);
  circular.shape = virtual_tests::PlateShape::circular, circular.bin = c.circularBin, circular.depth = c.circularDepth;
  fine.breadth = c.fineBreadth, fine.thickness = c.fineThickness, fine.young = c.young;
  virtual_tests::PlateTest graded = fine;
  graded.fineDepth = c.fineDepth, graded.coarsening = c.coarsening;
  std::vector<PlateCase> all = {{"base", "strip, floor of fixed grains", strip, "", true},
                                {"rough", "plane floor with friction 2", rough, "base"},
                                {"deep", "depth doubled", deep, "base", false, 2},
                                {"wide", "width doubled", wide, "base", false, 1, 2},
                                {"old", "five layers in a lattice on a plane floor", old, "base"},
                                {"circular", "circular plate", circular, "", true},
                                {"fine", "strip on uniformly fine grains", fine},
                                {"graded", "the same strip, grain size increases with depth", graded, "fine"}};
  if (c.cases.empty()) return all;
  std::vector<PlateCase> chosen;
  for (const std::string& name : c.cases) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const PlateCase& p) { return p.name == name; });
    if (found == all.end())
      throw base::InputError(fmt::format(
          "--cases: unknown case {}; choose from base, rough, deep, wide, old, circular, fine, graded", name));
    chosen.push_back(*found);
  }
  return chosen;
}

std::string nameOf(const PlateCase& plate, int seed) { return fmt::format("{}_seed{}", plate.name, seed); }

std::vector<Slice> sinkageSlices(double sinkage) {
  std::vector<Slice> slices;
  for (int k = 0; k < kSlices; ++k) slices.push_back({sinkage * k / kSlices, sinkage * (k + 1) / kSlices});
  slices.push_back({sinkage / kSlices, sinkage});
  return slices;
}

void studyPlatesCommand(const PlatesCommand& command) {
  const std::vector<PlateCase> cases = plateCases(command);
  const virtual_tests::Soil soil = soilOf(command);
  checkPlates(cases, soil);
  const nlohmann::ordered_json recipe = recipeOf(command, soil);
  jobs::Pieces pieces("plates", command.place, command.pieces, recipe);
  const support::StopSignals signals;
  const auto begin = std::chrono::steady_clock::now();
  fmt::print("          spheres of {:g} mm diameter (d) +- {:g} %, {:g} N/m, friction {:g}, rolling friction {:g}, "
             "friction {:g} during pouring; plate width {:g} d; {} seeds, +-: 95 % interval\n",
             2e3 * soil.grains.radius, 100 * soil.spread, soil.grains.stiffness, soil.grains.friction,
             soil.grains.rollingFriction, soil.preparationFriction, command.breadth, command.seeds);
  runAll(command, soil, cases, pieces);
  if (!pieces.whole()) return;
  const std::vector<CaseRuns> all = runsThatAreThere(cases, soil, command.seeds, pieces);
  const std::vector<Slice> slices = sinkageSlices(command.sinkage);
  std::string pressures, differences, bearing, costs;
  fmt::print("{}", pressureTable(all, slices, pressures));
  fmt::print("{}", differenceTable(all, slices, differences));
  fmt::print("{}", bearingTable(command, soil, all, slices, bearing));
  fmt::print("{}", costTable(all, costs));
  if (pieces.left() > 0)
    fmt::print("{} missing; repeat the command with --resume\n", base::counted(pieces.left(), "run is", "runs are"));
  support::writeTextFile(pieces.folder() / "plates.csv", pressures, "--out");
  support::writeTextFile(pieces.folder() / "differences.csv", differences, "--out");
  support::writeTextFile(pieces.folder() / "bearing.csv", bearing, "--out");
  support::writeTextFile(pieces.folder() / "costs.csv", costs, "--out");
  nlohmann::ordered_json more = recipe;
  more["seeds"] = command.seeds, more["angle_deg"] = command.angle;
  jobs::writeStudyOrigin(pieces.folder(), "plates",
                         std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), more);
  output::drawPicture("study_plates.py", {pieces.folder() / "plates.csv", pieces.folder() / "runs"},
                      pieces.folder() / "plates.png");
  fmt::print("tables    {}\n", pieces.folder().string());
}

} // namespace grouser::studies
