// SPDX-License-Identifier: BSD-3-Clause
// Grains restored from a saved state continue bitwise identically, for any threads, skin and device.
#include "base/error.hpp"
#include "grain_fixture.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

/// A heap with friction that slides against two walls and onto a floor.
Grains heap(const base::Exec& exec, double skin, int layers = 5) {
  GrainModel m = ball(1e-5);
  m.gravity = {0, 0, -9.81};
  makeRough(m.law, 2000);
  m.floorLaw = m.law;
  m.skin = skin;
  std::vector<GrainSpec> start;
  for (int z = 0; z < layers; ++z)
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 6; ++x)
        start.push_back({{0.0104 * x + 0.001 * (z % 3), 0.0104 * y, 0.006 + 0.0102 * z}, {0.1, 0.05, -0.3}, {}});
  const HeightField floor = HeightField::flat({-1, 1, -1, 1}, 0);
  return {exec, m, {{{{1, 0, 0}, -0.006, m.law}, {{0, -1, 0}, -0.06, m.law}}, floor}, start};
}

struct End {
  std::vector<std::uint32_t> words;
  std::int64_t rebuilds;
  double dissipated;
};
End endOf(Grains& grains) { return {grains.state().words(), grains.system().rebuilds, grains.ledger().dissipated()}; }

constexpr int kSteps = 4000;

End straight() {
  Grains grains = heap(base::cpuExec(1), 0.3);
  advance(grains, kSteps);
  return endOf(grains);
}

End resumedAt(int step, const base::Exec& before, const base::Exec& after, double skin) {
  Grains first = heap(before, 0.3);
  advance(first, step);
  const GrainState saved = first.state();
  Grains second = heap(after, skin);
  second.restore(saved);
  EXPECT_EQ(second.state().words(), saved.words());
  EXPECT_EQ(second.state().travelled == saved.travelled, skin == 0.3);
  advance(second, kSteps - step);
  return endOf(second);
}

TEST(Resume, GrainsGoOnToTheSameBitsAndRebuildsFromAnyStep) {
  const End whole = straight();
  ASSERT_GT(whole.rebuilds, 3) << "rebuilds must occur before and after the stop";
  for (const int step : {0, 1, 1234, 2500, kSteps}) {
    const End end = resumedAt(step, base::cpuExec(1), base::cpuExec(2), 0.3);
    EXPECT_EQ(end.words, whole.words) << "stopped at step " << step;
    EXPECT_EQ(end.rebuilds, whole.rebuilds) << "stopped at step " << step;
    EXPECT_EQ(end.dissipated, whole.dissipated) << "stopped at step " << step;
  }
}

TEST(Resume, GrainsGoOnToTheSameBitsWithAnotherSkin) {
  const End whole = straight();
  EXPECT_EQ(resumedAt(2500, base::cpuExec(1), base::cpuExec(1), 0.6).words, whole.words);
  EXPECT_EQ(resumedAt(2500, base::cpuExec(1), base::cpuExec(1), 0.15).words, whole.words);
}

TEST(Resume, GrainsGoFromCpuToCudaAndBack) {
  if (!base::cudaAvailable()) GTEST_SKIP() << "no CUDA device";
  const End whole = straight();
  EXPECT_EQ(resumedAt(2500, base::cpuExec(1), base::cudaExec(), 0.3).words, whole.words);
  EXPECT_EQ(resumedAt(2500, base::cudaExec(), base::cpuExec(1), 0.3).words, whole.words);
}

TEST(Resume, StateOfOtherGrainsIsRefused) {
  const GrainState saved = heap(base::cpuExec(1), 0.3).state();
  Grains other = heap(base::cpuExec(1), 0.3, 4);
  EXPECT_THROW(other.restore(saved), base::InputError);
}

} // namespace
} // namespace grouser::terrain::testing
