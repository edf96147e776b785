// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/forecast/elastic_layer.hpp"

#include "base/math.hpp"

#include <cmath>

namespace grouser::forecast {

namespace {

/// Settlement of the corner of a rectangle with sides `a` and `b`, times modulus / pressure [m]. Odd in `a` and in `b`,
/// so that the terms of four corners add up to the settlement of any point.
double cornerSettlement(double a, double b, double depth, double poisson) {
  if (a == 0 || b == 0) return 0;
  // Settlement of a half-space at its surface, then at `depth`.
  const double surface = a * std::asinh(b / std::fabs(a)) + b * std::asinh(a / std::fabs(b));
  double settled = (1 - poisson * poisson) * surface;
  if (std::isfinite(depth)) {
    const double logs = a * std::asinh(b / std::hypot(a, depth)) + b * std::asinh(a / std::hypot(b, depth));
    const double angle = std::atan(a * b / (depth * std::hypot(a, b, depth)));
    settled -= (1 + poisson) * ((1 - poisson) * logs - 0.5 * (1 - 2 * poisson) * depth * angle);
  }
  return settled / base::kPi;
}

} // namespace

double layerSettlement(const std::vector<LoadedRectangle>& loads, double depth, double poisson) {
  constexpr int kAlong = 32, kAcross = 8; // number of points at which the settlement is evaluated
  double sum = 0, area = 0;
  for (const LoadedRectangle& here : loads) {
    double settled = 0;
    for (int i = 0; i < kAlong; ++i)
      for (int j = 0; j < kAcross; ++j) {
        const double x = here.x + here.halfLength * ((2 * i + 1.0) / kAlong - 1);
        const double y = here.y + here.halfBreadth * ((2 * j + 1.0) / kAcross - 1);
        for (const LoadedRectangle& load : loads)
          for (const double a : {-1.0, 1.0})
            for (const double b : {-1.0, 1.0})
              settled +=
                  a * b *
                  cornerSettlement(x - load.x + a * load.halfLength, y - load.y + b * load.halfBreadth, depth, poisson);
      }
    const double carries = here.halfLength * here.halfBreadth;
    sum += carries * settled / (kAlong * kAcross), area += carries;
  }
  return sum / area;
}

} // namespace grouser::forecast
