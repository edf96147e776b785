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

/// What each feature of a scene costs when it is on, and that it costs nothing when it is off.
namespace grouser::studies {

struct FeaturesCommand {
  jobs::StudyPlace place;
  jobs::PieceOptions pieces;
  std::vector<std::string> features; ///< names; empty: all
  int grains = 20000;                ///< of the bed, about
  int pairs = 10;                    ///< of turns without and with the feature
  double turn = 0.2;                 ///< of steps, a turn [s]
};
/// `grouser study features`. Throws InputError for a name that is no feature.
void studyFeaturesCommand(const FeaturesCommand& command);

/// One feature: two scenes that differ in it alone.
struct Feature {
  std::string name;
  std::string what;          ///< what the second scene has, as its keys say it
  std::string without, with; ///< keys of [run], [material] or [terrain] that the two have: lines "section: key = value"
  bool ownBeds = false;      ///< each settles its own bed, else both begin with the grains of the base scene's
  bool neutral = false;      ///< `with` says what holds without it: state and memory must be the same
  std::function<void(coupling::GroundSetup&)> change = {}; ///< of the second one, where no key says it; may be empty
};
/// All of them; the last ones are neutral.
const std::vector<Feature>& features();

/// The scene that a feature is measured on: a periodic bed of about so many equal grains in six layers with friction,
/// copied from one settled tile. `keys`: as Feature has them.
std::string featureScene(int grains, const std::string& keys);

/// A row a pair of turns.
inline const std::vector<std::string> kFeatureColumns = {"without [ns]",   "with [ns]",   "bytes without", "bytes with",
                                                         "grains without", "grains with", "same state"};
/// Times of a grain's step in turns, bytes of device memory a grain, and whether both states had the same hash after as
/// many steps.
jobs::Table measureFeature(const FeaturesCommand& command, const Feature& feature, const base::Exec& exec);
/// The vehicle on a bed beside the bed alone: times of a whole step [ns], bytes of the process in place of a grain's.
jobs::Table measureVehicle(const FeaturesCommand& command, const base::Exec& exec);
/// A row and a frame every hundred steps beside steps alone, into `folder`.
jobs::Table measureOutput(const FeaturesCommand& command, const base::Exec& exec, const std::filesystem::path& folder);

/// One rank of two threads beside two ranks of one thread each (`mpirun`), which share a box of grains alone: calls of
/// `grouser bench bed`, whose files go into `folder`; a GPU is shared. Throws InputError where mpirun is not to be had
/// or a call fails.
jobs::Table measureRanks(const FeaturesCommand& command, const std::filesystem::path& folder);

/// What a feature costs, from the rows of its table.
struct FeatureCost {
  double without = 0, with = 0; ///< mean times [ns]
  support::Estimate difference; ///< of the pairs [ns]
  support::Estimate relative;   ///< of that, over `without` [-]
  double bytesWithout = 0, bytesWith = 0;
  bool sameState = false;
  /// Of a neutral one: same state, same bytes, and no difference of time that its interval shows.
  bool isNothing() const;
};
FeatureCost costOf(const jobs::Table& table);

} // namespace grouser::studies
