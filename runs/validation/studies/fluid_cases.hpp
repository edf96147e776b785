// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "runs/support/line_fit.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

/// Particle fluid against known solutions: error over spacing and run time.
namespace grouser::studies {

/// A relative error, with the tolerance at the finest spacing.
struct FluidQuantity {
  std::string name;
  double bar; ///< tolerance [-]; 0: none
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

/// Order of one quantity's error in spacing: log-log slope.
support::LineFit fluidOrder(const std::vector<FluidPoint>& points, std::size_t quantity);

} // namespace grouser::studies
