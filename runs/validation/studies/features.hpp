// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "runs/jobs/estimate.hpp"
#include "runs/jobs/pieces.hpp"
#include "runs/setup/ground_setup.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// Measures the cost of each feature of a scene if it is on, and checks that it costs nothing if it is off.
namespace grouser::studies {

struct FeaturesCommand {
  jobs::StudyPlace place;
  jobs::PieceOptions pieces;
  std::vector<std::string> features; ///< names; empty: all
  int grains = 20000;                ///< approximate number of grains
  int pairs = 10;                    ///< pairs of measurements without and with the feature
  double turn = 0.2;                 ///< duration of one measurement [s]
};
/// `grouser study features`. Throws InputError for an unknown feature.
void studyFeaturesCommand(const FeaturesCommand& command);

/// A feature: two scenes that differ only in this feature.
struct Feature {
  std::string name;
  std::string what;          ///< description: keys of the second scene
  std::string without, with; ///< keys of [run], [material] or [terrain] of both scenes: lines "section: key = value"
  bool ownBeds = false;      ///< each scene settles its own bed; else both start from the bed of the base scene
  bool neutral = false;      ///< `with` only repeats defaults, so that state and memory must be the same
  std::function<void(coupling::GroundSetup&)> change = {}; ///< changes the second scene where no key can; may be empty
};
/// All features; the neutral features come last.
const std::vector<Feature>& features();

/// Scene of the measurements: a periodic bed of about `grains` equal grains with friction in six layers, made from
/// copies of one settled tile. `keys`: lines as in Feature.
std::string featureScene(int grains, const std::string& keys);

/// One row per pair of measurements.
inline const std::vector<std::string> kFeatureColumns = {"without [ns]",   "with [ns]",   "bytes without", "bytes with",
                                                         "grains without", "grains with", "same state"};
/// Measures times per grain and step, alternately without and with the feature, and device memory per grain [bytes];
/// compares the state hashes after the same number of steps.
jobs::Table measureFeature(const FeaturesCommand& command, const Feature& feature, const base::Exec& exec);
/// Compares a vehicle on a bed with the bed without a vehicle: times per step [ns], total memory [bytes].
jobs::Table measureVehicle(const FeaturesCommand& command, const base::Exec& exec);
/// Compares steps with a row and a frame every 100 steps with steps without output. `folder`: folder of the output.
jobs::Table measureOutput(const FeaturesCommand& command, const base::Exec& exec, const std::filesystem::path& folder);

/// Compares one rank of two threads with two ranks (`mpirun`) of one thread each, which share a GPU if there is one.
/// Calls `grouser bench bed` with files in `folder`. Throws InputError if mpirun is missing or a call fails.
jobs::Table measureRanks(const FeaturesCommand& command, const std::filesystem::path& folder);

/// Cost of a feature, computed from the rows of its table.
struct FeatureCost {
  double without = 0, with = 0; ///< mean times without and with the feature [ns]
  support::Estimate difference; ///< with - without, mean over the pairs [ns]
  support::Estimate relative;   ///< difference / `without` [-]
  double bytesWithout = 0, bytesWith = 0;
  bool sameState = false;
  /// For a neutral feature: true if state and memory are the same and the times do not differ significantly.
  bool isNothing() const;
};
FeatureCost costOf(const jobs::Table& table);

} // namespace grouser::studies
