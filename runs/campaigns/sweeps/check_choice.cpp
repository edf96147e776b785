// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/check_choice.hpp"

#include "base/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace grouser::sweeps {

namespace {

/// Number of seeds of a case if seed-dependent cases have `seeds` seeds.
int seedsOf(const CheckCases& cases, std::size_t c, int seeds) {
  return !cases.seeded || cases.cases[c].axis == CheckAxis::skin ? 1 : seeds;
}

/// Sums the cost of the runs chosen so far.
class Spending {
public:
  Spending(const CheckCases& cases, const RunCosts& costs)
      : cases_(&cases), costs_(&costs), taken_(cases.cases.size(), 0), settled_(cases.cases.size(), 0) {}

  /// Increases the number of seeds of a case to `seeds`.
  void take(std::size_t c, int seeds) {
    const CheckCase& one = cases_->cases[c];
    seconds_ += costs_->run * one.cost * (seeds - taken_[c]);
    const int bed = c < costs_->beds.size() ? costs_->beds[c] : static_cast<int>(c);
    int& settled = settled_[static_cast<std::size_t>(bed)];
    for (; settled < seeds; ++settled)
      if (!costs_->isKept || !costs_->isKept(bed, settled)) seconds_ += costs_->settling * one.settling;
    taken_[c] = seeds;
  }
  double seconds() const { return seconds_; }
  const std::vector<int>& taken() const { return taken_; }

private:
  const CheckCases* cases_;
  const RunCosts* costs_;
  std::vector<int> taken_;   // seeds [cases]
  std::vector<int> settled_; // number of seeds with a settled or cached bed [beds]
  double seconds_ = 0;
};

} // namespace

CheckChoice chooseRuns(const CheckCases& cases, int seeds, std::optional<double> budget, const RunCosts& costs,
                       int jobs) {
  CheckChoice choice;
  const double most = budget ? *budget * jobs : HUGE_VAL;
  Spending spent(cases, costs);
  const int first = budget ? std::min(seeds, kFewSeeds) : seeds;
  for (std::size_t c = 0; c < cases.cases.size(); ++c) {
    if (!cases.cases[c].refused.empty()) continue;
    Spending more = spent;
    more.take(c, seedsOf(cases, c, first));
    if (c > 0 && more.seconds() > most)
      choice.beyondBudget.push_back(c);
    else
      spent = std::move(more);
  }
  for (int count = first + 1; budget && cases.seeded && count <= seeds; ++count) {
    Spending more = spent;
    for (std::size_t c = 0; c < cases.cases.size(); ++c)
      if (spent.taken()[c] > 0) more.take(c, seedsOf(cases, c, count));
    if (more.seconds() > most) break;
    spent = std::move(more);
  }
  choice.seeds = spent.taken(), choice.seconds = spent.seconds() / jobs;
  return choice;
}

double secondsOf(const CheckCases& cases, const RunCosts& costs, const std::vector<int>& seeds) {
  Spending spent(cases, costs);
  for (std::size_t c = 0; c < seeds.size(); ++c) spent.take(c, seeds[c]);
  return spent.seconds();
}

nlohmann::json choiceJson(const CheckChoice& choice) {
  return {{"seeds", choice.seeds}, {"left_out", choice.beyondBudget}, {"seconds", choice.seconds}};
}

std::optional<CheckChoice> keptChoice(const nlohmann::json& json, const CheckCases& cases, int most) {
  try {
    CheckChoice choice;
    json.at("seeds").get_to(choice.seeds), json.at("left_out").get_to(choice.beyondBudget);
    json.at("seconds").get_to(choice.seconds);
    const bool fits =
        choice.seeds.size() == cases.cases.size() &&
        std::all_of(choice.seeds.begin(), choice.seeds.end(), [most](int s) { return s >= 0 && s <= most; }) &&
        std::all_of(choice.beyondBudget.begin(), choice.beyondBudget.end(),
                    [&](std::size_t c) { return c < cases.cases.size(); });
    return fits ? std::optional(choice) : std::nullopt;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

double budgetSeconds(const std::string& text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::string unit(end, text.data() + text.size());
  const double factor = unit.empty() || unit == "s" ? 1 : unit == "min" ? 60 : unit == "h" ? 3600 : 0;
  const double seconds = factor * number;
  constexpr double kMax = 3600.0 * 10'000;
  if (error != std::errc() || !(seconds >= 1 && seconds <= kMax))
    throw base::InputError(
        fmt::format("--budget {}: must be a time between 1 s and 10000 h, e.g. 90s, 20min or 1.5h", text));
  return seconds;
}

} // namespace grouser::sweeps
