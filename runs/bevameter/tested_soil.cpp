// SPDX-License-Identifier: BSD-3-Clause
#include "runs/bevameter/tested_soil.hpp"

#include "base/table.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/support/locations.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace grouser::bevameter {

namespace fs = std::filesystem;

namespace {

struct QuantityName {
  Quantity quantity;
  const char *symbol, *unit;
  const char* otherUnit; ///< that a file may also use
  double factor;         ///< from the other unit
};
constexpr std::array kNames = {QuantityName{Quantity::exponent, "n", "-", "", 1},
                               QuantityName{Quantity::cohesionModulus, "k_c", "kN/m^(n+1)", "N/m^(n+1)", 1e-3},
                               QuantityName{Quantity::frictionModulus, "k_phi", "kN/m^(n+2)", "N/m^(n+2)", 1e-3},
                               QuantityName{Quantity::cohesion, "c", "kPa", "Pa", 1e-3},
                               QuantityName{Quantity::frictionAngle, "phi", "deg", "rad", 57.29577951308232},
                               QuantityName{Quantity::shearModulus, "K", "mm", "m", 1e3},
                               QuantityName{Quantity::repose, "repose", "deg", "rad", 57.29577951308232}};

const QuantityName& nameOf(Quantity quantity) {
  return *std::find_if(kNames.begin(), kNames.end(), [&](const QuantityName& n) { return n.quantity == quantity; });
}

struct SoilText {
  std::string title, description;
};

struct BedKeys {
  double grainRadius = 0, spread = 0.25;
  std::optional<double> porosity;
  std::optional<std::array<double, 2>> calibrated;
};

struct PublishedKeys {
  std::string quantity, unit, source;
  double value = 0;
  std::optional<double> low, high;
};

struct ReachedKeys {
  std::string quantity, unit, command;
  double value = 0, halfWidth = 0, grainRadius = 0;
};

base::Table<SoilText> soilTable() {
  base::Table<SoilText> t("soil", "What it is");
  t.add("title", &SoilText::title, "", "in a few words");
  t.add("description", &SoilText::description, "", "in a few lines");
  return t;
}

base::Table<BedKeys> bedTable() {
  base::Table<BedKeys> t("bed", "Its grains as they lie");
  t.add("grain_radius", &BedKeys::grainRadius, "m", "mean radius that [material] is valid at")
      .above(0)
      .atMost(10)
      .required();
  t.add("radius_spread", &BedKeys::spread, "-", "radii are uniform within this share of the mean")
      .atLeast(0)
      .atMost(0.9);
  t.add("porosity", &BedKeys::porosity, "-", "of the bed").atLeast(0.2).atMost(0.7);
  t.add("calibrated_radii", &BedKeys::calibrated, "m", "smallest and largest mean radius that were tested").above(0);
  return t;
}

base::Table<PublishedKeys> publishedTable() {
  base::Table<PublishedKeys> t("published", "A number of a source");
  t.add("quantity", &PublishedKeys::quantity, "", "n, k_c, k_phi, c, phi, K or repose").required();
  t.add("value", &PublishedKeys::value, "", "in `unit`").required();
  t.add("unit", &PublishedKeys::unit, "", "of the value").required();
  t.add("source", &PublishedKeys::source, "", "where it stands").required();
  t.add("low", &PublishedKeys::low, "", "of the span");
  t.add("high", &PublishedKeys::high, "", "of the span");
  return t;
}

base::Table<ReachedKeys> reachedTable() {
  base::Table<ReachedKeys> t("reached", "A number that was measured here");
  t.add("quantity", &ReachedKeys::quantity, "", "what").required();
  t.add("value", &ReachedKeys::value, "", "in `unit`").required();
  t.add("half_width", &ReachedKeys::halfWidth, "", "of its 95 % interval");
  t.add("unit", &ReachedKeys::unit, "", "of the value").required();
  t.add("grain_radius", &ReachedKeys::grainRadius, "m", "it was measured with");
  t.add("command", &ReachedKeys::command, "", "that measured it");
  return t;
}

PublishedValue publishedValue(const base::Section& section) {
  const PublishedKeys k = section.read(publishedTable());
  const std::optional<Quantity> quantity = quantityOf(k.quantity);
  std::vector<std::string> symbols;
  for (const QuantityName& n : kNames) symbols.emplace_back(n.symbol);
  if (!quantity)
    section.fail("quantity", fmt::format("is no quantity of a bevameter; nearest is {}, all are {}",
                                         base::nearestWord(k.quantity, symbols), fmt::join(symbols, ", ")));
  const QuantityName& name = nameOf(*quantity);
  double factor = 1;
  if (k.unit == name.otherUnit)
    factor = name.factor;
  else if (k.unit != name.unit)
    section.fail("unit", fmt::format("is no unit of {}; write \"{}\"{}", k.quantity, name.unit,
                                     *name.otherUnit ? fmt::format(" or \"{}\"", name.otherUnit) : ""));
  if (k.low && k.high && *k.low > *k.high) section.fail("low", "is above high; exchange the two");
  PublishedValue value{*quantity, factor * k.value, {}, {}, k.source};
  if (k.low) value.low = factor * *k.low;
  if (k.high) value.high = factor * *k.high;
  return value;
}

/// How a number of [material] changes with the ratio of radii.
double scaled(const std::string& key, double value, double ratio) {
  for (const char* grows : {"stiffness", "cohesion", "surface_energy"})
    if (key == grows) return value * ratio;
  return key == "damping" ? value / ratio : value;
}

std::string tomlOf(const std::string& key, const base::Section& section, const base::Node& node, double ratio) {
  if (const auto* real = std::get_if<double>(&node.value)) return base::toToml(scaled(key, *real, ratio));
  if (const auto* whole = std::get_if<std::int64_t>(&node.value))
    return base::toToml(scaled(key, static_cast<double>(*whole), ratio));
  if (const auto* text = std::get_if<std::string>(&node.value)) return base::toToml(*text);
  if (const auto* flag = std::get_if<bool>(&node.value)) return base::toToml(*flag);
  section.fail(key, "is a list; keys of [material] are numbers, words or switches");
}

/// "soil.toml:14" -> 14; 0 where there is none.
std::size_t lineOf(const std::string& origin) {
  const std::size_t colon = origin.rfind(':');
  return colon == std::string::npos ? 0 : std::strtoul(origin.c_str() + colon + 1, nullptr, 10);
}

/// What a scene says of the material: read as one, each key in its own line of the file, so that errors name it.
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
  if (fs::path(nameOrFile).extension() == ".toml") return nameOrFile;
  const std::vector<std::string> names = soilNames();
  if (std::find(names.begin(), names.end(), nameOrFile) != names.end())
    return support::shareFolder() / "assets" / "soils" / (nameOrFile + ".toml");
  const std::string all =
      names.empty() ? fmt::format("there are none in {}", (support::shareFolder() / "assets" / "soils").string())
                    : fmt::format("the nearest is {}; there are {}", base::nearestWord(nameOrFile, names),
                                  fmt::join(names, ", "));
  throw base::InputError(fmt::format("soil {} is not known: {}; or give a file that ends in .toml", nameOrFile, all));
}

} // namespace

std::string symbolOf(Quantity quantity) { return nameOf(quantity).symbol; }
std::string unitOf(Quantity quantity) { return nameOf(quantity).unit; }

std::optional<Quantity> quantityOf(const std::string& symbol) {
  for (const QuantityName& n : kNames)
    if (symbol == n.symbol) return n.quantity;
  return {};
}

std::vector<std::string> soilNames() {
  std::vector<std::string> names;
  const fs::path folder = support::shareFolder() / "assets" / "soils";
  if (!fs::is_directory(folder)) return names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  return names;
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
  soil.law.clear();
  for (const auto& [name, text] : soil.keys)
    if (name != "density" && name != "friction") soil.law += name + " = " + text + "\n";
}

TestedSoil readMaterial(const base::Section& root, const std::string& key, const fs::path& file, double grainRadius) {
  TestedSoil soil;
  soil.name = file.stem(), soil.file = file;
  const BedKeys bed = root.section("bed").read(bedTable());
  soil.fileRadius = bed.grainRadius, soil.grainRadius = grainRadius > 0 ? grainRadius : bed.grainRadius;
  soil.spread = bed.spread, soil.porosity = bed.porosity;
  if (bed.calibrated) soil.calibratedFrom = (*bed.calibrated)[0], soil.calibratedTo = (*bed.calibrated)[1];
  if (soil.calibratedFrom > soil.calibratedTo)
    root.section("bed").fail("calibrated_radii", "begins above its end; exchange the two");
  const base::Section material = root.section(key);
  const scene::Material m = checkedMaterial(material, file.string());
  if (m.law == scene::ContactLawKind::hertz)
    soil.young = *m.young, soil.poisson = m.poisson.value_or(scene::Material::kPoisson);
  soil.isPlain = m.law == scene::ContactLawKind::linear && m.cohesion == 0;
  const double ratio = soil.grainRadius / soil.fileRadius;
  for (const base::Node::Entry& e : std::get<base::Node::Map>(material.node().value))
    soil.keys.emplace_back(e.key, tomlOf(e.key, material, e.node, ratio));
  // What is left to its default is written down: a stiffness would not scale.
  if (m.law == scene::ContactLawKind::linear && !material.has("stiffness"))
    setNumber(soil, "stiffness", ratio * *m.stiffness);
  setNumber(soil, "density", m.density), setNumber(soil, "friction", m.friction);
  return soil;
}

TestedSoil readTestedSoil(const std::string& nameOrFile, double grainRadius) {
  const fs::path file = fileOf(nameOrFile);
  const base::Document document = base::Document::load(file);
  const base::Section root = document.root();
  root.allowOnly({"version", "soil", "material", "bed", "published", "reached"});
  TestedSoil soil = readMaterial(root, "material", file, grainRadius);
  if (root.has("soil")) {
    const SoilText text = root.section("soil").read(soilTable());
    soil.title = text.title, soil.description = text.description;
  }
  for (const base::Section& p : root.list("published")) soil.published.push_back(publishedValue(p));
  for (const base::Section& r : root.list("reached")) r.read(reachedTable());
  return soil;
}

} // namespace grouser::bevameter
