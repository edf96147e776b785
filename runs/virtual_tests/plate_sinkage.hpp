// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/plate_pace.hpp"
#include "runs/virtual_tests/plate_test.hpp"
#include "runs/virtual_tests/pressure_sinkage.hpp"

/// A rough strip is pushed into a bed until it reaches a pressure or a sinkage, held until waves have decayed, unloaded
/// and reloaded.
namespace grouser::virtual_tests {

struct PlateSinkage {
  PlateTest strip;
  double maxPressure = 100e3; ///< [Pa] pressure at which loading ends, unless strip.sinkage is reached first
  double lift = 12;           ///< [d] thickness of the lifts, for all breadths
  double quiet = 20e3;        ///< [Pa] reference pressure of strip.inertialNumber
  double added = 2e3;         ///< [Pa] pressure that waves may add (PlatePace)
  double firstModulus = 1e6;  ///< [Pa] initial estimate of the modulus of the bed, for the initial speed

  double fastest(const Soil& soil) const; ///< [m/s] maximum speed, from strip.inertialNumber
  PlatePace pace(const Soil& soil) const;
  BedPreparation preparation(const Soil& soil) const;
};

/// Columns of a run's table; the values from "porosity" on are the same in all rows. Phases: 0 loading, 3 hold,
/// 1 unloading, 2 reloading.
inline const std::vector<std::string> kSinkageColumns = {
    "phase",       "sinkage [m]",         "pressure [Pa]", "porosity [-]",         "grains",
    "bed's steps", "bed's wall time [s]", "plate's steps", "plate's wall time [s]"};

/// Prepares a bed and performs all phases. Sinkage is measured from the mean surface of the bed. `folder`: contains
/// temporary files, and bed.txt with the bed, which later calls reuse.
jobs::Table pushStrip(const Soil& soil, const PlateSinkage& test, std::int64_t seed,
                      const std::filesystem::path& folder, const base::Exec& exec, const PlateProgress& report);

/// Relative decrease of the pressure during the hold [-]: the fraction of the pressure at the end of loading that waves
/// and inertia added. NaN if there was no hold.
double addedByMotion(const jobs::Table& run);

/// The loading phase of a run.
SinkageCurve loadingCurve(const jobs::Table& run);

/// Unloading and reloading stiffness of one run.
struct Unloading {
  double from = 0;      ///< [Pa] pressure at which unloading starts
  double stiffness = 0; ///< [Pa/m] k_u: least-squares slope of the pressure from 80 % to 20 % of `from`
  double reloading = 0; ///< [Pa/m] the same slope for reloading
};
/// NaN for a phase with fewer than three points.
Unloading unloadingOf(const jobs::Table& run);

} // namespace grouser::virtual_tests
