// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "coupling/simulation.hpp"
#include "runs/virtual_tests/sample.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// Disordered beds of spheres for virtual soil tests: pouring, settling, and transfer between scenes.
namespace grouser::virtual_tests {

/// The spheres of a soil, and the preparation of a bed.
struct Soil {
  SampleGrains grains;
  double spread = 0.25;                    ///< half width of the uniform radius distribution (by number) / mean radius
  double preparationFriction = 0.5;        ///< [-] friction during settling; a lower friction makes the bed denser
  std::string preparationLaw;              ///< replaces grains.law during settling; empty: no replacement
  double stepsPerContact = 14;             ///< steps per shortest contact
  double impactSpeed = 0;                  ///< [m/s] for the time step of Hertz contacts, if above 0
  double meanVolume() const;               ///< mean grain volume [m3]
  Soil prepared() const;                   ///< soil with the friction and the law used during settling
  std::string toml(double friction) const; ///< [material.grain]
  /// First sections of a scene: [run] and the material. `run`: further keys of [run].
  std::string scene(double duration, std::int64_t seed, double friction, const base::Vec3d& gravity,
                    const std::string& run) const;
};

struct BedGrain {
  base::Vec3d position; ///< [m]
  double radius = 0;    ///< [m]
};
using BedGrains = std::vector<BedGrain>;

/// Periodic box: x from 0 to `length`, y from 0 to `width`; and the depth of its bed.
struct BedSize {
  double length = 0, width = 0, depth = 0; ///< [m]
  std::string run() const;                 ///< keys of [run] for the periodic boundaries
};

/// Pours a bed from a cloud onto `below` (scene sections with a floor at about z = 0) and settles it. `folder`:
/// contains the files of `below`. `kept`: folder of poured beds, which are reused for identical scenes; empty: beds are
/// not kept. Throws SimulationError if the bed does not come to rest.
BedGrains pourBed(const Soil& soil, const BedSize& size, const std::string& below, std::int64_t seed,
                  const std::filesystem::path& folder, const base::Exec& exec, const std::filesystem::path& kept = {});
/// Removes the beds that pourBed() has stored in `kept`.
void removePoured(const std::filesystem::path& kept);

/// A rough floor: a layer of fixed grains with their tops at about z = 0.
BedGrains roughFloor(const Soil& soil, const BedSize& size, std::int64_t seed);
/// Maximum depth that rough-floor grains reach below z = 0 [m].
double roughFloorDepth(const Soil& soil);

/// Writes a comment line that ends with `more`, then a line with x, y, z, r [m] for each grain, as [[grains]] with
/// form = "file" require. The file is replaced atomically.
void writeBed(const std::filesystem::path& file, const BedGrains& grains, const std::string& more = "");
/// Reads a file of writeBed(). Throws InputError if the file cannot be read.
BedGrains readBed(const std::filesystem::path& file);
/// Grains of a run at its present time, wrapped into the periodic box `size`.
BedGrains grainsOf(const coupling::Simulation& simulation, const BedSize& size);

/// Steps until the kinetic energy of all grains is below `energy` [J] in three successive checks, or until `limit` [s].
/// Returns the maximum energy in the last checks / `energy` [-]: below 1 if the bed is at rest.
double comeToRest(coupling::Simulation& simulation, double energy, double limit);
/// Throws the SimulationError for a bed that is not at rest after `limit` [s]. `energy`: mean kinetic energy / (m g r).
[[noreturn]] void failRestless(std::int64_t seed, double limit, double energy);

/// Solid fraction between two heights [-].
double solidFraction(const BedGrains& grains, const BedSize& size, double low, double high);
/// Height of the surface [m]: mean of the highest points in columns that are two grains wide.
double surfaceHeight(const BedGrains& grains, const BedSize& size, double diameter);

} // namespace grouser::virtual_tests
