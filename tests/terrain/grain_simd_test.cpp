// SPDX-License-Identifier: BSD-3-Clause
// SIMD steps on the CPU against the scalar kernels: bitwise identical for every width of this processor.
#include "surface_fixture.hpp"
#include "tests/device_under_test.hpp"

#include "base/carry.hpp"
#include "base/random.hpp"
#include "terrain/grain_faults.hpp"
#include "terrain/grains_ahead.hpp"
#include "terrain/kernel_choice.hpp"

#include <array>
#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

using base::Vec3d;

struct LaneKind {
  bool friction = true, ledger = true, walls = true, loads = false, attraction = false;
  int grains = 391; ///< not a multiple of a width or of a block
  double wallFriction = 0.5;
  bool hertz = false, rolling = false, periodic = false, fixed = false, surface = false;
  double smallest = 1; ///< radii are uniform from this share up [-]
  bool cohesive = false, yielding = false, luding = false;
  double pull = 40, pullGrowth = 0;      ///< plastic contacts, as in BasicPlasticity
  bool onDevice = false, special = true; ///< device under test; specialised kernel if available
};

constexpr int kSteps = 400;

double die(int grain, int use) {
  return base::uniform(3, base::purpose("grain lanes test"), static_cast<std::uint64_t>(grain),
                       static_cast<std::uint64_t>(use));
}

GrainModel laneModel(const LaneKind& kind) {
  GrainModel m = ball(4e-5);
  m.gravity = {0.5, -0.2, -9.81};
  m.law.damping = 800, m.law.attraction = kind.attraction;
  m.law.friction = kind.friction ? 0.4 : 0;
  m.law.tangentialStiffness = 3e4, m.law.tangentialDamping = 300;
  m.ledger = kind.ledger;
  if (kind.hertz) {
    m.law.hertz = true, m.law.stiffness = 5e7, m.law.tangentialStiffness = 4e7, m.law.damping = 0;
    m.law.rootDamping = 3000, m.law.tangentialRootDamping = 1500, m.law.tangentialDamping = 0;
  }
  if (kind.cohesive) m.law.pullPerRadius = 2;
  if (kind.yielding) m.law.plastic = {0.6, 0.7, 0.3, kind.pull, kind.pullGrowth, 0, 0, 3};
  if (kind.luding) m.law.plastic = {0.6, 0, 0, 0, 0, 0.02, kind.pull / 40, 2};
  m.specialised = kind.special;
  if (kind.rolling) m.law.rollingFriction = 0.1, m.law.rollingDamping = 0.3;
  if (kind.smallest < 1 && !kind.hertz) m.law.damping = 0, m.law.rootDamping = 60, m.law.tangentialRootDamping = 30;
  return m;
}

/// A falling heap that splashes against the walls and partly comes to rest: contacts start, stick, slide and end.
std::vector<GrainSpec> heap(const LaneKind& kind) {
  std::vector<GrainSpec> start;
  const int grains = kind.grains;
  const auto sized = [&](GrainSpec& g, int i) {
    if (kind.smallest < 1) g.radius = 0.005 * (kind.smallest + (1 - kind.smallest) * die(i, 11));
  };
  for (int i = 0; i < grains; ++i) {
    GrainSpec g;
    g.position = Vec3d{i % 7 + 0.09 * die(i, 0), i / 7 % 7 + 0.09 * die(i, 1), i / 49 + 0.55} * 0.0105;
    g.velocity = {die(i, 2) - 0.5, die(i, 3) - 0.5, -die(i, 4)};
    g.spin = {100 * die(i, 5), -50 * die(i, 6), 80 * die(i, 7)};
    sized(g, i);
    start.push_back(g);
  }
  for (int i = 0; kind.fixed && i < 81; ++i) {
    GrainSpec g{{0.0082 * (i % 9) - 0.001, 0.0082 * (i / 9) - 0.001, -0.0045}, {}, {}, 0, 0, true};
    sized(g, i + 1000);
    start.insert(start.begin() + i, g);
  }
  return start;
}

/// Pushes every fifth grain, another fifth each step, by an amount that depends only on its id.
struct Pushes {
  std::vector<std::uint32_t> range;
  std::vector<std::uint32_t> slot;
  std::vector<contact::GrainLoad> load;
  std::int64_t received[3]{};
  contact::GrainLoadsView view(const Grains& grains, std::int64_t step) {
    const base::FixedPoint quantum = base::fixedPointFor(1e3);
    range.assign(grains.view().count, 0), load.clear(), slot.clear();
    for (std::size_t i = 0; i < grains.view().count; ++i) {
      const auto id = static_cast<int>(grains.view().id[i]);
      if ((id + step) % 5 != 0) continue;
      range[i] = static_cast<std::uint32_t>(load.size()) << 8 | 2u;
      slot.insert(slot.end(), 2, static_cast<std::uint32_t>(i));
      for (int k = 0; k < 2; ++k)
        load.push_back({quantum.quantise(Vec3d{die(id, 8) - 0.5, die(id, 9) - 0.5, die(id, 10)} * (0.01 * (k + 1))),
                        {1e-5f, 0, -2e-5f},
                        1e-5f});
    }
    return {range.data(), load.data(), quantum, received, slot.data(), static_cast<std::int64_t>(slot.size())};
  }
};

/// As in a step launched ahead.
void stepApart(Grains& grains, const contact::GrainLoadsView& loads) {
  GrainsAhead ahead(grains);
  ahead.launchUncoupled(loads);
  ahead.launchGrains(loads);
  ahead.joinGrains();
  base::carry(base::cpuExec(1), std::array{ahead.flagsAfter()});
  ahead.exchangeBuffers();
  ahead.end(0);
}

/// State words and ledger sums.
std::vector<std::uint32_t> wordsAfter(const LaneKind& kind, int lanes, int threads, int steps, double skin = 0.5,
                                      bool apart = false) {
  GrainModel m = laneModel(kind);
  m.maxSimdLanes = lanes, m.skin = skin;
  contact::ContactLaw wall = m.law;
  wall.friction = kind.wallFriction;
  std::vector<Wall> walls;
  if (kind.walls && !kind.fixed) walls = {{{0, 0, 1}, 0, wall}};
  if (kind.walls && !kind.periodic) walls.insert(walls.end(), {{{1, 0, 0}, -0.01, wall}, {{0, -1, 0}, -0.085, wall}});
  // All cases fall to the plane; between periodic boundaries it lies below the fixed grains.
  if (kind.onDevice) walls = {{{0, 0, 1}, kind.periodic ? -0.02 : -0.001, wall}};
  Boundaries around{walls, {}};
  if (kind.periodic) around.periodic = {std::array{-0.005, 0.0685}, std::array{-0.006, 0.0685}};
  if (kind.surface) around.surfaces.push_back({boxOf({0.02, 0.02, 0.004}), wall, placed({0.03, 0.03, -0.0035})});
  m.smallestRadius = kind.smallest < 1 ? kind.smallest * m.radius : 0;
  Grains grains(kind.onDevice ? testExec(threads) : base::cpuExec(threads), m, around, heap(kind));
  m.specialised = true;
  EXPECT_TRUE(!kind.onDevice || !stepKernel(grains.system().constants.features, m).general())
      << featureText(grains.system().constants.features);
  Pushes pushes;
  for (int s = 0; s < steps; ++s) {
    grains.refreshNeighbours();
    const contact::GrainLoadsView loads = kind.loads ? pushes.view(grains, s) : contact::GrainLoadsView{};
    if (apart)
      stepApart(grains, loads);
    else
      grains.step(kind.loads ? &loads : nullptr);
  }
  EXPECT_TRUE(skin > 0.2 || grains.system().rebuilds > 5) << "the list was rebuilt during the run";
  const GrainState state = grains.state();
  std::vector<std::uint32_t> words = state.words();
  for (const std::int64_t sum : state.ledgerSums)
    words.push_back(static_cast<std::uint32_t>(sum)), words.push_back(static_cast<std::uint32_t>(sum >> 32));
  return words;
}

TEST(GrainsLaunchedAhead, StepToTheSameBits) {
  std::vector<LaneKind> kinds = {{}, {.loads = true}, {.friction = false, .loads = true, .wallFriction = 0}};
  for (const bool soil : {false, true}) {
    LaneKind kind{.loads = true};
    kind.fixed = true;
    if (soil) kind.hertz = kind.rolling = kind.cohesive = kind.yielding = true, kind.smallest = 0.6;
    kinds.push_back(kind);
  }
  for (const LaneKind& kind : kinds) EXPECT_EQ(wordsAfter(kind, 1, 2, 150, 0.5, true), wordsAfter(kind, 1, 2, 150));
}

TEST(GrainsLaunchedAhead, DeepOverlapIsAFault) {
  const GrainModel m = laneModel({});
  GrainSpec lower, upper;
  upper.position = {0, 0, (2 - 1.5 * m.maxOverlap) * m.radius};
  Grains grains(base::cpuExec(1), m, {}, {lower, upper});
  grains.refreshNeighbours();
  Pushes pushes;
  EXPECT_THROW(stepApart(grains, pushes.view(grains, 0)), GrainFault);
}

TEST(GrainSimd, EveryWidthGivesTheBitsOfTheScalarKernel) {
  const LaneKind kinds[] = {{},
                            {.ledger = false},
                            {.friction = false, .wallFriction = 0},
                            {.friction = false, .ledger = false, .wallFriction = 0},
                            {.friction = false}, // friction on walls only
                            {.walls = false},
                            {.loads = true},
                            {.friction = false, .loads = true, .wallFriction = 0},
                            {.attraction = true},
                            {.grains = 1},
                            {.grains = 63},
                            {.grains = 257}};
  for (const LaneKind& kind : kinds) {
    const auto expected = wordsAfter(kind, 1, 1, kSteps);
    for (const int lanes : {4, 8, 16})
      EXPECT_TRUE(wordsAfter(kind, lanes, 1, kSteps) == expected) << lanes << " lanes, " << kind.grains << " grains";
    EXPECT_TRUE(wordsAfter(kind, 16, 2, kSteps, 0.15) == expected) << "two threads, more rebuilds";
  }
}

/// All features of soil beds, each on and off.
TEST(GrainSimd, EveryWidthGivesTheBitsOfTheScalarKernelInBedsOfSoil) {
  for (int bits = 0; bits < 32; ++bits) {
    const LaneKind kind{.ledger = bits != 7,
                        .loads = bits % 3 == 1,
                        .grains = 257,
                        .hertz = (bits & 1) != 0,
                        .rolling = (bits & 2) != 0,
                        .periodic = (bits & 16) != 0,
                        .fixed = (bits & 8) != 0,
                        .surface = bits % 5 == 1,
                        .smallest = bits & 4 ? 0.6 : 1,
                        .cohesive = bits & 1 && bits % 7 < 4}; // lanes support cohesion of Hertz contacts
    const auto expected = wordsAfter(kind, 1, 1, kSteps);
    for (const int lanes : {4, 8, 16})
      EXPECT_TRUE(wordsAfter(kind, lanes, 1, kSteps) == expected) << lanes << " lanes, kind " << bits;
    EXPECT_TRUE(wordsAfter(kind, 16, 2, kSteps, 0.2) == expected) << "two threads, more rebuilds, kind " << bits;
  }
}

/// Beds with plastic contacts that adhere according to their maximum overlap, and separate along the adhesive branch.
TEST(GrainSimd, EveryWidthGivesTheBitsOfTheScalarKernelWhereContactsYield) {
  for (int bits = 0; bits < 24; ++bits) {
    const bool luding = bits >= 16;
    LaneKind kind{.ledger = bits != 5,
                  .loads = bits % 3 == 1,
                  .grains = 257,
                  .hertz = !luding,
                  .rolling = bits != 20,
                  .periodic = (bits & 4) != 0,
                  .fixed = (bits & 2) != 0,
                  .surface = bits % 5 == 1,
                  .smallest = bits & 1 ? 0.6 : 1,
                  .cohesive = !luding && (bits & 8) != 0,
                  .yielding = !luding,
                  .luding = luding};
    kind.pull = bits % 4 == 1 ? 0 : 40, kind.pullGrowth = bits % 4 == 3 ? 4e3 : 0;
    const auto expected = wordsAfter(kind, 1, 1, kSteps);
    LaneKind loose = kind;
    loose.pull = loose.pullGrowth = 0;
    EXPECT_TRUE(bits % 4 == 1 || wordsAfter(loose, 1, 1, kSteps) != expected) << "no contact has pulled, kind " << bits;
    for (const int lanes : {4, 8, 16})
      EXPECT_TRUE(wordsAfter(kind, lanes, 1, kSteps) == expected) << lanes << " lanes, kind " << bits;
    EXPECT_TRUE(wordsAfter(kind, 16, 2, kSteps, 0.2) == expected) << "two threads, more rebuilds, kind " << bits;
  }
}

/// Kernels of soils with rolling, adhesion, yielding on fixed grains: between periodic boundaries, as in a bevameter,
/// alone and under a surface; and on walls. On the device under test. Under a vehicle, which pushes grains from
/// the host, on CPUs only.
TEST(SoilKernels, GiveTheBitsOfTheGeneralOne) {
  enum { settling, pressed, walled, driven };
  for (const int place : {settling, pressed, walled, driven})
    for (int bits = 0; bits < 8; ++bits) {
      LaneKind kind{.hertz = true,
                    .rolling = (bits & 4) != 0,
                    .periodic = place == settling || place == pressed,
                    .fixed = true,
                    .surface = place == pressed,
                    .smallest = 0.6,
                    .cohesive = (bits & 1) != 0,
                    .yielding = (bits & 2) != 0,
                    .onDevice = true};
      kind.loads = place == driven;
      if (kind.yielding && !kind.rolling) continue;                      // no specialised kernel
      if (kind.yielding && kind.cohesive && place == settling) continue; // they settle without cohesion
      if (place == driven && !testExec(1).onCpu()) continue;
      const auto special = wordsAfter(kind, 1, 2, kSteps);
      kind.special = false;
      EXPECT_TRUE(wordsAfter(kind, 1, 1, kSteps) == special) << "place " << place << ", kind " << bits;
    }
}

/// A grain among six times smaller ones has more neighbours than a word has bits; with twelve times smaller ones more
/// than a block of contacts holds.
TEST(GrainSimd, GrainsWithManyNeighboursAreTakenWhole) {
  const auto check = [](double times, bool yields) {
    GrainModel m = laneModel({.hertz = yields, .rolling = true, .smallest = 0.5, .yielding = yields});
    const double small = m.radius / times;
    m.skin = 1.5, m.timeStep = times > 6 ? 5e-7 : 1.5e-6, m.smallestRadius = small;
    std::vector<GrainSpec> start{{{0, 0, 0}, {0, 0, -1}, {10, 20, 30}, m.radius}};
    const int across = static_cast<int>(times) + 4;
    for (int i = 0; i < across * across * across; ++i) {
      const Vec3d cell{i % across + 0.0, i / across % across + 0.0, i / (across * across) + 0.0};
      const Vec3d place = (cell - Vec3d{1, 1, 1} * (0.5 * (across - 1))) * (2.05 * small);
      if (norm(place) > m.radius + 1.01 * small)
        start.push_back({place, {}, {0, 0, 5}, small * (0.9 + 0.1 * die(i, 1))});
    }
    const auto words = [&](int lanes) {
      m.maxSimdLanes = lanes;
      Grains grains(base::cpuExec(1), m, {{{{0, 0, 1}, -(across + 1) * 1.05 * small, m.law}}, {}}, start);
      advance(grains, 1);
      const contact::NeighbourList::HostCopy lists = grains.system().neighbours.toHost();
      EXPECT_GT(*std::max_element(lists.count.begin(), lists.count.end()), times > 6 ? 192u : 64u);
      advance(grains, 700);
      return grains.state().words();
    };
    const auto expected = words(1);
    for (const int lanes : {4, 8, 16}) EXPECT_TRUE(words(lanes) == expected) << lanes << " lanes, " << times;
  };
  for (const double times : {6.0, 12.0}) check(times, false), check(times, true);
}

/// Two grains with an overlap below the resolution of float squares, and two that just do not touch.
TEST(GrainSimd, TouchOfOneUnitIsFound) {
  GrainModel m = ball(1e-6);
  const double unit = base::positionScale(2 * m.radius).unit;
  for (const int units : {-2, -1, 0, 1, 2})
    for (const int lanes : {1, 4, 8, 16}) {
      m.maxSimdLanes = lanes;
      Grains grains(base::cpuExec(1), m, {}, {{{0, 0, 0}, {}, {}}, {{2 * m.radius + units * unit, 0, 0}, {}, {}}});
      advance(grains, 1);
      std::uint64_t touching = 0;
      for (const std::uint64_t word : grains.system().neighbours.toHost().touching) touching += word != 0;
      EXPECT_EQ(touching, units < 0 ? 2u : 0u) << units << " units apart, " << lanes << " lanes";
    }
}

TEST(GrainSimd, FaultsAreThoseOfTheScalarKernel) {
  const auto messageOf = [](int lanes, const GrainSpec& second) -> std::string {
    GrainModel m = ball(1e-5);
    m.maxSimdLanes = lanes;
    Grains grains(base::cpuExec(1), m, {}, {{{0, 0, 0}, {}, {}}, second});
    try {
      advance(grains, 2000);
    } catch (const base::SimulationError& e) {
      return e.what();
    }
    return "";
  };
  const GrainSpec deep{{0.007, 0, 0}, {}, {}}, fast{{0.5, 0, 0}, {200, 0, 0}, {}}, far{{127.9, 0, 0}, {100, 0, 0}, {}};
  for (const GrainSpec& second : {deep, fast, far}) {
    const std::string expected = messageOf(1, second);
    EXPECT_EQ(messageOf(16, second), expected);
    EXPECT_EQ(messageOf(4, second), expected);
  }
  EXPECT_NE(messageOf(16, deep).find("overlaps"), std::string::npos);
  EXPECT_NE(messageOf(16, fast).find("moves at"), std::string::npos);
}

/// Coordinates with low words that wrap during the run.
TEST(GrainSimd, GrainsCrossTheEndsOfTheirLowWords) {
  GrainModel m = ball(1e-5);
  const double wrap = 4294967296.0 * base::positionScale(2 * m.radius).unit;
  const auto words = [&](int lanes) {
    m.maxSimdLanes = lanes;
    std::vector<GrainSpec> start;
    for (int k = -3; k <= 3; ++k) start.push_back({{k * wrap + 1e-4, -k * wrap - 1e-4, 1e-5}, {-1, 1, -0.5}, {}});
    Grains grains(base::cpuExec(1), m, {}, start);
    advance(grains, 100);
    return grains.state().words();
  };
  EXPECT_EQ(words(16), words(1));
  EXPECT_EQ(words(8), words(1));
  EXPECT_EQ(words(4), words(1));
}

} // namespace
} // namespace grouser::terrain::testing
