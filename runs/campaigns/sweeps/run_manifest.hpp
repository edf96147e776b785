// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace grouser::sweeps {

/// manifest.json of a run's folder; without one, or where it is damaged, everything in it is missing.
class RunManifest {
public:
  explicit RunManifest(const std::filesystem::path& folder);

  double number(const char* key) const;    ///< NaN where it is missing
  double figure(const char* key) const;    ///< of the run's figures; NaN where it is missing
  std::string text(const char* key) const; ///< empty where it is missing
  std::string commit() const;              ///< of the program; empty where it is missing
  /// All steps of the run over those that its times are of: a run that went on from a checkpoint tells times since
  /// then. Steps before a branch are not its own.
  double stepsOverTimed() const;
  double wallTime() const; ///< all steps [s]; a resumed run measured only its last part; NaN: missing

private:
  nlohmann::json json_;
};

} // namespace grouser::sweeps
