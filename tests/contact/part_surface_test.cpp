// SPDX-License-Identifier: BSD-3-Clause
#include "contact/part_surface.hpp"

#include "part_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace grouser::contact::testing {
namespace {

using base::Vec3d;

TEST(Disc, IsThePlaneWithinItsFlatAndRoundBeyond) {
  const Disc disc{{0, 0, -0.01f}, 0.01f, {0, 0, 1}, 0.02f};
  const DiscDistance above = distanceTo(disc, {0.015, 0, 0.03});
  EXPECT_NEAR(above.distance - 0.01, 0.03, 1e-8) << "float round-off of a distance of 0.04 m";
  EXPECT_FLOAT_EQ(above.normal.z, 1);
  const DiscDistance beside = distanceTo(disc, {0.05, 0, -0.01});
  EXPECT_NEAR(beside.distance, 0.03, 1e-8);
  EXPECT_FLOAT_EQ(beside.normal.x, 1);
}

TEST(SurfaceGrid, PruningNeverChangesTheNearestDisc) {
  // Compared with all discs, for balls around a plate and in a corner, at three radii.
  for (const bool inCorner : {false, true}) {
    const base::SphereSet set = inCorner ? corner(0.06, 0.005, 0.006) : plate(0.06, 0.005, 0.006);
    const SurfaceGrid grid(base::cpuExec(1), set, 0.027, 0.0045);
    const SurfaceGridView view = grid.view();
    const std::vector<Disc> discs = discsOf(set);
    int touching = 0;
    for (int k = 0; k < 40000; ++k) {
      const Vec3d p{-0.1 + 0.2 * (k % 37) / 36.0, -0.1 + 0.2 * (k / 37 % 31) / 30.0, -0.08 + 0.16 * (k / 1147) / 34.0};
      for (const double radius : {0.005, 0.015, 0.027}) {
        double all = 0, table = 0;
        for (const Disc& d : discs) all = std::max(all, radius + d.radius - distanceTo(d, p).distance);
        const std::int64_t cell = view.cellAt(p);
        if (cell >= 0)
          for (std::uint32_t e = view.start[cell]; e < view.start[cell + 1]; ++e)
            table = std::max(table, radius + view.disc[view.entry[e]].radius -
                                        distanceTo(view.disc[view.entry[e]], p).distance);
        ASSERT_EQ(all, table) << p.x << " " << p.y << " " << p.z << " R " << radius;
        touching += all > 0;
      }
    }
    EXPECT_GT(touching, 1000);
  }
}

TEST(Probes, ClusterByTheWayTheirFaceLooks) {
  const auto samples = surfaceSamplesOf(plate(0.03, 0.005, 0.01));
  EXPECT_EQ(samples.front().cluster, 5u); // +z
  EXPECT_EQ(samples.back().cluster, 4u);  // -z
}

} // namespace
} // namespace grouser::contact::testing
