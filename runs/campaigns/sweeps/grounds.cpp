// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/grounds.hpp"

#include "base/error.hpp"
#include "base/table.hpp"
#include "runs/campaigns/sweeps/overrides.hpp"
#include "runs/scene/soil.hpp"
#include "runs/scene/terrain_keys.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::sweeps {

namespace {

using base::InputError;
using base::Node;
using scene::TerrainKind;

constexpr const char* kScm = "scm";

const std::string* wordOf(const Node* section, const char* key) {
  const Node* node = section ? section->find(key) : nullptr;
  return node ? std::get_if<std::string>(&node->value) : nullptr;
}

/// Returns true if a material has constants of deformable soil: its name or its key `soil` is that of a soil file.
bool isSoil(const Node& root, const std::string& material, const std::filesystem::path& scene) {
  const Node* materials = root.find("material");
  const Node* own = materials ? materials->find(material) : nullptr;
  const std::string* of = wordOf(own, "soil");
  if (own && !of && own->origin != "--set") return false;
  std::vector<std::filesystem::path> tried;
  return !scene::findSoil(of ? *of : material, scene, tried).empty();
}

/// Throws InputError if the scene lacks a key that this kind of ground requires. The loader checks all other keys.
void requireKeys(const Node& root, const std::filesystem::path& scene, TerrainKind ground) {
  const Node& terrain = *root.find("terrain");
  const auto missing = [&](const char* key, const char* unit) {
    throw InputError(fmt::format("{}: granular ground requires terrain.{} [{}]; add --set terrain.{}=VALUE",
                                 scene.string(), key, unit, key));
  };
  if (ground == TerrainKind::granular) {
    const std::string* radii = wordOf(&terrain, "radius_distribution");
    if (!terrain.find("grain_radius") && !(radii && *radii == "sieve")) missing("grain_radius", "m");
    if (!terrain.find("depth") && !terrain.find("layers")) missing("depth", "m");
  }
  const std::string* material = wordOf(&terrain, "material");
  if (ground != TerrainKind::scm || !material || root.find(kScm) || isSoil(root, *material, scene)) return;
  throw InputError(
      fmt::format("{}: ground scm requires a soil, but terrain.material = \"{}\" is not one; add --set "
                  "terrain.material=SOIL (`grouser soils` lists them), or --set scm.n, k_c, k_phi, c, phi and K",
                  scene.string(), *material));
}

/// Paths of those keys of the scene that this kind of ground does not have.
std::vector<std::string> foreignKeys(const Node& root, TerrainKind ground) {
  std::vector<std::string> found;
  if (ground != TerrainKind::scm && root.find(kScm)) found.emplace_back(kScm);
  if (ground == TerrainKind::granular) return found;
  const Node* terrain = root.find("terrain");
  const auto look = [&](const char* key) {
    if (terrain && terrain->find(key)) found.push_back(fmt::format("terrain.{}", key));
  };
  std::for_each(scene::kBedKeys.begin(), scene::kBedKeys.end(), look);
  std::for_each(scene::kSieveKeys.begin(), scene::kSieveKeys.end(), look);
  return found;
}

/// Key that an override sets or removes.
std::string changedKey(const std::string& set) {
  const std::string word = keyOf(set);
  return word.substr(word.starts_with('~'));
}

/// Returns overrides that remove the keys `inFile` from the scene, followed by `sets` without the keys `inFile`,
/// `foreign` or any below them.
std::vector<std::string> without(const std::vector<std::string>& sets, const std::vector<std::string>& inFile,
                                 std::vector<std::string> foreign) {
  std::vector<std::string> all;
  foreign.insert(foreign.end(), inFile.begin(), inFile.end());
  for (const std::string& path : inFile) all.push_back("~" + path);
  for (const std::string& set : sets) {
    const std::string key = changedKey(set);
    if (std::none_of(foreign.begin(), foreign.end(),
                     [&](const std::string& path) { return key == path || key.starts_with(path + "."); }))
      all.push_back(set);
  }
  return all;
}

} // namespace

std::vector<std::string> contactOverrides(const std::filesystem::path& scene, const std::vector<std::string>& sets,
                                          scene::ContactMethod method) {
  const base::Document file = base::Document::load(scene);
  const Node& root = file.root().node();
  const Node* const run = root.find("run");
  const std::string* const named = wordOf(run, "contact");
  const std::string word(base::wordOf(method));
  std::vector<std::string> foreign, inFile;
  if (method == scene::ContactMethod::penalty) {
    foreign = {"run.residual", "complementarity"};
    if (run && run->find("residual")) inFile.emplace_back("run.residual");
    if (root.find("complementarity")) inFile.emplace_back("complementarity");
  } else if (!root.find("terrain") && !root.find("vehicle") && !root.find("body")) { // without any penalty contacts
    foreign = {"run.steps_per_contact"};
    if (run && run->find("steps_per_contact")) inFile.emplace_back("run.steps_per_contact");
  }
  std::vector<std::string> all = without(sets, inFile, foreign);
  const bool stepSet =
      std::any_of(sets.begin(), sets.end(), [](const std::string& set) { return changedKey(set) == "run.time_step"; });
  if (word != (named ? *named : base::wordOf(scene::ContactMethod::penalty)) && run && run->find("time_step") &&
      !stepSet)
    all.emplace_back("~run.time_step");
  putOverride(all, "run.contact=" + word);
  return all;
}

std::vector<std::string> groundOverrides(const std::filesystem::path& scene, const std::vector<std::string>& sets,
                                         TerrainKind ground) {
  const base::Document file = base::Document::load(scene), changed = base::Document::load(scene, sets);
  const Node& root = changed.root().node();
  if (const Node* terrain = root.find("terrain"); !terrain || !terrain->isMap())
    throw InputError(fmt::format("{}: [terrain] is missing; add it to choose a ground", scene.string()));
  requireKeys(root, scene, ground);
  const std::vector<std::string> inFile = foreignKeys(file.root().node(), ground);
  std::vector<std::string> all = without(sets, inFile, foreignKeys(root, ground));
  putOverride(all, fmt::format("terrain.kind=\"{}\"", base::wordOf(ground)));
  return all;
}

std::vector<std::string> groundOverrides(const std::filesystem::path& scene, const SweepLists& lists,
                                         const std::vector<std::string>& fixed, TerrainKind ground) {
  std::vector<std::string> sets = fixed, swept;
  for (const std::string& list : lists.sets) {
    const std::size_t equals = equalsSign(list);
    if (equals == std::string::npos) continue; // planSweep() reports it
    if (keyOf(list) == "terrain.kind")
      throw InputError("--set terrain.kind: mutually exclusive with --ground; remove one");
    swept.push_back(list.substr(0, equals + 1) + splitValues(std::string_view(list).substr(equals + 1)).front());
  }
  sets.insert(sets.end(), swept.begin(), swept.end());
  std::vector<std::string> all = groundOverrides(scene, sets, ground);
  std::erase_if(all, [&](const std::string& o) { return std::find(swept.begin(), swept.end(), o) != swept.end(); });
  return all;
}

} // namespace grouser::sweeps
