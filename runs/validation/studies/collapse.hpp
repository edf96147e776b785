// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"
#include "runs/virtual_tests/sample.hpp"

#include <string>
#include <vector>

/// A column of grains whose gate is taken away: how far it runs, against the laws measured in channels (Lube et al.
/// 2005, Lajeunesse et al. 2005).
namespace grouser::studies {

/// One collapse.
struct Collapse {
  double aspect = 0; ///< [-] height of the column before over its length
  double runOut = 0; ///< [-] (x_end - d0) / d0, where the deposit is half a diameter deep
  double height = 0; ///< [-] of the deposit at the back wall over d0
  double time = 0;   ///< [s] when the front had come within one diameter of its end, over sqrt(h0 / g) [-]
  std::size_t grains = 0;
  bool rests = true; ///< within the time given
};

/// A column `length` diameters long and about `aspect` times as high, `width` diameters between periodic boundaries. It
/// runs with `contact`, a word of run.contact.
Collapse collapseColumn(const virtual_tests::SampleGrains& material, double length, double width, double aspect,
                        std::int64_t seed, const std::string& contact = "penalty");

/// What experiments in channels found, for any material: run-out, height of the deposit over d0, time over sqrt(h0 /
/// g).
double channelRunOut(double aspect);
double channelHeight(double aspect);
inline constexpr double kChannelTime = 3.3;

struct CollapseCommand {
  jobs::StudyPlace place;
  double length = 20, width = 5; ///< [d]
  int seeds = 4;
  std::string contact = "penalty"; ///< word of run.contact
  std::vector<double> aspects = {0.5, 1, 2, 3};
};
/// `grouser study collapse`
void studyCollapseCommand(const CollapseCommand& command);

} // namespace grouser::studies
