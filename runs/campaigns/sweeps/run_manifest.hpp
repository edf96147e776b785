// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace grouser::sweeps {

/// manifest.json of a run's folder. If the file is missing or damaged, all entries count as missing.
class RunManifest {
public:
  explicit RunManifest(const std::filesystem::path& folder);

  double number(const char* key) const;    ///< NaN if missing
  double figure(const char* key) const;    ///< entry of the run's figures; NaN if missing
  std::string text(const char* key) const; ///< empty if missing
  std::string commit() const;              ///< commit of the program; empty if missing
  /// Checksum of a file of the run as eight hexadecimal digits; empty if missing.
  std::string checksumOf(const char* file) const;
  /// Number of all steps / number of timed steps: the wall time of a resumed run starts at its checkpoint. Excludes
  /// steps before a branch.
  double stepsOverTimed() const;
  double wallTime() const; ///< wall time of the run, extrapolated for a resumed run [s]; NaN if missing
  /// Figure of the timed steps, extrapolated to all steps for a resumed run; NaN if missing.
  double ofAllSteps(const char* key) const;

private:
  double wholeOverTimed() const; ///< stepsOverTimed(), or 1 if that is unknown

  nlohmann::json json_;
};

} // namespace grouser::sweeps
