// SPDX-License-Identifier: BSD-3-Clause
// Grains of every law, with mixed radii and materials, in both precisions: identical results, and conserved quantities.
#include "base/error.hpp"
#include "base/random.hpp"
#include "grain_fixture.hpp"
#include "terrain/kernel_choice.hpp"
#include "tests/device_under_test.hpp"
#include "tests/terrain/state_words.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

using base::Vec3d;

struct Kind {
  bool hertz = false, rolling = false, cohesion = false, radii = false, materials = false;
  Precision precision = Precision::single;
  bool friction = true;
  bool plastic = false, luding = false;
  bool mixed = false, fixed = false; ///< Hertz and linear contacts in one scene; the lowest grains never move
};

contact::ContactLaw lawOf(const Kind& kind, double factor) {
  contact::ContactLaw law;
  if (kind.hertz) {
    law.hertz = true, law.stiffness = 5e7 * factor, law.tangentialStiffness = 4e7 * factor;
    law.rootDamping = 0.4 * std::sqrt(1.5 * law.stiffness), law.tangentialRootDamping = law.rootDamping / 2;
  } else {
    law.stiffness = 1e5 * factor, law.tangentialStiffness = law.stiffness * 2 / 7;
    if (kind.radii || kind.materials)
      law.rootDamping = 0.4 * std::sqrt(law.stiffness), law.tangentialRootDamping = law.rootDamping / 2;
    else
      law.damping = 800, law.tangentialDamping = 400;
  }
  if (kind.friction) law.friction = 0.5;
  if (kind.rolling) law.rollingFriction = 0.1, law.rollingDamping = 0.3;
  if (kind.cohesion) law.pullPerRadius = 2;
  if (kind.plastic) law.plastic = {0.6, 0.7, 0.3, 40, 0, 0, 0, 3};
  if (kind.luding) law.plastic = {0.6, 0, 0, 0, 0, 0.02, 0.5, 2};
  return law;
}

struct Bed {
  GrainModel model;
  Boundaries boundaries;
  std::vector<GrainSpec> start;
};

/// A hundred grains thrown into a corner.
Bed bedOf(const Kind& kind, int across = 5) {
  Bed bed;
  GrainModel& m = bed.model;
  m = ball(1e-5);
  m.gravity = {0, 0, -9.81};
  m.precision = kind.precision;
  m.law = m.floorLaw = lawOf(kind, 1);
  bed.boundaries.walls = {{{0, 0, 1}, 0, m.law}, {{1, 0, 0}, -0.004, m.law}, {{0, 1, 0}, -0.004, m.law}};
  if (kind.materials) {
    m.materials.density = {2600, 1000};
    auto soft = lawOf(kind, 0.5), pair = lawOf(kind, 0.7);
    if (kind.mixed) soft = lawOf({.radii = true, .friction = false}, 1), pair.rollingFriction = pair.pullPerRadius = 0;
    m.materials.grains = {m.law, pair, pair, soft};
    for (int b = 0; b < 3; ++b) m.materials.boundaries.insert(m.materials.boundaries.end(), {m.law, soft});
  }
  for (int i = 0; i < across * across * 4; ++i) {
    const auto u = [&](std::uint64_t k) { return base::uniform(1, 2, static_cast<std::uint64_t>(i), k); };
    GrainSpec g;
    g.position = Vec3d{i % across + 0.2 * u(0), i / across % across + 0.2 * u(1), i / (across * across) + 0.6} * 0.0115;
    g.velocity = {-1 - u(2), -1 + u(3), -1}, g.spin = {100 * u(4), -50 * u(5), 80 * u(6)};
    g.radius = kind.radii ? 0.0015 + 0.0035 * u(7) : m.radius;
    g.material = kind.materials && u(8) < 0.5 ? 1 : 0;
    if (kind.fixed && i < across * across) g.velocity = g.spin = {}, g.position.z = 0, g.fixed = true;
    bed.start.push_back(g);
  }
  if (kind.radii) bed.start[0].radius = m.radius;
  return bed;
}

std::vector<std::uint32_t> wordsAfter(const Bed& bed, int steps, int threads = 1) {
  Grains grains(testExec(threads), bed.model, bed.boundaries, bed.start);
  advance(grains, steps);
  return wordsOf(grains);
}

std::vector<Kind> allKinds() {
  std::vector<Kind> kinds;
  for (int bits = 0; bits < 64; ++bits)
    kinds.push_back({(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0, (bits & 16) != 0,
                     bits & 32 ? Precision::double_ : Precision::single});
  kinds.push_back({.friction = false});
  kinds.push_back({.hertz = true, .friction = false});
  kinds.push_back({.radii = true, .friction = false});
  for (const Precision precision : {Precision::single, Precision::double_}) {
    kinds.push_back({.rolling = true, .radii = true, .precision = precision, .plastic = true});
    kinds.push_back({.hertz = true, .rolling = true, .radii = true, .precision = precision, .plastic = true});
    kinds.push_back({.precision = precision, .luding = true});
    kinds.push_back({.rolling = true, .radii = true, .materials = true, .precision = precision, .luding = true});
    kinds.push_back({.hertz = true, .precision = precision, .friction = false, .plastic = true});
    kinds.push_back({.hertz = true,
                     .rolling = true,
                     .cohesion = true,
                     .radii = true,
                     .materials = true,
                     .precision = precision,
                     .plastic = true,
                     .mixed = true,
                     .fixed = true});
  }
  kinds.push_back({.radii = true, .materials = true, .luding = true, .fixed = true});
  return kinds;
}

TEST(ManyKinds, EveryKernelGivesTheBitsOfTheGeneralOneOnAnyThreadsAndRebuilds) {
  for (const Kind& kind : allKinds()) {
    Bed bed = bedOf(kind);
    bed.model.specialised = false, bed.model.skin = 0.7;
    const auto expected = wordsAfter(bed, 300, 2);
    bed.model.specialised = true, bed.model.skin = 0.5;
    for (const int lanes : {16, 8, 4, 1}) {
      bed.model.maxSimdLanes = lanes;
      EXPECT_TRUE(wordsAfter(bed, 300) == expected)
          << lanes << " lanes, "
          << featureText(Grains(testExec(1), bed.model, bed.boundaries, bed.start).system().constants.features);
      if (lanes == 16 && (!testExec(1).onCpu() || kind.precision == Precision::double_)) break; // no lanes
    }
  }
}

TEST(ManyKinds, RadiiOfOneSizeAreNotStored) {
  Grains one(testExec(1), bedOf({}).model, bedOf({}).boundaries, bedOf({}).start);
  EXPECT_FALSE(one.system().constants.manyRadii());
  EXPECT_TRUE(one.state().radius.empty());
  EXPECT_TRUE(one.state().material.empty());
  EXPECT_TRUE(one.state().contactRolling.empty());
  const Bed bed = bedOf({.friction = false});
  Grains smooth(testExec(1), bed.model, bed.boundaries, bed.start);
  advance(smooth, 200);
  EXPECT_TRUE(smooth.state().contactShear.empty());
  EXPECT_TRUE(smooth.system().neighbours.toHost().history.empty()) << "frictionless: no history arrays";
}

TEST(ManyKinds, ResumedRunGivesTheSameBits) {
  const Bed bed =
      bedOf({.hertz = true, .rolling = true, .cohesion = true, .radii = true, .materials = true, .plastic = true});
  const auto expected = wordsAfter(bed, 600);
  Grains first(testExec(1), bed.model, bed.boundaries, bed.start);
  advance(first, 150);
  const GrainState saved = first.state();
  ASSERT_FALSE(saved.contactRolling.empty());
  ASSERT_FALSE(saved.contactDeepest.empty());
  ASSERT_FALSE(saved.wallOrigin.empty());
  Grains second(testExec(1), bed.model, bed.boundaries, bed.start);
  second.restore(saved);
  advance(second, 600 - 150);
  EXPECT_EQ(wordsOf(second), expected);
}

/// Grains that collide without gravity or walls: momentum, angular momentum about the origin, energy.
struct Totals {
  Vec3d momentum, angular;
  double scale = 0;
};
Totals totalsOf(const Grains& grains, const std::vector<double>& mass) {
  Totals t;
  const auto s = grains.snapshot();
  for (std::size_t i = 0; i < mass.size(); ++i) {
    const double r = s.radius.empty() ? grains.model().radius : static_cast<double>(s.radius[i]);
    const Vec3d v = s.velocity[i].as<double>();
    t.momentum += v * mass[i];
    t.angular += cross(s.position[i], v * mass[i]) + s.spin[i].as<double>() * (0.4 * mass[i] * r * r);
    t.scale += mass[i] * norm(v) * 0.05;
  }
  return t;
}

TEST(ManyKinds, MomentumAndAngularMomentumAreKept) {
  for (const Precision precision : {Precision::single, Precision::double_}) {
    Bed bed = bedOf({.hertz = true, .radii = true, .materials = true, .precision = precision});
    bed.model.gravity = {};
    bed.boundaries = {}, bed.model.materials.boundaries.clear();
    std::vector<double> mass;
    for (GrainSpec& g : bed.start) {
      g.velocity = (Vec3d{0.03, 0.03, 0.03} - g.position) * 40.0;
      mass.push_back(bed.model.materials.density[static_cast<std::size_t>(g.material)] * 4.0 / 3 * base::kPi *
                     g.radius * g.radius * g.radius);
    }
    Grains grains(testExec(1), bed.model, bed.boundaries, bed.start);
    const Totals before = totalsOf(grains, mass);
    std::int64_t contacts = 0;
    for (int k = 0; k < 20; ++k) advance(grains, 200), contacts += grains.ledger().contacts;
    ASSERT_GT(contacts, 100);
    const Totals after = totalsOf(grains, mass);
    // Single: each force and torque has a relative rounding error of 6e-8. Double: the residual is float rounding of
    // velocities and radii in these sums.
    constexpr double share = 2e-6;
    EXPECT_LT(norm(after.momentum - before.momentum), share * before.scale / 0.05);
    EXPECT_LT(norm(after.angular - before.angular), 5 * share * before.scale);
  }
}

TEST(ManyKinds, EqualSpheresAsManyRadiiMoveAlikeToRoundOff) {
  // Compares the kernel for mixed radii, selected by one distant small grain, with that for one radius.
  Bed bed = bedOf({});
  bed.model.law.rootDamping = 0;
  const auto reference = [&](bool other) {
    Bed b = bed;
    if (other) b.start.push_back({{0.5, 0.5, 0.5}, {}, {}, 0.004, 0});
    Grains grains(testExec(1), b.model, b.boundaries, b.start);
    advance(grains, 150);
    return grains.snapshot();
  };
  const auto one = reference(false), many = reference(true);
  double worst = 0;
  for (std::size_t i = 0; i < one.position.size(); ++i)
    worst = std::max(worst, norm(one.position[i] - many.position[i]));
  EXPECT_LT(worst, 1e-8) << "round-off of float forces over 150 steps, radii of 5 mm";
}

TEST(ManyKinds, SmallGrainsInReachOfALargeOneAreAllListed) {
  // A ball with 200 small ones on its surface: more contacts than bits of a word.
  GrainModel m = ball(1e-6);
  m.law.friction = 0.5, m.law.tangentialStiffness = 2e4;
  m.law.damping = 500;
  std::vector<GrainSpec> start{{{0, 0, 0}, {}, {}, m.radius, 0}};
  const int n = 200;
  const double small = 0.0004, reach = m.radius + small - 1e-6;
  for (int k = 0; k < n; ++k) { // Fibonacci's sphere
    const double z = 1 - (2 * k + 1.0) / n, phi = k * 2.39996322972865332;
    const double across = std::sqrt(1 - z * z);
    start.push_back({Vec3d{across * base::cos(phi), across * base::sin(phi), z} * reach, {}, {}, small, 0});
  }
  Grains grains(testExec(1), m, {}, start);
  advance(grains, 1);
  EXPECT_EQ(grains.ledger().contacts, n);
  EXPECT_EQ(grains.state().contacts[0], static_cast<std::uint32_t>(n));
  const GrainState saved = grains.state();
  Grains other(testExec(1), m, {}, start);
  other.restore(saved);
  advance(grains, 5), other.invalidateNeighbours(), advance(other, 5);
  EXPECT_EQ(other.state().words(), grains.state().words());
}

TEST(ManyKinds, RadiiTooUnlikeAreRefused) {
  GrainModel m = ball(1e-6);
  EXPECT_THROW(Grains(testExec(1), m, {}, {{{0, 0, 0}, {}, {}, m.radius, 0}, {{1, 0, 0}, {}, {}, 1e-6, 0}}),
               base::InputError);
}

TEST(ManyKinds, OneGrainFeelsMoreNeighboursThanAWordHasBits) {
  // A ball with 150 small ones pressed on evenly from all sides: each is a contact with its own spring.
  constexpr int kSmall = 150;
  const Kind kind{.radii = true};
  GrainModel m = bedOf(kind).model;
  m.gravity = {}, m.timeStep = 1e-7; // the small ones weigh 0.3 mg
  const double small = 0.06 * m.radius, reach = m.radius + 0.98 * small;
  std::vector<GrainSpec> start{{{}, {}, {0, 0, 5}, m.radius}};
  for (int k = 0; k < kSmall; ++k) { // along a spiral from pole to pole
    const double z = 1 - (2 * k + 1.0) / kSmall, across = std::sqrt(1 - z * z), angle = 2.399963 * k;
    start.push_back({Vec3d{across * std::cos(angle), across * std::sin(angle), z} * reach, {}, {}, small});
  }
  Grains grains(testExec(), m, {}, start);
  advance(grains, 2);
  const GrainState state = grains.state();
  ASSERT_EQ(state.contacts[0], kSmall);
  for (int k = 0; k < kSmall; ++k) {
    EXPECT_EQ(state.neighbour[static_cast<std::size_t>(k)], static_cast<std::uint32_t>(k + 1));
    EXPECT_NE(state.contactShear[static_cast<std::size_t>(k)], base::Vec3f{}) << "the ball turns under " << k + 1;
  }
  // A resumed run has lost nothing.
  Grains resumed(testExec(), m, {}, start);
  resumed.restore(state);
  advance(grains, 3), advance(resumed, 3);
  EXPECT_EQ(grains.state().words(), resumed.state().words());
}

} // namespace
} // namespace grouser::terrain::testing
