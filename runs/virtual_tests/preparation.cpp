// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/preparation.hpp"

#include "base/math.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace grouser::virtual_tests {

namespace {

constexpr double kFirstFriction = 0.2; // [-] settling friction of the first trial
constexpr std::size_t kMaxBeds = 14;
constexpr double kWider = 4; // factor between frictions while all trials are on one side of the target
constexpr double kTolerance = 0.002, kCoarseTolerance = 0.004;
constexpr double kBedWidth = 12, kCoarseBedWidth = 8; // [d] width of the small bed
constexpr double kLifts = 2, kCoarseLifts = 1;
constexpr double kInside = 0.1; // minimum distance of a trial from both ends of its interval / interval width

double porosityWith(const TestPlan& plan, double friction, const std::filesystem::path& folder, const base::Exec& exec,
                    const std::function<void(const std::string&)>& report) {
  Soil soil = plan.grains;
  soil.preparationFriction = friction;
  const double d = soil.grains.diameter(), width = (plan.options.coarse ? kCoarseBedWidth : kBedWidth) * d;
  BedPreparation bed;
  bed.size = {width, width, (plan.options.coarse ? kCoarseLifts : kLifts) * plan.small.lift * d};
  bed.lift = plan.small.lift * d;
  const BedGrains grains = prepareBed(soil, bed, 1, folder, exec, report).grains;
  const double surface = surfaceHeight(grains, bed.size, d), off = PlateTest::kOffEnds * d;
  return 1 - solidFraction(grains, bed.size, off, surface - off);
}

} // namespace

double nextFriction(const std::vector<std::vector<double>>& trials, double porosity, double tolerance) {
  if (trials.empty()) return kFirstFriction;
  if (trials.size() >= kMaxBeds) return 0;
  // The nearest trial on each side of the target; the porosity increases with friction.
  const std::vector<double>*loose = nullptr, *dense = nullptr;
  for (const std::vector<double>& t : trials) {
    if (std::fabs(t[1] - porosity) <= tolerance) return 0;
    const std::vector<double>*& side = t[1] > porosity ? loose : dense;
    if (!side || (t[1] > porosity ? t[0] < (*side)[0] : t[0] > (*side)[0])) side = &t;
  }
  if (!loose) return (*dense)[0] >= kMaxSettlingFriction ? 0 : std::min(kMaxSettlingFriction, kWider * (*dense)[0]);
  if (!dense) return (*loose)[0] <= kMinSettlingFriction ? 0 : std::max(kMinSettlingFriction, (*loose)[0] / kWider);
  const double low = base::log((*dense)[0]), high = base::log((*loose)[0]);
  if (high - low < 0.01) return 0; // the porosity jumps between these frictions
  const double share = (porosity - (*dense)[1]) / ((*loose)[1] - (*dense)[1]);
  return base::exp(low + (high - low) * std::clamp(share, kInside, 1 - kInside));
}

const std::vector<double>& nearestTrial(const std::vector<std::vector<double>>& trials, double porosity) {
  return *std::min_element(trials.begin(), trials.end(), [&](const auto& a, const auto& b) {
    return std::fabs(a[1] - porosity) < std::fabs(b[1] - porosity);
  });
}

jobs::Table findPreparation(const TestPlan& plan, const std::filesystem::path& folder, const base::Exec& exec,
                            const std::function<void(const std::string&)>& report) {
  jobs::Table trials;
  trials.names = kPreparationColumns;
  if (!plan.soil.porosity) return trials;
  const double tolerance = plan.options.coarse ? kCoarseTolerance : kTolerance;
  double friction = 0;
  while ((friction = nextFriction(trials.rows, *plan.soil.porosity, tolerance)) > 0) {
    const auto say = [&](const std::string& phase) {
      report(fmt::format("bed with settling friction {:.3g}, target porosity {:g}, {}", friction, *plan.soil.porosity,
                         phase));
    };
    trials.rows.push_back({friction, porosityWith(plan, friction, folder, exec, say)});
  }
  return trials;
}

} // namespace grouser::virtual_tests
