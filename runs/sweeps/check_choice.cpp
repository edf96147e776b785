// SPDX-License-Identifier: BSD-3-Clause
#include "runs/sweeps/check_choice.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace grouser::sweeps {

namespace {

constexpr int kFewSeeds = 3; // with which an interval begins to say something

/// Seeds of one case where those that scatter have `seeds`.
int seedsOf(const CheckCases& cases, std::size_t c, int seeds) {
  return !cases.seeded || cases.cases[c].axis == CheckAxis::skin ? 1 : seeds;
}

} // namespace

CheckChoice chooseRuns(const CheckCases& cases, int seeds, std::optional<double> budget, double baseSeconds, int jobs) {
  CheckChoice choice;
  choice.seeds.assign(cases.cases.size(), 0);
  double spent = 0; // in runs of the base
  const double most = budget ? *budget * jobs / baseSeconds : HUGE_VAL;
  const auto take = [&](std::size_t c, int count) {
    spent += cases.cases[c].cost * (count - choice.seeds[c]);
    choice.seeds[c] = count;
  };
  const int first = budget ? std::min(seeds, kFewSeeds) : seeds;
  for (std::size_t c = 0; c < cases.cases.size(); ++c) {
    if (!cases.cases[c].refused.empty()) continue;
    const int count = seedsOf(cases, c, first);
    if (c > 0 && spent + cases.cases[c].cost * count > most)
      choice.beyondBudget.push_back(c);
    else
      take(c, count);
  }
  for (int count = first + 1; budget && cases.seeded && count <= seeds; ++count) {
    double more = 0;
    for (std::size_t c = 0; c < cases.cases.size(); ++c)
      if (choice.seeds[c] > 0) more += cases.cases[c].cost * (seedsOf(cases, c, count) - choice.seeds[c]);
    if (spent + more > most) break;
    for (std::size_t c = 0; c < cases.cases.size(); ++c)
      if (choice.seeds[c] > 0) take(c, seedsOf(cases, c, count));
  }
  choice.seconds = spent * baseSeconds / jobs;
  return choice;
}

double budgetSeconds(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  const std::string unit = end;
  const double factor = unit.empty() || unit == "s" ? 1 : unit == "min" ? 60 : unit == "h" ? 3600 : 0;
  const double seconds = factor * number;
  if (end == text.c_str() || !std::isfinite(seconds) || seconds < 1)
    throw base::InputError(fmt::format("--budget {}: is no time; write e.g. 90s, 20min or 1.5h", text));
  return seconds;
}

} // namespace grouser::sweeps
