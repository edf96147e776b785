// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/integrator.hpp"

#include "base/error.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace grouser::multibody::detail {

void Stepper::startResponse(const State&, const Loads&, double, std::vector<Twist>&) {
  throw std::logic_error("RATTLE has no impulse response; use kSymplecticEuler");
}
void Stepper::respond(const std::vector<Wrench>&, std::vector<Twist>&) {
  throw std::logic_error("RATTLE has no impulse response; use kSymplecticEuler");
}

void checkTwist(const Body& body, const Twist& twist, double time, double dt) {
  const double turn = std::fabs(dt) * norm(twist.w);
  if (std::isfinite(norm2(twist.v)) && std::isfinite(norm2(twist.w)) && turn <= kLargestTurn) return;
  std::ostringstream message;
  message << "multibody step from t = " << time << " s: ";
  if (std::isfinite(turn) && turn > kLargestTurn)
    message << "body '" << body.name << "' turns by " << turn << " rad in a step of " << dt << " s, more than "
            << kLargestTurn << "; reduce the step, or check the loads on it";
  else
    message << "the velocity of body '" << body.name << "' is not finite; check the loads on it";
  throw base::SimulationError(message.str(), std::isfinite(turn) && turn > kLargestTurn ? base::Cause::fastTurn
                                                                                        : base::Cause::noNumber);
}

} // namespace grouser::multibody::detail
