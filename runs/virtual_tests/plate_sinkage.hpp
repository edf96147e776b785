// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/plate_pace.hpp"
#include "runs/virtual_tests/plate_test.hpp"
#include "runs/virtual_tests/pressure_sinkage.hpp"

/// A rough strip pushed into a bed to a pressure or a sinkage, whichever comes first, held until waves have decayed,
/// unloaded and reloaded.
namespace grouser::virtual_tests {

struct PlateSinkage {
  PlateTest strip;
  double mostPressure = 100e3; ///< [Pa] end of loading, unless strip.sinkage is reached first
  double lift = 12;            ///< [d] thickness of the lifts, for all breadths
  double quiet = 20e3;         ///< [Pa] reference pressure of strip.inertialNumber
  double added = 2e3;          ///< [Pa] pressure that waves may add (PlatePace)
  double firstModulus = 1e6;   ///< [Pa] of the bed, for the initial speed

  double fastest(const Soil& soil) const; ///< [m/s] by strip.inertialNumber
  PlatePace pace(const Soil& soil) const;
  BedPreparation preparation(const Soil& soil) const;
};

/// Columns of a run's table; constant from "porosity". Phases: 0 loading, 3 hold, 1 unloading, 2 reloading.
inline const std::vector<std::string> kSinkageColumns = {
    "phase",       "sinkage [m]",         "pressure [Pa]", "porosity [-]",         "grains",
    "bed's steps", "bed's wall time [s]", "plate's steps", "plate's wall time [s]"};

/// Prepares a bed and performs all phases. Sinkage is from the mean surface of the bed. `folder`: temporary files, and
/// bed.txt with the bed, which is reused.
jobs::Table pushStrip(const Soil& soil, const PlateSinkage& test, std::int64_t seed,
                      const std::filesystem::path& folder, const base::Exec& exec, const PlateProgress& tell);

/// Share of the pressure at the end of loading that is lost during the hold, i.e. added by waves and inertia [-]; NaN
/// without hold.
double addedByMotion(const jobs::Table& run);

/// The loading part of a run.
SinkageCurve loadingCurve(const jobs::Table& run);

/// Unloading and reloading stiffness of one run.
struct Unloading {
  double from = 0;      ///< [Pa] initial pressure
  double stiffness = 0; ///< [Pa/m] k_u: slope of the pressure between 80 % and 20 % of that, by least squares
  double reloading = 0; ///< [Pa/m] the same for reloading
};
/// NaN for a part with fewer than three points.
Unloading unloadingOf(const jobs::Table& run);

} // namespace grouser::virtual_tests
