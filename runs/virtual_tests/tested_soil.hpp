// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/table.hpp"
#include "runs/scene/soil_calibration.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// A soil for the virtual bevameter, by name or file: contact parameters, bed, and published constants.
namespace grouser::virtual_tests {

/// Soil constants that the virtual bevameter measures.
enum class Quantity { exponent, frictionModulus, cohesionModulus, cohesion, frictionAngle, shearModulus, repose };
inline constexpr Quantity kQuantities[] = {Quantity::exponent, Quantity::cohesionModulus, Quantity::frictionModulus,
                                           Quantity::cohesion, Quantity::frictionAngle,   Quantity::shearModulus,
                                           Quantity::repose};
std::string symbolOf(Quantity quantity); ///< "n", "k_c", "k_phi", "c", "phi", "K", "repose", as in soil files
std::string unitOf(Quantity quantity);   ///< "-", "kN/m^(n+1)", "kN/m^(n+2)", "kPa", "deg", "mm", "deg"
std::optional<Quantity> quantityOf(const std::string& symbol);
/// inSoilFile() converts a number in unitOf(quantity) to the SI unit of soil files; soilFileUnitOf() returns this unit.
double inSoilFile(Quantity quantity, double value);
std::string soilFileUnitOf(Quantity quantity);

/// Published value, in unitOf(quantity).
struct PublishedValue {
  Quantity quantity{};
  double value = 0;
  std::optional<double> low, high; ///< span that the source states
  std::string source;
};

struct TestedSoil {
  std::string name;           ///< "lete_sand"
  std::filesystem::path file; ///< the file from which the soil was read
  std::string title, description;
  /// Keys of a scene's [material] and their TOML values for `grainRadius`, in the order of the file.
  std::vector<std::pair<std::string, std::string>> keys;
  /// The keys without density and friction, one per line.
  std::string law;
  std::string lawWithoutPull;                  ///< `law` without cohesion and adhesion
  double density = 0;                          ///< [kg/m3] solid density
  double friction = 0;                         ///< [-]
  double young = 0;                            ///< [Pa] Young's modulus of Hertz contacts; 0: another contact law
  double poisson = 0;                          ///< [-] Poisson's ratio, with `young`
  bool isPlain = false;                        ///< linear springs without cohesion
  double grainRadius = 0;                      ///< [m] mean radius in the tests
  double fileRadius = 0;                       ///< [m] mean radius for which the numbers in the file are valid
  double spread = 0;                           ///< [-] half width of the radius distribution / mean radius
  std::optional<double> porosity;              ///< [-] bed porosity; empty: beds settle with the friction of the soil
  double calibratedFrom = 0, calibratedTo = 0; ///< [m] calibrated_radii; both 0 if the file does not set them
  std::vector<PublishedValue> published;

  /// True if the contact stiffness scales with the grain size like the stiffness of a solid, and the adhesion like a
  /// stress. Grains of different sizes then represent the same soil.
  bool isOneAtAllSizes = false;

  bool isCalibrated() const {
    return calibratedTo == 0 || scene::isCalibratedSize({calibratedFrom, calibratedTo}, grainRadius);
  }
};

/// Reads a soil by name, or from a .toml file, and scales it to `grainRadius` [m] (0: radius in the file): stiffness,
/// cohesion and surface energy in proportion to the radius, damping rates in inverse proportion. Throws
/// base::InputError for an unknown name (lists the nearest and all names) or an invalid value (file:line and key).
TestedSoil readTestedSoil(const std::string& nameOrFile, double grainRadius);

/// Number of a material key; `otherwise` if the key is missing.
double numberOf(const TestedSoil& soil, const std::string& key, double otherwise);
/// Sets a material key, and updates the values derived from it.
void setNumber(TestedSoil& soil, const std::string& key, double value);

/// Reads a material from section `key` of a file, and the bed from [bed]; scales them like readTestedSoil().
TestedSoil readMaterial(const base::Section& root, const std::string& key, const std::filesystem::path& file,
                        double grainRadius);

} // namespace grouser::virtual_tests
