// SPDX-License-Identifier: BSD-3-Clause
// Reads the files of soils, and finds them by name.
#include "runs/scene/soil.hpp"

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

constexpr double kWidest = 1e15; // of a constant in SI

Table<SoilHead> headTable() {
  using S = SoilHead;
  Table<S> t("soil", "What the soil is");
  t.add("title", &S::title, "", "in a few words").required();
  t.add("description", &S::description, "", "what stands for it, and what that cannot do").required();
  t.add("calibrated", &S::calibrated, "",
        "whether [material] has been found by measuring what it gives, which [[reached]] then says; a run on a soil "
        "that is not says so");
  return t;
}

Table<SoilGrains> grainsTable() {
  using S = SoilGrains;
  Table<S> t("bed", "The grains that [material] is meant for, and how they lie");
  t.add("grain_radius", &S::radius, "m", "in the middle of the distribution, at which [material] holds")
      .above(0)
      .atMost(10)
      .required();
  t.add("radius_spread", &S::radiusSpread, "-", "half the width of the uniform distribution over grain_radius")
      .above(0)
      .atMost(0.9);
  t.add("porosity", &S::porosity, "-", "of a bed at random; as poured where not given").atLeast(0.2).atMost(0.7);
  t.add("calibrated_radii", &S::calibratedRadii, "m",
        "least and greatest grain_radius at which it has been measured; its own where not given")
      .above(0)
      .atMost(10);
  return t;
}

Table<PublishedConstant> publishedTable() {
  using S = PublishedConstant;
  Table<S> t("[published]", "A constant of the soil that has been published; as many as there are");
  t.add("quantity", &S::quantity, "",
        "p = (k_c / b + k_phi) z^n under a plate of width b; tau = (c + p tan phi) (1 - exp(-j / K))")
      .required();
  t.add("value", &S::value, "", "in unit").atLeast(-kWidest).atMost(kWidest).required();
  t.add("unit", &S::unit, "", "N/m^(n+1), N/m^(n+2), Pa, deg, m, kg/m3, -: as the quantity has it").required();
  t.add("source", &S::source, "", "author, year, and where it stands").required();
  t.add("low", &S::low, "", "least of several sources").atLeast(-kWidest).atMost(kWidest);
  t.add("high", &S::high, "", "greatest of several sources").atLeast(-kWidest).atMost(kWidest);
  return t;
}

Table<ReachedConstant> reachedTable() {
  using S = ReachedConstant;
  Table<S> t("[reached]", "A constant that [material] was measured to give; as many as there are");
  t.add("quantity", &S::quantity, "", "as of [[published]]").required();
  t.add("value", &S::value, "", "in unit").atLeast(-kWidest).atMost(kWidest).required();
  t.add("half_width", &S::halfWidth, "", "of its 95 % interval").atLeast(0).atMost(kWidest).required();
  t.add("unit", &S::unit, "", "as of [[published]]").required();
  t.add("grain_radius", &S::grainRadius, "m", "at which it was measured").above(0).atMost(10).required();
  t.add("command", &S::command, "", "that measured it").required();
  return t;
}

template <class Constant> void checkUnit(const Section& section, const Constant& c) {
  if (c.unit != unitOf(c.quantity))
    section.fail("unit", fmt::format("is not that of quantity = \"{}\"; give the value in {} and unit = \"{}\"",
                                     base::wordOf(c.quantity), unitOf(c.quantity), unitOf(c.quantity)));
}

void checkPublished(const Section& section, const PublishedConstant& c) {
  checkUnit(section, c);
  if (c.low && *c.low > c.value) section.fail("low", "is above value; give the least of the sources");
  if (c.high && *c.high < c.value) section.fail("high", "is below value; give the greatest of the sources");
}

/// What [material] of a soil's file may hold: all but what says which soil a scene's material is of.
Material readMaterial(const Section& section) {
  for (const char* key : {"soil", "soil_hash", "grain_radius"})
    if (section.has(key))
      section.fail(key,
                   "belongs to a scene, whose material is a soil; remove it: a soil's file has [bed] grain_radius");
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
  if (least > greatest) bed.fail("calibrated_radii", "[m] descends; give the least first");
  if (soil.grains.radius < least || soil.grains.radius > greatest)
    bed.fail("calibrated_radii", fmt::format("[m] does not hold grain_radius = {:g}, at which [material] is meant to "
                                             "hold; widen it",
                                             soil.grains.radius));
  for (const Section& section : root.list("published")) {
    soil.published.push_back(section.read(publishedTable()));
    checkPublished(section, soil.published.back());
  }
  for (const Section& section : root.list("reached")) {
    soil.reached.push_back(section.read(reachedTable()));
    checkUnit(section, soil.reached.back());
  }
  if (soil.head.calibrated && soil.reached.empty())
    root.section("soil").fail("calibrated", "has nothing behind it: no [[reached]] says what was measured; add that, "
                                            "or set it to false");
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
  if (names.empty()) return "there are none in soils/ beside the scene or in assets/soils";
  return fmt::format("did you mean \"{}\"? (soils: {})", base::nearestWord(word, names), fmt::join(names, ", "));
}

std::string soilFieldHelp() {
  return "## Keys of a soil's file\n\nEvery file begins with `version = 1`. Its `[material]` has the keys of a scene's "
         "`[material.NAME]`, but for\n`soil`, `soil_hash` and `grain_radius`. What the file is for: "
         "[soils.md](soils.md)."
         "\n\n" +
         base::describe(headTable()) + "\n" + base::describe(grainsTable()) + "\n" + base::describe(publishedTable()) +
         "\n" + base::describe(reachedTable());
}

} // namespace grouser::scene
