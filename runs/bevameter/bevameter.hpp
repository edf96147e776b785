// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/bevameter/plan.hpp"
#include "runs/studies/pieces.hpp"

#include <string>

/// `grouser soil NAME`: a soil's constants measured in a virtual bevameter.
namespace grouser::bevameter {

struct SoilCommand {
  std::string soil;          ///< a name, or a file that ends in .toml
  double grainRadius = 0;    ///< [m]; 0: the file's
  studies::StudyPlace place; ///< folder empty: out/soil_NAME; quick: coarse
  studies::PieceOptions pieces;
  int jobs = 1; ///< tests at the same time
  PlanOptions plan;
};
void soilCommand(const SoilCommand& command);

/// Does the tests of a plan that are not there yet, `jobs` at a time, after the preparation of their beds, which it
/// puts into the plan. Returns the tests that are missing after that.
/// A test that ends unsoundly is done again with shorter steps; one that does so then leaves a note, and the others go
/// on (test_notes.hpp).
int doTests(TestPlan& plan, studies::Pieces& pieces, const studies::PieceOptions& options, int jobs);

} // namespace grouser::bevameter
