// SPDX-License-Identifier: BSD-3-Clause
#include "runs/scene/scene_file.hpp"

#include "base/nearest_key.hpp"
#include "base/table.hpp"
#include "runs/scene/detail/section_checks.hpp"
#include "runs/scene/detail/section_lists.hpp"
#include "runs/scene/detail/soil_materials.hpp"
#include "runs/scene/soil.hpp"
#include "runs/scene/soil_calibration.hpp"
#include "runs/support/locations.hpp"
#include "runs/support/print_stderr.hpp"
#include "vehicle/spec_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace grouser::scene {

using detail::SectionEntry;
using detail::SectionList;

namespace {

/// All sections of a scene file, in the order of reading, writing and help.
SectionList allSections() {
  SectionList all;
  for (SectionList (*const subject)() :
       {detail::runSections, detail::materialSections, detail::grainSections, detail::surfaceSections,
        detail::terrainSections, detail::mechanismSections, detail::vehicleSections, detail::hitchSections,
        detail::fluidSections, detail::outputSections})
    for (SectionEntry& entry : subject()) all.push_back(std::move(entry));
  return all;
}

void allowOnlyKnown(const base::Section& root, const SectionList& sections) {
  std::vector<std::string> names{"version"};
  for (const SectionEntry& entry : sections)
    if (entry.name.find('.') == std::string::npos) names.push_back(entry.name);
  root.allowOnly(names);
}

/// True if the text contains the whole word, not as a part of a longer one.
bool contains(const std::string& text, const std::string& key) {
  const auto isPart = [&](std::size_t i) {
    return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) || text[i] == '_' || text[i] == '.');
  };
  for (std::size_t at = text.find(key); !key.empty() && at != std::string::npos; at = text.find(key, at + 1))
    if (!(at > 0 && isPart(at - 1)) && !isPart(at + key.size())) return true;
  return false;
}

/// True if an error names the key "section.key", or "key" alone, unless that may be another word.
bool isNamed(const std::string& key, const std::string& error) {
  constexpr std::size_t kShortest = 4;
  const std::string last = key.substr(key.rfind('.') + 1);
  return contains(error, key) || (last.size() >= kShortest && contains(error, last));
}

Scene sceneOf(base::Document read, const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  const SectionList sections = allSections();
  for (const SectionEntry& entry : sections) entry.renameKeys(read);
  detail::supplySoils(read, file);
  Scene scene;
  scene.file = file, scene.overrides = overrides;
  scene.document = std::make_shared<const base::Document>(std::move(read));
  const base::Section root = scene.document->root();
  withUnusualValues(scene, [&] {
    try {
      allowOnlyKnown(root, sections);
      for (const SectionEntry& entry : sections) entry.read(root, scene);
    } catch (const base::UnknownKey& unknown) {
      std::vector<std::string> all;
      for (const SectionEntry& entry : sections) all.insert(all.end(), entry.keys.begin(), entry.keys.end());
      throw base::amongAllKeys(unknown, all);
    }
    detail::scaleSoils(scene);
    detail::checkTogether(scene);
  });
  return scene;
}

} // namespace

Scene readScene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    if (const std::string hint = support::nearestFileHint(file, {support::shareFolder() / "runs" / "scenes"});
        !hint.empty())
      throw base::InputError(fmt::format("{}: no such file; {}Check the path", file.string(), hint));
  return sceneOf(base::Document::load(file, overrides), file, overrides);
}

Scene readSceneText(std::string_view text, const std::filesystem::path& file,
                    const std::vector<std::string>& overrides) {
  return sceneOf(base::Document::parse(text, file.string(), overrides), file, overrides);
}

std::string unsettledWarning(const Scene& scene) {
  if (!scene.terrain || !scene.terrain->granular() || scene.terrain->settleTimeLimit > 0) return "";
  const Terrain& t = *scene.terrain;
  if (t.lattice() || !(t.porosity || scene.vehicle)) return "";
  return fmt::format("terrain.settle_time_limit = 0: the bed is not settled, so the grains fall as a loose column at "
                     "the start of the run{}{}; set a time limit for settling, e.g. {:g}",
                     t.porosity ? fmt::format(", without terrain.porosity = {:g}", *t.porosity) : "",
                     scene.vehicle ? ", under the vehicle" : "", Terrain{}.settleTimeLimit);
}

void withUnusualValues(const Scene& scene, const std::function<void()>& act) {
  try {
    act();
  } catch (const base::InputError& error) {
    std::string text = error.what();
    for (const base::UnusualValue& unusual : scene.document->unusual())
      if (isNamed(unusual.key, error.what()) || contains(error.what(), unusual.value))
        text += "; note: " + unusual.note;
    throw base::InputError(text);
  }
}

std::vector<std::string> unusualValues(const Scene& scene) {
  std::vector<std::string> notes;
  const auto add = [&notes](const std::vector<base::UnusualValue>& more) {
    for (const base::UnusualValue& unusual : more)
      if (std::find(notes.begin(), notes.end(), unusual.note) == notes.end()) notes.push_back(unusual.note);
  };
  if (scene.document) add(scene.document->unusual());
  for (const auto& [material, soil] : scene.soils)
    if (soil->document) add(soil->document->unusual());
  if (scene.vehicle) add(vehicle::unusualSpecValues(scene.vehicle->source()));
  return notes;
}

std::vector<SceneNote> sceneNotes(const Scene& scene) {
  std::vector<SceneNote> notes;
  if (!scene.document) return notes;
  for (std::string& warning : soilWarnings(scene)) notes.push_back({true, std::move(warning)});
  if (std::string warning = unsettledWarning(scene); !warning.empty()) notes.push_back({true, std::move(warning)});
  for (const std::string& note : scene.document->notes()) notes.push_back({false, note});
  for (std::string& note : unusualValues(scene)) notes.push_back({false, std::move(note)});
  for (std::string& note : soilNotes(scene)) notes.push_back({false, std::move(note)});
  return notes;
}

void printNotes(const Scene& scene) {
  for (const SceneNote& note : sceneNotes(scene))
    support::printStderr("{}: {}\n", note.isWarning ? "WARNING" : "grouser: note", note.text);
}

std::string resolvedToml(const Scene& scene) {
  std::string text = "version = 1\n";
  for (const SectionEntry& entry : allSections()) text += entry.write(scene);
  return text;
}

std::string fieldHelp() {
  std::string text =
      "## Keys of a scene file\n\nEvery file begins with `version = 1`. Only `[run]` is required.\n\nThe column range "
      "has the allowed range and, after *usually*, the usual magnitude of the value (for vectors and\n"
      "lists: of the largest component). A value outside the allowed range is an error. A value outside "
      "the usual span, except\n0, is accepted with a note that names the unit in which it would be "
      "usual. Both are in the unit of the key.\n";
  for (const SectionEntry& entry : allSections()) text.append("\n").append(entry.describe());
  return text;
}

} // namespace grouser::scene
