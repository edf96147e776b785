// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "coupling/simulation.hpp"
#include "runs/virtual_tests/sample.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// Disordered beds of spheres for virtual soil tests: poured, settled, and transferred between scenes.
namespace grouser::virtual_tests {

/// The spheres of a soil, and the preparation of a bed.
struct Soil {
  SampleGrains grains;
  double spread = 0.25;                    ///< half width of the uniform radius distribution (by number) over the mean
  double preparationFriction = 0.5;        ///< [-] during settling: smaller is denser
  std::string preparationLaw;              ///< grains.law during settling; empty: the same
  double stepsPerContact = 14;             ///< steps per shortest contact
  double impactSpeed = 0;                  ///< [m/s] for the time step of Hertz contacts, if above 0
  double meanVolume() const;               ///< mean grain volume [m3]
  Soil prepared() const;                   ///< soil with friction and law of the preparation
  std::string toml(double friction) const; ///< [material.grain]
  /// Start of a scene: [run], and the material. `run`: further keys of [run].
  std::string scene(double duration, std::int64_t seed, double friction, const base::Vec3d& gravity,
                    const std::string& run) const;
};

struct BedGrain {
  base::Vec3d position; ///< [m]
  double radius = 0;    ///< [m]
};
using BedGrains = std::vector<BedGrain>;

/// Periodic box from 0 to length and width, with depth.
struct BedSize {
  double length = 0, width = 0, depth = 0; ///< [m]
  std::string run() const;                 ///< keys of [run]
};

/// Pours a bed from a cloud onto `below` (scene sections with a floor at about z = 0) and settles it. `folder`:
/// files of `below`. `kept`: folder of poured beds, reused for identical scenes; empty: none. Throws SimulationError if
/// the bed does not come to rest.
BedGrains pourBed(const Soil& soil, const BedSize& size, const std::string& below, std::int64_t seed,
                  const std::filesystem::path& folder, const base::Exec& exec, const std::filesystem::path& kept = {});
/// Removes the files of pourBed().
void removePoured(const std::filesystem::path& kept);

/// A rough floor: fixed grains in a layer with tops at about z = 0.
BedGrains roughFloor(const Soil& soil, const BedSize& size, std::int64_t seed);
/// Maximum depth of rough-floor grains below z = 0 [m].
double roughFloorDepth(const Soil& soil);

/// Writes lines of x, y, z, r [m] for [[grains]] of form "file", after a comment line that ends with `more`. Atomic.
void writeBed(const std::filesystem::path& file, const BedGrains& grains, const std::string& more = "");
/// Reads such a file, exact to its digits. Throws InputError if it cannot be read.
BedGrains readBed(const std::filesystem::path& file);
/// Present grains of a run, wrapped into the periodic box `size`.
BedGrains grainsOf(const coupling::Simulation& simulation, const BedSize& size);

/// Steps until the kinetic energy of all grains is below `energy` [J] in three checks, or until `limit` [s]. Returns
/// the maximum energy of the last checks over `energy` [-]: below 1 at rest.
double comeToRest(coupling::Simulation& simulation, double energy, double limit);
/// Throws SimulationError for a bed not at rest after `limit` [s], with `energy` over m g r [-].
[[noreturn]] void failRestless(std::int64_t seed, double limit, double energy);

/// Solid fraction between two heights [-].
double solidFraction(const BedGrains& grains, const BedSize& size, double low, double high);
/// Height of the surface: mean top of the highest grain in columns two grains wide [m].
double surfaceHeight(const BedGrains& grains, const BedSize& size, double diameter);

} // namespace grouser::virtual_tests
