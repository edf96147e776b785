// SPDX-License-Identifier: BSD-3-Clause
// Stable steps of grains: small maps against predicted limits, and the underlying modes.
#include "base/math.hpp"
#include "runs/validation/studies/grain_stability.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::studies {
namespace {

/// Highest natural frequency of a column of n frictionless spheres on a plane, in units of sqrt(k / m).
double columnFrequency(int n) { return 2 * std::cos(base::kPi / (2 * n + 1)); }

ContactNetwork closePacked(int cells, double tangentialRatio) {
  // Face-centred cubic: nearest neighbours along the face diagonals, sqrt(1/2) of the cubic edge away.
  ContactNetwork network;
  network.tangentialRatio = tangentialRatio;
  const auto id = [cells](int x, int y, int z) { return static_cast<std::uint32_t>((x * cells + y) * cells + z); };
  for (int x = 0; x < cells; ++x)
    for (int y = 0; y < cells; ++y)
      for (int z = 0; z < cells; ++z) {
        if ((x + y + z) % 2) continue;
        for (int k = 0; k < 27; ++k) {
          const int a = k / 9 - 1, b = k / 3 % 3 - 1, c = k % 3 - 1;
          if (a * a + b * b + c * c != 2) continue;
          // Neighbours beyond the edge: a crystal without surface.
          const std::uint32_t i = id(x, y, z),
                              j = id((x + a + cells) % cells, (y + b + cells) % cells, (z + c + cells) % cells);
          const double h = std::sqrt(0.5);
          if (i < j) network.contacts.push_back({i, j, {a * h, b * h, c * h}});
        }
      }
  network.spheres = static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells * cells);
  return network;
}

TEST(ContactModes, ColumnIsTheClosedForm) {
  for (const int n : {1, 2, 7}) {
    ContactNetwork network;
    network.spheres = static_cast<std::size_t>(n);
    for (std::uint32_t i = 0; i < network.spheres; ++i)
      network.contacts.push_back({i, static_cast<std::int64_t>(i) - 1, {0, 0, -1}});
    EXPECT_NEAR(highestFrequency(network), columnFrequency(n), 1e-9) << n;
  }
}

TEST(ContactModes, ClosePackedSpheresReachGershgorinsBound) {
  const ContactNetwork smooth = closePacked(6, 0);
  EXPECT_NEAR(highestFrequency(smooth) * highestFrequency(smooth), 8, 1e-6);
  EXPECT_NEAR(gershgorinFrequency(smooth) * gershgorinFrequency(smooth), 8, 1e-9);
}

TEST(ContactModes, ClosePackedSpheresThatStickTurnAlikeFastest) {
  // All rotate with w: each of 12 contacts slips at 2 w R; on average two thirds of it is across the contact. So
  // 12 (2/3) 2 k_t R^2 / (2/5 m R^2) = 40 k_t / m.
  for (const double ratio : {2.0 / 7, 0.8}) {
    const double frequency = highestFrequency(closePacked(6, ratio));
    EXPECT_NEAR(frequency * frequency, 40 * ratio, 1e-6) << ratio;
  }
}

void expectLimits(const GrainStabilityMap& map) {
  for (const GrainStabilityCell& c : map.cells) {
    EXPECT_TRUE(c.agrees()) << map.grains.title << ": zeta " << c.zeta << ", " << c.ofLimit
                            << " of the predicted limit, growth " << c.growth;
    EXPECT_FALSE(c.calm && !c.stable) << map.grains.title << ": not calm at " << c.timeStep;
  }
}

StabilityAxes fewCells() { return {{1e4, 1e6}, {0, 0.3, 1, 2}, {}, {0.5, 0.95, 1.05, 2}}; }

TEST(StudyGrainStability, OneContactIsStableUpToTheClosedForm) {
  const RestingGrains grains = oneContact();
  EXPECT_NEAR(grains.frequency, 1, 1e-12);
  // Known limits of omega_0 dt over zeta.
  const struct {
    double zeta, limit;
  } known[] = {{0, 2}, {0.1, 1.8100}, {0.2, 1.6396}, {0.3, 1.4881}, {0.5, 1.2361}, {1, 0.8284}};
  for (const auto& row : known) EXPECT_NEAR(predictedLimit(grains, row.zeta), row.limit, 5e-5) << row.zeta;
  expectLimits(stabilityMap(grains, fewCells()));
}

TEST(StudyGrainStability, ColumnIsStableUpToItsHighestMode) {
  const RestingGrains grains = column(6);
  EXPECT_NEAR(grains.frequency, columnFrequency(6), 1e-6);
  expectLimits(stabilityMap(grains, fewCells()));
}

TEST(StudyGrainStability, RandomBedIsStableUpToItsHighestMode) {
  for (const double friction : {0.0, 0.5}) {
    const RestingGrains grains = randomBed(40, friction);
    EXPECT_LT(grains.forceRatio, 1e-3) << "at rest";
    EXPECT_GT(grains.network.contacts.size(), 1.5 * static_cast<double>(grains.network.spheres));
    StabilityAxes axes = fewCells();
    axes.stiffness = {1e5}, axes.zeta = {0, 0.3, 1};
    expectLimits(stabilityMap(grains, axes));
  }
}

TEST(StudyGrainStability, GuardsCountAsUnstable) {
  const RestingGrains grains = oneContact();
  const double step = 5 * predictedLimit(grains, 0);
  const double stiffness = 1e5, rate = std::sqrt(stiffness / (2600 * 4 * base::kPi / 3 * 0.005 * 0.005 * 0.005));
  const GrainStabilityCell cell = tryCell(grains, stiffness, 0, step / rate);
  EXPECT_FALSE(cell.stable);
  EXPECT_FALSE(cell.calm);
}

} // namespace
} // namespace grouser::studies
