// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/test_notes.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

namespace grouser::virtual_tests {

std::filesystem::path noteFile(const jobs::Pieces& pieces, const PlannedTest& test, TestNote kind) {
  return pieces.folder() / "runs" / (test.name + (kind == TestNote::unsound ? ".unsound.txt" : ".shorter_steps.txt"));
}

std::vector<NotedTest> notedTests(const TestPlan& plan, const jobs::Pieces& pieces, TestNote kind) {
  std::vector<NotedTest> noted;
  for (const PlannedTest& test : plan.tests) {
    const bool isDone = kind == TestNote::shorterSteps; // only finished tests count as repeated
    if (pieces.has(test.name) != isDone) continue;
    if (std::ifstream note(noteFile(pieces, test, kind)); note)
      noted.push_back({test.name, std::string(std::istreambuf_iterator<char>(note), {})});
  }
  return noted;
}

std::string textOf(const std::vector<NotedTest>& tests) {
  std::string text;
  for (const NotedTest& t : tests) text += fmt::format("\n  {}: {}", t.name, t.why);
  return text;
}

std::string failedTestsText(const std::vector<NotedTest>& tests) {
  return "these tests failed, even with shorter steps (raise --steps-per-contact and choose a new --out folder):" +
         textOf(tests);
}

} // namespace grouser::virtual_tests
