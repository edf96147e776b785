// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/pieces.hpp"
#include "runs/virtual_tests/plan.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// Notes about failed tests: files beside the tables of the tests, with the reason of the failure.
namespace grouser::virtual_tests {

enum class TestNote {
  unsound,     ///< the test failed and has no table
  shorterSteps ///< the test was repeated with shorter steps
};

struct NotedTest {
  std::string name, why;
};

std::filesystem::path noteFile(const jobs::Pieces& pieces, const PlannedTest& test, TestNote kind);
/// Tests with a note of this kind, in the order of the plan.
std::vector<NotedTest> notedTests(const TestPlan& plan, const jobs::Pieces& pieces, TestNote kind);
/// One line per test, each after a line break; empty if there are no tests.
std::string textOf(const std::vector<NotedTest>& tests);
/// Error message about failed tests, with a remedy.
std::string failedTestsText(const std::vector<NotedTest>& tests);

} // namespace grouser::virtual_tests
