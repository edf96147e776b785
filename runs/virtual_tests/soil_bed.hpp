// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "coupling/simulation.hpp"
#include "runs/virtual_tests/sample.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// Disordered beds of spheres for virtual soil tests: poured, at rest, and taken from one scene into the next.
namespace grouser::virtual_tests {

/// The spheres of a soil, and how a bed of them is prepared.
struct Soil {
  SampleGrains grains;
  double spread = 0.25;                    ///< radii are uniform, by number, within this share of the mean
  double preparationFriction = 0.5;        ///< [-] between grains while they come to rest: the less, the denser
  std::string preparationLaw;              ///< grains.law while they come to rest; empty: the same
  double stepsPerContact = 14;             ///< of the shortest contact
  double impactSpeed = 0;                  ///< [m/s] above 0: that steps of Hertz' contacts are chosen for
  double meanVolume() const;               ///< of a grain [m3]
  Soil prepared() const;                   ///< with friction and law of the preparation
  std::string toml(double friction) const; ///< [material.grain]
  /// The start of a scene: [run] with these, and the material. Keys of [run] in `run` come first.
  std::string scene(double duration, std::int64_t seed, double friction, const base::Vec3d& gravity,
                    const std::string& run) const;
};

struct BedGrain {
  base::Vec3d position; ///< [m]
  double radius = 0;    ///< [m]
};
using BedGrains = std::vector<BedGrain>;

/// Between periodic boundaries at 0 and these.
struct BedSize {
  double length = 0, width = 0, depth = 0; ///< [m]
  std::string run() const;                 ///< keys of [run]
};

/// Pours a bed from a cloud upon `below` (sections of a scene that bear it at about z = 0) and lets it come to rest.
/// `folder`: where `below` looks for its files. `kept`: a folder where what was poured stays for the next call of the
/// very same scene; empty: none does. Throws SimulationError where it does not come to rest.
BedGrains pourBed(const Soil& soil, const BedSize& size, const std::string& below, std::int64_t seed,
                  const std::filesystem::path& folder, const base::Exec& exec, const std::filesystem::path& kept = {});
/// Takes away what pourBed has kept there.
void removePoured(const std::filesystem::path& kept);

/// A rough floor: places of grains that never move, in a layer whose tops reach to about z = 0.
BedGrains roughFloor(const Soil& soil, const BedSize& size, std::int64_t seed);
/// No grain of a rough floor reaches deeper below z = 0 [m].
double roughFloorDepth(const Soil& soil);

/// Lines of x, y, z, r [m], as [[grains]] of form "file" reads them, behind a line of comment that ends with `more`.
/// The file is there whole or not at all.
void writeBed(const std::filesystem::path& file, const BedGrains& grains, const std::string& more = "");
/// Such a file; to its digits what was written. Throws InputError where it cannot be read.
BedGrains readBed(const std::filesystem::path& file);
/// The grains of a run as they are now, back between their periodic boundaries of `size`.
BedGrains grainsOf(const coupling::Simulation& simulation, const BedSize& size);

/// Steps until the kinetic energy of all grains is below `energy` [J] for a while, or `limit` [s] have passed. Returns
/// the greatest energy of the last looks over `energy`: below 1 at rest [-].
double comeToRest(coupling::Simulation& simulation, double energy, double limit);
/// Of a bed that goes on moving after `limit` [s] with `energy` over m g r [-]: Throws SimulationError.
[[noreturn]] void failRestless(std::int64_t seed, double limit, double energy);

/// Volume of the grains between two heights over the volume there [-].
double solidFraction(const BedGrains& grains, const BedSize& size, double low, double high);
/// Height below which the grains fill the bed: mean of the tops of the highest grain in columns two grains wide [m].
double surfaceHeight(const BedGrains& grains, const BedSize& size, double diameter);

} // namespace grouser::virtual_tests
