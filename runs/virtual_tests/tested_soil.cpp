// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/tested_soil.hpp"

#include "base/table.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/scene/soil.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace grouser::virtual_tests {

namespace fs = std::filesystem;

namespace {

struct QuantityName {
  Quantity quantity;
  const char *symbol, *unit;
  double perUnit; ///< value in `unit` / value in the SI unit of soil files
};
constexpr std::array kNames = {QuantityName{Quantity::exponent, "n", "-", 1},
                               QuantityName{Quantity::cohesionModulus, "k_c", "kN/m^(n+1)", 1e-3},
                               QuantityName{Quantity::frictionModulus, "k_phi", "kN/m^(n+2)", 1e-3},
                               QuantityName{Quantity::cohesion, "c", "kPa", 1e-3},
                               QuantityName{Quantity::frictionAngle, "phi", "deg", 1},
                               QuantityName{Quantity::shearModulus, "K", "mm", 1e3},
                               QuantityName{Quantity::repose, "repose", "deg", 1}};

const QuantityName& nameOf(Quantity quantity) {
  return *std::find_if(kNames.begin(), kNames.end(), [&](const QuantityName& n) { return n.quantity == quantity; });
}

struct BedKeys {
  double grainRadius = 0, spread = 0.25;
  std::optional<double> porosity;
  std::optional<std::array<double, 2>> calibrated;
};

base::Table<BedKeys> bedTable() {
  base::Table<BedKeys> t("bed", "Bed of the soil");
  t.add("grain_radius", &BedKeys::grainRadius, "m", "mean grain radius for which [material] is valid")
      .above(0)
      .atMost(10)
      .required();
  t.add("radius_spread", &BedKeys::spread, "-", "half width of the uniform distribution of grain radii / mean radius")
      .atLeast(0)
      .atMost(0.9);
  t.add("porosity", &BedKeys::porosity, "-", "porosity of the bed").atLeast(0.2).atMost(0.7);
  t.add("calibrated_radii", &BedKeys::calibrated, "m", "smallest and largest mean radius with a calibration").above(0);
  return t;
}

/// Converts a constant of a soil file from SI units; empty if the bevameter does not measure this quantity.
std::optional<PublishedValue> publishedValue(const scene::PublishedConstant& c) {
  const std::optional<Quantity> quantity = quantityOf(std::string(base::wordOf(c.quantity)));
  if (!quantity) return {};
  const double factor = nameOf(*quantity).perUnit;
  PublishedValue value{*quantity, factor * c.value, {}, {}, c.source};
  if (c.low) value.low = factor * *c.low;
  if (c.high) value.high = factor * *c.high;
  return value;
}

/// TOML text of a key of [material], scaled by the ratio of the grain radii.
double scaled(const std::string& key, double value, double ratio) {
  const int power = scene::radiusPowerOf(key);
  return power > 0 ? value * ratio : power < 0 ? value / ratio : value;
}

std::string tomlOf(const std::string& key, const base::Section& section, const base::Node& node, double ratio) {
  if (const auto* real = std::get_if<double>(&node.value)) return base::toToml(scaled(key, *real, ratio));
  if (const auto* whole = std::get_if<std::int64_t>(&node.value))
    return base::toToml(scaled(key, static_cast<double>(*whole), ratio));
  if (const auto* text = std::get_if<std::string>(&node.value)) return base::toToml(*text);
  if (const auto* flag = std::get_if<bool>(&node.value)) return base::toToml(*flag);
  section.fail(key, "is a list, but keys of [material] must be numbers, words or booleans");
}

/// "soil.toml:14" -> 14; 0 if the origin has no line number.
std::size_t lineOf(const std::string& origin) {
  const std::size_t colon = origin.rfind(':');
  return colon == std::string::npos ? 0 : std::strtoul(origin.c_str() + colon + 1, nullptr, 10);
}

/// Checks the material as part of a scene. Each key is put in its original line, so that error messages are correct.
scene::Material checkedMaterial(const base::Section& section, const std::string& file) {
  std::vector<std::string> lines{"version = 1"};
  const auto put = [&](std::size_t line, const std::string& text) {
    if (lines.size() < line) lines.resize(line);
    lines[line - 1] += (lines[line - 1].empty() ? "" : " ") + text;
  };
  put(std::max<std::size_t>(2, lineOf(section.origin())), "[material.soil]");
  for (const base::Node::Entry& e : std::get<base::Node::Map>(section.node().value))
    put(lineOf(e.node.origin), e.key + " = " + tomlOf(e.key, section, e.node, 1));
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  text += "[run]\nduration = 1\n[[grain]]\nposition = [0, 0, 1]\nradius = 0.01\nmaterial = \"soil\"\n";
  return scene::readSceneText(text, file).materials.front();
}

fs::path fileOf(const std::string& nameOrFile) {
  std::vector<fs::path> tried;
  fs::path file = scene::findSoil(nameOrFile, "", tried);
  if (!file.empty()) return file;
  throw base::InputError(
      fmt::format("unknown soil {}; {}; or specify a soil file (.toml)", nameOrFile, scene::soilHint(nameOrFile, "")));
}

/// Copies the keys of a checked material, and sets the values derived from them.
void takeMaterial(const base::Section& section, const scene::Material& m, TestedSoil& soil) {
  if (m.hertzian()) soil.young = *m.young, soil.poisson = m.poisson.value_or(scene::Material::kPoisson);
  soil.isPlain = m.law == contact::LawKind::linear && m.cohesion == 0;
  const double ratio = soil.grainRadius / soil.fileRadius;
  for (const base::Node::Entry& e : std::get<base::Node::Map>(section.node().value))
    soil.keys.emplace_back(e.key, tomlOf(e.key, section, e.node, ratio));
  // Store the defaults explicitly, because a default stiffness would not be scaled with the grain radius.
  if (!m.hertzian() && !section.has("stiffness")) setNumber(soil, "stiffness", ratio * *m.stiffness);
  setNumber(soil, "density", m.density), setNumber(soil, "friction", m.friction);
}

} // namespace

std::string symbolOf(Quantity quantity) { return nameOf(quantity).symbol; }
std::string unitOf(Quantity quantity) { return nameOf(quantity).unit; }

double inSoilFile(Quantity quantity, double value) { return value / nameOf(quantity).perUnit; }
std::string soilFileUnitOf(Quantity quantity) {
  return scene::unitOf(*base::valueOf<scene::SoilQuantity>(symbolOf(quantity)));
}

std::optional<Quantity> quantityOf(const std::string& symbol) {
  for (const QuantityName& n : kNames)
    if (symbol == n.symbol) return n.quantity;
  return {};
}

double numberOf(const TestedSoil& soil, const std::string& key, double otherwise) {
  for (const auto& [name, text] : soil.keys)
    if (name == key) return std::strtod(text.c_str(), nullptr);
  return otherwise;
}

void setNumber(TestedSoil& soil, const std::string& key, double value) {
  const auto found = std::find_if(soil.keys.begin(), soil.keys.end(), [&](const auto& k) { return k.first == key; });
  if (found != soil.keys.end())
    found->second = base::toToml(value);
  else
    soil.keys.emplace_back(key, base::toToml(value));
  soil.density = numberOf(soil, "density", soil.density), soil.friction = numberOf(soil, "friction", soil.friction);
  if (soil.young > 0) soil.young = numberOf(soil, "young", soil.young);
  if (key == "cohesion") soil.isPlain = soil.isPlain && value == 0;
  soil.law.clear(), soil.lawWithoutPull.clear();
  bool holds = false, grows = false;
  for (const auto& [name, text] : soil.keys) {
    if (name == "density" || name == "friction") continue;
    const bool pulls = name == "cohesion" || name == "surface_energy" || name == "adhesion_stiffness";
    soil.law += name + " = " + text + "\n";
    if (!pulls) soil.lawWithoutPull += name + " = " + text + "\n";
    holds = holds || (pulls && numberOf(soil, name, 0) > 0), grows = grows || name == "adhesion_radius";
  }
  soil.isOneAtAllSizes = soil.young > 0 && (!holds || grows);
}

TestedSoil readMaterial(const base::Section& root, const std::string& key, const fs::path& file, double grainRadius) {
  TestedSoil soil;
  soil.name = file.stem(), soil.file = file;
  const BedKeys bed = root.section("bed").read(bedTable());
  soil.fileRadius = bed.grainRadius, soil.grainRadius = grainRadius > 0 ? grainRadius : bed.grainRadius;
  soil.spread = bed.spread, soil.porosity = bed.porosity;
  if (bed.calibrated) soil.calibratedFrom = (*bed.calibrated)[0], soil.calibratedTo = (*bed.calibrated)[1];
  if (soil.calibratedFrom > soil.calibratedTo) root.section("bed").fail("calibrated_radii", "must be [min, max]");
  const base::Section material = root.section(key);
  takeMaterial(material, checkedMaterial(material, file.string()), soil);
  return soil;
}

TestedSoil readTestedSoil(const std::string& nameOrFile, double grainRadius) {
  const scene::Soil read = scene::readSoil(fileOf(nameOrFile));
  TestedSoil soil;
  soil.name = read.name, soil.file = read.file, soil.title = read.head.title, soil.description = read.head.description;
  soil.fileRadius = read.grains.radius, soil.grainRadius = grainRadius > 0 ? grainRadius : read.grains.radius;
  soil.spread = read.grains.radiusSpread, soil.porosity = read.grains.porosity;
  soil.calibratedFrom = read.grains.calibratedRadii[0], soil.calibratedTo = read.grains.calibratedRadii[1];
  takeMaterial(read.document->root().section("material"), read.material, soil);
  for (const scene::PublishedConstant& c : read.published)
    if (const std::optional<PublishedValue> value = publishedValue(c)) soil.published.push_back(*value);
  return soil;
}

} // namespace grouser::virtual_tests
