// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/pieces.hpp"
#include "runs/virtual_tests/plan.hpp"

#include <string>

/// `grouser soil NAME`: measures the constants of a soil in a virtual bevameter.
namespace grouser::virtual_tests {

struct SoilCommand {
  std::string soil;       ///< a name, or a file that ends in .toml
  double grainRadius = 0; ///< [m]; 0: the file's
  jobs::StudyPlace place; ///< folder empty: out/soil_NAME; quick: coarse
  jobs::PieceOptions pieces;
  int jobs = 1; ///< concurrent tests
  PlanOptions plan;
  bool fitScm = false; ///< fits the soil contact model to the tests as well
};
void soilCommand(const SoilCommand& command);

/// Performs the missing tests of a plan, `jobs` at a time, after finding the preparation of their beds, which it adds
/// to the plan. Returns the number of tests still missing. A failed test is repeated with shorter steps; if it fails
/// again it leaves a note, and the others continue (test_notes.hpp).
int doTests(TestPlan& plan, jobs::Pieces& pieces, const jobs::PieceOptions& options, int jobs);

} // namespace grouser::virtual_tests
