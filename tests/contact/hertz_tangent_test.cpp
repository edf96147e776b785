// SPDX-License-Identifier: BSD-3-Clause
// Tangents of Hertz's law that lead to the end of an implicit step.
#include "contact/hertz_tangent.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grouser::contact {
namespace {

TEST(HertzTangent, EndOverlapBalancesInertiaAndForce) {
  const double h = 1e-3;
  for (const double elastic : {1e2, 1e6, 1e10})
    for (const double free : {1e-9, 1e-6, 1e-3}) {
      const HertzNormal<double> law{elastic, 0, 0.01};
      const double deep = endOverlap(law, free, h);
      EXPECT_GT(deep, 0);
      const double force = elastic * std::pow(deep, 1.5), inertia = 0.01 * (free - deep) / (h * h);
      EXPECT_NEAR(force, inertia, 1e-9 * std::max(force, 0.01 * free / (h * h) * 1e-6)) << elastic << " " << free;
      const HertzNormal<float> single{static_cast<float>(elastic), 0, 0.01f};
      EXPECT_NEAR(static_cast<double>(endOverlap(single, static_cast<float>(free), 1e-3f)), deep, 1e-5 * deep);
    }
}

TEST(HertzTangent, TangentsMeetTheLaw) {
  const HertzNormal<double> law{1e8, 50, 0.01};
  const double h = 1e-3, deep = 1e-5, gap = -2e-6;
  const NormalRow<double> row = linearised(law, deep, gap, h);
  // a = u + softness x + offset = 0 at the overlap `deep`: the impulse of spring and dashpot.
  const double parting = -(deep + gap) / h, damping = 50 * std::pow(deep, 0.25);
  EXPECT_NEAR(row.damping, damping, 1e-12 * damping);
  const double impulse = h * (1e8 * std::pow(deep, 1.5) - damping * parting);
  EXPECT_NEAR(-(parting + row.offset) / row.softness, impulse, 1e-12 * impulse);
  EXPECT_NEAR(hertzError(law, row, -gap, impulse, parting, h).speed, 0, 1e-12);
}

TEST(HertzTangent, LeadToTheEndOfAnImplicitStep) {
  // A mass m meets the contact at the speed v: m (u + v) = h (elastic deep^1.5 - damping deep^0.25 u), deep = -gap - h
  // u. The contact assumes a mass that is too small, right or too large.
  const double h = 1e-3, v = 0.01;
  for (const double elastic : {1e4, 1e7, 1e10})
    for (const double share : {0.1, 1.0, 10.0})
      for (const double start : {1e-9, 1e-6, 1e-5}) {
        const double m = 0.01;
        const HertzNormal<double> law{elastic, 1e-3 * std::sqrt(elastic * m), share * m};
        NormalRow<double> row = linearised(law, start, -start, h);
        double u = 0, x = 0;
        int passes = 0;
        for (; passes < 50; ++passes) {
          x = std::max(0.0, (v - row.offset) / (1 / m + row.softness)), u = x / m - v;
          const HertzError<double> error = hertzError(law, row, start, x, u, h);
          if (!(error.speed > 1e-9)) break;
          row = linearised(law, error.deep, -start, h);
        }
        EXPECT_LE(passes, 25) << elastic << " " << share << " " << start;
        const double deep = start - h * u,
                     force = elastic * std::pow(deep, 1.5) - law.damping * std::pow(deep, 0.25) * u;
        // The velocity error that remains after another step of Newton's method.
        const double stiff = h * h * 1.5 * elastic * std::sqrt(deep) / m;
        EXPECT_NEAR((u + v - h * force / m) / (1 + stiff), 0, 1e-6 * v) << elastic << " " << share << " " << start;
      }
}

} // namespace
} // namespace grouser::contact
