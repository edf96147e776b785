// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "runs/support/line_fit.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

/// Flows of the particle fluid whose solution is known: error against spacing and run time.
namespace grouser::studies {

/// A relative error, and the bar that the finest spacing must keep.
struct FluidQuantity {
  std::string name;
  double bar; ///< [-]; 0: no bar
};

/// One spacing.
struct FluidPoint {
  double spacing{};  ///< [m]
  double timeStep{}; ///< [s]
  std::size_t particles{};
  std::int64_t steps{};
  double seconds{};           ///< wall time of the steps
  std::vector<double> errors; ///< by quantity [-], not negative
};

struct FluidCase {
  std::string name, title;
  std::vector<FluidQuantity> quantities;
  std::vector<double> spacings; ///< coarse to fine [m]
  /// Fills steps, particles, seconds and errors.
  std::function<void(const base::Exec& exec, FluidPoint& point)> run;
};
std::vector<FluidCase> fluidCases();

/// Order in spacing of one quantity's error: slope of the line through the logarithms.
support::LineFit fluidOrder(const std::vector<FluidPoint>& points, std::size_t quantity);

} // namespace grouser::studies
