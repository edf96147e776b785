// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/pieces.hpp"
#include "runs/virtual_tests/plan.hpp"

#include <string>

/// `grouser soil NAME`: measures the constants of a soil in a virtual bevameter.
namespace grouser::virtual_tests {

struct SoilCommand {
  std::string soil;       ///< name of a soil, or a file that ends in .toml
  double grainRadius = 0; ///< [m]; 0: radius in the soil file
  jobs::StudyPlace place; ///< an empty folder means out/soil_NAME; quick: coarse settings
  jobs::PieceOptions pieces;
  int jobs = 1; ///< concurrent tests
  PlanOptions plan;
  bool fitScm = false; ///< fits the soil contact model to the tests as well
};
void soilCommand(const SoilCommand& command);

/// Finds the settling friction of the beds, adds it to the plan, and performs the missing tests, `jobs` at a time.
/// Returns the number of tests that are still missing. Repeats a failed test with shorter steps; if the test fails
/// again, writes a note (test_notes.hpp) and continues with the other tests.
int doTests(TestPlan& plan, jobs::Pieces& pieces, const jobs::PieceOptions& options, int jobs);

} // namespace grouser::virtual_tests
