// SPDX-License-Identifier: BSD-3-Clause
// Combinations of features for which kernels are compiled. Kernels are instantiated (grain_kernels.cu, grain_simd.hpp)
// and selected (kernel_choice.cpp) from these lists.
#pragma once

#include "terrain/grain_model.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace grouser::terrain::detail {

using contact::kCohesion;
using contact::kFriction;
using contact::kHertz;
using contact::kPlastic;
using contact::kRollingFriction;

template <std::size_t... kSizes>
constexpr std::array<unsigned, (kSizes + ...)> joined(const std::array<unsigned, kSizes>&... lists) {
  std::array<unsigned, (kSizes + ...)> all{};
  std::size_t at = 0;
  const auto append = [&](const auto& list) {
    for (const unsigned features : list) all[at++] = features;
  };
  (append(lists), ...);
  return all;
}

template <std::size_t kSize> constexpr bool isListed(const std::array<unsigned, kSize>& list, unsigned features) {
  return std::find(list.begin(), list.end(), features) != list.end();
}

template <std::size_t kSize> constexpr bool allDiffer(const std::array<unsigned, kSize>& list) {
  for (std::size_t k = 0; k < kSize; ++k)
    if (std::find(list.begin() + k + 1, list.end(), list[k]) != list.end()) return false;
  return true;
}

/// Scenes always have a ledger; benchmarks may omit it.
inline constexpr unsigned kBed = kFriction | kBoundaries | kLedger;

/// Soil beds: every combination of these features.
constexpr std::array<unsigned, 32> soilKernels() {
  constexpr unsigned kEach[] = {kHertz, kRollingFriction, kManyRadii, kFixed, kLoads};
  std::array<unsigned, 32> sets{};
  for (unsigned which = 0; which < sets.size(); ++which) {
    sets[which] = kBed;
    for (unsigned k = 0; k < 5; ++k) sets[which] |= which >> k & 1 ? kEach[k] : 0u;
  }
  return sets;
}

inline constexpr std::array kOtherKernels = {
    kFriction | kBoundaries, kFriction | kBoundaries | kLoads, kFriction | kBoundaries | kFixed,
    kFriction | kBoundaries | kManyRadii, kFriction | kLedger, kFriction, kLedger, kBoundaries | kLedger,
    // between periodic boundaries
    kBed | kPeriodic, kBed | kPeriodic | kRollingFriction, kBed | kPeriodic | kManyRadii,
    kBed | kPeriodic | kManyRadii | kRollingFriction,
    // with moving surfaces
    kBed | kSurfaces, kBed | kSurfaces | kRollingFriction, kBed | kSurfaces | kFixed, kBed | kSurfaces | kManyRadii,
    kBed | kSurfaces | kFixed | kManyRadii, kBed | kSurfaces | kFixed | kManyRadii | kRollingFriction};

/// Elastic-plastic soils under a vehicle; the variants with constant attraction (`cohesion`) use Hertz's law.
inline constexpr unsigned kYielding = kBed | kPlastic | kManyRadii | kRollingFriction,
                          kEepa = kYielding | kHertz | kCohesion;
inline constexpr std::array kPlasticKernels = {kYielding,
                                               kYielding | kFixed,
                                               kYielding | kLoads,
                                               kYielding | kFixed | kLoads,
                                               kYielding | kHertz,
                                               kYielding | kHertz | kFixed,
                                               kYielding | kHertz | kLoads,
                                               kYielding | kHertz | kFixed | kLoads,
                                               kEepa,
                                               kEepa | kFixed,
                                               kEepa | kLoads,
                                               kEepa | kFixed | kLoads};

/// Cohesive Hertz soils under a vehicle.
inline constexpr unsigned kSoil = kBed | kHertz | kManyRadii, kSticky = kSoil | kCohesion;
inline constexpr std::array kCohesiveKernels = {kSticky,
                                                kSticky | kLoads,
                                                kSticky | kFixed,
                                                kSticky | kFixed | kLoads,
                                                kSticky | kRollingFriction,
                                                kSticky | kRollingFriction | kLoads,
                                                kSticky | kRollingFriction | kFixed,
                                                kSticky | kRollingFriction | kFixed | kLoads};

/// Tests of `grouser soil` between periodic boundaries: shear between toothed plates (parts); settling on fixed grains;
/// a plate on the bed (a surface).
inline constexpr unsigned kSheared = (kSoil & ~kBoundaries) | kPeriodic | kLoads,
                          kSettling = kSoil | kPeriodic | kFixed, kPressed = kSettling | kSurfaces,
                          kSlipping = kRollingFriction | kPlastic;
inline constexpr std::array kBevameterKernels = {kSheared,
                                                 kSheared | kRollingFriction,
                                                 kSheared | kCohesion,
                                                 kSheared | kCohesion | kRollingFriction,
                                                 kSheared | kSlipping,
                                                 kSheared | kSlipping | kCohesion,
                                                 kSettling,
                                                 kSettling | kRollingFriction,
                                                 kSettling | kCohesion,
                                                 kSettling | kCohesion | kRollingFriction,
                                                 kSettling | kSlipping,
                                                 kPressed,
                                                 kPressed | kRollingFriction,
                                                 kPressed | kCohesion,
                                                 kPressed | kCohesion | kRollingFriction,
                                                 kPressed | kSlipping,
                                                 kPressed | kSlipping | kCohesion};

/// Kernels of the grain step, independent of a height-map floor.
inline constexpr auto kStepKernels =
    joined(soilKernels(), kPlasticKernels, kCohesiveKernels, kBevameterKernels, kOtherKernels);
static_assert(allDiffer(kStepKernels));

/// Features that affect the kernels of walls and floor. The search on a floor requires many registers.
inline constexpr unsigned kAtBoundaries = kHertz | kFriction | kRollingFriction | kCohesion | kPlastic | kManyRadii |
                                          kManyMaterials | kSurfaces | kFloor | contact::kGeneral;
inline constexpr unsigned kSoilWalls = kHertz | kFriction | kRollingFriction | kManyRadii;
inline constexpr std::array kBoundaryKernels = {0u,
                                                kFriction,
                                                kFriction | kRollingFriction,
                                                kHertz | kFriction,
                                                kFloor,
                                                kFriction | kFloor,
                                                kFriction | kRollingFriction | kFloor,
                                                kHertz | kFriction | kFloor,
                                                kFriction | kSurfaces,
                                                kFriction | kRollingFriction | kSurfaces,
                                                kFriction | kSurfaces | kFloor,
                                                kFriction | kRollingFriction | kSurfaces | kFloor,
                                                kFriction | kManyRadii,
                                                kFriction | kManyRadii | kFloor,
                                                kFriction | kManyRadii | kSurfaces,
                                                kFriction | kManyRadii | kSurfaces | kFloor,
                                                kFriction | kRollingFriction | kManyRadii,
                                                kFriction | kRollingFriction | kManyRadii | kFloor,
                                                kHertz | kFriction | kManyRadii | kFloor,
                                                kSoilWalls,
                                                kSoilWalls | kFloor,
                                                kSoilWalls | kSurfaces,
                                                kSoilWalls | kCohesion,
                                                kSoilWalls | kCohesion | kFloor,
                                                kSoilWalls | kCohesion | kSurfaces,
                                                kSoilWalls | kCohesion | kPlastic,
                                                kSoilWalls | kCohesion | kPlastic | kFloor,
                                                kSoilWalls | kCohesion | kPlastic | kSurfaces};
static_assert(allDiffer(kBoundaryKernels));

/// Variants compiled with and without a ledger. In the grain step the feature set determines it; kernels of walls and
/// floor without a ledger are compiled for the benchmark.
constexpr bool withLedger(unsigned set, bool ofStep) { return !ofStep || set & (kLedger | contact::kGeneral); }
constexpr bool withoutLedger(unsigned set, bool ofStep) {
  return set & contact::kGeneral || (ofStep ? !(set & kLedger) : set == kFriction);
}

/// Features of the SIMD grain step that are fixed at compile time. Features tested at run time need no additional
/// kernel.
inline constexpr unsigned kSimdCompiled =
    kHertz | kFriction | kRollingFriction | kCohesion | kPlastic | kManyRadii | kLedger;
inline constexpr unsigned kSimdAsked = kBoundaries | kSurfaces | kLoads | kPeriodic | kFixed | kFloor;
/// Each of these laws with friction, with and without many radii and a ledger; and frictionless grains.
constexpr auto simdKernels() {
  constexpr std::array kLaws = {0u,
                                kHertz,
                                kRollingFriction,
                                kHertz | kRollingFriction,
                                kHertz | kCohesion,
                                kHertz | kRollingFriction | kCohesion,
                                kHertz | kRollingFriction | kPlastic,
                                kHertz | kRollingFriction | kCohesion | kPlastic,
                                kRollingFriction | kPlastic};
  std::array<unsigned, 2 + 4 * kLaws.size()> sets{0, kLedger};
  for (unsigned which = 0; which < 4 * kLaws.size(); ++which)
    sets[2 + which] = kFriction | kLaws[which / 4] | (which & 1 ? kManyRadii : 0u) | (which & 2 ? kLedger : 0u);
  return sets;
}
inline constexpr auto kSimdKernels = simdKernels();
static_assert(allDiffer(kSimdKernels));

/// Returns the SIMD kernel for grains of these features, or kGeneral.
constexpr unsigned simdKernel(unsigned features) {
  const unsigned own = features & kSimdCompiled;
  return (features & ~(kSimdCompiled | kSimdAsked)) == 0 && isListed(kSimdKernels, own) ? own : contact::kGeneral;
}

} // namespace grouser::terrain::detail
