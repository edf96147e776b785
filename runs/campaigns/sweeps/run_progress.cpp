// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/run_progress.hpp"

#include "base/error.hpp"
#include "runs/setup/bed_alone.hpp"
#include "runs/setup/grain_count.hpp"
#include "runs/setup/step_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>

namespace grouser::sweeps {

double expectedEnd(const SweepRun& run) {
  return run.expectedEnd > 0 ? std::min(run.expectedEnd, run.scene.run.duration) : run.scene.run.duration;
}

double workOf(const SweepRun& run) {
  constexpr double kVehicle = 2e4; // 3.0 ms per step on two cores; 1.5 million grains: 229 ms (grouser plan)
  const auto grains = static_cast<double>(setup::plannedGrains(run.scene));
  return expectedEnd(run) * std::max(1.0, grains + (run.scene.vehicle ? kVehicle : 0));
}

double stepWorkOf(const SweepRun& run) {
  try {
    return workOf(run) / setup::chooseTimeStep(run.scene);
  } catch (const base::InputError&) {
    return workOf(run); // the run itself reports the error
  }
}

double timeReached(const std::filesystem::path& folder) {
  std::ifstream file(folder / "timeseries.csv", std::ios::binary | std::ios::ate);
  if (!file) return 0;
  const std::streamoff size = file.tellg(), tail = std::min<std::streamoff>(size, 1 << 16);
  file.seekg(size - tail);
  std::string text(static_cast<std::size_t>(tail), '\0');
  file.read(text.data(), tail);
  const std::size_t end = text.rfind('\n');
  if (end == std::string::npos || end == 0) return 0;
  const std::size_t begin = text.rfind('\n', end - 1);
  if (begin == std::string::npos) return 0; // header line only
  const std::size_t comma = text.find(',', begin);
  return comma < end ? std::max(0.0, std::strtod(text.c_str() + comma + 1, nullptr)) : 0;
}

std::size_t RunTimes::add(const std::string& kind, const std::string& bed, double work) {
  Run run;
  run.kind = kind, run.bed = bed, run.work = work;
  runs_.push_back(std::move(run));
  return runs_.size() - 1;
}

std::size_t RunTimes::add(const SweepRun& run) {
  const scene::Scene& scene = run.scene;
  std::string bed;
  try {
    bed = run.from ? "" : setup::originOfBed(scene);
  } catch (const base::InputError&) {
    bed.clear(); // the run itself reports the error
  }
  const std::string ground(scene.terrain ? base::wordOf(scene.terrain->kind) : "none");
  return add(fmt::format("{} {} {} {}", ground, base::wordOf(scene.run.contact), base::wordOf(scene.run.precision),
                         scene.vehicle.has_value()),
             bed.empty() ? "" : fmt::format("{} {}", bed, scene.run.seed), stepWorkOf(run));
}

void RunTimes::begin(std::size_t i, double share) {
  Run& run = runs_[i];
  run.hasBegun = true, run.begin = run.share = share, run.firstShare = -1, run.wall = 0;
}

void RunTimes::reach(std::size_t i, double share, double wall) {
  Run& run = runs_[i];
  run.wall = wall;
  if (share <= run.share) return;
  if (run.firstShare < 0) run.firstShare = share, run.firstWall = wall;
  run.share = share, run.shareAt = wall;
}

void RunTimes::end(std::size_t i, double preparation, double settling, double steps) {
  Run& run = runs_[i];
  run.hasEnded = true;
  run.isMeasured = std::isfinite(preparation) && std::isfinite(steps);
  run.preparation = preparation, run.settling = std::isfinite(settling) ? settling : 0, run.steps = steps;
}

std::optional<RunTimes::Rate> RunTimes::rateOf(const std::string& kind) const {
  constexpr double kEnough = 1; // [s] shortest time of steps from which a rate is extrapolated
  double seconds = 0, work = 0, preparation = 0, kept = 0;
  int runs = 0, ended = 0;
  for (const Run& run : runs_) {
    if (run.kind != kind) continue;
    if (run.isMeasured) {
      seconds += run.steps, work += (1 - run.begin) * run.work;
      preparation += run.preparation, kept += run.preparation - run.settling;
      ++runs, ++ended;
    } else if (!run.hasEnded && run.firstShare >= 0 && run.share > run.firstShare) {
      const double took = run.shareAt - run.firstWall, share = run.share - run.firstShare;
      seconds += took, work += share * run.work;
      // The steps before the first row seen are no preparation.
      const double before = std::max(0.0, run.firstWall - took / share * (run.firstShare - run.begin));
      preparation += before, kept += before;
      ++runs;
    }
  }
  if (!(work > 0) || (ended == 0 && seconds < kEnough)) return {};
  return Rate{seconds / work, preparation / runs, kept / runs};
}

std::optional<double> RunTimes::left(int jobs) const {
  double all = 0, longest = 0;
  for (const Run& run : runs_) {
    if (run.hasEnded) continue;
    const std::optional<Rate> rate = rateOf(run.kind);
    if (!rate) return {};
    const auto hasBed = [&](const Run& other) { return &other != &run && other.hasBegun && other.bed == run.bed; };
    double left = (1 - run.share) * run.work * rate->perWork;
    if (run.firstShare < 0) { // still to prepare
      const bool settles = run.bed.empty() || std::none_of(runs_.begin(), runs_.end(), hasBed);
      left += std::max(0.0, (settles ? rate->settled : rate->kept) - run.wall);
    } else {
      left -= run.wall - run.shareAt;
    }
    left = std::max(0.0, left);
    all += left, longest = std::max(longest, left);
  }
  return std::max(all / jobs, longest);
}

} // namespace grouser::sweeps
