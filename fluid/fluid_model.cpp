// SPDX-License-Identifier: BSD-3-Clause
#include "fluid/fluid_model.hpp"

#include "base/math.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::fluid {

double FluidModel::volume() const { return dimensions == 2 ? spacing * spacing : spacing * spacing * spacing; }

double FluidModel::mass() const { return density * volume(); }

double FluidModel::skin() const { return 0.3 * spacing; }

double StepLimits::least() const { return std::min({sound, force, viscous}); }

StepLimits stepLimits(const FluidModel& model, double speed, double acceleration) {
  const double h = model.smoothing * model.spacing, nu = model.viscosity / model.density;
  const double most = std::max(acceleration, base::norm(model.gravity));
  return {0.25 * h / (model.soundSpeed + speed), most > 0 ? 0.25 * std::sqrt(h / most) : base::kInfinity,
          nu > 0 ? 0.125 * h * h / nu : base::kInfinity};
}

double soundSpeedFor(double speed, double pressure, double density) {
  return 10 * std::max(speed, std::sqrt(pressure / density));
}

double pressureAt(const FluidModel& model, double compression) {
  return model.density * model.soundSpeed * model.soundSpeed * compression;
}

double compressionAt(const FluidModel& model, double pressure) {
  return pressure / (model.density * model.soundSpeed * model.soundSpeed);
}

} // namespace grouser::fluid
