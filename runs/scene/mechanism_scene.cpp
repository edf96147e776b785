// SPDX-License-Identifier: BSD-3-Clause
#include "runs/scene/mechanism_scene.hpp"

#include "runs/scene/detail/scene_tables.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::scene {

using base::Section;

namespace {

auto tableOf(const std::vector<BodySection>&) { return detail::bodyTable(); }
auto tableOf(const std::vector<JointSection>&) { return detail::jointTable(); }
auto tableOf(const std::vector<SpringSection>&) { return detail::springTable(); }
auto tableOf(const std::vector<BushingSection>&) { return detail::bushingTable(); }
auto tableOf(const std::vector<DriveSection>&) { return detail::driveTable(); }
auto tableOf(const std::vector<CouplingSection>&) { return detail::couplingTable(); }

template <class S>
void writeAll(std::string& text, const std::string& key, const base::Table<S>& table, const std::vector<S>& sections) {
  for (const S& s : sections) {
    text += "\n[[" + key + "]]\n";
    // A list without entries says that the key was not given.
    std::string lines = table.write(s);
    for (std::size_t at = 0; at < lines.size();) {
      const std::size_t end = lines.find('\n', at);
      const std::string line = lines.substr(at, end - at);
      if (!line.ends_with("= []") && !line.ends_with("= \"\"")) text += line + "\n";
      at = end + 1;
    }
  }
}

} // namespace

void readMechanism(const Section& root, Scene& scene) {
  MechanismSections& m = scene.mechanism;
  forEachKind(m, [&](const char* key, auto& sections) {
    const auto table = tableOf(sections);
    for (const Section& section : root.list(key)) sections.push_back(section.read(table));
  });
  if (m.bodies.empty()) return;
  for (const char* other : {"grain", "grains", "source", "plane", "box", "cylinder", "mesh", "terrain", "vehicle"})
    if (root.has(other))
      root.list("body").front().fail("",
                                     fmt::format("stands beside {}, but free bodies touch neither ground nor grains "
                                                 "nor a vehicle; give the mechanism a scene of its own",
                                                 other));
}

void checkRecord(const Section& output, const Scene& scene) {
  std::vector<std::string> known;
  forEachKind(scene.mechanism, [&](const char*, const auto& sections) {
    for (const auto& section : sections) known.push_back(section.name);
  });
  for (const std::string& name : scene.output.record)
    if (std::find(known.begin(), known.end(), name) == known.end())
      output.fail("record", known.empty() ? "names parts of a mechanism, but there is none; remove it"
                                          : fmt::format("names nothing \"{}\" of the mechanism; did you mean \"{}\"?",
                                                        name, base::nearestWord(name, known)));
}

std::string mechanismToml(const MechanismSections& m) {
  std::string text;
  forEachKind(m, [&](const char* key, const auto& sections) { writeAll(text, key, tableOf(sections), sections); });
  return text;
}

} // namespace grouser::scene
