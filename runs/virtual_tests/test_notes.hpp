// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/pieces.hpp"
#include "runs/virtual_tests/plan.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// Notes of failed tests beside their tables, with the reason.
namespace grouser::virtual_tests {

enum class TestNote {
  unsound,     ///< failed, no table
  shorterSteps ///< repeated with shorter steps
};

struct NotedTest {
  std::string name, why;
};

std::filesystem::path noteFile(const jobs::Pieces& pieces, const PlannedTest& test, TestNote kind);
/// In the order of the plan.
std::vector<NotedTest> notedTests(const TestPlan& plan, const jobs::Pieces& pieces, TestNote kind);
/// One line per test, each after a line break; empty without tests.
std::string textOf(const std::vector<NotedTest>& tests);
/// Message about failed tests, with remedy.
std::string failedTestsText(const std::vector<NotedTest>& tests);

} // namespace grouser::virtual_tests
