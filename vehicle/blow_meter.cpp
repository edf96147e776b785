// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/blow_meter.hpp"

#include <fmt/format.h>

namespace grouser::vehicle {

std::string BlowMeter::text() const {
  return fmt::format(
      "of up to {:.3g} times the weight (ground force, mean of {:g} ms up to {:.4g} s): what follows them "
      "may depend on the step and on chance; grouser check tells by how much",
      most, 1e3 * kSpan, at);
}

} // namespace grouser::vehicle
