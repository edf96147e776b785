// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/pieces.hpp"
#include "runs/virtual_tests/plan.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// Notes that tests leave beside their tables: why they have ended unsoundly.
namespace grouser::virtual_tests {

enum class TestNote {
  unsound,     ///< there is no table
  shorterSteps ///< there is one, done again with shorter steps
};

struct NotedTest {
  std::string name, why;
};

std::filesystem::path noteFile(const jobs::Pieces& pieces, const PlannedTest& test, TestNote kind);
/// In the order of the plan.
std::vector<NotedTest> notedTests(const TestPlan& plan, const jobs::Pieces& pieces, TestNote kind);
/// Each on a line of its own, which begins with a line break; empty where there are none.
std::string textOf(const std::vector<NotedTest>& tests);
/// What a user is told of tests that have ended unsoundly, and what to do.
std::string unsoundText(const std::vector<NotedTest>& tests);

} // namespace grouser::virtual_tests
