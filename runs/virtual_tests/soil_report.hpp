// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/results.hpp"
#include "runs/virtual_tests/test_notes.hpp"

/// Printed report and result files of the tests of a soil.
namespace grouser::virtual_tests {

/// Table of measured and published constants, with verdicts.
std::string constantsTable(const TestPlan& plan, const SoilResults& results);
/// Details: plates, unloading, shear curves and costs.
std::string detailsTable(const TestPlan& plan, const SoilResults& results);

std::string constantsCsv(const TestPlan& plan, const SoilResults& results);
std::string platesCsv(const TestPlan& plan, const jobs::Pieces& pieces);
std::string shearCsv(const TestPlan& plan, const jobs::Pieces& pieces);
/// JSON of an estimate; non-finite numbers become null.
nlohmann::ordered_json estimateJson(const support::Estimate& estimate, const std::string& unit);
nlohmann::ordered_json resultsJson(const TestPlan& plan, const SoilResults& results, int missing,
                                   const std::vector<NotedTest>& shorterSteps);

/// Prints the tables, writes soil.json, soil.txt, constants.csv, plates.csv and shear.csv, and plots soil.png.
void reportSoil(const TestPlan& plan, const jobs::Pieces& pieces, int missing);

} // namespace grouser::virtual_tests
