// SPDX-License-Identifier: BSD-3-Clause
// Structure of beds compared with known arrangements.
#include "terrain/bed_structure.hpp"

#include "base/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::terrain {

namespace {

constexpr double kRadius = 0.01;

/// A box of grains above z = 0, with level surface and floor.
BedStructure measured(const std::vector<LyingGrain>& grains, double side, double height) {
  return measureBed(
      grains,
      {{0, side, 0, side}, {}, [](double, double) { return 0.0; }, [height](double, double) { return height; }});
}

/// Face-centred cubic, touching by `overlap` [m].
std::vector<LyingGrain> closePacking(int cells, double overlap) {
  std::vector<LyingGrain> grains;
  const double a = (2 * kRadius - overlap) * std::sqrt(2.0);
  for (int z = 0; z < cells; ++z)
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x)
        for (const auto& [u, v, w] : {base::Vec3d{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}})
          grains.push_back({{(x + 0.25 + u) * a, (y + 0.25 + v) * a, (z + 0.25 + w) * a}, kRadius, false});
  return grains;
}

} // namespace

TEST(BedStructure, ClosePackingHasItsPorosityContactsAndOrder) {
  const int cells = 10;
  const double overlap = 1e-6, side = cells * (2 * kRadius - overlap) * std::sqrt(2.0);
  const BedStructure s = measured(closePacking(cells, overlap), side, side);
  EXPECT_NEAR(s.porosity, 1 - M_PI / std::sqrt(18.0), 4 * s.porosityError + 3 * overlap / kRadius);
  EXPECT_NEAR(s.porosityError, 1e-3, 3e-4);
  EXPECT_EQ(s.coordination, 12);
  EXPECT_EQ(s.order, 1);
  EXPECT_EQ(s.rattlers, 0);
  EXPECT_NEAR(s.meanDiameter, 2 * kRadius, 1e-12);
  EXPECT_NEAR(s.thickness, side, 1e-12);
  // Its neighbours are at 1, sqrt 2, sqrt 3 ... diameters, and nowhere in between.
  for (std::size_t k = 0; k < s.distance.size(); ++k) {
    if (s.distance[k] < 0.95 || (s.distance[k] > 1.1 && s.distance[k] < 1.35)) {
      EXPECT_EQ(s.radialDistribution[k], 0) << s.distance[k];
    }
  }
}

TEST(BedStructure, NearIsNoContact) {
  const int cells = 6;
  const double apart = 0.02 * kRadius, side = cells * (2 * kRadius + apart) * std::sqrt(2.0);
  const BedStructure s = measured(closePacking(cells, -apart), side, side);
  EXPECT_EQ(s.coordination, 0);
  EXPECT_EQ(s.rattlers, 1);
  EXPECT_EQ(s.order, 1) << "its sites are those of a crystal";
}

TEST(BedStructure, RandomPointsHaveAFlatRadialDistributionAndNoOrder) {
  std::vector<LyingGrain> grains;
  constexpr double kSide = 0.5;
  constexpr int kGrains = 30'000;
  for (std::uint64_t g = 0; g < kGrains; ++g) {
    const auto at = [&](std::uint64_t k) { return kSide * base::uniform(3, base::purpose("test"), g, k); };
    grains.push_back({{at(0), at(1), at(2)}, kRadius, false});
  }
  const BedStructure s = measured(grains, kSide, kSide);
  // Overlapping random spheres leave a share of exp(-number density x volume) free.
  const double filled = kGrains / (kSide * kSide * kSide) * 4.0 / 3 * M_PI * kRadius * kRadius * kRadius;
  EXPECT_NEAR(s.porosity, std::exp(-filled), 0.004);
  EXPECT_LT(s.order, 0.02);
  // The density follows from the grains' volume over 1 - porosity, which overlapping grains do not fill.
  const double scale = (1 - std::exp(-filled)) / filled;
  for (std::size_t k = 20; k < s.distance.size(); ++k) EXPECT_NEAR(s.radialDistribution[k] * scale, 1, 0.1);
}

TEST(BedStructure, ProfileFollowsTheSurface) {
  // Grains fill the lower half; the surface is set to the top: above the middle all is void.
  const int cells = 10;
  const double overlap = 1e-6, side = cells * (2 * kRadius - overlap) * std::sqrt(2.0);
  const BedStructure s = measured(closePacking(cells, overlap), side, 2 * side);
  ASSERT_EQ(s.depth.size(), s.porosityAtDepth.size());
  for (std::size_t k = 0; k < s.depth.size(); ++k) {
    if (s.depth[k] < 0.9 * side) {
      EXPECT_EQ(s.porosityAtDepth[k], 1);
    }
    if (s.depth[k] > 1.15 * side && s.depth[k] < 1.85 * side) {
      EXPECT_NEAR(s.porosityAtDepth[k], 0.26, 0.12) << "layers of the crystal";
    }
  }
}

TEST(BedStructure, FixedGrainsArePartnersOnly) {
  std::vector<LyingGrain> grains = closePacking(10, 1e-6);
  const double side = 10 * (2 * kRadius - 1e-6) * std::sqrt(2.0);
  const BedStructure free = measured(grains, side, side);
  for (std::size_t g = 0; g < grains.size(); g += 2) grains[g].fixed = true;
  const BedStructure half = measured(grains, side, side);
  EXPECT_LT(half.grains, 0.6 * static_cast<double>(free.grains));
  EXPECT_EQ(half.coordination, 12);
}

TEST(BedStructure, PeriodicSidesAreAsGoodAsTheInside) {
  const std::vector<LyingGrain> grains = closePacking(6, 1e-6);
  const double side = 6 * (2 * kRadius - 1e-6) * std::sqrt(2.0);
  const auto zero = [](double, double) { return 0.0; };
  const auto top = [side](double, double) { return side; };
  const BedStructure s = measureBed(grains, {{0, side, 0, side}, {true, true}, zero, top});
  EXPECT_NEAR(s.porosity, 1 - M_PI / std::sqrt(18.0), 4 * s.porosityError + 0.001);
  EXPECT_EQ(s.coordination, 12);
  EXPECT_EQ(s.order, 1);
  EXPECT_GT(s.grains, 2 * measureBed(grains, {{0, side, 0, side}, {}, zero, top}).grains);
}

TEST(BedStructure, NothingToMeasureIsNoError) {
  const BedStructure s = measured({}, 1, 1);
  EXPECT_EQ(s.grains, 0);
  EXPECT_EQ(s.thickness, 1);
}

} // namespace grouser::terrain
