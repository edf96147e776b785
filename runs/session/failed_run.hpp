// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "coupling/ground_setup.hpp"
#include "runs/session/run_request.hpp"
#include "runs/setup/record_setup.hpp"
#include "terrain/grains.hpp"

#include <filesystem>
#include <string>

/// Output of a failed run, for diagnosis. Nothing here throws, so that the user gets the error that ended the run.
namespace grouser::session {

/// Output of a bed that failed to settle: a folder with the error in its manifest, and the bed as a frame and a
/// picture. On several ranks, only the manifest is written, since the error may have occurred on some ranks only.
class FailedBed {
public:
  FailedBed(const coupling::GroundSetup& ground, const setup::RecordSetup& record, const RunRequest& options,
            const base::Exec& exec);
  /// `bed`: current state of the bed; null if lost. Only the first call has an effect.
  void leave(const terrain::Grains* bed, const std::string& message, base::Cause cause);

private:
  void write(const terrain::Grains* bed, const std::string& message, base::Cause cause) const;

  const RunRequest& options_;
  setup::Provenance provenance_;
  setup::OutputSetup output_;
  base::TriangleMesh ground_;
  std::string device_;
  bool left_ = false;
};

/// Plots the rows of a run with closed files, and lists the plots in the manifest.
void leavePlots(const std::filesystem::path& folder, bool ofVehicle);

} // namespace grouser::session
