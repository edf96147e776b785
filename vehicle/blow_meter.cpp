// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/blow_meter.hpp"

#include <fmt/format.h>

namespace grouser::vehicle {

std::string BlowMeter::text() const {
  return fmt::format(
      "ground force up to {:.3g} times the weight (mean over {:g} ms, until {:.4g} s): the motion after this impact "
      "may depend on time step and seed; grouser check quantifies this error",
      most, 1e3 * kSpan, at);
}

} // namespace grouser::vehicle
