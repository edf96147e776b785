// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/table.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/soil.hpp"

#include <filesystem>
#include <optional>
#include <string>

/// Materials of soils: from names in a scene to sections, from a soil's file to a material, from its grains to theirs.
namespace grouser::scene::detail {

base::Table<Material> materialTable();
/// What the table cannot say about a material, and the defaults of its law.
void completeMaterial(const base::Section& section, Material& m);

/// Has the scene say [material.NAME] soil = "NAME" of each soil that stands where a material does, and of which the
/// scene has no section of that name, but for overrides.
void supplySoils(base::Document& document, const std::filesystem::path& scene);

/// The soil that [material.NAME] is of, where it is; kept in the scene. Null otherwise. Throws InputError.
const Soil* soilOf(const base::Section& section, const std::string& name, Scene& scene);

/// What the soil's file says, but for keys that contradict those of the scene's section: those of the other law, or
/// the other way to say how lossy a contact is.
Material materialOf(const Soil& soil, const base::Section& section);

/// Once all sections are read: scales what comes from soils' files from their grains to those of the scene. Throws
/// InputError where these have no one radius.
void scaleSoils(Scene& scene);

/// Hands to `f` what goes with the radius r of the grains, as key, unit, value and power of r. Modulus, densities,
/// coefficients of friction and restitution do not: strains under a pressure, and strength over it, are then the same
/// at all sizes, and the time step goes with r. (Thakur et al. 2015; stiffness with r, forces of adhesion with r^2.)
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
