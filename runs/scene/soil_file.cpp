// SPDX-License-Identifier: BSD-3-Clause
// Reads soil files and finds them by name.
#include "runs/scene/soil.hpp"

#include "base/name_fault.hpp"
#include "base/nearest_key.hpp"
#include "base/table.hpp"
#include "runs/scene/detail/soil_materials.hpp"
#include "runs/support/file_hash.hpp"
#include "runs/support/locations.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grouser::scene {

namespace fs = std::filesystem;

using base::Section;
using base::Table;

namespace {

constexpr double kWidest = 1e15; // maximum magnitude of a constant in SI units

Table<SoilHead> headTable() {
  using S = SoilHead;
  Table<S> t("soil", "Title and description of the soil");
  t.add("title", &S::title, "", "short title").required();
  t.add("description", &S::description, "", "description of the soil model and its limits").required();
  t.add("calibrated", &S::calibrated, "",
        "whether [material] was calibrated by virtual tests (results in [[reached]]); runs on an uncalibrated soil "
        "print a note");
  return t;
}

Table<SoilGrains> grainsTable() {
  using S = SoilGrains;
  Table<S> t("bed", "Grain size for which [material] is valid, and arrangement of the bed");
  t.add("grain_radius", &S::radius, "m", "median radius of the distribution for which [material] is valid")
      .plausible(1e-6, 0.5)
      .above(0)
      .atMost(10)
      .required();
  t.add("radius_spread", &S::radiusSpread, "-", "half width of the uniform radius distribution / grain_radius")
      .above(0)
      .atMost(0.9);
  t.add("porosity", &S::porosity, "-", "porosity of a random bed; default: as poured").atLeast(0.2).atMost(0.7);
  t.add("calibrated_radii", &S::calibratedRadii, "m",
        "minimum and maximum grain_radius of the measurements; default: grain_radius")
      .plausible(1e-6, 0.5)
      .above(0)
      .atMost(10);
  return t;
}

Table<PublishedConstant> publishedTable() {
  using S = PublishedConstant;
  Table<S> t("[published]", "Published constant of the soil; one section per constant");
  t.add("quantity", &S::quantity, "",
        "constant in p = (k_c / b + k_phi) z^n under a plate of width b, or in tau = (c + p tan phi) (1 - exp(-j / K))")
      .required();
  t.add("value", &S::value, "", "value, in the unit of the key unit").atLeast(-kWidest).atMost(kWidest).required();
  t.add("unit", &S::unit, "", "unit of the quantity: N/m^(n+1), N/m^(n+2), Pa, deg, m, kg/m3 or -").required();
  t.add("source", &S::source, "", "author, year and location in the publication").required();
  t.add("low", &S::low, "", "minimum of the values of several sources").atLeast(-kWidest).atMost(kWidest);
  t.add("high", &S::high, "", "maximum of the values of several sources").atLeast(-kWidest).atMost(kWidest);
  return t;
}

Table<ReachedConstant> reachedTable() {
  using S = ReachedConstant;
  Table<S> t("[reached]", "Constant measured in virtual tests with [material]; one section per constant");
  t.add("quantity", &S::quantity, "", "as in [[published]]").required();
  t.add("value", &S::value, "", "value, in the unit of the key unit").atLeast(-kWidest).atMost(kWidest).required();
  t.add("half_width", &S::halfWidth, "", "half width of the 95 % confidence interval of value")
      .atLeast(0)
      .atMost(kWidest)
      .required();
  t.add("unit", &S::unit, "", "as in [[published]]").required();
  t.add("grain_radius", &S::grainRadius, "m", "grain radius of the measurement")
      .plausible(1e-6, 0.5)
      .above(0)
      .atMost(10)
      .required();
  t.add("command", &S::command, "", "command that measured the constant").required();
  return t;
}

/// Field of a scene with the usual span of a constant.
base::Field fieldOf(SoilQuantity quantity) {
  const bool ofGrains = quantity == SoilQuantity::grainDensity;
  const std::string key = quantity == SoilQuantity::reposeAngle        ? "repose_angle"
                          : quantity == SoilQuantity::unloadingModulus ? "unloading_stiffness"
                          : ofGrains                                   ? "density"
                                                                       : std::string(base::wordOf(quantity));
  for (base::Field field : ofGrains ? detail::materialTable().fields() : detail::scmTable().fields()) {
    if (field.key != key) continue;
    field.min = -kWidest, field.max = kWidest; // [[published]] has its own range
    return field;
  }
  return {};
}

template <class Constant> void checkConstant(const Section& section, const Constant& c) {
  for (const char* key : {"value", "low", "high"})
    section.noteIfUnusual(key, fieldOf(c.quantity),
                          fmt::format("{}.{} of {}", section.path(), key, base::wordOf(c.quantity)));
  if (c.unit != unitOf(c.quantity))
    section.fail("unit", fmt::format("does not match quantity = \"{}\"; set value in {} and unit = \"{}\"",
                                     base::wordOf(c.quantity), unitOf(c.quantity), unitOf(c.quantity)));
}

void checkPublished(const Section& section, const PublishedConstant& c) {
  checkConstant(section, c);
  if (c.low && *c.low > c.value) section.fail("low", "exceeds value; set the minimum of the sources");
  if (c.high && *c.high < c.value) section.fail("high", "is below value; set the maximum of the sources");
}

/// Reads [material] of a soil file, which may have all keys of a material but soil, soil_hash and grain_radius.
Material readMaterial(const Section& section) {
  for (const char* key : {"soil", "soil_hash", "grain_radius"})
    if (section.has(key))
      section.fail(key, "is a key of scene files only; remove it (a soil file has grain_radius in [bed])");
  Material m = section.read(detail::materialTable());
  detail::completeMaterial(section, m);
  return m;
}

std::vector<std::string> soilKeys() {
  std::vector<std::string> all;
  const auto add = [&](const std::string& section, const auto& table) {
    for (const base::Field& field : table.fields()) all.push_back(section + "." + field.key);
  };
  add("soil", headTable()), add("material", detail::materialTable()), add("bed", grainsTable());
  return all;
}

} // namespace

std::string unitOf(SoilQuantity quantity) {
  switch (quantity) {
  case SoilQuantity::exponent:
  case SoilQuantity::porosity:
    return "-";
  case SoilQuantity::cohesiveModulus:
    return "N/m^(n+1)";
  case SoilQuantity::frictionalModulus:
    return "N/m^(n+2)";
  case SoilQuantity::cohesion:
    return "Pa";
  case SoilQuantity::frictionAngle:
  case SoilQuantity::reposeAngle:
    return "deg";
  case SoilQuantity::shearModulus:
    return "m";
  case SoilQuantity::bulkDensity:
  case SoilQuantity::grainDensity:
    return "kg/m3";
  case SoilQuantity::unloadingModulus:
    return "N/m3";
  }
  return "";
}

Soil readSoil(const fs::path& file) {
  Soil soil;
  soil.name = file.stem().string(), soil.file = file;
  if (const std::string fault = base::textFault(soil.name, base::kLongestName); !fault.empty())
    throw base::InputError(fmt::format("{}: the name of a soil file {}", file.string(), fault));
  soil.document = std::make_shared<const base::Document>(base::Document::load(file));
  soil.hash = support::hashOfFile(file);
  const Section root = soil.document->root();
  try {
    root.allowOnly({"version", "soil", "material", "bed", "published", "reached"});
    soil.head = root.section("soil").read(headTable());
    soil.material = readMaterial(root.section("material"));
    soil.grains = root.section("bed").read(grainsTable());
  } catch (const base::UnknownKey& unknown) {
    throw base::amongAllKeys(unknown, soilKeys());
  }
  const Section bed = root.section("bed");
  if (!bed.has("calibrated_radii")) soil.grains.calibratedRadii = {soil.grains.radius, soil.grains.radius};
  const auto [least, greatest] = soil.grains.calibratedRadii;
  if (least > greatest) bed.fail("calibrated_radii", "[m] must be [min, max]; swap the radii");
  if (soil.grains.radius < least || soil.grains.radius > greatest)
    bed.fail("calibrated_radii", fmt::format("[m] does not include grain_radius = {:g}; widen it", soil.grains.radius));
  for (const Section& section : root.list("published")) {
    soil.published.push_back(section.read(publishedTable()));
    checkPublished(section, soil.published.back());
  }
  for (const Section& section : root.list("reached")) {
    soil.reached.push_back(section.read(reachedTable()));
    checkConstant(section, soil.reached.back());
  }
  if (soil.head.calibrated && soil.reached.empty())
    root.section("soil").fail("calibrated",
                              "is true, but the file has no measured constants; add [[reached]], or set it to false");
  return soil;
}

fs::path findSoil(const std::string& word, const fs::path& scene, std::vector<fs::path>& tried) {
  const bool isPath = word.find('/') != std::string::npos || fs::path(word).extension() == ".toml";
  return support::findInput(isPath || word.empty() ? word : "soils/" + word + ".toml", scene, tried);
}

std::map<std::string, fs::path> knownSoils(const fs::path& scene) {
  std::map<std::string, fs::path> known;
  for (const fs::path& folder : support::inputFolders(scene)) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / "soils", error))
      if (entry.path().extension() == ".toml" && entry.is_regular_file(error))
        known.emplace(entry.path().stem().string(), fs::weakly_canonical(entry.path(), error));
  }
  return known;
}

std::string soilHint(const std::string& word, const fs::path& scene) {
  std::vector<std::string> names;
  for (const auto& [name, file] : knownSoils(scene)) names.push_back(name);
  if (names.empty()) return "no soils found in soils/ beside the scene or in assets/soils";
  return fmt::format("did you mean \"{}\"? (soils: {})", base::nearestWord(word, names), fmt::join(names, ", "));
}

std::string soilFieldHelp() {
  return "## Keys of a soil file\n\nEvery file begins with `version = 1`. Its `[material]` has the keys of a scene's "
         "`[material.NAME]` except\n`soil`, `soil_hash` and `grain_radius`. See [soils.md](soils.md).\n\n" +
         base::describe(headTable()) + "\n" + base::describe(grainsTable()) + "\n" + base::describe(publishedTable()) +
         "\n" + base::describe(reachedTable());
}

} // namespace grouser::scene
