// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/results.hpp"
#include "runs/virtual_tests/test_notes.hpp"

/// What is printed and written of a soil's tests.
namespace grouser::virtual_tests {

/// The table of constants: measured, published, and whether the one lies in the other.
std::string constantsTable(const TestPlan& plan, const SoilResults& results);
/// Plates, unloading, curves of shear, costs.
std::string detailsTable(const TestPlan& plan, const SoilResults& results);

std::string constantsCsv(const TestPlan& plan, const SoilResults& results);
std::string platesCsv(const TestPlan& plan, const jobs::Pieces& pieces);
std::string shearCsv(const TestPlan& plan, const jobs::Pieces& pieces);
/// Of numbers that are none null.
nlohmann::ordered_json estimateJson(const support::Estimate& estimate, const std::string& unit);
nlohmann::ordered_json resultsJson(const TestPlan& plan, const SoilResults& results, int missing,
                                   const std::vector<NotedTest>& shorterSteps);

/// Prints the tables, writes soil.json, soil.txt, constants.csv, plates.csv and shear.csv, and draws.
void reportSoil(const TestPlan& plan, const jobs::Pieces& pieces, int missing);

} // namespace grouser::virtual_tests
