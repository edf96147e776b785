// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/provenance.hpp"

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/scene/soil.hpp"
#include "runs/setup/contact_pairs.hpp"
#include "runs/setup/vehicle_setup.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/file_hash.hpp"
#include "vehicle/spec_file.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace grouser::setup {

namespace fs = std::filesystem;
using support::hashOfFile;

namespace {

/// Returns true if grains or contact partners other than vehicle and bodies have this material, so that it affects the
/// bed.
bool isOfBed(const ContactPairs& pairs, const std::string& material) {
  return std::any_of(pairs.partners.begin(), pairs.partners.end(), [&](const ContactPartner& p) {
    return p.material == material && p.kind != ContactPartner::Kind::vehicle && p.kind != ContactPartner::Kind::body;
  });
}

/// Surfaces are at rest while a bed settles: the bed depends on their positions and materials, not on their later
/// motion and names. A plane that counts as a surface remains a surface.
void bringToRest(scene::SurfaceSection& s, bool named) {
  const std::string material = s.material;
  s = {};
  s.material = material;
  if (named) s.name = "surface";
}

/// Copies the run settings that affect a settled bed. Others keep their defaults: duration, output, machine, skin of
/// the neighbour list (changes no bit), mechanisms, and inputs of the automatic time step (bedOrigin() contains the
/// step).
scene::RunSettings settingsOfBed(const scene::RunSettings& run) {
  scene::RunSettings bed;
  bed.gravity = run.gravity, bed.seed = run.seed, bed.precision = run.precision;
  bed.maxOverlap = run.maxOverlap; // with a different limit, settling could fail
  bed.periodic = run.periodic, bed.domainX = run.domainX, bed.domainY = run.domainY;
  return bed;
}

/// Grains that enter later affect the layout by size and material, not by time and position.
std::vector<scene::Source> sourcesOfBed(const std::vector<scene::Source>& sources) {
  std::vector<scene::Source> bed;
  for (const scene::Source& s : sources) {
    scene::Source kind;
    kind.radius = s.radius, kind.material = s.material, kind.every = 1;
    if (std::find(bed.begin(), bed.end(), kind) == bed.end()) bed.push_back(kind);
  }
  return bed;
}

/// The scene without anything that cannot affect the bed. Everything not removed here counts: a new key may split one
/// cached bed into two, but never merges two different beds (except keys of [run], see settingsOfBed()).
scene::Scene bedAlone(scene::Scene scene) {
  scene.run = settingsOfBed(scene.run);
  const ContactPairs pairs(scene);
  std::erase_if(scene.materials, [&](const scene::Material& m) { return !isOfBed(pairs, m.name); });
  for (scene::Material& m : scene.materials) {
    m.soil.clear(), m.soilHash.clear(), m.grainRadius.reset(); // only the values count
    m.crushingStrength.reset();                                // acts between grains and parts only
  }
  std::erase_if(scene.contacts,
                [&](const scene::ContactPair& p) { return !isOfBed(pairs, p.first) || !isOfBed(pairs, p.second); });
  removeVehicle(scene);
  scene.mechanism = {}, scene.output = {}, scene.parallel = {}, scene.complementarity.reset();
  scene.terrain->cache = true;
  scene.sources = sourcesOfBed(scene.sources);
  for (scene::Plane& p : scene.planes) bringToRest(p, !p.isWall());
  for (scene::BoxSection& b : scene.boxes) bringToRest(b, false);
  for (scene::CylinderSection& c : scene.cylinders) bringToRest(c, false);
  return scene;
}

} // namespace

Provenance provenanceOf(const scene::Scene& scene) {
  return {scene.file, scene.overrides, scene::resolvedToml(scene), inputsOf(scene), scene::soilUses(scene)};
}

std::string inputsOf(const scene::Scene& scene) {
  std::string text;
  for (const scene::Material& m : scene.materials)
    if (!m.soil.empty()) text += fmt::format("material.{}.soil {}\n", m.name, m.soilHash);
  if (scene.terrain) text += fmt::format("terrain.heightmap {}\n", hashOfFile(scene.terrain->heightmap));
  for (const scene::GrainFill& fill : scene.fills)
    if (fill.file) text += fmt::format("grains.file:{} {}\n", *fill.file, hashOfFile(*fill.file));
  for (const scene::MeshSection& mesh : scene.meshes)
    text += fmt::format("mesh.file:{} {}\n", mesh.file, hashOfFile(mesh.file));
  for (const scene::BodySection& body : scene.mechanism.bodies)
    for (const scene::ShapeSection& shape : body.shapes)
      if (shape.file) text += fmt::format("body.shape.file:{} {}\n", *shape.file, hashOfFile(*shape.file));
  if (!scene.vehicle) return text;
  text += fmt::format("vehicle.spec {}\n", hashOfFile(scene.vehicle->spec));
  const vehicle::VehicleSpec spec = vehicle::readVehicleSpec(scene.vehicle->source());
  using Named = std::pair<const char*, const std::string&>;
  for (const auto& [section, mesh] :
       {Named{"chassis", spec.chassis.mesh}, Named{"shoe", spec.shoe.mesh}, Named{"sprocket", spec.sprocket.mesh},
        Named{"road_wheel", spec.roadWheel.mesh}, Named{"roller", spec.roller.mesh}, Named{"idler", spec.idler.mesh}}) {
    if (&mesh == &spec.roller.mesh && spec.roller.x.empty()) continue;
    const fs::path file = fs::path(spec.meshFolder) / mesh;
    if (const std::string fault = base::inputFault(file); !fault.empty())
      vehicle::refuseMesh(scene.vehicle->source(), section, file.string() + fault + "; check the path");
    text += fmt::format("mesh:{} {}\n", mesh, hashOfFile(file));
  }
  return text;
}

std::string bedOrigin(const scene::Scene& scene, double timeStep) {
  scene::Scene bed = bedAlone(scene);
  const std::string inputs = inputsOf(bed);
  bed.terrain->heightmap.clear(); // the bytes count, not the file name
  return fmt::format("program {}\ntime step {:a}\n{}{}", support::programHash(), timeStep, inputs,
                     scene::resolvedToml(bed));
}

} // namespace grouser::setup
