// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/box.hpp"

#include <array>
#include <functional>
#include <string>

/// Contact decisions between spheres in several arithmetics, in configurations of a run. The reference are exact
/// integers, which a step uses in any precision.
namespace grouser::studies {

/// Arithmetic of the comparison of squared distance and squared diameter.
enum TouchArithmetic {
  kFloatFromOrigin, ///< positions in metres from the scene's origin, in single precision
  kFloatFromCell,   ///< positions in metres from the corner of a cell about as wide as a grain, in single precision
  kFloatDifference, ///< exact integer difference in units, rounded to single precision
  kDoubleMetres,    ///< positions in metres from the origin, in double precision (exact)
  kTouchArithmetics
};
const char* touchArithmeticName(int arithmetic);

/// True if the squared distance is below the squared diameter in this arithmetic.
bool touchesIn(TouchArithmetic arithmetic, const base::Position& a, const base::Position& b,
               const base::PositionScale& scale, std::int64_t diameterUnits);
/// Contact decision of a step (exact integers).
bool touchesExactly(const base::Position& a, const base::Position& b, std::int64_t diameterUnits);

struct TouchCounts {
  std::int64_t pairs = 0;    ///< candidate pairs on the neighbour list
  std::int64_t touching = 0; ///< pairs in contact according to exact integers
  double nearest = 1e300;    ///< smallest |distance - diameter| of all pairs [m]
  struct Disagreements {
    std::int64_t missed = 0, invented = 0; ///< missed contacts; false contacts
    double widest = 0;                     ///< largest |distance - diameter| among the wrong decisions [m]
    std::int64_t count() const { return missed + invented; }
  };
  std::array<Disagreements, kTouchArithmetics> wrong;
  void add(const base::Position& a, const base::Position& b, const base::PositionScale& scale,
           std::int64_t diameterUnits);
  void add(const TouchCounts& more);
};

/// Decides all pairs on the neighbour list of `grains`, each once. Requires a valid list.
TouchCounts judgePairs(const terrain::Grains& grains, std::int64_t diameterUnits);

/// One configuration of a run.
struct TouchConfiguration {
  std::int64_t step = 0;
  TouchCounts counts;
  double kineticPerGrain = 0; ///< mean kinetic energy of a grain [J]
  double changed = 0;         ///< contacts made or lost since the previous configuration / all contacts [-]
  /// Grains with different contacts (with grains, with walls) in a step in single and a step in double precision.
  std::int64_t grainListsDiffer = 0, wallListsDiffer = 0;
};

struct TouchStudy {
  std::int64_t grains = 100'000;
  int configurations = 100;
  std::int64_t every = 100; ///< number of steps between configurations
  int threads = 0;          ///< number of CPU threads; 0: all
};
/// Calls `done` after each configuration.
std::vector<TouchConfiguration> studyTouch(const TouchStudy& study,
                                           const std::function<void(const TouchConfiguration&)>& done);
std::string touchTable(const std::vector<TouchConfiguration>& all, const TouchStudy& study);
std::string touchCsv(const std::vector<TouchConfiguration>& all);

} // namespace grouser::studies
