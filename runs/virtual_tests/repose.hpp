// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/plate_bed.hpp"
#include "runs/virtual_tests/plate_test.hpp"

/// The angle of repose of a bed between periodic boundaries that is tilted until it flows, and back until it rests.
namespace grouser::virtual_tests {

struct ReposeTest {
  double length = 24, width = 16, depth = 14; ///< [d]
  double from = 12, most = 60;                ///< [deg] where the tilting begins, and where it ends at the latest
  double up = 1, down = 0.5;                  ///< [deg] a stage
  double stage = 10;                          ///< [sqrt(d / g)] that an angle is held
  double flows = 0.1, rests = 0.01;           ///< [sqrt(g d)] root mean square speed of grains that flow, that rest
};

/// Columns of a run's table, a row a stage: tilt, and speed at its end.
inline const std::vector<std::string> kReposeColumns = {"tilt [deg]", "speed [sqrt(g d)]", "porosity [-]"};

/// Prepares a bed and tilts it: gravity turns, contacts keep what they remember.
jobs::Table tiltBed(const Soil& soil, const ReposeTest& test, std::int64_t seed, const std::filesystem::path& folder,
                    const base::Exec& exec, const PlateProgress& tell);

struct ReposeAngles {
  double starts = 0; ///< [deg] at which the bed begins to flow: its angle of stability
  double repose = 0; ///< [deg] at which it rests again
};
/// No numbers where the bed never flowed, or never came to rest.
ReposeAngles reposeAngles(const jobs::Table& run, const ReposeTest& test);

} // namespace grouser::virtual_tests
