// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"
#include "runs/scene/choices.hpp"
#include "runs/virtual_tests/sample.hpp"

#include <vector>

/// Collapse of a column of grains: run-out against channel experiments (Lube et al. 2005, Lajeunesse et al. 2005).
namespace grouser::studies {

/// One collapse.
struct Collapse {
  double aspect = 0; ///< [-] initial height / initial length
  double runOut = 0; ///< [-] (x_end - d0) / d0, x_end: deposit half a diameter deep
  double height = 0; ///< [-] height of the deposit at the back wall / d0
  double time = 0;   ///< [-] time until the front is within one diameter of its end, over sqrt(h0 / g)
  std::size_t grains = 0;
  bool rests = true; ///< at rest within the maximum duration
};

/// A column `length` diameters long and about `aspect` times as high, `width` diameters between periodic boundaries.
/// `contact`: contact method during the collapse.
Collapse collapseColumn(const virtual_tests::SampleGrains& material, double length, double width, double aspect,
                        std::int64_t seed, scene::ContactMethod contact = scene::ContactMethod::penalty);

/// Fits to channel experiments, for any material: run-out, height of the deposit / d0, time / sqrt(h0 / g).
double channelRunOut(double aspect);
double channelHeight(double aspect);
inline constexpr double kChannelTime = 3.3;

struct CollapseCommand {
  jobs::StudyPlace place;
  double length = 20, width = 5; ///< [d]
  int seeds = 4;
  scene::ContactMethod contact = scene::ContactMethod::penalty;
  std::vector<double> aspects = {0.5, 1, 2, 3};
};
/// `grouser study collapse`
void studyCollapseCommand(const CollapseCommand& command);

} // namespace grouser::studies
