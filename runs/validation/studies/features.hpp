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

/// Cost of each feature of a scene when it is on, and check that it costs nothing when it is off.
namespace grouser::studies {

struct FeaturesCommand {
  jobs::StudyPlace place;
  jobs::PieceOptions pieces;
  std::vector<std::string> features; ///< names; empty: all
  int grains = 20000;                ///< approximate number
  int pairs = 10;                    ///< pairs of measurements without and with the feature
  double turn = 0.2;                 ///< duration of a measurement [s]
};
/// `grouser study features`. Throws InputError for an unknown feature.
void studyFeaturesCommand(const FeaturesCommand& command);

/// One feature: two scenes that differ in this feature only.
struct Feature {
  std::string name;
  std::string what;          ///< description: keys of the second scene
  std::string without, with; ///< keys of [run], [material] or [terrain] of both: lines "section: key = value"
  bool ownBeds = false;      ///< each settles its own bed; else both start from the bed of the base scene
  bool neutral = false;      ///< `with` only repeats defaults: state and memory must be the same
  std::function<void(coupling::GroundSetup&)> change = {}; ///< change of the second scene without a key; may be empty
};
/// All features; the last ones are neutral.
const std::vector<Feature>& features();

/// Scene of the measurements: a periodic bed of about `grains` equal grains in six layers with friction, copied from
/// one settled tile. `keys`: as in Feature.
std::string featureScene(int grains, const std::string& keys);

/// One row per pair of measurements.
inline const std::vector<std::string> kFeatureColumns = {"without [ns]",   "with [ns]",   "bytes without", "bytes with",
                                                         "grains without", "grains with", "same state"};
/// Alternating times per grain and step, device memory per grain [bytes], and whether both states have the same hash
/// after the same number of steps.
jobs::Table measureFeature(const FeaturesCommand& command, const Feature& feature, const base::Exec& exec);
/// A vehicle on a bed against the bed alone: times per step [ns], memory of the process [bytes].
jobs::Table measureVehicle(const FeaturesCommand& command, const base::Exec& exec);
/// A row and a frame every hundred steps, against steps alone; output in `folder`.
jobs::Table measureOutput(const FeaturesCommand& command, const base::Exec& exec, const std::filesystem::path& folder);

/// One rank of two threads against two ranks of one thread each (`mpirun`) on a box of grains: calls of `grouser bench
/// bed` with files in `folder`; a GPU is shared. Throws InputError if mpirun is missing or a call fails.
jobs::Table measureRanks(const FeaturesCommand& command, const std::filesystem::path& folder);

/// Cost of a feature, from the rows of its table.
struct FeatureCost {
  double without = 0, with = 0; ///< mean times [ns]
  support::Estimate difference; ///< mean of the pairs [ns]
  support::Estimate relative;   ///< difference / `without` [-]
  double bytesWithout = 0, bytesWith = 0;
  bool sameState = false;
  /// For a neutral feature: same state, same memory, and no significant time difference.
  bool isNothing() const;
};
FeatureCost costOf(const jobs::Table& table);

} // namespace grouser::studies
