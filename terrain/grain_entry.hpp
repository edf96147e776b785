// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_arrays.hpp"

#include <optional>
#include <vector>

/// Validation and conversion of entering grains.
namespace grouser::terrain {

struct GrainSystem;

/// Number of fixed grains.
std::size_t fixedAmong(const std::vector<GrainSpec>& grains);

/// Returns the integer positions of grains; the first has the id `first`. Throws InputError if a grain is outside the
/// range of positions or the periodic boundaries, or a fixed grain has a velocity.
std::vector<base::Position> placesOf(const std::vector<GrainSpec>& start, std::size_t first, const GrainConstants& c);

/// Throws InputError if two grains have the same position, since the contact normal would be undefined. Uses the
/// threads of `exec`; for a GPU, the threads of its host.
void checkDistinct(const base::Exec& exec, const std::vector<base::Position>& position,
                   const std::vector<std::uint32_t>& id);

/// Overlap, above the model's limit, of an entering grain with another grain or a surface.
struct InsertionOverlap {
  std::size_t entering{};             ///< index in the list of entering grains
  double overlap{};                   ///< [m]
  std::optional<std::uint32_t> grain; ///< id of the other grain; empty: a surface
  base::Vec3d position;               ///< position of the other grain [m]
  std::size_t surface{};              ///< index of the surface in the boundaries, if `grain` is empty
};

/// Returns the first overlap with a surface, or the deepest with a grain. Collective.
std::optional<InsertionOverlap> insertionOverlapOf(const std::vector<GrainSpec>& entering, const GrainSystem& system);

} // namespace grouser::terrain
