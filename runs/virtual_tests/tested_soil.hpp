// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/table.hpp"
#include "runs/scene/soil_calibration.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// A soil by name or file for the bevameter: contact parameters, bed, and published constants.
namespace grouser::virtual_tests {

/// Constants measured by a bevameter.
enum class Quantity { exponent, frictionModulus, cohesionModulus, cohesion, frictionAngle, shearModulus, repose };
inline constexpr Quantity kQuantities[] = {Quantity::exponent, Quantity::cohesionModulus, Quantity::frictionModulus,
                                           Quantity::cohesion, Quantity::frictionAngle,   Quantity::shearModulus,
                                           Quantity::repose};
std::string symbolOf(Quantity quantity); ///< "n", "k_c", "k_phi", "c", "phi", "K", "repose", as in soil files
std::string unitOf(Quantity quantity);   ///< "-", "kN/m^(n+1)", "kN/m^(n+2)", "kPa", "deg", "mm", "deg"
std::optional<Quantity> quantityOf(const std::string& symbol);
/// Converts a number in unitOf(quantity) to the SI unit of soil files; that unit.
double inSoilFile(Quantity quantity, double value);
std::string soilFileUnitOf(Quantity quantity);

/// Published value, in unitOf(quantity).
struct PublishedValue {
  Quantity quantity{};
  double value = 0;
  std::optional<double> low, high; ///< span of the source
  std::string source;
};

struct TestedSoil {
  std::string name;           ///< "lete_sand"
  std::filesystem::path file; ///< source file
  std::string title, description;
  /// Keys of a scene's [material] at `grainRadius` with TOML values, in file order.
  std::vector<std::pair<std::string, std::string>> keys;
  /// The same without density and friction, one per line.
  std::string law;
  std::string lawWithoutPull;                  ///< the same without cohesion and adhesion
  double density = 0;                          ///< [kg/m3] solid density
  double friction = 0;                         ///< [-]
  double young = 0;                            ///< [Pa] Young's modulus of Hertz contacts; 0: a different law
  double poisson = 0;                          ///< [-] Poisson's ratio, with `young`
  bool isPlain = false;                        ///< linear springs without cohesion
  double grainRadius = 0;                      ///< [m] mean radius in the tests
  double fileRadius = 0;                       ///< [m] radius for which the file's numbers are valid
  double spread = 0;                           ///< [-] half width of the radius distribution over the mean
  std::optional<double> porosity;              ///< [-] bed porosity; empty: settled with the soil's own friction
  double calibratedFrom = 0, calibratedTo = 0; ///< [m] radii; both 0 if the file has none
  std::vector<PublishedValue> published;

  /// Whether contact stiffness scales with grain size as that of a solid, and adhesion as a stress: then grains of
  /// different sizes represent the same soil.
  bool isOneAtAllSizes = false;

  bool isCalibrated() const {
    return calibratedTo == 0 || scene::isCalibratedSize({calibratedFrom, calibratedTo}, grainRadius);
  }
};

/// Reads a soil by name, or from a .toml file, scaled to grains of `grainRadius` [m] (0: that of the file): stiffness,
/// cohesion and surface energy in proportion to the radius, damping rates inversely, others unchanged. Throws
/// base::InputError: an unknown name (with the nearest and all names), or file:line and key of an invalid value.
TestedSoil readTestedSoil(const std::string& nameOrFile, double grainRadius);

/// Number of a material key; `otherwise` if missing.
double numberOf(const TestedSoil& soil, const std::string& key, double otherwise);
/// Sets a material key, and updates derived values.
void setNumber(TestedSoil& soil, const std::string& key, double value);

/// Reads the material of section `key` of a file, and its [bed], as readTestedSoil().
TestedSoil readMaterial(const base::Section& root, const std::string& key, const std::filesystem::path& file,
                        double grainRadius);

} // namespace grouser::virtual_tests
