// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"
#include "runs/virtual_tests/sample.hpp"

#include <string>
#include <vector>

/// Solid fraction and coordination of poured spheres, against known limits of random packings.
namespace grouser::studies {

/// The interior of one poured sample, away from floor and top.
struct Packing {
  double solidFraction = 0; ///< [-] volume of the spheres, overlaps counted once
  double coordination = 0;  ///< [-] contacts per grain
  double coordinationWithoutRattlers = 0;
  double rattlers = 0; ///< [-] fraction of grains without sufficient contacts
  double overlap = 0;  ///< [-] mean overlap of the contacts, in diameters
  double rest = 0;     ///< [s] time until rest; negative: not reached
};

/// Pours `grains` spheres at a seventh of the volume between periodic boundaries `width` diameters apart, and measures.
/// Grains with fewer than `least` contacts are rattlers: four without friction, two with.
Packing pourPacking(const virtual_tests::SampleGrains& material, int grains, double width, std::int64_t seed);

struct PackingCommand {
  jobs::StudyPlace place;
  int grains = 1800, seeds = 5;
  double width = 10; ///< [d]
};
/// `grouser study packing`
void studyPackingCommand(const PackingCommand& command);

} // namespace grouser::studies
