// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/box.hpp"

#include <array>
#include <functional>
#include <string>

/// Contact decisions between spheres in several arithmetics, on the configurations of a run. Reference: exact integers,
/// as used by the step in any precision.
namespace grouser::studies {

/// Arithmetic of the comparison of squared distance and squared diameter.
enum TouchArithmetic {
  kFloatFromOrigin, ///< positions as float metres from the scene's origin
  kFloatFromCell,   ///< positions as float metres from the corner of a cell about as wide as a grain
  kFloatDifference, ///< exact integer difference, rounded to float units
  kDoubleMetres,    ///< positions as double metres from the origin (exact)
  kTouchArithmetics
};
const char* touchArithmeticName(int arithmetic);

/// Whether the squared distance is below the squared diameter in this arithmetic.
bool touchesIn(TouchArithmetic arithmetic, const base::Position& a, const base::Position& b,
               const base::PositionScale& scale, std::int64_t diameterUnits);
/// Decision of the step (exact integers).
bool touchesExactly(const base::Position& a, const base::Position& b, std::int64_t diameterUnits);

struct TouchCounts {
  std::int64_t pairs = 0;    ///< candidate pairs on the neighbour list
  std::int64_t touching = 0; ///< pairs in contact, exact
  double nearest = 1e300;    ///< smallest |distance - diameter| of all [m]
  struct Disagreements {
    std::int64_t missed = 0, invented = 0; ///< contacts missed; contacts reported without contact
    double widest = 0;                     ///< largest |distance - diameter| of a wrong decision [m]
    std::int64_t count() const { return missed + invented; }
  };
  std::array<Disagreements, kTouchArithmetics> wrong;
  void add(const base::Position& a, const base::Position& b, const base::PositionScale& scale,
           std::int64_t diameterUnits);
  void add(const TouchCounts& more);
};

/// All pairs on the grains' neighbour list, each once. Requires a valid list.
TouchCounts judgePairs(const terrain::Grains& grains, std::int64_t diameterUnits);

/// One configuration of a run.
struct TouchConfiguration {
  std::int64_t step = 0;
  TouchCounts counts;
  double kineticPerGrain = 0; ///< [J]
  double changed = 0;         ///< contacts made or lost since the previous configuration / contacts [-]
  /// Grains whose contacts with grains, and with walls, differ between a step in single and one in double precision.
  std::int64_t grainListsDiffer = 0, wallListsDiffer = 0;
};

struct TouchStudy {
  std::int64_t grains = 100'000;
  int configurations = 100;
  std::int64_t every = 100; ///< steps between them
  int threads = 0;          ///< 0: all
};
/// `done` is called after each configuration.
std::vector<TouchConfiguration> studyTouch(const TouchStudy& study,
                                           const std::function<void(const TouchConfiguration&)>& done);
std::string touchTable(const std::vector<TouchConfiguration>& all, const TouchStudy& study);
std::string touchCsv(const std::vector<TouchConfiguration>& all);

} // namespace grouser::studies
