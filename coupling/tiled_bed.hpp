// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/ground_setup.hpp"
#include "terrain/grains.hpp"
#include "terrain/height_field.hpp"

#include <array>
#include <vector>

namespace grouser::coupling {

/// Bed composed of copies of one settled tile.
///
/// A level piece of the bed (size about terrain.tile, periodic boundaries) is built and settled by itself, then copied
/// over the terrain with its contact springs, so that the copies are in equilibrium across their seams. Grains that
/// would overlap a wall are omitted and, on uneven ground, grains with centres above the height map; the neighbours of
/// omitted grains must settle again. Every rank creates the same tile.
class TiledBed {
public:
  /// `settled`: the grains of tile.ground, at rest; `surface`: height field of the whole terrain.
  TiledBed(const TileSetup& tile, const terrain::Grains& settled, const terrain::HeightField& surface);

  /// Initial grains, by id.
  std::vector<terrain::GrainSpec> start(int material) const;
  /// Sets velocities and contact springs of these grains; `floor`: index of the floor among their boundaries.
  void bringToRest(terrain::Grains& grains, std::size_t floor) const;

private:
  /// Grain of the tile in one of the copies.
  struct Copy {
    std::array<std::int64_t, 2> tile;
    std::size_t grain; ///< row of the tile's state
  };
  base::Vec3l place(const Copy& copy) const;
  double radiusOf(std::size_t grain) const {
    return tile_.radius.empty() ? radius_ : static_cast<double>(tile_.radius[grain]);
  }
  bool isFixed(std::size_t grain) const { return !tile_.fixed.empty() && tile_.fixed[grain] != 0; }
  std::int64_t idOf(std::array<std::int64_t, 2> tile, std::size_t grain) const;

  std::array<bool, 2> periodic_{};
  std::array<std::int64_t, 2> copies_{};
  base::PositionScale scale_;
  double radius_;       ///< radius of all grains, if equal [m]
  base::Period period_; ///< periodicity of the tile
  base::Vec3l lift_{};  ///< shift from the settled tile to the first copy
  terrain::GrainState tile_;
  std::vector<Copy> grains_;     ///< sorted by id
  std::vector<std::int64_t> id_; ///< [copies x][copies y][grains of the tile]; -1: omitted
};

} // namespace grouser::coupling
