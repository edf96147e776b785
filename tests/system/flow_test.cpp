// SPDX-License-Identifier: BSD-3-Clause
// Early ends of a vehicle run: a distance, the edge of the terrain, immobility.
#include "base/error.hpp"
#include "runs/setup/load_scene.hpp"
#include "tests/system/driven_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fmt/format.h>

namespace grouser::coupling {
namespace {

/// On level rigid ground of 6 m, at 4 rad/s from 0.15 s; `more` adds keys, including a [stop].
scene::Scene sceneWith(const std::string& more, const std::string& vehicle = {},
                       const std::vector<std::string>& overrides = {}) {
  return setup::parseScene("version = 1\n[run]\nduration = 4\ntime_step = 1e-4\n[material.steel]\nstiffness = 1e6\n"
                           "friction = 0.5\n[terrain]\n"
                           "kind = \"rigid\"\nheightmap = \"heightmaps/flat.png\"\nsize = [6, 3]\n"
                           "height_range = [0, 0]\nmaterial = \"steel\"\n[vehicle]\n"
                           "spec = \"vehicles/light_tracked.toml\"\nsphere_radius = 0.03\nposition = [1, 0]\n" +
                               vehicle +
                               "\n[driver]\ntension_ramp = 0.02\nweight_ramp = 0.1\nsprocket_speed = 4\n"
                               "drive_start = 0.15\ndrive_ramp = 0.05\n" +
                               more,
                           GROUSER_SOURCE_DIR "/tests/scenes/flow.toml", overrides);
}

/// Reason of the end within so many steps.
std::string endOf(Simulation& simulation, std::int64_t within) {
  while (simulation.steps() < within && simulation.vehicle()->ended().empty()) simulation.advance(1000);
  return simulation.vehicle()->ended();
}

double way(const Simulation& simulation) { return simulation.vehicle()->observe().position.x - 1; }

TEST(Flow, EndsAfterADistance) {
  const scene::Scene scene = sceneWith("[stop]\ndistance = 0.1\n");
  Simulation simulation = begin(scene);
  EXPECT_NE(endOf(simulation, 6000).find("stop.distance: the vehicle is 0.1"), std::string::npos);
  EXPECT_GE(way(simulation), 0.1);
  EXPECT_LT(way(simulation), 0.1 + 50 * 1e-4 * 1.2) << "checked every 50 steps, at 4 rad/s on 0.245 m";
  EXPECT_EQ(simulation.steps() % 50, 0);
  // A run resumed from its end stops at once; one with a longer limit continues.
  EXPECT_FALSE(Simulation(setup::simulationSetup(scene), testExec(), simulation.save(), {}, sharedSpheres())
                   .vehicle()
                   ->ended()
                   .empty());
  Simulation farther(setup::simulationSetup(sceneWith("[stop]\ndistance = 0.2\n")), testExec(), simulation.save(), {},
                     sharedSpheres());
  EXPECT_TRUE(farther.vehicle()->ended().empty());
}

TEST(Flow, EndsBeforeTheEdge) {
  // Its foremost shoe stands 0.8 m before the end, its sides 0.55 m.
  Simulation simulation = begin(sceneWith("[stop]\nedge = 0.5\n", "", {"vehicle.position=[2.2,0]"}));
  const std::string end = endOf(simulation, 8000);
  EXPECT_NE(end.find("stop.edge: the "), std::string::npos) << end;
  EXPECT_NE(end.find("within 0.5 m of the terrain's edge"), std::string::npos) << end;
  EXPECT_GT(way(simulation) + 1, 2.3) << "it has driven to the edge";
}

TEST(Flow, GoesOnWhereItWasSetDownNearerToTheEndThanThat) {
  // Its rear shoes are some 0.15 m inside, and it drives away from the edge.
  Simulation simulation = begin(sceneWith("[stop]\nedge = 0.5\n", "", {"vehicle.position=\"auto\""}));
  EXPECT_EQ(endOf(simulation, 3000), "");
}

TEST(Flow, AnEdgeOfNothingEndsInOrder) {
  Simulation simulation = begin(sceneWith("[stop]\nedge = 0\n", "", {"vehicle.position=[2.85, 0]"}));
  EXPECT_NE(endOf(simulation, 8000).find("within 0 m of the terrain's edge"), std::string::npos);
}

TEST(Flow, EndsWhereTheTracksSpinInVain) {
  // A block under the hull lifts the tracks off the ground.
  Simulation simulation =
      begin(sceneWith("[stop]\nimmobile = 0.1\n[[box]]\nposition = [2.3, 0, 0.175]\nsize = [1.6, 1.4, 0.35]\n"
                      "material = \"steel\"\n"));
  const std::string end = endOf(simulation, 12000);
  EXPECT_NE(end.find("stop.immobile: for 0.1"), std::string::npos) << end;
  EXPECT_LT(std::fabs(way(simulation)), 0.02);
}

TEST(Flow, WhatIsAskedWronglyIsSaid) {
  struct Wrong {
    const char *text, *vehicle;
    std::vector<std::string> words;
  };
  for (const Wrong& w : {Wrong{"[stop]\ndistance = -1\n", "", {"stop.distance = -1 [m] is outside"}},
                         Wrong{"[stop]\nimobile = 1\n", "", {"unknown key stop.imobile", "did you mean immobile?"}},
                         Wrong{"[stop]\nedge = 1\n",
                               "chassis = \"fixed\"\n",
                               {"stop", "on a vehicle with a fixed hull", "set vehicle.chassis = \"free\""}}}) {
    try {
      sceneWith(w.text, w.vehicle);
      ADD_FAILURE() << w.text << " is accepted";
    } catch (const base::InputError& error) {
      for (const std::string& word : w.words)
        EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << word << " in: " << error.what();
    }
  }
}

TEST(Flow, GoesOnWhereNothingIsAsked) {
  Simulation simulation = begin(sceneWith(""));
  EXPECT_EQ(endOf(simulation, 4000), "");
}

} // namespace
} // namespace grouser::coupling
