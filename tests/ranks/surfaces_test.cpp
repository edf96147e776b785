// SPDX-License-Identifier: BSD-3-Clause
// Moving surfaces on any number of ranks: bits and loads are the same as on one rank.
#include "terrain/grains.hpp"
#include "tests/ranks/ranks.hpp"
#include "tests/terrain/surface_fixture.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

struct Outcome {
  std::vector<std::uint32_t> words;
  std::vector<Vec3d> loads; ///< loads at every step
};

Outcome runMill(const PartitionOptions& partition, double skin = 0.3, std::int64_t stop = 0) {
  const GrainModel m = millModel(skin);
  const Motion motion = millMotion(m.timeStep);
  const Boundaries around{{{{0, 1, 0}, -0.1, m.law}}, {}, {}, mill(m.law)};
  auto grains = std::make_unique<Grains>(base::cpuExec(1), m, around, millGrains(), partition);
  Outcome out;
  for (std::int64_t n = 0; n < 3000; ++n) {
    if (n == stop && n > 0) {
      const GrainState saved = grains->state();
      grains = std::make_unique<Grains>(base::cpuExec(1), m, around, millGrains(), partition);
      grains->setSurfacePoses(motion(n));
      grains->restore(saved);
    }
    advanceWith(*grains, motion, n, n + 1);
    for (const SurfaceLoad& load : grains->system().boundaries.surfaceLoads())
      out.loads.push_back(load.force), out.loads.push_back(load.torque);
  }
  for (const auto& part : grains->system().comm.gatherAll(grains->state().words()))
    out.words.insert(out.words.end(), part.begin(), part.end());
  return out;
}

TEST(SurfacesOnRanks, GiveTheBitsAndLoadsOfOneRank) {
  const Outcome alone = runMill({});
  for (const Outcome& shared : {runMill({test::comm(), {}, {}, true}), runMill({test::comm(), {}, {}, false}, 0.7),
                                runMill({test::comm(), {}, {}, true}, 0.3, 1357)}) {
    EXPECT_EQ(shared.words, alone.words);
    EXPECT_EQ(shared.loads == alone.loads, true);
  }
}

} // namespace
} // namespace grouser::terrain::testing
