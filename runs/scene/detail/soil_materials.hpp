// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/table.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/soil.hpp"

#include <filesystem>
#include <optional>
#include <string>

/// Materials of soils: sections for names in a scene, materials from soil files, scaling to the scene's grains.
namespace grouser::scene::detail {

base::Table<Material> materialTable();
base::Table<Scm> scmTable();
/// Checks of a material beyond its table, and the defaults of its law.
void completeMaterial(const base::Section& section, Material& m);

/// Adds [material.NAME] soil = "NAME" for each soil that the scene uses as a material without a section [material.NAME]
/// in its file.
void supplySoils(base::Document& document, const std::filesystem::path& scene);

/// The soil of [material.NAME], which is then stored in the scene; null if the section has no key soil. Throws
/// InputError.
const Soil* soilOf(const base::Section& section, const std::string& name, Scene& scene);

/// Values of the soil's file, without keys that contradict the scene's section: keys of a different law, or restitution
/// against damping.
Material materialOf(const Soil& soil, const base::Section& section);

/// Scales values of soil files to the grains of the scene. Call after all sections are read. Throws InputError if the
/// grains of a soil have no common radius.
void scaleSoils(Scene& scene);

/// Calls `f` with key, unit, value and power of r for each value that scales with the grain radius r. Modulus,
/// densities, coefficients of friction and restitution do not scale: strain under a given pressure and the ratio of
/// strength to pressure are then the same at all grain sizes, and the time step is proportional to r. (Thakur et al.
/// 2015; stiffness with r, forces of adhesion with r^2.)
template <class M, class F> void forEachScaled(M&& m, F f) {
  f("stiffness", "N/m", m.stiffness, 1);
  f("damping", "1/s", m.damping, -1);
  f("cohesion", "J/m2", m.cohesion, 1);
  f("surface_energy", "J/m2", m.surfaceEnergy, 1);
  f("adhesion_radius", "m", m.adhesionRadius, 1);
  f("adhesion_stiffness", "N/m", m.adhesionStiffness, 1);
}
inline bool isGiven(const std::optional<double>& value) { return value.has_value(); }
inline bool isGiven(double value) { return value != 0; }
inline double numberOf(const std::optional<double>& value) { return *value; }
inline double numberOf(double value) { return value; }

} // namespace grouser::scene::detail
