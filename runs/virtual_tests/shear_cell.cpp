// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/shear_cell.hpp"

#include "base/math.hpp"
#include "base/sphere.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::virtual_tests {

namespace {

using base::Vec3d;

constexpr double kPitch = 2;                // [d] distance between teeth
constexpr double kBack = 2;                 // [d] thickness of the plates behind their teeth
constexpr double kBeyond = 2;               // [d] minimum extent of the plates beyond the boundaries
constexpr double kRounded = 0.25;           // [d] radius of the spheres that represent a plate's mesh
constexpr double kRamp = 30, kPressed = 70; // [d sqrt(density / stress)] duration of the load ramp, time of first shear
constexpr double kPlateMass = 0.25;         // mass of the upper plate / mass of the sample
constexpr auto kEntry = "max_overlap = 0.5\n"; // the limit between grains; soft grains can start with such overlaps
constexpr double kOffPlates = 2;               // [d] distance between the core and the tips of the teeth

/// A plate as OBJ text: teeth along x with their tips at z = 0. The body is below the tips if `up`, else above.
std::string toothedPlate(double from, double to, double width, double d, const ShearCell& cell, bool up) {
  const auto teeth = static_cast<int>(std::lround((to - from) / (kPitch * d)));
  std::vector<std::array<double, 2>> profile; // x, z
  for (int k = 0; k < teeth; ++k) {
    const double tip = from + (k + 0.5) * kPitch * d;
    profile.push_back({from + k * kPitch * d, -cell.tooth * d});
    profile.push_back({tip - 0.5 * cell.tip * d, 0});
    if (cell.tip > 0) profile.push_back({tip + 0.5 * cell.tip * d, 0});
  }
  profile.push_back({from + teeth * kPitch * d, -cell.tooth * d});
  const int m = static_cast<int>(profile.size());
  std::string text;
  for (const bool back : {false, true})
    for (const double y : {-kBeyond * d, width + kBeyond * d})
      for (const auto& [x, z] : profile)
        text +=
            fmt::format("v {:.12g} {:.12g} {:.12g}\n", x, y, (up ? 1 : -1) * (back ? -(cell.tooth + kBack) * d : z));
  const auto at = [m](int i, int side, bool back) { return 1 + i + m * side + (back ? 2 * m : 0); };
  const auto face = [&](int a, int b, int c) {
    text += up ? fmt::format("f {} {} {}\n", a, b, c) : fmt::format("f {} {} {}\n", c, b, a);
  };
  const auto quad = [&](int a, int b, int c, int e) { face(a, b, c), face(a, c, e); };
  for (int i = 0; i + 1 < m; ++i) {
    quad(at(i, 0, false), at(i + 1, 0, false), at(i + 1, 1, false), at(i, 1, false));
    quad(at(i, 1, true), at(i + 1, 1, true), at(i + 1, 0, true), at(i, 0, true));
    quad(at(i, 0, false), at(i, 0, true), at(i + 1, 0, true), at(i + 1, 0, false));
    quad(at(i + 1, 1, false), at(i + 1, 1, true), at(i, 1, true), at(i, 1, false));
  }
  quad(at(0, 1, false), at(0, 1, true), at(0, 0, true), at(0, 0, false));
  quad(at(m - 1, 0, false), at(m - 1, 0, true), at(m - 1, 1, true), at(m - 1, 1, false));
  return text;
}

std::string plateSection(const std::string& name, double d, double z, const std::string& more) {
  return fmt::format("[[mesh]]\nname = \"{0}\"\nfile = \"{0}.obj\"\nmaterial = \"grain\"\nsphere_radius = {1:.17g}\n"
                     "position = [0, 0, {2:.17g}]\n{3}",
                     name, kRounded * d, z, more);
}

/// Shear and normal stress, each the mean magnitude over both plates.
struct PlateStress {
  double shear = 0, normal = 0, height = 0;
};
PlateStress plateStress(const coupling::Simulation& simulation, double area) {
  const coupling::Surfaces& surfaces = *simulation.surfaces();
  PlateStress s;
  for (std::size_t i = 0; i < surfaces.count(); ++i) {
    const coupling::Surfaces::Observation o = surfaces.observe(i, simulation.steps());
    const bool upper = surfaces.surface(i).name == "upper";
    s.shear += (upper ? -0.5 : 0.5) * o.force.x / area;
    s.normal += (upper ? 0.5 : -0.5) * o.force.z / area;
    if (upper) s.height = o.position.z;
  }
  return s;
}

/// Writes the meshes of both plates. The period of the teeth divides the length of the cell, so that the teeth match
/// across the boundaries. The upper plate extends backwards by its displacement.
void writePlates(const ShearCell& cell, const BedSize& size, double d, const std::filesystem::path& folder) {
  const double period = kPitch * d, way = cell.strain * 1.5 * size.depth;
  const double behind = period * std::ceil((way + kBeyond * d) / period), end = size.length + period;
  support::writeTextFile(folder / "lower.obj", toothedPlate(-period, end, size.width, d, cell, true), "--out");
  support::writeTextFile(folder / "upper.obj", toothedPlate(-behind, end, size.width, d, cell, false), "--out");
}

/// Geometry and mass of a layer between its plates, before shear.
struct Layer {
  BedGrains grains;
  double upper = 0; ///< initial height of the upper plate's tips [m]
  double mass = 0;  ///< total grain mass [kg]
};

/// Scene sections of both plates; the load on the upper plate rises during `ramp` [s].
std::string plateSections(double d, const Layer& layer, double load, double ramp, const std::string& drawn) {
  return plateSection("lower", d, 0, "") +
         plateSection("upper", d, layer.upper,
                      fmt::format("free = \"z\"\nmass = {:.17g}\nload = {:.17g}\nload_ramp = {:.17g}\n",
                                  kPlateMass * layer.mass, -load, ramp) +
                          drawn);
}

std::string grainsSection(const std::string& file) {
  return fmt::format("[[grains]]\nform = \"file\"\nfile = \"{}\"\nmaterial = \"grain\"\n", file);
}

/// Presses the teeth of the upper plate into the layer while it has no cohesion; on a cohesive layer, the teeth would
/// rest on the grains and slide.
void pressIn(const Soil& soil, const BedSize& size, double stress, std::int64_t seed,
             const std::filesystem::path& folder, const base::Exec& exec, Layer& layer) {
  const double d = soil.grains.diameter(), unit = d * std::sqrt(soil.grains.density / stress);
  const std::string bed = fmt::format("unpressed_{:g}_{}.txt", stress, seed);
  writeBed(folder / bed, layer.grains);
  const std::string text =
      soil.prepared().scene(kPressed * unit, seed, soil.preparationFriction, {0, 0, 0}, size.run()) +
      plateSections(d, layer, stress * size.length * size.width, kRamp * unit, "") + grainsSection(bed);
  coupling::Simulation simulation(setup::simulationSetup(setup::parseScene(text, folder / "press.toml")), exec,
                                  [](double, double) {});
  std::filesystem::remove(folder / bed);
  const auto all = static_cast<std::int64_t>(kPressed * unit / simulation.timeStep());
  while (simulation.steps() < all) {
    jobs::stopStudyOnRequest();
    simulation.advance(std::min<std::int64_t>(all - simulation.steps(), 2000));
  }
  layer.grains = grainsOf(simulation, size);
  layer.upper = plateStress(simulation, size.length * size.width).height;
}

/// Shear velocity of the soil: mean velocity of the grains at the upper tips minus the mean at the lower tips [m/s].
double shearedSpeed(const coupling::Simulation& simulation, double d, double height) {
  constexpr double kNear = 1; // [d] distance from the tips
  const terrain::GrainSnapshot s = simulation.ground().grains->snapshot();
  double below = 0, above = 0, lower = 0, upper = 0;
  for (std::size_t g = 0; g < s.position.size(); ++g) {
    const double z = s.position[g].z, speed = static_cast<double>(s.velocity[g].x);
    if (z > 0 && z < kNear * d) below += speed, ++lower;
    if (z < height && z > height - kNear * d) above += speed, ++upper;
  }
  return above / std::max(1.0, upper) - below / std::max(1.0, lower);
}

double columnMean(const jobs::Table& run, const std::string& name, std::size_t from, std::size_t to) {
  const std::size_t c = run.column(name);
  double sum = 0;
  for (std::size_t k = from; k < to; ++k) sum += run.rows[k][c];
  return sum / static_cast<double>(to - from);
}

} // namespace

CoreStress coreStress(const terrain::Grains& grains, const BedSize& size, double low, double high) {
  const terrain::GrainState state = grains.state();
  const contact::ContactLaw& law = grains.model().law;
  const base::Period& period = grains.system().constants.period;
  const base::PositionScale& scale = grains.scale();
  const auto radius = [&](std::size_t g) {
    return state.radius.empty() ? grains.model().radius : std::fabs(static_cast<double>(state.radius[g]));
  };
  CoreStress s;
  double inside = 0, contacts = 0;
  std::size_t c = 0;
  for (std::size_t g = 0; g < state.rows(); ++g) {
    const double z = scale.toMetres(state.position[g]).z;
    const bool counts = z > low && z < high;
    inside += counts;
    for (const std::size_t end = c + state.contacts[g]; c < end; ++c) {
      const std::size_t other = state.neighbour[c];
      contacts += counts;
      const Vec3d branch = period.apart(state.position[other], state.position[g]).as<double>() * scale.unit;
      if (const double middle = z - 0.5 * branch.z; middle < low || middle > high) continue;
      const double distance = norm(branch), overlap = radius(g) + radius(other) - distance;
      Vec3d force = branch * (law.stiffness * overlap / distance); // force on g
      if (!state.contactShear.empty()) force -= state.contactShear[c].as<double>() * law.tangentialStiffness;
      // The loop visits each contact twice, once from each grain, hence the factors 0.5.
      s.xx += 0.5 * force.x * branch.x, s.zz += 0.5 * force.z * branch.z;
      s.xz += 0.5 * force.x * branch.z, s.zx += 0.5 * force.z * branch.x;
    }
  }
  const double volume = size.length * size.width * (high - low);
  for (double* component : {&s.xx, &s.zz, &s.xz, &s.zx}) *component /= volume;
  s.coordination = inside > 0 ? contacts / inside : 0;
  return s;
}

jobs::Table shearCell(const Soil& soil, const ShearCell& cell, double stress, std::int64_t seed,
                      const std::filesystem::path& folder, const base::Exec& exec, const std::filesystem::path& kept) {
  const double d = soil.grains.diameter();
  const BedSize size{cell.length * d, cell.width * d, cell.depth * d};
  writePlates(cell, size, d, folder);
  Layer layer;
  // The comment with the mesh parameters is needed because the hash of the scene text identifies the poured sample.
  const std::string below =
      plateSection("lower", d, 0, "") + fmt::format("# teeth {:.17g} {:.17g}\n", cell.tooth, cell.tip);
  layer.grains = pourBed(soil, size, below, seed, folder, exec, kept);
  double top = 0;
  for (const BedGrain& g : layer.grains) {
    top = std::max(top, g.position.z + g.radius);
    layer.mass += base::sphereMass(soil.grains.density, g.radius);
  }
  layer.upper = top + 0.01 * d;
  if (cell.pressesIn) pressIn(soil, size, stress, seed, folder, exec, layer);
  const std::string bed = fmt::format("bed_{:g}_{}.txt", stress, seed);
  writeBed(folder / bed, layer.grains);

  const double unit = d * std::sqrt(soil.grains.density / stress); // [s]
  const double rate = cell.inertialNumber / unit, start = kPressed * unit;
  const double duration = start + cell.strain / rate, area = size.length * size.width;
  // Approximate height of the sample; the strain is relative to the actual height.
  const double height = cell.pressesIn ? layer.upper : top - 0.5 * d, drawn = rate * height;
  const std::string run = size.run() + (cell.pressesIn ? kEntry : "");
  const std::string text = soil.scene(duration, seed, soil.grains.friction, {0, 0, 0}, run) +
                           plateSections(d, layer, stress * area, cell.pressesIn ? 0 : kRamp * unit,
                                         fmt::format("velocity = [{:.17g}, 0, 0]\nstart = {:.17g}\n", drawn, start)) +
                           grainsSection(bed);
  coupling::Simulation simulation(setup::simulationSetup(setup::parseScene(text, folder / "shear.toml")), exec,
                                  [](double, double) {});
  std::filesystem::remove(folder / bed);

  jobs::Table table;
  table.names = kShearColumns;
  const auto all = static_cast<std::int64_t>(duration / simulation.timeStep());
  const auto begin = static_cast<std::int64_t>(start / simulation.timeStep());
  const double before = plateStress(simulation, area).height;
  double consolidated = before;
  for (int row = 0; row <= cell.rows; ++row) {
    const std::int64_t until = begin + (all - begin) * row / cell.rows;
    while (simulation.steps() < until) {
      jobs::stopStudyOnRequest();
      simulation.advance(std::min<std::int64_t>(until - simulation.steps(), 2000));
    }
    const PlateStress plates = plateStress(simulation, area);
    simulation.restartMeans();
    if (row == 0) consolidated = plates.height;
    const double low = kOffPlates * d, high = plates.height - kOffPlates * d;
    const CoreStress core = cell.core ? coreStress(*simulation.ground().grains, size, low, high) : CoreStress{};
    const double porosity = 1 - solidFraction(grainsOf(simulation, size), size, low, high);
    table.rows.push_back({drawn * std::max(0.0, simulation.time() - start) / consolidated, plates.shear, plates.normal,
                          plates.height / d, core.xx, core.zz, -core.xz, -core.zx, porosity, core.coordination,
                          drawn / plates.height * unit,
                          row == 0 ? 0 : shearedSpeed(simulation, d, plates.height) / drawn});
  }
  simulation.checkEnergy();
  return table;
}

double mohrCoulombAngle(double xx, double zz, double xz) {
  const double radius = std::hypot(0.5 * (xx - zz), xz), centre = 0.5 * (xx + zz);
  return std::asin(std::clamp(radius / centre, 0.0, 1.0));
}

ShearStrength shearStrength(const jobs::Table& run) {
  ShearStrength s;
  const std::size_t n = run.rows.size(), half = n / 2, window = std::max<std::size_t>(1, n / 20);
  s.normal = columnMean(run, "normal stress [Pa]", half, n), s.shear = columnMean(run, "shear stress [Pa]", half, n);
  s.residual = s.shear / s.normal;
  for (std::size_t k = 1; k + window <= n; ++k)
    s.peak = std::max(s.peak, columnMean(run, "shear stress [Pa]", k, k + window) /
                                  columnMean(run, "normal stress [Pa]", k, k + window));
  s.mohrCoulomb =
      mohrCoulombAngle(columnMean(run, "core xx [Pa]", half, n), columnMean(run, "core zz [Pa]", half, n),
                       0.5 * (columnMean(run, "core xz [Pa]", half, n) + columnMean(run, "core zx [Pa]", half, n)));
  s.porosityBefore = run.rows.front()[run.column("porosity [-]")];
  s.porosityAfter = columnMean(run, "porosity [-]", half, n);
  s.inertialNumber = columnMean(run, "inertial number [-]", half, n);
  s.sheared = columnMean(run, "sheared [-]", half, n);
  return s;
}

} // namespace grouser::virtual_tests
