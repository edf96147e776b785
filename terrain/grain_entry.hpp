// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_arrays.hpp"

#include <optional>
#include <vector>

/// Checks and conversion of entering grains.
namespace grouser::terrain {

struct GrainSystem;

/// Number of fixed grains.
std::size_t fixedAmong(const std::vector<GrainSpec>& grains);

/// Integer positions of grains; the first has the id `first`. Throws InputError if a grain lies outside the range of
/// positions or the periodic boundaries, or if a fixed one has a velocity.
std::vector<base::Position> placesOf(const std::vector<GrainSpec>& start, std::size_t first, const GrainConstants& c);

/// Throws InputError if two grains have the same position: no direction would push them apart. Uses the threads of
/// `exec`, for a GPU those of its host.
void checkDistinct(const base::Exec& exec, const std::vector<base::Position>& position,
                   const std::vector<std::uint32_t>& id);

/// Overlap of an entering grain with another grain or a surface that exceeds the model's limit.
struct InsertionOverlap {
  std::size_t entering{};             ///< its place in the list of those that enter
  double overlap{};                   ///< [m]
  std::optional<std::uint32_t> grain; ///< id of the other one; none: it is a surface
  base::Vec3d position;               ///< of that grain [m]
  std::size_t surface{};              ///< or the place of that surface among those of the boundaries
};

/// The first overlap with a surface, or the deepest with a grain. All ranks call it.
std::optional<InsertionOverlap> insertionOverlapOf(const std::vector<GrainSpec>& entering, const GrainSystem& system);

} // namespace grouser::terrain
