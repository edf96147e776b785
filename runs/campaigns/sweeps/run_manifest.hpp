// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace grouser::sweeps {

/// manifest.json of a run's folder; every entry is missing if the file is missing or damaged.
class RunManifest {
public:
  explicit RunManifest(const std::filesystem::path& folder);

  double number(const char* key) const;    ///< NaN where it is missing
  double figure(const char* key) const;    ///< of the run's figures; NaN where it is missing
  std::string text(const char* key) const; ///< empty where it is missing
  std::string commit() const;              ///< of the program; empty where it is missing
  /// All steps of the run over the timed ones: a resumed run has times since its checkpoint. Excludes steps before a
  /// branch.
  double stepsOverTimed() const;
  double wallTime() const; ///< of all steps, extrapolated for a resumed run [s]; NaN: missing

private:
  nlohmann::json json_;
};

} // namespace grouser::sweeps
