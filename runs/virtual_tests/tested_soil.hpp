// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/table.hpp"
#include "runs/scene/soil_calibration.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// A soil by name or file as the bevameter takes it: contact parameters, bed, and what is published of the soil.
namespace grouser::virtual_tests {

/// What a bevameter measures.
enum class Quantity { exponent, frictionModulus, cohesionModulus, cohesion, frictionAngle, shearModulus, repose };
inline constexpr Quantity kQuantities[] = {Quantity::exponent, Quantity::cohesionModulus, Quantity::frictionModulus,
                                           Quantity::cohesion, Quantity::frictionAngle,   Quantity::shearModulus,
                                           Quantity::repose};
std::string symbolOf(Quantity quantity); ///< "n", "k_c", "k_phi", "c", "phi", "K", "repose", as in soil files
std::string unitOf(Quantity quantity);   ///< "-", "kN/m^(n+1)", "kN/m^(n+2)", "kPa", "deg", "mm", "deg"
std::optional<Quantity> quantityOf(const std::string& symbol);
/// A number in unitOf(quantity) as soils' files have it, and its unit there: SI.
double inSoilFile(Quantity quantity, double value);
std::string soilFileUnitOf(Quantity quantity);

/// A number of a source, in unitOf(quantity).
struct PublishedValue {
  Quantity quantity{};
  double value = 0;
  std::optional<double> low, high; ///< of the source's own span
  std::string source;
};

struct TestedSoil {
  std::string name;           ///< "lete_sand"
  std::filesystem::path file; ///< that it was read from
  std::string title, description;
  /// Keys of a scene's [material] at `grainRadius` with their values as TOML, in the file's order.
  std::vector<std::pair<std::string, std::string>> keys;
  /// Those but for density and friction, a line each.
  std::string law;
  std::string lawWithoutPull;                  ///< the same without cohesion and adhesion
  double density = 0;                          ///< [kg/m3] of the solid
  double friction = 0;                         ///< [-]
  double young = 0;                            ///< [Pa] of Hertz' contacts; 0: of another law
  double poisson = 0;                          ///< [-] with `young`
  bool isPlain = false;                        ///< linear springs without cohesion
  double grainRadius = 0;                      ///< [m] mean, that the tests are done with
  double fileRadius = 0;                       ///< [m] that the file's numbers are valid at
  double spread = 0;                           ///< of the radii [-]
  std::optional<double> porosity;              ///< [-] of the bed; empty: as it falls with the soil's own friction
  double calibratedFrom = 0, calibratedTo = 0; ///< [m] radii; both 0 where the file names none
  std::vector<PublishedValue> published;

  /// Whether the stiffness of contacts grows with their grains as that of a solid does, and adhesion, if there is any,
  /// as the stress that it stands for: then grains of many sizes are one soil.
  bool isOneAtAllSizes = false;

  bool isCalibrated() const {
    return calibratedTo == 0 || scene::isCalibratedSize({calibratedFrom, calibratedTo}, grainRadius);
  }
};

/// Reads a soil by its name, or by a file that ends in .toml, with numbers for grains of `grainRadius` [m] (0: the
/// file's own): stiffness, cohesion and surface energy grow in proportion to the radius, damping rates fall with it,
/// all else stays. Throws base::InputError: an unknown name (names the nearest and lists all), file:line and key of
/// what is wrong.
TestedSoil readTestedSoil(const std::string& nameOrFile, double grainRadius);

/// The number of a key of the material; `otherwise` where it has none.
double numberOf(const TestedSoil& soil, const std::string& key, double otherwise);
/// Gives a key of the material another value, or adds it, and what follows from it.
void setNumber(TestedSoil& soil, const std::string& key, double value);

/// The material of section `key` of a file, and its [bed], as readTestedSoil() takes them.
TestedSoil readMaterial(const base::Section& root, const std::string& key, const std::filesystem::path& file,
                        double grainRadius);

} // namespace grouser::virtual_tests
