// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/spec.hpp"

#include "base/math.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::vehicle {

double VehicleSpec::pitchRadius() const { return sprocket.teeth * shoe.pitch / (2 * base::kPi); }

double VehicleSpec::totalMass() const {
  const double track = shoe.count * shoe.mass + sprocket.mass + roadWheel.count * (roadWheel.mass + arm.mass) +
                       static_cast<double>(roller.x.size()) * roller.mass + idler.mass + idler.carrierMass;
  return chassis.mass + 2 * track;
}

double VehicleSpec::smallestWheel() const {
  const double least = std::min(roadWheel.radius, idler.radius);
  return roller.x.empty() ? least : std::min(least, roller.radius);
}

double VehicleSpec::sprocketPinRadius() const { return 0.5 * shoe.pitch / base::sin(base::kPi / sprocket.teeth); }

double VehicleSpec::idlerPinRadius() const {
  const double plate = idler.radius + shoe.plateTop;
  return std::sqrt(plate * plate + 0.25 * shoe.pitch * shoe.pitch);
}

} // namespace grouser::vehicle
