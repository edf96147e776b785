// SPDX-License-Identifier: BSD-3-Clause
#include "runs/scene/mechanism_scene.hpp"

#include "runs/scene/detail/scene_tables.hpp"
#include "runs/simulation/mechanism.hpp"
#include "runs/setup/mechanism_model.hpp"

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

/// Reads all of [[key]] by `table`, and has the builder check each; a fault gets the place of its key.
template <class S> void readAll(const Section& root, const std::string& key, const base::Table<S>& table,
                                setup::MechanismBuilder& builder, std::vector<S>& sections) {
  for (const Section& section : root.list(key)) {
    sections.push_back(section.read(table));
    try {
      builder.add(sections.back());
    } catch (const support::SectionFault& fault) {
      section.fail(fault.key(), fault.what());
    }
  }
}

/// Has the solver look at the whole: joints that do not close, drives that contradict each other through a loop. Its
/// messages begin with kind and name of a part, whose place in the file is put before.
void checkWhole(const Section& root, const multibody::Model& model, const Scene& scene) {
  try {
    const multibody::Solver solver(model, simulation::solverOptions(scene.run));
  } catch (const base::InputError& error) {
    const std::string message = error.what();
    const std::size_t open = message.find(" '"), close = message.find("': ");
    if (open == std::string::npos || close == std::string::npos || close < open)
      throw base::InputError(fmt::format("{}: {}", scene.file.string(), message));
    const std::string kind = message.substr(0, open), name = message.substr(open + 2, close - open - 2);
    for (const Section& section : root.list(kind)) {
      const base::Node* given = section.node().find("name");
      if (given && std::get<std::string>(given->value) == name)
        section.fail("", fmt::format("(\"{}\"): {}", name, message.substr(close + 3)));
    }
    throw base::InputError(fmt::format("{}: {}", scene.file.string(), message));
  }
}

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
  setup::MechanismBuilder builder;
  forEachKind(m, [&](const char* key, auto& sections) { readAll(root, key, tableOf(sections), builder, sections); });
  if (m.bodies.empty()) {
    for (const char* key : {"joint", "spring", "bushing", "drive", "coupling"})
      for (const Section& section : root.list(key)) section.fail("", "has no body to act on; add a [[body]]");
    return;
  }
  const std::vector<Section> joints = root.list("joint");
  for (std::size_t j = 0; j < joints.size(); ++j) {
    try {
      setup::checkStartVelocity(builder.model(), static_cast<int>(j));
    } catch (const support::SectionFault& fault) {
      joints[j].fail(fault.key(), fault.what());
    }
  }
  checkWhole(root, builder.model(), scene);
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
