// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/step_controller.hpp"

#include "base/error.hpp"
#include "base/math.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace grouser::coupling {

namespace {

/// Ratio of the next interval to the last [-]: safety factor, minimum and maximum ratio.
constexpr double kAim = 0.9, kMin = 0.2, kMax = 2;
/// Negligible remaining time, and the shortest interval, relative to the time [-].
constexpr double kNoTime = 1e-12, kShortest = 1e-13;
/// Round-off error of an interval per metre of coordinates and per radian [-].
constexpr double kRoundOff = 1e-14;

} // namespace

/// Longest interval permitted by drives and rotations of bodies [s].
double StepController::longest(const multibody::State& state) const {
  double rate = 0;
  for (const multibody::Twist& V : state.twist) rate = std::max(rate, norm(V.w));
  return rate > 0 ? std::min(control_.longest, largestTurn_ / rate) : control_.longest;
}

double StepController::error(double h) const {
  double most = 0;
  for (std::size_t b = 0; b < once_.pose.size(); ++b) {
    const base::Quat turn = once_.pose[b].orientation * twice_.pose[b].orientation.conjugate();
    const double place = norm(once_.pose[b].position - twice_.pose[b].position) +
                         h * norm(once_.twist[b].v - twice_.twist[b].v),
                 angle = 2 * norm(base::Vec3d{turn.x, turn.y, turn.z}) + h * norm(once_.twist[b].w - twice_.twist[b].w);
    most = std::max({most, place, angle});
  }
  return most / 3;
}

/// Round-off error of an interval [m, rad].
double StepController::roundOff() const {
  double scale = 1;
  for (const base::Pose& X : once_.pose) scale = std::max(scale, norm(X.position));
  return kRoundOff * scale;
}

/// Integrates an interval from twice_ (a copy of the state) in one and in two steps; returns true if the solver
/// succeeded.
bool StepController::tryStretch(multibody::Solver& solver, const multibody::Loads& loads, double h) {
  once_ = twice_;
  try {
    solver.step(once_, loads, h);
    solver.step(twice_, loads, 0.5 * h);
    solver.step(twice_, loads, 0.5 * h);
  } catch (const base::SimulationError&) { // too long a step: a shorter one may succeed
    return false;
  }
  return true;
}

void StepController::advance(multibody::Solver& solver, multibody::State& state, const multibody::Loads& loads,
                             double until, const std::function<void()>& each) {
  while (until - state.time > kNoTime * until) {
    const double left = until - state.time, wanted = std::min(record_.next, longest(state));
    // Divide the remaining time equally, so that the last interval is not much shorter.
    const double pieces = std::max(1.0, std::ceil(left / wanted - 1e-9)), h = left / pieces;
    twice_ = state;
    const bool solved = tryStretch(solver, loads, h);
    const double found = solved ? error(h) : 0, allowed = control_.tolerance * h + roundOff();
    const double factor = !solved ? kMin : found > 0 ? std::clamp(kAim * std::sqrt(allowed / found), kMin, kMax) : kMax;
    if (!solved || !(found <= allowed)) {
      ++record_.rejected;
      record_.next = h * std::min(factor, 0.5);
      if (record_.next > kShortest * std::max(until, 1e-3)) continue;
      throw base::SimulationError(
          fmt::format("time {:.6g} s: no step of {:.3g} s or more keeps the error below run.tolerance = {:g} a second; "
                      "raise it, or check for an impact at this time",
                      state.time, record_.next, control_.tolerance));
    }
    // An interval shortened to end at `until` does not limit later intervals.
    record_.next = factor >= 1 && pieces == 1 ? std::max(h * factor, record_.next) : h * factor;
    record_.smallest = record_.taken == 0 ? 0.5 * h : std::min(record_.smallest, 0.5 * h);
    record_.largest = std::max(record_.largest, 0.5 * h);
    record_.taken += 2;
    std::swap(state, twice_);
    each();
  }
  state.time = until;
}

} // namespace grouser::coupling
