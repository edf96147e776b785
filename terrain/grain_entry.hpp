// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_arrays.hpp"

#include <optional>
#include <vector>

/// Grains that are about to enter: whether they may, and how the state holds them.
namespace grouser::terrain {

struct GrainSystem;

/// How many of these never move.
std::size_t fixedAmong(const std::vector<GrainSpec>& grains);

/// Where the grains lie; the first of them has the id `first`. Throws InputError where one lies outside the range of
/// the integer positions or beyond periodic boundaries, or where a fixed one has a velocity.
std::vector<base::Position> placesOf(const std::vector<GrainSpec>& start, std::size_t first, const GrainConstants& c);

/// Throws InputError when two grains have the same place: no direction would push them apart. Takes the threads of
/// `exec`, of a GPU those of its host.
void checkDistinct(const base::Exec& exec, const std::vector<base::Position>& position,
                   const std::vector<std::uint32_t>& id);

/// What keeps a grain from entering: it would lie in another grain or in a surface, deeper than the model allows.
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
