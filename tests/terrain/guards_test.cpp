// SPDX-License-Identifier: BSD-3-Clause
// Faults that stop a run or prevent its start: coinciding grains, the end of the position range, excessive overlap.
#include "grain_fixture.hpp"

#include "base/error.hpp"
#include "terrain/grain_faults.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

TEST(Guards, GrainsAtOnePlaceAreRefusedByTheirNumbers) {
  try {
    Grains grains(base::cpuExec(1), ball(1e-6), {}, {{{0, 0, 0}, {}, {}}, {{1, 0, 0}, {}, {}}, {{0, 0, 0}, {}, {}}});
    FAIL() << "two grains at one position were accepted";
  } catch (const base::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("grains 0 and 2"), std::string::npos) << error.what();
  }
}

TEST(Guards, LeavingTheRangeStopsTheRun) {
  GrainModel m = ball(1e-5);
  m.skin = 1;
  const double limit = base::positionScale(2 * m.radius).limit();
  Grains grains(base::cpuExec(1), m, {}, {{{0, 0, 1e-3 - limit}, {0, 0, -50}, {}}});
  EXPECT_THROW(advance(grains, 100), base::SimulationError) << "positions must not wrap round";
}

TEST(Guards, DeepOverlapStopsTheRun) {
  GrainModel m = ball(1e-6);
  m.maxOverlap = 0.2;
  Grains grains(base::cpuExec(1), m, {}, {{{0, 0, 0}, {}, {}}, {{1.7 * m.radius, 0, 0}, {}, {}}});
  EXPECT_THROW(advance(grains, 1), base::SimulationError);
}

/// The error of one step of a grain with an overlap of `overlap` radii on a plane.
Fault faultAtPlane(double overlap, int lanes) {
  GrainModel m = ball(1e-6);
  m.maxSimdLanes = lanes;
  try {
    Grains grains(base::cpuExec(1), m, {{floorPlane(m.law)}, {}}, {{{0, 0, (1 - overlap) * m.radius}, {}, {}}});
    advance(grains, 1);
  } catch (const GrainFault& fault) {
    return fault.fault;
  }
  return Fault::none;
}

TEST(Guards, AGrainMayBeSqueezedButNotPassThroughAPlane) {
  for (const int lanes : {16, 1}) {
    EXPECT_EQ(faultAtPlane(0.79, lanes), Fault::none) << "lanes " << lanes;
    EXPECT_EQ(faultAtPlane(0.81, lanes), Fault::through) << "lanes " << lanes;
  }
}

TEST(Guards, TwoGrainsMayOverlapByHalfARadiusAndTheirOverlapIsCounted) {
  for (const int lanes : {16, 1}) {
    GrainModel m = ball(1e-6);
    m.maxSimdLanes = lanes;
    const auto pair = [&](double overlap) {
      return Grains(base::cpuExec(1), m, {},
                    {{{0, 0, 0}, {}, {}}, {{(2 - overlap) * m.radius, 0, 0}, {}, {}}, {{1, 0, 0}, {}, {}}});
    };
    Grains light = pair(0.19), squeezed = pair(0.21), deep = pair(0.49), beyond = pair(0.51);
    EXPECT_EQ(light.ledger().squeezed, 0);
    EXPECT_EQ(squeezed.ledger().squeezed, 1);
    EXPECT_NO_THROW(advance(deep, 1)) << "lanes " << lanes;
    EXPECT_THROW(advance(beyond, 1), GrainFault) << "lanes " << lanes;
  }
}

TEST(Guards, SqueezedContactsWithPlanesAreCountedApart) {
  const GrainModel m = ball(1e-6);
  const auto counted = [&](double overlap) {
    Grains grains(base::cpuExec(1), m, {{floorPlane(m.law)}, {}}, {{{0, 0, (1 - overlap) * m.radius}, {}, {}}});
    const GrainLedger l = grains.ledger();
    EXPECT_EQ(l.squeezed, 0);
    return l.deepAtBoundaries;
  };
  EXPECT_EQ(counted(0.19), 0);
  EXPECT_EQ(counted(0.21), 1);
}

TEST(Guards, GrainsThatComeToOnePlaceStopTheRun) {
  // They pass through each other, since hardly any force separates them; no other alarm detects them at one position.
  for (const int lanes : {16, 1}) {
    GrainModel m = ball(0x1p-13);
    m.law.stiffness = 1e-9, m.maxOverlap = 1.99, m.maxSimdLanes = lanes;
    const double way = 0x1p-13; // path per step at 1 m/s; a whole number of units
    const auto pass = [&](double offset) {
      Grains grains(base::cpuExec(1), m, {},
                    {{{-8 * way, 0, 0}, {1, 0, 0}, {}}, {{8 * way, offset, 0}, {-1, 0, 0}, {}}});
      advance(grains, 16);
    };
    EXPECT_NO_THROW(pass(0.1 * m.radius)) << "side by side they pass, lanes " << lanes;
    EXPECT_THROW(pass(0), base::SimulationError) << "lanes " << lanes;
  }
}

TEST(Guards, GrainsFarApartDoNotFeelEachOther) {
  // 2^32 units apart, the low words of positions agree; distant grains widen the cells until both share one.
  GrainModel m = ball(1e-6);
  const base::PositionScale scale = base::positionScale(2 * m.radius);
  const double alias = 4294967296.0 * scale.unit, far = 0.9 * scale.limit();
  Grains grains(base::cpuExec(1), m, {},
                {{{0, 0, 0}, {}, {}},
                 {{alias + 1.9 * m.radius, 0, 0}, {}, {}},
                 {{far, far, far}, {}, {}},
                 {{-far, -far, -far}, {}, {}}});
  advance(grains, 10);
  for (const base::Vec3f& v : grains.snapshot().velocity) EXPECT_EQ(v, base::Vec3f{});
}

} // namespace
} // namespace grouser::terrain::testing
