// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/plate_bed.hpp"
#include "runs/virtual_tests/plate_test.hpp"

/// Angle of repose of a periodic bed, which is tilted until it flows, and tilted back until it rests.
namespace grouser::virtual_tests {

struct ReposeTest {
  double length = 24, width = 16, depth = 14; ///< [d]
  double from = 12, most = 60;                ///< [deg] initial and maximum tilt
  double up = 1, down = 0.5;                  ///< [deg] tilt increments per stage
  double stage = 10;                          ///< [sqrt(d / g)] duration of a stage
  double flows = 0.1, rests = 0.01; ///< [sqrt(g d)] the bed flows at rms speeds above `flows`, rests below `rests`
};

/// Columns of a run's table, which has a row per stage: tilt, and speed at the end of the stage.
inline const std::vector<std::string> kReposeColumns = {"tilt [deg]", "speed [sqrt(g d)]", "porosity [-]"};

/// Prepares a bed and tilts it by rotating gravity; the contact history is kept.
jobs::Table tiltBed(const Soil& soil, const ReposeTest& test, std::int64_t seed, const std::filesystem::path& folder,
                    const base::Exec& exec, const PlateProgress& report);

struct ReposeAngles {
  double starts = 0; ///< [deg] tilt at which flow starts: angle of stability
  double repose = 0; ///< [deg] tilt at which flow stops: angle of repose
};
/// Both angles are NaN if the bed never flowed; `repose` is also NaN if the bed did not come to rest again.
ReposeAngles reposeAngles(const jobs::Table& run, const ReposeTest& test);

} // namespace grouser::virtual_tests
