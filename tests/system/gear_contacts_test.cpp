// SPDX-License-Identifier: BSD-3-Clause
// Grains in the running gear: counted by their contacts, and compared on a bed with the ledger's contacts.
#include "coupling/gear_contacts.hpp"

#include "coupling/simulation.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/device_under_test.hpp"
#include "tests/runs/shared_cache.hpp"

#include <gtest/gtest.h>

namespace grouser::coupling {
namespace {

using vehicle::PartKind;

TEST(GearContacts, AGrainIsAStoneOnceAndPinchedWhereAShoeTouchesItToo) {
  const GearContacts c = countGear({{3, PartKind::kShoe},
                                    {3, PartKind::kShoe}, // between two shoes, below
                                    {5, PartKind::kShoe},
                                    {5, PartKind::kRoadWheel},
                                    {5, PartKind::kRoadWheel}, // between plate and two wheels
                                    {8, PartKind::kSprocket},
                                    {9, PartKind::kIdler},
                                    {9, PartKind::kRoller},
                                    {11, PartKind::kChassis}});
  EXPECT_EQ(c.shoes, 3);
  EXPECT_EQ(c.roadWheels, 2);
  EXPECT_EQ(c.sprockets, 1);
  EXPECT_EQ(c.idlers, 1);
  EXPECT_EQ(c.rollers, 1);
  EXPECT_EQ(c.hull, 1);
  EXPECT_EQ(c.stones, 3) << "grains 5, 8 and 9";
  EXPECT_EQ(c.pinched, 1) << "grain 5";
}

TEST(GearContacts, OnABedAreThePairsInTouch) {
  Simulation simulation(
      setup::simulationSetup(setup::loadScene(testScene("coupled.toml"))), testExec(), [](double, double) {}, {},
      sharedBeds(), sharedSpheres());
  while (simulation.steps() < 1500) simulation.step();
  const GearContacts c = simulation.granularGround()->onParts()->gearContacts();
  const std::int64_t patches = simulation.ledger().partContacts;
  const std::int64_t pairs = c.shoes + c.sprockets + c.roadWheels + c.rollers + c.idlers + c.hull;
  EXPECT_GT(c.shoes, 20);
  EXPECT_LE(pairs, patches) << "a touching pair has at least one patch";
  EXPECT_GE(pairs, patches / contact::kPatches);
  EXPECT_LE(c.pinched, c.stones);
}

} // namespace
} // namespace grouser::coupling
