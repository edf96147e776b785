// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"
#include "runs/scene/choices.hpp"
#include "runs/virtual_tests/sample.hpp"

#include <vector>

/// Collapse of a column of grains: compares the run-out with channel experiments (Lube et al. 2005, Lajeunesse et al.
/// 2005).
namespace grouser::studies {

/// Results of one collapse.
struct Collapse {
  double aspect = 0; ///< [-] initial height / initial length
  double runOut = 0; ///< [-] (x_end - d0) / d0; at x_end the deposit is half a diameter deep, d0: initial length
  double height = 0; ///< [-] height of the deposit at the back wall / d0
  double time = 0;   ///< [-] time until the front is within one diameter of its final position / sqrt(h0 / g)
  std::size_t grains = 0;
  bool rests = true; ///< true if the grains came to rest within the maximum duration
};

/// Collapse of a column: `length` diameters long, about `aspect` times as high, and `width` diameters wide between
/// periodic boundaries. `contact`: contact method during the collapse.
Collapse collapseColumn(const virtual_tests::SampleGrains& material, double length, double width, double aspect,
                        std::int64_t seed, scene::ContactMethod contact = scene::ContactMethod::penalty);

/// Fits to channel experiments, valid for any material: run-out, height of the deposit / d0, time / sqrt(h0 / g).
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
