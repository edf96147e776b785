// SPDX-License-Identifier: BSD-3-Clause
// One grain against parts made of spheres: the plane under it, two patches in a corner, history, balance of loads.
#include "contact/grain_part_contacts.hpp"

#include "base/bits.hpp"
#include "base/math.hpp"
#include "base/random.hpp"
#include "part_fixture.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grouser::contact::testing {
namespace {

using base::Vec3d;

constexpr double kGrainRadius = 0.027, kGrainStiffness = 1e6;

/// A grain on the device under test.
struct OneGrain {
  base::Array<base::Position> position;
  base::Array<Motion> motion;
  base::Array<std::uint32_t> id;

  OneGrain(const base::Exec& exec, const base::Position& p, const base::Vec3f& v)
      : position(exec, std::vector{p}), motion(exec, std::vector{Motion{{v.x, v.y, v.z, 0}, {}}}), id(exec, 1) {}
  GrainsView view() const { return {position.data(), motion.data(), id.data(), 1}; }
};

/// One grain against one part, stepped by hand.
struct Bench {
  GrainPartModel model;
  base::Exec exec = testExec();
  std::unique_ptr<GrainPartContacts> contacts;
  base::Array<PartMotion> motion;
  base::Array<PartLoad> loads;

  explicit Bench(const base::SphereSet& set, double friction = 0, const ContactLaw& pull = {}) {
    model.radius = kGrainRadius, model.mass = 0.2, model.timeStep = 1e-4, model.margin = 0.01;
    model.law.stiffness = kGrainStiffness, model.law.friction = static_cast<float>(friction);
    model.law.tangentialStiffness = 2e5f;
    model.law.pullPerRadius = pull.pullPerRadius, model.law.pullPerArea = pull.pullPerArea;
    model.scale = base::positionScale(2 * kGrainRadius);
    model.force = model.torque = base::fixedPointFor(kGrainStiffness * kGrainRadius, 36);
    model.energy = base::fixedPointFor(10, 36);
    contacts = std::make_unique<GrainPartContacts>(exec, model, std::vector<const base::SphereSet*>{&set},
                                                   std::vector<GrainPart>{{0, {}, {}}});
    loads = base::Array<PartLoad>(exec, 1);
  }

  struct Result {
    Vec3d onGrain, onPart, torqueOnPart, torqueOnGrain;
    std::int64_t patches;
    double deepest = 0; ///< [m]
  };
  Result touch(const Vec3d& x, const Vec3d& v, const PartMotion& part, bool refresh = true) {
    const OneGrain grain(exec, model.scale.fromMetres(x), v.as<float>());
    motion = base::Array<PartMotion>(exec, std::vector<PartMotion>{part});
    const GrainsView grains = grain.view();
    if (refresh) contacts->refresh(grains, motion);
    loads.zero();
    contacts->compute(grains, motion, loads.data());
    Result r{};
    const GrainLoadsView view = contacts->grainLoads();
    std::uint32_t range = 0;
    base::copyToHost(exec, &range, view.range, sizeof range);
    std::vector<GrainLoad> load(range & 255u);
    base::copyToHost(exec, load.data(), view.load + (range >> 8), load.size() * sizeof(GrainLoad));
    for (const GrainLoad& l : load) r.onGrain += view.force.value(l.force), r.torqueOnGrain += l.torque.as<double>();
    for (const GrainLoad& l : load) r.deepest = std::max(r.deepest, static_cast<double>(l.deepest));
    r.onPart = model.force.value(loads.at(0).force);
    r.torqueOnPart = model.torque.value(loads.at(0).torque);
    r.patches = contacts->ledger().contacts;
    return r;
  }
};

TEST(GrainOnPlate, FeelsThePlaneNotTheBumps) {
  const double overlap = 5e-4;
  for (const double spacing : {0.004, 0.008, 0.016}) { // the force must not depend on how finely the part is cut
    Bench bench(plate(0.1, 0.008, spacing));
    for (double x = -0.03; x < 0.03; x += 0.0037) {
      const auto r = bench.touch({x, 0.3 * x, kGrainRadius - overlap}, {}, atRest({}));
      EXPECT_EQ(r.patches, 1);
      EXPECT_NEAR(r.onGrain.z, kGrainStiffness * overlap, 1e-4 * kGrainStiffness * overlap)
          << "float distances of 35 mm, 4e-9 m";
      EXPECT_NEAR(r.onGrain.x, 0, 1e-4 * kGrainStiffness * overlap);
    }
  }
}

/// F = k x - 2 pi w R, with an energy w = w0 + w1 R / R1 of surfaces that touch; R is the grain's own radius on a
/// plane.
TEST(GrainOnPlate, ThatSticksIsHeldUntilTheyPart) {
  ContactLaw pull;
  pull.pullPerRadius = 2 * base::kPi * 500, pull.pullPerArea = 2 * base::kPi * 600 / 0.03;
  const double held = 2 * base::kPi * (500 + 600 * kGrainRadius / 0.03) * kGrainRadius;
  Bench bench(plate(0.1, 0.008, 0.008), 0, pull);
  for (const double overlap : {5e-4, 1e-4, 1e-6}) {
    const auto r = bench.touch({0.01, 0.003, kGrainRadius - overlap}, {}, atRest({}));
    EXPECT_NEAR(r.onGrain.z, kGrainStiffness * overlap - held, 2e-4 * held) << overlap;
    EXPECT_EQ(r.onPart.z, -r.onGrain.z);
  }
  EXPECT_EQ(bench.touch({0.01, 0.003, kGrainRadius + 1e-6}, {}, atRest({})).onGrain, Vec3d{}) << "apart";
}

TEST(GrainOnPlate, TurnedAndMovedPlateGivesTheSameForceInItsFrame) {
  Bench bench(plate(0.1, 0.008, 0.008));
  const double angle = 0.7;
  const base::Quat q{base::cos(angle / 2), 0.6 * base::sin(angle / 2), 0.8 * base::sin(angle / 2), 0};
  const PartMotion part = atRest({3, -2, 1}, q);
  const double overlap = 3e-4;
  const auto r = bench.touch(part.toWorld({0.011, -0.007, kGrainRadius - overlap}), {}, part);
  const Vec3d inPart = transposedTimes(part.rotation, r.onGrain);
  EXPECT_NEAR(inPart.z, kGrainStiffness * overlap, 1e-3 * kGrainStiffness * overlap);
  EXPECT_NEAR(inPart.x, 0, 1e-3 * kGrainStiffness * overlap);
}

TEST(GrainOnPlate, LoadsBalanceToTheLastQuantum) {
  Bench bench(plate(0.1, 0.008, 0.008), 0.5);
  for (int k = 0; k < 20; ++k) {
    const Vec3d x{0.001 * k, 0.0003 * k, kGrainRadius - 1e-4 * k};
    const auto r = bench.touch(x, {0.3, 0.1, -0.2}, atRest({}));
    EXPECT_EQ(r.onGrain + r.onPart, Vec3d{}) << "integers of opposite sign";
    // Torque of both about the world's origin: x cross F + torque on grain + torque on part (about the origin).
    const Vec3d total = cross(x, r.onGrain) + r.torqueOnGrain + r.torqueOnPart;
    EXPECT_LT(norm(total), 1e-5) << "float torque of 27 mm x 1 kN";
  }
}

TEST(GrainInCorner, HasOnePatchOnEachFace) {
  Bench bench(corner(0.1, 0.008, 0.008));
  const double a = 4e-4, b = 2e-4;
  const auto r = bench.touch({kGrainRadius - a, 0.003, kGrainRadius - b}, {}, atRest({}));
  EXPECT_EQ(r.patches, 2);
  EXPECT_NEAR(r.onGrain.x, kGrainStiffness * a, 0.01);
  EXPECT_NEAR(r.onGrain.z, kGrainStiffness * b, 0.01);
}

/// State of a grain of given radius and material after some steps of sliding, rolling and sinking into a
/// corner. Grains that may crush use the kernel with all features.
struct Trace {
  std::vector<GrainLoad> loads;
  std::vector<std::int64_t> sums;
  std::vector<std::uint32_t> patches;
};
Trace traceOf(const base::SphereSet& set, bool manyRadii, double strength) {
  GrainPartModel model = Bench(set, 0.1).model;
  model.manyRadii = manyRadii;
  model.law.rootDamping = manyRadii ? 60 : 0, model.law.tangentialRootDamping = manyRadii ? 30 : 0;
  model.law.damping = manyRadii ? 0 : 40, model.law.tangentialDamping = manyRadii ? 0 : 20;
  const base::Exec exec = testExec();
  GrainPartContacts contacts(exec, model, {&set}, {{0, {}, {}}}, {}, {{model.law}, {1e4}, {strength}});
  const double radius = manyRadii ? 0.7 * kGrainRadius : kGrainRadius;
  const base::Array<PartMotion> motion(exec, std::vector{atRest({})});
  base::Array<PartLoad> part(exec, 2);
  const base::Array<std::uint32_t> id(exec, 1);
  Trace trace;
  for (int k = 0; k < 30; ++k) {
    const Vec3d x{radius - 2e-5 * k, 1e-5 * k, radius - 3e-5 * k};
    const base::Array<base::Position> position(exec, std::vector{model.scale.fromMetres(x)});
    const base::Array<Motion> flight(exec, std::vector{Motion{{-0.2f, 0.1f, -0.3f, float(radius)}, {1, -2, 3, 0}}});
    const GrainsView grains{position.data(), flight.data(), id.data(), 1};
    contacts.refresh(grains, motion);
    contacts.compute(grains, motion, part.data());
    GrainLoad load{};
    base::copyToHost(exec, &load, contacts.grainLoads().load, sizeof load);
    trace.loads.push_back(load);
  }
  const SavedGrainPatches saved = contacts.save();
  trace.sums = saved.sums, trace.patches = saved.memories;
  return trace;
}

TEST(GrainInCorner, KernelsOfFewFeaturesGiveTheBitsOfTheGeneralOne) {
  const base::SphereSet set = corner(0.1, 0.008, 0.008);
  for (const bool manyRadii : {false, true}) {
    const Trace special = traceOf(set, manyRadii, 0), general = traceOf(set, manyRadii, 1e12);
    EXPECT_EQ(special.patches.size(), 16u) << "a floor and a wall";
    EXPECT_EQ(special.patches, general.patches);
    EXPECT_EQ(special.sums, general.sums);
    for (std::size_t k = 0; k < special.loads.size(); ++k) {
      EXPECT_EQ(special.loads[k].force, general.loads[k].force);
      EXPECT_EQ(special.loads[k].torque, general.loads[k].torque);
    }
    EXPECT_NE(special.sums[kSlidingLossByParts], 0);
    EXPECT_NE(special.sums[kDampedByParts], 0);
  }
}

TEST(GrainPinched, BetweenTwoTeethIsHeldByBoth) {
  // Two parts face each other 2 R - 2 overlap apart: forces cancel, each part carries its own.
  base::SphereSet set = plate(0.1, 0.008, 0.008);
  GrainPartModel model = Bench(set).model;
  const base::Exec exec = testExec();
  GrainPartContacts contacts(exec, model, {&set}, {{0, {}, {}}, {0, {}, {}}});
  const double overlap = 3e-4, gap = 2 * (kGrainRadius - overlap);
  const PartMotion below = atRest({}), above = atRest({0, 0, gap}, {0, 1, 0, 0}); // turned by half a turn about x
  base::Array<PartMotion> motion(exec, std::vector<PartMotion>{below, above});
  base::Array<PartLoad> loads(exec, 2);
  const OneGrain grain(exec, model.scale.fromMetres({0.005, 0.002, 0.5 * gap}), {});
  contacts.refresh(grain.view(), motion);
  contacts.compute(grain.view(), motion, loads.data());
  const double down = model.force.value(loads.at(0).force.z), up = model.force.value(loads.at(1).force.z);
  EXPECT_NEAR(down, -kGrainStiffness * overlap, 0.05);
  EXPECT_NEAR(up, kGrainStiffness * overlap, 0.05);
}

TEST(GrainOnPlate, WhoseMiddleHasComeThroughASurfaceIsDeeperThanItsRadius) {
  Bench bench(plate(0.1, 0.008, 0.008));
  EXPECT_LT(bench.touch({0, 0, 1e-4}, {}, atRest({})).deepest, kGrainRadius);
  EXPECT_GT(bench.touch({0, 0, -1e-4}, {}, atRest({})).deepest, kGrainRadius);
}

TEST(GrainOnPlate, ThatAStepHasCarriedThroughAThinPlateCountsAsPressedBeyondItsMiddle) {
  // 4 mm thin, as spheres of 2 mm; from 3 mm above the upper face to 3 mm below the lower one.
  Bench bench(plate(0.1, 0.002, 0.004, 0.004));
  EXPECT_NEAR(bench.touch({0, 0, 0.003}, {}, atRest({})).deepest, kGrainRadius - 0.003, 1e-6);
  EXPECT_GT(bench.touch({0, 0, -0.007}, {}, atRest({}), false).deepest, kGrainRadius);
  // From there on it lies on the lower face, as one does that has always been there.
  EXPECT_NEAR(bench.touch({0, 0, -0.007}, {}, atRest({}), false).deepest, kGrainRadius - 0.003, 1e-6);
}

TEST(GrainOnPlate, BetweenTwoFacesOfOnePartThatBothLetGoDoesNotCountAsCarriedThrough) {
  // First touch is never half a radius deep.
  Bench bench(plate(0.1, 0.002, 0.004, 0.004));
  EXPECT_NEAR(bench.touch({0, 0, kGrainRadius - 1e-4}, {}, atRest({})).deepest, 1e-4, 1e-6);
  EXPECT_NEAR(bench.touch({0, 0, -0.004 - kGrainRadius + 1e-4}, {}, atRest({}), false).deepest, 1e-4, 1e-6);
}

TEST(GrainOnPlate, WhatIsPressedMostSinceTheLastRowIsKeptWithItsGrain) {
  Bench bench(plate(0.1, 0.008, 0.008));
  EXPECT_FALSE(bench.contacts->mostPressed());
  for (const double share : {0.1, 0.4, 0.3}) bench.touch({0, 0, (1 - share) * kGrainRadius}, {}, atRest({}));
  const auto most = bench.contacts->mostPressed();
  ASSERT_TRUE(most);
  EXPECT_EQ(most->part, 0);
  EXPECT_EQ(most->grain, 0u);
  EXPECT_NEAR(most->share, 0.4, 1e-6) << "float, and positions in units of 4e-10 m";
  EXPECT_EQ(bench.contacts->ledger().squeezed, 1) << "in the last step alone, 0.3";
  const SavedGrainPatches saved = bench.contacts->save();
  bench.contacts->resetDeepestOverlap();
  EXPECT_FALSE(bench.contacts->mostPressed());
  bench.contacts->restore(saved);
  EXPECT_NEAR(bench.contacts->mostPressed()->share, 0.4, 1e-6);
}

TEST(GrainOnPlate, APartThatGrainsDoNotMeetIsNotFelt) {
  const base::SphereSet set = plate(0.1, 0.008, 0.008);
  const Bench bench(set);
  GrainPartContacts contacts(bench.exec, bench.model, {&set}, {{0, {}, {}, false}, {0, {}, {}}});
  const OneGrain grain(bench.exec, bench.model.scale.fromMetres({0, 0, kGrainRadius - 1e-3}), {});
  const base::Array<PartMotion> motion(bench.exec, std::vector{atRest({}), atRest({})});
  base::Array<PartLoad> loads(bench.exec, 2);
  contacts.refresh(grain.view(), motion);
  contacts.compute(grain.view(), motion, loads.data());
  EXPECT_EQ(contacts.pairs(), 1u);
  EXPECT_EQ(loads.at(0).force, base::Vec3l{});
  EXPECT_LT(loads.at(1).force.z, 0);
}

TEST(GrainOnPlate, KeepsItsFrictionSpringThroughARefresh) {
  for (const bool refresh : {false, true}) {
    Bench bench(plate(0.1, 0.008, 0.008), 0.5);
    double x = 0;
    const double overlap = 1e-3, speed = 0.01;
    Bench::Result r{};
    for (int k = 0; k < 50; ++k) { // 50 steps of 1e-4 s at 1 cm/s: 50 um of stretch, 10 N of 500 N limit
      r = bench.touch({x, 0, kGrainRadius - overlap}, {speed, 0, 0}, atRest({}), k == 0 || refresh);
      x += speed * bench.model.timeStep;
    }
    EXPECT_NEAR(r.onGrain.x, -2e5 * 50 * speed * bench.model.timeStep, 1e-3);
  }
}

/// A cloud of grains that falls on a plate in large steps: loads, springs and sums of all steps.
std::vector<std::uint64_t> fallOnPlate(std::size_t searchFrom, bool soil) {
  Bench bench(plate(0.1, 0.008, 0.008), 0.5);
  const base::SphereSet set = plate(0.1, 0.008, 0.008);
  bench.model.searchFrom = searchFrom, bench.model.manyRadii = soil;
  GrainPartMaterials materials;
  if (soil) {
    ContactLaw law = bench.model.law;
    law.rollingFriction = 0.2;
    materials = {{law}, {2500 * 4.0 / 3 * base::kPi}, {5e5}};
  }
  GrainPartContacts contacts(bench.exec, bench.model, {&set}, {{0, {}, {}}}, {}, materials);
  base::Array<PartLoad> loads(bench.exec, 2);
  const std::vector<PartMotion> still{atRest({})};
  const base::Array<PartMotion> motion(bench.exec, still);
  constexpr std::uint32_t kGrains = 300;
  std::vector<std::uint64_t> result;
  for (int step = 0; step < 6; ++step) {
    std::vector<base::Position> position;
    std::vector<Motion> moving;
    std::vector<std::uint32_t> id;
    for (std::uint32_t g = 0; g < kGrains; ++g) {
      const auto die = [g](std::uint64_t k) { return base::uniform(1, 2, g, k); };
      const double fall = 0.002 + 0.004 * die(3);
      position.push_back(bench.model.scale.fromMetres(
          {0.25 * (die(0) - 0.5), 0.25 * (die(1) - 0.5), 0.1 * die(2) - 0.04 - fall * step}));
      const float radius = soil ? static_cast<float>(std::ldexp(std::floor(64 + 40 * die(4)), -12)) : 0.0f;
      moving.push_back(
          {{0.3f, 0, static_cast<float>(-fall / 1e-4), g % 7 == 0 ? -radius : radius}, {0, 5, 0, 0}}); // some are fixed
      id.push_back(g);
    }
    const base::Array<base::Position> places(bench.exec, position);
    const base::Array<Motion> motions(bench.exec, moving);
    const base::Array<std::uint32_t> ids(bench.exec, id);
    const GrainsView grains{places.data(), motions.data(), ids.data(), kGrains};
    if (step % 3 == 0) contacts.refresh(grains, motion);
    loads.zero();
    contacts.compute(grains, motion, loads.data());
    const PartLoad onPart = loads.at(0);
    for (int a = 0; a < 3; ++a)
      result.push_back(static_cast<std::uint64_t>(onPart.force[a])),
          result.push_back(static_cast<std::uint64_t>(onPart.torque[a]));
    for (const std::uint32_t word : contacts.save().words()) result.push_back(word);
    for (const std::int64_t sum : contacts.save().sums) result.push_back(static_cast<std::uint64_t>(sum));
    const GrainLoadsView view = contacts.grainLoads();
    std::vector<GrainLoad> load(static_cast<std::size_t>(view.count));
    base::copyToHost(bench.exec, load.data(), view.load, load.size() * sizeof(GrainLoad));
    for (const GrainLoad& l : load)
      result.push_back(static_cast<std::uint64_t>(l.force.z)), result.push_back(base::bitsAs<std::uint32_t>(l.deepest));
  }
  return result;
}

TEST(GrainsNearParts, HaveTheSameLoadsWhereTheyAreSearchedFirst) {
  for (const bool soil : {false, true}) EXPECT_EQ(fallOnPlate(1, soil), fallOnPlate(1000000, soil)) << soil;
}

} // namespace
} // namespace grouser::contact::testing
