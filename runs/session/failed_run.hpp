// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "coupling/ground_setup.hpp"
#include "runs/session/run_request.hpp"
#include "runs/setup/record_setup.hpp"
#include "terrain/grains.hpp"

#include <filesystem>
#include <string>

/// What a run that failed leaves, so that its user can see why. Nothing here throws: the error that ended the run is
/// the one that is told.
namespace grouser::session {

/// Of a bed that met a fault before the run began: a folder whose manifest says so, with the bed as a frame and as a
/// picture. Several ranks leave the manifest alone, since not all of them need have met the fault.
class FailedBed {
public:
  FailedBed(const coupling::GroundSetup& ground, const setup::RecordSetup& record, const RunRequest& options,
            const base::Exec& exec);
  /// `bed`: as it is now; null where it is lost. The first call counts.
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

/// Plots of the rows that a run has written, all files of which are closed; the manifest names them.
void leavePlots(const std::filesystem::path& folder, bool ofVehicle);

} // namespace grouser::session
