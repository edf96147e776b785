// SPDX-License-Identifier: BSD-3-Clause
// Soils of a scene, for results and messages.
#include "runs/scene/soil.hpp"

#include "base/math.hpp"
#include "base/table.hpp"
#include "runs/scene/detail/soil_materials.hpp"
#include "runs/scene/soil_calibration.hpp"

#include <fmt/format.h>

#include <cmath>

namespace grouser::scene {

namespace {

std::string millimetres(double radius) { return fmt::format("{:.4g} mm", 1000 * radius); }

/// "7 mm", "7 mm to 14 mm"
std::string calibratedSizes(const Soil& soil) {
  const auto [least, greatest] = soil.grains.calibratedRadii;
  return least < greatest ? fmt::format("{} to {}", millimetres(least), millimetres(greatest)) : millimetres(least);
}

/// Returns true if values of a material differ from those of its soil, scaled to the grain radius of the material.
bool isChanged(const Material& m, const Soil& soil) {
  constexpr double kRounding = 1e-9;
  const base::Table<Material> table = detail::materialTable();
  const double scale = *m.grainRadius / soil.grains.radius;
  for (const base::Field& field : table.fields()) {
    if (field.key == "soil" || field.key == "soil_hash" || field.key == "grain_radius") continue;
    const base::FieldValue is = table.value(m, field.key), was = table.value(soil.material, field.key);
    const auto *a = std::get_if<double>(&is), *b = std::get_if<double>(&was);
    const double wanted = b ? *b * base::pow(scale, radiusPowerOf(field.key)) : 0;
    if (a && b ? std::fabs(*a - wanted) > kRounding * std::fabs(wanted) : is != was) return true;
  }
  return false;
}

/// Returns true if the material has the size and values of the soil's calibration.
bool isCalibrated(const Material& m, const Soil& soil) {
  return soil.head.calibrated && isCalibratedSize(soil.grains.calibratedRadii, *m.grainRadius) && !isChanged(m, soil);
}

/// Adds a note if the bed's grain radius differs from that of the material.
void noteGrains(const Scene& scene, const Material& m, std::vector<std::string>& notes) {
  const double radius = *m.grainRadius;
  const auto& t = scene.terrain;
  if (t && t->granular() && t->material == m.name && std::fabs(*t->grainRadius - radius) > 1e-9 * radius)
    notes.push_back(
        fmt::format("material.{}: scaled to grains of {} (grain_radius), but the grains of the bed have a radius of {}",
                    m.name, millimetres(radius), millimetres(*t->grainRadius)));
}

/// Adds a note if the soil file has changed since the scene was written.
void noteChange(const Scene& scene, const Material& m, const Soil& soil, std::vector<std::string>& notes) {
  for (const auto& [name, section] : scene.document->root().named("material")) {
    const base::Node* hash = name == m.name ? section.node().find("soil_hash") : nullptr;
    const auto* text = hash ? std::get_if<std::string>(&hash->value) : nullptr;
    if (text && *text != soil.hash)
      notes.push_back(fmt::format("{}: material.{}.soil_hash = \"{}\" differs from the hash of {}, {}: the soil file "
                                  "has changed; check the values in the scene",
                                  hash->origin, m.name, *text, soil.file.string(), soil.hash));
  }
}

/// Adds a note if a bed is too shallow to reach the soil's porosity.
void notePorosity(const Scene& scene, std::vector<std::string>& notes) {
  const auto& t = scene.terrain;
  if (!t || !t->granular() || t->lattice() || t->porosity || t->settleTimeLimit == 0) return;
  const auto soil = scene.soils.find(t->material);
  if (soil != scene.soils.end() && soil->second->grains.porosity)
    notes.push_back(fmt::format("terrain: the bed is too shallow to be prepared with the porosity of the soil {}, "
                                "{:g}; the bed keeps the porosity as poured",
                                soil->second->name, *soil->second->grains.porosity));
}

} // namespace

bool isCalibratedSize(const std::array<double, 2>& calibratedRadii, double radius) {
  return radius >= (1 - kCalibratedWithin) * calibratedRadii[0] &&
         radius <= (1 + kCalibratedWithin) * calibratedRadii[1];
}

std::vector<support::SoilUse> soilUses(const Scene& scene) {
  std::vector<support::SoilUse> uses;
  for (const Material& m : scene.materials) {
    if (m.soil.empty()) continue;
    const Soil& soil = *scene.soils.at(m.name);
    support::SoilUse use{m.name, soil.name, m.soil, m.soilHash, isCalibrated(m, soil), *m.grainRadius, 1, {}};
    use.scale = use.grainRadius / soil.grains.radius;
    detail::forEachScaled(m, [&](const char* key, const char* unit, const auto& value, int) {
      if (detail::isGiven(value)) use.scaled[fmt::format("{} [{}]", key, unit)] = detail::numberOf(value);
    });
    uses.push_back(std::move(use));
  }
  return uses;
}

std::string soilLine(const support::SoilUse& use, bool isGranular) {
  std::string name = fmt::format("{}{}: {} ({})", use.material,
                                 use.material == use.soil ? "" : fmt::format(" is {}", use.soil), use.file, use.hash);
  if (!isGranular) return name;
  std::string values;
  for (const auto& [key, value] : use.scaled) values += fmt::format(", {} {:.6g}", key, value);
  return fmt::format("{}, grains of {}, {:.4g} times the soil's grain radius{}; {}", name, millimetres(use.grainRadius),
                     use.scale, values,
                     use.calibrated                                 ? "calibrated"
                     : std::fabs(use.scale - 1) > kCalibratedWithin ? "scaled, not calibrated at this size"
                                                                    : "uncalibrated");
}

std::vector<std::string> soilWarnings(const Scene& scene) {
  std::vector<std::string> warnings;
  for (const Material& m : scene.materials) {
    if (m.soil.empty()) continue;
    const Soil& soil = *scene.soils.at(m.name);
    if (!soil.head.calibrated || isCalibratedSize(soil.grains.calibratedRadii, *m.grainRadius)) continue;
    warnings.push_back(fmt::format("material.{}: the soil {} is calibrated for grains of {}, not {} ({:.3g} times the "
                                   "soil's grain radius); parameters are scaled, not calibrated at this size; to "
                                   "measure the soil constants, run: grouser soil {} --grain-radius {:g}",
                                   m.name, soil.name, calibratedSizes(soil), millimetres(*m.grainRadius),
                                   *m.grainRadius / soil.grains.radius, soil.name, *m.grainRadius));
  }
  return warnings;
}

std::vector<std::string> soilNotes(const Scene& scene) {
  std::vector<std::string> notes;
  const std::map<std::string, std::filesystem::path> known = knownSoils(scene.file);
  for (const Material& m : scene.materials) {
    if (m.soil.empty()) {
      if (known.contains(m.name))
        notes.push_back(fmt::format(
            "material.{}: defined in the scene; the soil of the same name is not used; to use it, add soil = \"{}\"",
            m.name, m.name));
      continue;
    }
    const Soil& soil = *scene.soils.at(m.name);
    if (!soil.head.calibrated)
      notes.push_back(fmt::format("material.{}: the soil {} is uncalibrated: no soil constants have been measured with "
                                  "its contact parameters ({})",
                                  m.name, soil.name, m.soil));
    noteGrains(scene, m, notes);
    noteChange(scene, m, soil, notes);
  }
  notePorosity(scene, notes);
  return notes;
}

bool goesWithGrains(const Scene& scene, const std::string& name, const std::string& key) {
  if (!scene.soils.contains(name) || !scene.document) return false;
  for (const auto& [known, section] : scene.document->root().named("material"))
    if (known == name) return !section.has(key);
  return false;
}

} // namespace grouser::scene
