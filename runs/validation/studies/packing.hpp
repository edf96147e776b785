// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"
#include "runs/virtual_tests/sample.hpp"

#include <string>
#include <vector>

/// Solid fraction and coordination of poured spheres; comparison with known limits of random packings.
namespace grouser::studies {

/// Measurements in the interior of one poured sample, away from floor and top.
struct Packing {
  double solidFraction = 0; ///< [-] volume of the spheres / total volume; overlaps are counted once
  double coordination = 0;  ///< [-] contacts per grain
  double coordinationWithoutRattlers = 0;
  double rattlers = 0; ///< [-] number of rattlers / number of grains
  double overlap = 0;  ///< [d] mean overlap of the contacts
  double rest = 0;     ///< [s] time until the sample is at rest; negative: it did not come to rest
};

/// Pours `grains` spheres from a solid fraction of 1/7 between periodic boundaries `width` diameters apart. Grains with
/// fewer than `least` contacts are rattlers; use 4 without friction, and 2 with friction.
Packing pourPacking(const virtual_tests::SampleGrains& material, int grains, double width, std::int64_t seed);

struct PackingCommand {
  jobs::StudyPlace place;
  int grains = 1800, seeds = 5;
  double width = 10; ///< [d]
};
/// `grouser study packing`
void studyPackingCommand(const PackingCommand& command);

} // namespace grouser::studies
