// SPDX-License-Identifier: BSD-3-Clause
// Complementarity contacts across subdomains: velocities are exchanged in each iteration.
#include "terrain/grains.hpp"
#include "tests/ranks/ranks.hpp"
#include "tests/terrain/impulse_fixture.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

class ComplementarityOnRanks : public ::testing::TestWithParam<contact::Compliance> {};

TEST_P(ComplementarityOnRanks, HasTheBitsAndIterationsOfOneRank) {
  const GrainModel m = impulsiveGravel(GetParam());
  const Boundaries box{{floorPlane(m.law), {{1, 0, 0}, -0.05, m.law}, {{-1, 0, 0}, -0.85, m.law}}, {}};
  const std::vector<GrainSpec> start = gravelBlock(12, 4, 4, {1.5, 0.5, -1}, {3, -2, 9});
  Grains alone(base::cpuExec(1), m, box, start),
      grains(base::cpuExec(1), m, box, start, {test::comm(), {0, 0, 0}, {}, false});
  advance(alone, 200), advance(grains, 200);
  std::vector<std::uint32_t> words;
  for (const auto& part : test::comm().gatherAll(grains.state().words()))
    words.insert(words.end(), part.begin(), part.end());
  EXPECT_EQ(words, alone.state().words());
  EXPECT_EQ(grains.system().impulses->totals().iterations, alone.system().impulses->totals().iterations);
  EXPECT_EQ(grains.system().impulses->report().residual, alone.system().impulses->report().residual);
  EXPECT_EQ(grains.system().impulses->report().rows, alone.system().impulses->report().rows);
}

INSTANTIATE_TEST_SUITE_P(Both, ComplementarityOnRanks,
                         ::testing::Values(contact::Compliance::law, contact::Compliance::rigid));

} // namespace
} // namespace grouser::terrain::testing
