// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/plan.hpp"

#include "base/error.hpp"
#include "base/free_memory.hpp"
#include "base/math.hpp"
#include "base/sphere.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace grouser::virtual_tests {

namespace {

constexpr double kFineDepth = 0.1, kCoarsening = 0.0265; // graded beds, validated by `grouser study plates`
constexpr double kCellLength = 32, kCellWidth = 16, kCellHeight = 10; // [d]: samples of 16 x 8 d scatter by 10 %
constexpr double kCoarseLength = 12, kCoarseWidth = 6;                // [d]
constexpr double kTooth = 1.2, kTip = 0.4;                            // [d] height and tip width of the plate teeth
constexpr double kLiftFall = 0.5;                                     // [s] simulated per lift, for cost estimates only
constexpr double kYielding = 8; // sinkage / sinkage of a bed as stiff as columns of grains, for cost estimates only
constexpr double kPressed = 70; // [d sqrt(density / stress)] time before shear starts, for cost estimates only

/// Elastic overlap of two grains under a force [m].
double overlapUnder(const TestedSoil& soil, double force) {
  if (soil.young == 0) return force / numberOf(soil, "stiffness", 0);
  const double modulus = 0.5 * soil.young / (1 - soil.poisson * soil.poisson), radius = 0.5 * soil.grainRadius;
  return base::pow(0.5625 * force * force / (modulus * modulus * radius), 1.0 / 3);
}

/// Modulus of a bed that consists of columns of grains, under the track's pressure [Pa]. It is an upper bound for real
/// beds, and determines the initial speed of plates.
double modulusOfColumns(const TestedSoil& soil) {
  const double d = 2 * soil.grainRadius;
  return kTrackPressure * d / overlapUnder(soil, kTrackPressure * d * d);
}

/// Impact speed with the same maximum overlap as a contact in a force chain under `pressure`; used for the time step.
/// The mean contact force is about pressure times d^2; in force chains it is twice as large.
double impactLikePressure(const TestedSoil& soil, double pressure) {
  if (soil.young == 0) return 0;
  const double d = 2 * soil.grainRadius, force = 2 * pressure * d * d, overlap = overlapUnder(soil, force);
  // Energy of a Hertz contact: 2/5 F overlap = m_eff v^2 / 2.
  return std::sqrt(0.8 * force * overlap / (0.5 * base::sphereMass(soil.density, soil.grainRadius)));
}

double volumeOf(const Soil& soil, const PlateSinkage& plate) {
  const BedSize size = plate.strip.bed(soil);
  return size.length * size.width * size.depth;
}

double plateCost(const Soil& soil, const PlateSinkage& plate) {
  const double lifts = plate.strip.depth * plate.strip.breadth / plate.lift;
  const double d = soil.grains.diameter(), breadth = plate.strip.breadth * d;
  const double way =
      std::min(1.2 * plate.strip.sinkage * breadth, d + kYielding * breadth * plate.maxPressure / plate.firstModulus);
  const double push = way / std::sqrt(plate.pace(soil).first() * plate.fastest(soil));
  return volumeOf(soil, plate) / soil.meanVolume() * (plate.strip.coarsening > 0 ? 0.3 : 1.0) *
         (0.6 * kLiftFall * std::max(1.0, lifts) + push);
}

double shearCost(const Soil& soil, const ShearCell& cell, double load) {
  const double d = soil.grains.diameter(), unit = d * std::sqrt(soil.grains.density / load);
  return cell.length * cell.width * cell.depth *
         (kLiftFall + unit * ((cell.pressesIn ? 2 : 1) * kPressed + cell.strain / cell.inertialNumber));
}

double reposeCost(const Soil& soil, const ReposeTest& test) {
  constexpr double kStages = 30;
  const double held = kStages * test.stage * std::sqrt(soil.grains.diameter() / 9.81);
  return test.length * test.width * test.depth * (2 * kLiftFall + held);
}

double measuredPlateCost(const TestPlan& plan, double diameter) {
  const MeasuredPlateTest test = plan.measuredPlate(diameter);
  return test.bin * test.bin * test.depth / plan.grains.meanVolume() *
         (kLiftFall + test.sinkage / test.speed(plan.grains));
}

void addMeasuredPlates(TestPlan& plan) {
  const PlanOptions& o = plan.options;
  const std::string care = o.coarse ? "coarse_" : "";
  for (int seed = 1; seed <= o.seeds && !o.plates.diameters.empty(); ++seed) {
    for (const double d : o.plates.diameters)
      plan.tests.push_back({fmt::format("{}plate{:g}mm_seed{}", care, 1e3 * d, seed), TestKind::plate, 0, d, seed,
                            measuredPlateCost(plan, d)});
  }
}

void addTests(TestPlan& plan) {
  const PlanOptions& o = plan.options;
  const auto add = [&](TestKind kind, const std::string& what, double load, int seed, double cost) {
    plan.tests.push_back(
        {fmt::format("{}{}_seed{}", o.coarse ? "coarse_" : "", what, seed), kind, load, 0, seed, cost});
  };
  for (int seed = 1; seed <= std::max({o.seeds, o.largeSeeds, o.reposeSeeds}); ++seed) {
    if (seed <= o.seeds) {
      add(TestKind::small, "small", 0, seed, plateCost(plan.grains, plan.small));
      for (const double load : o.loads)
        add(TestKind::shear, fmt::format("shear{:g}kPa", 1e-3 * load), load, seed,
            shearCost(plan.grains, plan.cell, load));
    }
    if (seed <= o.reposeSeeds) add(TestKind::repose, "repose", 0, seed, reposeCost(plan.grains, plan.repose));
    if (seed <= o.largeSeeds) add(TestKind::large, "large", 0, seed, plateCost(plan.grains, plan.large));
  }
  for (int seed = 1; o.wide && seed <= o.seeds; ++seed)
    add(TestKind::wide, "wide", 0, seed, plateCost(plan.grains, plan.wide));
  addMeasuredPlates(plan);
}

/// Throws InputError if the grains of any bed or sample exceed the free memory.
void checkSizes(const TestPlan& plan) {
  constexpr double kGiB = 1073741824.0;
  constexpr double kBytes = 600;   // [bytes] memory per grain
  constexpr double kPacked = 1.15; // number of grains in a volume d^3
  const std::optional<double> free = base::freeMemoryOfHost();
  const auto require = [&](double grains, const std::string& what) {
    if (free && grains * kBytes > *free)
      throw base::InputError(
          fmt::format("{} {:.3g} grains, which require about {:.3g} GiB, but only {:.3g} GiB are free; reduce its size",
                      what, grains, grains * kBytes / kGiB, *free / kGiB));
  };
  const PlanOptions& o = plan.options;
  for (const TestKind kind : {TestKind::small, TestKind::large, TestKind::wide}) {
    if (kind == TestKind::wide && !o.wide) continue;
    const PlateSinkage& plate = plan.plate(kind);
    require(
        volumeOf(plan.grains, plate) / plan.grains.meanVolume() * (plate.strip.coarsening > 0 ? 0.3 : 1.0),
        fmt::format(
            "--plate-grains {:g}, --plate-ratio {:g}, --bin {:g}, --depth {:g} and --thickness {:g} require a bed of",
            o.plateGrains, o.plateRatio, o.bin, o.depth, o.thickness));
  }
  require(plan.cell.length * plan.cell.width * plan.cell.depth * kPacked,
          fmt::format("--shear-height {:g} [m] with grains of radius {:g} m requires a sample of", o.shearHeight,
                      plan.soil.grainRadius));
}

/// Throws InputError if a plate is too wide for its bed or would come too close to the floor.
void checkMeasuredPlates(const MeasuredPlatesBed& p, double coarsest) {
  for (std::size_t k = 0; k < p.diameters.size(); ++k) {
    if (p.bin < 2 * p.diameters[k])
      throw base::InputError(
          fmt::format("plates.bin = {:g} m is less than twice the plate diameter, {:g} m; raise plates.bin", p.bin,
                      p.diameters[k]));
    if (p.depth < p.sinkages[k] + 2 * coarsest)
      throw base::InputError(fmt::format("plates.depth = {:g} m is too small: fewer than two grains remain below the "
                                         "plate of {:g} m at a sinkage of {:g} m; raise plates.depth",
                                         p.depth, p.diameters[k], p.sinkages[k]));
  }
}

/// Throws InputError if a grain could touch two periodic images of another grain, or if a plate could touch the floor.
void checkBeds(const TestPlan& plan) {
  const double least = 3.5 * (1 + plan.soil.spread), d = 2 * plan.soil.grainRadius;
  const PlanOptions& o = plan.options;
  checkMeasuredPlates(o.plates, d * (1 + plan.soil.spread));
  if (o.thickness < least)
    throw base::InputError(fmt::format(
        "--thickness {:g} [d] is too small: the largest grains require at least {:.3g} d between the periodic "
        "boundaries; raise --thickness",
        o.thickness, least));
  if (o.bin * o.plateGrains < least)
    throw base::InputError(fmt::format(
        "--plate-grains {:g} [d] is too small: the bed is {:g} d wide, but the largest grains require at least "
        "{:.3g} d; raise --plate-grains or --bin",
        o.plateGrains, o.bin * o.plateGrains, least));
  const double most = (o.depth * o.plateGrains - 1 - plan.soil.spread) / o.plateGrains;
  if (plan.small.strip.sinkage > most)
    throw base::InputError(fmt::format(
        "--plate-grains {:g} [d] is too small: the gap between the plate and the floor would be less than the "
        "largest grain (mean diameter {:g} m); raise --plate-grains or --depth",
        o.plateGrains, d));
}

} // namespace

PlanOptions coarsePlan() {
  PlanOptions o;
  o.coarse = true;
  o.plateGrains = 8, o.plateRatio = 2, o.bin = 4, o.depth = 1.5, o.thickness = 6, o.gradedThickness = 9;
  o.plateWaves = 0.1, o.inertialNumber = 5e-3, o.shearInertialNumber = 5e-3, o.shearStrain = 0.3;
  o.seeds = 3, o.largeSeeds = 3, o.wide = false;
  return o;
}

const PlateSinkage& TestPlan::plate(TestKind kind) const {
  return kind == TestKind::large ? large : kind == TestKind::wide ? wide : small;
}

MeasuredPlateTest TestPlan::measuredPlate(double diameter) const {
  const MeasuredPlatesBed& p = options.plates;
  const auto k =
      static_cast<std::size_t>(std::find(p.diameters.begin(), p.diameters.end(), diameter) - p.diameters.begin());
  return {diameter, p.sinkages.at(k), p.bin, p.depth, options.inertialNumber, soil.porosity};
}

double TestPlan::breadth(TestKind kind) const { return plate(kind).strip.breadth * grains.grains.diameter(); }

TestPlan planOf(const TestedSoil& soil, const PlanOptions& options) {
  TestPlan plan;
  plan.options = options, plan.soil = soil;
  plan.grains.grains.radius = soil.grainRadius, plan.grains.grains.density = soil.density;
  plan.grains.grains.friction = soil.friction, plan.grains.grains.law = soil.law;
  plan.grains.preparationLaw = soil.lawWithoutPull;
  plan.grains.spread = soil.spread, plan.grains.preparationFriction = soil.friction;
  plan.grains.stepsPerContact = options.stepsPerContact;
  plan.grains.impactSpeed = impactLikePressure(
      soil, std::max(options.maxPressure, *std::max_element(options.loads.begin(), options.loads.end())));
  PlateTest& small = plan.small.strip;
  small.breadth = options.plateGrains, small.bin = options.bin, small.depth = options.depth;
  small.thickness = options.thickness, small.inertialNumber = options.inertialNumber;
  plan.small.maxPressure = options.maxPressure;
  plan.small.added = options.plateWaves * kTrackPressure, plan.small.firstModulus = modulusOfColumns(soil);
  plan.wide = plan.large = plan.small;
  plan.wide.strip.bin *= 2;
  plan.large.strip.breadth *= options.plateRatio;
  if (soil.isOneAtAllSizes) {
    plan.large.strip.fineDepth = kFineDepth, plan.large.strip.coarsening = kCoarsening;
    plan.large.strip.thickness = options.gradedThickness;
  }
  const double d = 2 * soil.grainRadius;
  plan.cell.length = options.coarse ? kCoarseLength : kCellLength;
  plan.cell.width = options.coarse ? kCoarseWidth : kCellWidth;
  if (options.coarse) plan.repose.length = 10, plan.repose.width = 6, plan.repose.depth = 12, plan.repose.stage = 8;
  plan.cell.depth = std::max(kCellHeight, options.shearHeight / d);
  plan.cell.inertialNumber = options.shearInertialNumber, plan.cell.strain = options.shearStrain;
  plan.cell.core = soil.isPlain;
  plan.cell.tooth = kTooth, plan.cell.tip = kTip, plan.cell.pressesIn = true;
  checkBeds(plan), checkSizes(plan);
  addTests(plan);
  return plan;
}

nlohmann::ordered_json TestPlan::recipe() const {
  nlohmann::ordered_json all = {
      {"test", "soil"},
      {"soil", soil.name},
      {"care", care()},
      {"law", soil.law},
      {"density_kg_m3", soil.density},
      {"friction", soil.friction},
      {"grain_radius_m", soil.grainRadius},
      {"radius_spread", soil.spread},
      {"porosity", soil.porosity ? nlohmann::ordered_json(*soil.porosity) : nlohmann::ordered_json(nullptr)},
      {"plate_grains", options.plateGrains},
      {"plate_ratio", options.plateRatio},
      {"bin", options.bin},
      {"depth", options.depth},
      {"thickness_d", options.thickness},
      {"graded_thickness_d", large.strip.coarsening > 0 ? options.gradedThickness : 0.0},
      {"most_pressure_Pa", options.maxPressure},
      {"inertial_number", options.inertialNumber},
      {"plate_waves", options.plateWaves},
      {"steps_per_contact", options.stepsPerContact},
      {"shear_length_d", cell.length},
      {"shear_width_d", cell.width},
      {"shear_height_d", cell.depth},
      {"shear_tooth_d", cell.tooth},
      {"shear_strain", options.shearStrain},
      {"shear_inertial_number", options.shearInertialNumber},
      {"repose_length_d", repose.length},
      {"repose_width_d", repose.width},
      {"repose_depth_d", repose.depth},
      {"repose_stage", repose.stage}};
  if (!options.plates.diameters.empty())
    all["measured_plates"] = {{"diameters_m", options.plates.diameters},
                              {"sinkages_m", options.plates.sinkages},
                              {"bin_m", options.plates.bin},
                              {"depth_m", options.plates.depth}};
  return all;
}

void longestFirst(std::vector<const PlannedTest*>& tests) {
  std::stable_sort(tests.begin(), tests.end(),
                   [](const PlannedTest* a, const PlannedTest* b) { return a->cost > b->cost; });
}

jobs::Table doTest(const TestPlan& plan, const PlannedTest& test, const std::filesystem::path& folder,
                   const std::filesystem::path& kept, const base::Exec& exec, const PlateProgress& report) {
  if (test.kind == TestKind::repose) return tiltBed(plan.grains, plan.repose, test.seed, folder, exec, report);
  if (test.kind == TestKind::plate)
    return pushMeasuredPlate(plan.grains, plan.measuredPlate(test.diameter), test.seed, folder, exec, report);
  if (test.kind != TestKind::shear)
    return pushStrip(plan.grains, plan.plate(test.kind), test.seed, folder, exec, report);
  report(0, "shearing");
  return shearCell(plan.grains, plan.cell, test.load, test.seed, folder, exec, kept);
}

ShearCurve shearCurve(const jobs::Table& run, double diameter) {
  ShearCurve curve;
  curve.shear = run.values("shear stress [Pa]"), curve.normal = run.values("normal stress [Pa]");
  const double height = run.values("height [d]").front() * diameter;
  for (const double strain : run.values("strain [-]")) curve.displacement.push_back(strain * height);
  return curve;
}

} // namespace grouser::virtual_tests
