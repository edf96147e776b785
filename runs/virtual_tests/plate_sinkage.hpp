// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/plate_pace.hpp"
#include "runs/virtual_tests/plate_test.hpp"
#include "runs/virtual_tests/pressure_sinkage.hpp"

/// A rough strip pushed into a bed to a pressure or a sinkage, whichever comes first, held until the bed's waves are
/// gone, lifted until it carries nothing, and pushed down again.
namespace grouser::virtual_tests {

struct PlateSinkage {
  PlateTest strip;
  double mostPressure = 100e3; ///< [Pa] at which loading ends, if strip.sinkage does not come first
  double lift = 12;            ///< [d] thickness in which beds are rained, alike for all breadths
  double quiet = 20e3;         ///< [Pa] pressure that strip.inertialNumber is meant at
  double added = 2e3;          ///< [Pa] that waves may add to the pressure (PlatePace)
  double firstModulus = 1e6;   ///< [Pa] of the bed, that the plate's speed begins with

  double fastest(const Soil& soil) const; ///< [m/s] by strip.inertialNumber
  PlatePace pace(const Soil& soil) const;
  BedPreparation preparation(const Soil& soil) const;
};

/// Columns of a run's table; from "porosity" on the same in all rows. Phases: 0 loading, 1 unloading, 2 reloading, and
/// between the first two 3, held where it is.
inline const std::vector<std::string> kSinkageColumns = {
    "phase",       "sinkage [m]",         "pressure [Pa]", "porosity [-]",         "grains",
    "bed's steps", "bed's wall time [s]", "plate's steps", "plate's wall time [s]"};

/// Prepares a bed and does all three. Sinkage counts from the mean surface of the bed. `folder`: for files on the way;
/// its bed.txt is the bed, which is taken from there where an earlier call has left it.
jobs::Table pushStrip(const Soil& soil, const PlateSinkage& test, std::int64_t seed,
                      const std::filesystem::path& folder, const base::Exec& exec, const PlateProgress& tell);

/// What waves and grains on the move had added to the pressure at the end of the loading: share of it that is gone when
/// the plate has been held [-]; not a number where no row is of that.
double addedByMotion(const jobs::Table& run);

/// The loading part of a run.
SinkageCurve loadingCurve(const jobs::Table& run);

/// What unloading and reloading say of one run.
struct Unloading {
  double from = 0;      ///< [Pa] pressure where it begins
  double stiffness = 0; ///< [Pa/m] k_u: slope of the pressure between 80 % and 20 % of that, by least squares
  double reloading = 0; ///< [Pa/m] the same of the reloading
};
/// No numbers where a part has fewer than three points.
Unloading unloadingOf(const jobs::Table& run);

} // namespace grouser::virtual_tests
