// SPDX-License-Identifier: BSD-3-Clause
#include "runs/scene/detail/soil_materials.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace grouser::scene::detail {

namespace fs = std::filesystem;

using base::Node;
using base::Section;

namespace {

/// A material's name, and the place in the file that mentions it.
struct Mention {
  std::string name, origin;
};

/// All material names that a scene mentions, section by section.
std::vector<Mention> mentionedMaterials(const Section& root) {
  std::vector<Mention> all;
  const auto addKey = [&](const Node& section, const char* key) {
    const Node* node = section.find(key);
    if (const auto* name = node ? std::get_if<std::string>(&node->value) : nullptr)
      all.push_back({*name, node->origin});
  };
  for (const char* kind : {"grain", "grains", "source", "plane", "box", "cylinder", "mesh"})
    if (const Node* list = root.node().find(kind); list && list->isList())
      for (const Node& section : std::get<Node::List>(list->value)) addKey(section, "material");
  if (const Node* terrain = root.node().find("terrain"))
    addKey(*terrain, "material"), addKey(*terrain, "ground_material");
  if (const Node* vehicle = root.node().find("vehicle")) addKey(*vehicle, "material");
  if (const Node* pairs = root.node().find("contact"); pairs && pairs->isMap())
    for (const Node::Entry& pair : std::get<Node::Map>(pairs->value))
      if (const std::size_t bar = pair.key.find('|'); bar != std::string::npos) {
        all.push_back({pair.key.substr(0, bar), pair.node.origin});
        all.push_back({pair.key.substr(bar + 1), pair.node.origin});
      }
  return all;
}

/// Returns true for keys of a material that apply to every law.
bool isOfAnyLaw(const std::string& key) {
  constexpr const char* kAny[] = {"density",  "restitution",      "attraction",
                                  "friction", "rolling_friction", "rolling_damping_ratio",
                                  "cohesion", "adhesion_radius",  "crushing_strength"};
  return std::find(std::begin(kAny), std::end(kAny), key) != std::end(kAny);
}

/// "14 mm".
std::string millimetres(double radius) { return fmt::format("{:.4g} mm", 1000 * radius); }

/// Radius of a material's grains [m]; the radius of a bed has precedence. Throws InputError if they have no common
/// radius.
double radiusOfGrains(const Scene& scene, const Material& m) {
  const auto& t = scene.terrain;
  if (t && t->granular() && t->material == m.name) return *t->grainRadius;
  if (t && !t->granular() && t->material == m.name) return scene.soils.at(m.name)->grains.radius; // there are no grains
  std::vector<double> radii;
  for (const Grain& g : scene.grains)
    if (g.material == m.name) radii.push_back(g.radius);
  for (const GrainFill& fill : scene.fills) {
    if (fill.material != m.name) continue;
    if (fill.radius) radii.push_back(0.5 * (*fill.radius + fill.radiusTo.value_or(*fill.radius)));
    for (const Grain& g : fill.fromFile) radii.push_back(g.radius);
  }
  for (const Source& s : scene.sources)
    if (s.material == m.name) radii.push_back(s.radius);
  const std::string remedy = fmt::format("but the soil's stiffness and cohesion depend on the grain radius; add "
                                         "grain_radius = {:g} to [material.{}] with soil = \"{}\"",
                                         radii.empty() ? scene.soils.at(m.name)->grains.radius : radii.front(), m.name,
                                         scene.soils.at(m.name)->name);
  if (radii.empty())
    scene.failMaterial(m.name, "grain_radius", "[m] is missing: the scene has no grains of this soil, " + remedy);
  const auto [least, greatest] = std::minmax_element(radii.begin(), radii.end());
  if (*greatest - *least > 1e-9 * *greatest)
    scene.failMaterial(m.name, "grain_radius",
                       fmt::format("[m] is missing: grains of this soil have radii from {} to {}, {}",
                                   millimetres(*least), millimetres(*greatest), remedy));
  return radii.front();
}

double power(double base, int exponent) {
  double result = 1;
  for (int k = 0; k < std::abs(exponent); ++k) result *= base;
  return exponent < 0 ? 1 / result : result;
}

void multiply(double& value, double by) { value *= by; }
void multiply(std::optional<double>& value, double by) {
  if (value) *value *= by;
}

/// True if a soil has this name. An unusable soil file counts, and is an error where its section is read.
bool namesSoil(const std::string& name, const fs::path& scene) {
  std::vector<fs::path> tried;
  try {
    return name.find('/') == std::string::npos && !findSoil(name, scene, tried).empty();
  } catch (const base::InputError&) {
    return true;
  }
}

} // namespace

void supplySoils(base::Document& document, const fs::path& scene) {
  for (const Mention& mention : mentionedMaterials(document.root())) {
    const Node* materials = document.root().node().find("material");
    const Node* own = materials ? materials->find(mention.name) : nullptr;
    if (own && own->origin != "--set") continue; // the scene file has its own section
    if (!namesSoil(mention.name, scene)) continue;
    // A section that only overrides define counts as a mistyped name.
    const std::string origin = mention.origin == "--set" ? "--set, as a material" : mention.origin;
    document.supply("material", mention.name, "soil", mention.name, origin);
  }
}

const Soil* soilOf(const Section& section, const std::string& name, Scene& scene) {
  const Node* node = section.node().find("soil");
  const auto* word = node ? std::get_if<std::string>(&node->value) : nullptr;
  if (!word) return nullptr;
  std::vector<fs::path> tried;
  fs::path file;
  try {
    file = findSoil(*word, scene.file, tried);
  } catch (const base::InputError& error) { // a folder or FIFO of this name
    section.fail("soil", fmt::format("cannot be used: {}", error.what()));
  }
  if (file.empty()) {
    std::string places;
    for (const fs::path& p : tried) places += (places.empty() ? "" : ", ") + p.string();
    section.fail("soil", fmt::format("is not a known soil; {}{}", soilHint(*word, scene.file),
                                     places.empty() ? "" : fmt::format("; searched {}", places)));
  }
  auto& kept = scene.soils[name];
  kept = std::make_shared<const Soil>(readSoil(file));
  return kept.get();
}

Material materialOf(const Soil& soil, const Section& section) {
  const base::Table<Material> table = materialTable();
  Node said = soil.document->root().section("material").node();
  auto& entries = std::get<Node::Map>(said.value);
  const Node* law = section.node().find("law");
  const auto* word = law ? std::get_if<std::string>(&law->value) : nullptr;
  if (word && *word != base::wordOf(soil.material.law))
    std::erase_if(entries, [](const Node::Entry& e) { return !isOfAnyLaw(e.key); });
  for (const auto& [one, other] : {std::pair{"damping", "restitution"}, {"restitution", "damping"}})
    if (section.has(one)) std::erase_if(entries, [&, key = other](const Node::Entry& e) { return e.key == key; });
  Material m;
  table.read(said, "material", m);
  return m;
}

void scaleSoils(Scene& scene) {
  for (const auto& [name, section] : scene.document->root().named("material")) {
    const auto found = std::find_if(scene.materials.begin(), scene.materials.end(),
                                    [&, word = name](const Material& m) { return m.name == word; });
    Material& m = *found;
    if (m.soil.empty()) continue;
    if (!m.grainRadius) m.grainRadius = radiusOfGrains(scene, m);
    const double scale = *m.grainRadius / scene.soils.at(m.name)->grains.radius;
    forEachScaled(m, [&, given = section](const char* key, const char*, auto& value, int exponent) {
      if (!given.has(key)) multiply(value, power(scale, exponent));
    });
  }
}

} // namespace grouser::scene::detail

namespace grouser::scene {

int radiusPowerOf(const std::string& key) {
  int power = 0;
  detail::forEachScaled(Material{}, [&](const char* name, const char*, const auto&, int exponent) {
    if (key == name) power = exponent;
  });
  return power;
}

} // namespace grouser::scene
