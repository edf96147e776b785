// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/load_scene.hpp"

#include "base/table.hpp"
#include "multibody/part_error.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/setup/contact_pairs.hpp"
#include "runs/setup/grain_space.hpp"
#include "runs/setup/hitched_bodies.hpp"
#include "runs/setup/mechanism_model.hpp"
#include "runs/setup/mechanism_setup.hpp"

#include <fmt/format.h>

#include <map>

namespace grouser::setup {

using base::Section;

namespace {

/// Throws the error of a part with the location of the part in the file, if the file contains it.
void failAtPart(const Section& root, const multibody::PartError& error) {
  const multibody::PartName& part = error.part();
  for (const Section& section : root.list(part.kind)) {
    const base::Node* given = section.node().find("name");
    if (given && std::get<std::string>(given->value) == part.name)
      section.fail("", fmt::format("(\"{}\"): {}", part.name, error.text()));
  }
}

/// Checks the mechanism as a whole: joints must close, and drives in a loop must not contradict each other.
void checkWhole(const Section& root, const multibody::Model& model, const scene::Scene& scene) {
  try {
    const multibody::Solver solver(model, solverOptions(scene.run));
  } catch (const base::InputError& error) {
    if (const auto* fault = dynamic_cast<const multibody::PartError*>(&error)) failAtPart(root, *fault);
    throw base::InputError(fmt::format("{}: {}", scene.file.string(), error.what()));
  }
}

/// Runs `check`, and adds the location of the key to its errors.
template <class Check> void withPlace(const Section& section, const Check& check) {
  try {
    check();
  } catch (const support::SectionFault& fault) {
    section.fail(fault.key(), fault.what());
  }
}

void checkMechanism(const Section& root, const scene::Scene& scene) {
  const std::optional<vehicle::Assembly> vehicle = vehicleOf(scene);
  MechanismBuilder builder = vehicle ? MechanismBuilder(*vehicle) : MechanismBuilder();
  const std::size_t firstJoint = builder.model().joints().size();
  scene::forEachKind(scene.mechanism, [&](const char* key, const auto& sections) {
    const std::vector<Section> places = root.list(key);
    for (std::size_t k = 0; k < sections.size(); ++k) withPlace(places[k], [&] { builder.add(sections[k]); });
  });
  if (scene.mechanism.empty()) return;
  if (scene.mechanism.bodies.empty() && !vehicle) {
    for (const char* key : {"joint", "spring", "bushing", "drive", "coupling"})
      for (const Section& section : root.list(key)) section.fail("", "requires a body; add a [[body]]");
    return;
  }
  const std::vector<Section> joints = root.list("joint");
  for (std::size_t j = 0; j < joints.size(); ++j)
    withPlace(joints[j], [&] { checkStartVelocity(builder.model(), static_cast<int>(firstJoint + j)); });
  checkWhole(root, builder.model(), scene);
  if (vehicle) hitchedBodies(scene, builder.model(), *vehicle);
}

/// Throws InputError for a surface without effect: vehicles and bodies touch only surfaces at rest.
void rejectUnusedSurface(const Section& section, const scene::Scene& scene, const SceneSurface& s) {
  const bool others = scene.vehicle || scene.mechanism.touches() || scene.fluid;
  if (others && !s.moves) return;
  if (others)
    section.fail(
        "", "moves, but vehicle and bodies have contact with fixed surfaces only; remove the motion or the surface");
  section.fail("", s.kind == coupling::SurfaceKind::plane
                       ? "has a motion or name, which has no effect without grains; remove it"
                       : "has no effect without grains; remove it");
}

/// Checks that surfaces have an effect, that their names are unique, and that grains fit into hollow cylinders.
void checkSurfaces(const Section& root, const ContactPairs& pairs, const scene::Scene& scene) {
  const GrainKinds& kinds = pairs.kinds;
  std::map<std::string, std::string> places; // section by name
  for (const SceneSurface& s : pairs.surfaces) {
    const Section section = root.list(s.list())[s.number];
    if (!kinds.any()) rejectUnusedSurface(section, scene, s);
    const auto [other, fresh] = places.emplace(s.name, section.path());
    if (!fresh)
      section.fail("name", fmt::format("\"{}\" is also the name of {}; choose another", s.name, other->second));
    if (s.geometry.shape == terrain::SurfaceShape::tube && kinds.any() && s.geometry.half.x <= kinds.largest)
      section.fail(
          "radius",
          fmt::format(
              "[m] of a hollow cylinder must exceed the largest grain radius, {:g} m; raise it, or set hollow = false",
              kinds.largest));
  }
}

scene::Scene checked(scene::Scene scene) {
  scene::withUnusualValues(scene, [&scene] {
    const Section root = scene.document->root();
    checkMechanism(root, scene);
    const ContactPairs pairs(scene);
    checkSurfaces(root, pairs, scene);
    checkGrainSpace(scene, pairs.kinds);
  });
  return scene;
}

} // namespace

scene::Scene loadScene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return checked(scene::readScene(file, overrides));
}

scene::Scene parseScene(std::string_view text, const std::filesystem::path& file,
                        const std::vector<std::string>& overrides) {
  return checked(scene::readSceneText(text, file, overrides));
}

} // namespace grouser::setup
