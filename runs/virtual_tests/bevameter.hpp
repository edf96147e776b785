// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/pieces.hpp"
#include "runs/virtual_tests/plan.hpp"

#include <string>

/// `grouser soil NAME`: a soil's constants measured in a virtual bevameter.
namespace grouser::virtual_tests {

struct SoilCommand {
  std::string soil;       ///< a name, or a file that ends in .toml
  double grainRadius = 0; ///< [m]; 0: the file's
  jobs::StudyPlace place; ///< folder empty: out/soil_NAME; quick: coarse
  jobs::PieceOptions pieces;
  int jobs = 1; ///< tests at the same time
  PlanOptions plan;
  bool fitScm = false; ///< fits the soil contact model to the tests as well
};
void soilCommand(const SoilCommand& command);

/// Does the tests of a plan that are not there yet, `jobs` at a time, after the preparation of their beds, which it
/// puts into the plan. Returns the tests that are missing after that.
/// A test that ends unsoundly is done again with shorter steps; one that does so then leaves a note, and the others go
/// on (test_notes.hpp).
int doTests(TestPlan& plan, jobs::Pieces& pieces, const jobs::PieceOptions& options, int jobs);

} // namespace grouser::virtual_tests
