// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"
#include "runs/scene/scene.hpp"
#include "runs/support/soil_use.hpp"

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Soils by name: files with contact parameters of a soil at one grain size, its published constants, and the constants
/// measured by virtual tests of these parameters. docs/soils.md describes them.
namespace grouser::scene {

/// Constants of a soil: p = (k_c / b + k_phi) z^n under a plate of width b, tau = (c + p tan phi) (1 - exp(-j / K)).
enum class SoilQuantity {
  exponent,
  cohesiveModulus,
  frictionalModulus,
  cohesion,
  frictionAngle,
  shearModulus,
  bulkDensity,
  grainDensity,
  porosity,
  reposeAngle,
  unloadingModulus
};
/// SI unit as in a file: "N/m^(n+1)", "Pa", "deg".
std::string unitOf(SoilQuantity quantity);

/// [soil]
struct SoilHead {
  std::string title, description;
  bool calibrated = false; ///< whether [material] is calibrated with a bevameter run
};

/// [bed]: grain size for which [material] is valid.
struct SoilGrains {
  double radius = 0;                       ///< [m] median radius
  double radiusSpread = Terrain::kSpread;  ///< [-] spread, uniform by number
  std::optional<double> porosity;          ///< [-] bed porosity; empty: as poured
  std::array<double, 2> calibratedRadii{}; ///< [m] minimum and maximum measured radius
};

/// [[published]]
struct PublishedConstant {
  SoilQuantity quantity{};
  double value = 0;
  std::string unit, source;
  std::optional<double> low, high; ///< range, if sources differ
};

/// [[reached]]
struct ReachedConstant {
  SoilQuantity quantity{};
  double value = 0, halfWidth = 0; ///< `halfWidth`: half width of the 95 % interval
  std::string unit;
  double grainRadius = 0; ///< [m]
  std::string command;    ///< command that measured it
};

/// A soil's file.
struct Soil {
  std::string name; ///< file name without .toml
  std::filesystem::path file;
  std::string hash; ///< hash of the file's bytes
  SoilHead head;
  SoilGrains grains;
  Material material; ///< material at grains.radius, with every default
  std::vector<PublishedConstant> published;
  std::vector<ReachedConstant> reached;
  std::shared_ptr<const base::Document> document;

  /// The first published constant of this quantity; null if there is none.
  const PublishedConstant* publishedValue(SoilQuantity quantity) const {
    for (const PublishedConstant& p : published)
      if (p.quantity == quantity) return &p;
    return nullptr;
  }
};

/// Reads a soil's file. Throws base::InputError with file, line, key, value, range and remedy.
Soil readSoil(const std::filesystem::path& file);

/// Path of the soil file that `word` means in a scene: a name means soils/NAME.toml, a word with a slash or .toml is a
/// path. Both are searched for in the scene's folder, the current folder and assets/. Empty if there is no such file;
/// `tried` receives the searched paths.
std::filesystem::path findSoil(const std::string& word, const std::filesystem::path& scene,
                               std::vector<std::filesystem::path>& tried);

/// Files of all soils that a scene can use by name.
std::map<std::string, std::filesystem::path> knownSoils(const std::filesystem::path& scene);

/// "did you mean \"lete_sand\"? (soils: ...)", for an unknown name.
std::string soilHint(const std::string& word, const std::filesystem::path& scene);

/// Soils of a scene: one for each material that is a soil, in the order of the materials.
std::vector<support::SoilUse> soilUses(const Scene& scene);
/// "lete_sand: /.../lete_sand.toml (0123...), grains of 14 mm, 2 times the soil's grain radius, cohesion [J/m2] 3;
/// uncalibrated"; only name, file and hash if not `isGranular`.
std::string soilLine(const support::SoilUse& use, bool isGranular = true);

/// Notes on the scene's soils, one per line.
std::vector<std::string> soilNotes(const Scene& scene);

/// Returns true if material `name` is a soil and `key` comes from the soil's file, so that it scales with the radius of
/// the scene's grains.
bool goesWithGrains(const Scene& scene, const std::string& name, const std::string& key);

/// Exponent k if a key of a soil's [material] is proportional to (grain radius)^k; 0 for keys that do not scale.
int radiusPowerOf(const std::string& key);

/// All keys of a soil's file with unit, default, range and meaning, as Markdown.
std::string soilFieldHelp();

} // namespace grouser::scene

namespace grouser::base {

template <> struct EnumWords<scene::SoilQuantity> {
  using E = scene::SoilQuantity;
  static constexpr EnumWord<E> list[] = {{E::exponent, "n"},
                                         {E::cohesiveModulus, "k_c"},
                                         {E::frictionalModulus, "k_phi"},
                                         {E::cohesion, "c"},
                                         {E::frictionAngle, "phi"},
                                         {E::shearModulus, "K"},
                                         {E::bulkDensity, "bulk_density"},
                                         {E::grainDensity, "grain_density"},
                                         {E::porosity, "porosity"},
                                         {E::reposeAngle, "repose"},
                                         {E::unloadingModulus, "k_u"}};
};

} // namespace grouser::base
