// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/plate_bed.hpp"
#include "runs/virtual_tests/plate_test.hpp"

/// Angle of repose of a periodic bed that is tilted until it flows, and back until it rests.
namespace grouser::virtual_tests {

struct ReposeTest {
  double length = 24, width = 16, depth = 14; ///< [d]
  double from = 12, most = 60;                ///< [deg] initial and maximum tilt
  double up = 1, down = 0.5;                  ///< [deg] tilt increments per stage
  double stage = 10;                          ///< [sqrt(d / g)] duration of a stage
  double flows = 0.1, rests = 0.01;           ///< [sqrt(g d)] rms speed above which grains flow, below which they rest
};

/// Columns of a run's table, one row per stage: tilt, and speed at its end.
inline const std::vector<std::string> kReposeColumns = {"tilt [deg]", "speed [sqrt(g d)]", "porosity [-]"};

/// Prepares a bed and tilts it by rotating gravity, with contact history.
jobs::Table tiltBed(const Soil& soil, const ReposeTest& test, std::int64_t seed, const std::filesystem::path& folder,
                    const base::Exec& exec, const PlateProgress& tell);

struct ReposeAngles {
  double starts = 0; ///< [deg] at which flow starts: angle of stability
  double repose = 0; ///< [deg] at which flow stops
};
/// NaN if the bed never flowed, or never came to rest.
ReposeAngles reposeAngles(const jobs::Table& run, const ReposeTest& test);

} // namespace grouser::virtual_tests
