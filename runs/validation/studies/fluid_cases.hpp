// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "runs/support/line_fit.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

/// Compares the particle fluid with known solutions: error over spacing and run time.
namespace grouser::studies {

/// A quantity with a relative error, and the tolerance of this error at the finest spacing.
struct FluidQuantity {
  std::string name;
  double bar; ///< tolerance [-]; 0: no tolerance
};

/// Results at one spacing.
struct FluidPoint {
  double spacing{};  ///< [m]
  double timeStep{}; ///< [s]
  std::size_t particles{};
  std::int64_t steps{};
  double seconds{};           ///< wall time of all steps
  std::vector<double> errors; ///< relative error of each quantity [-], not negative
};

struct FluidCase {
  std::string name, title;
  std::vector<FluidQuantity> quantities;
  std::vector<double> spacings; ///< particle spacings, from coarse to fine [m]
  /// Runs the case at one spacing; sets steps, particles, seconds and errors.
  std::function<void(const base::Exec& exec, FluidPoint& point)> run;
};
std::vector<FluidCase> fluidCases();

/// Order of a quantity's error in the spacing: slope of ln error over ln spacing.
support::LineFit fluidOrder(const std::vector<FluidPoint>& points, std::size_t quantity);

} // namespace grouser::studies
