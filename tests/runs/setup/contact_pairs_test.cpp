// SPDX-License-Identifier: BSD-3-Clause
// Contact partners of grains in a scene.
#include "runs/setup/contact_pairs.hpp"
#include "runs/setup/load_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace grouser::setup {
namespace {

/// "name (material)" of each partner.
std::vector<std::string> partnersOf(const scene::Scene& scene) {
  std::vector<std::string> all;
  for (const ContactPartner& p : ContactPairs(scene).partners) all.push_back(p.name + " (" + p.material + ")");
  return all;
}

TEST(ContactPairs, ListEachPartnerOnceInTheOrderOfTheFile) {
  const scene::Scene scene =
      parseScene("version = 1\n[run]\nduration = 1\n[material.a]\n[material.b]\n[material.c]\n"
                 "[[box]]\nname = \"lid\"\nmaterial = \"b\"\nposition = [0, 0, 3]\nsize = [1, 1, 0.1]\n"
                 "[[plane]]\nmaterial = \"c\"\n"
                 "[[plane]]\nname = \"belt\"\nmaterial = \"a\"\nvelocity = [1, 0, 0]\n"
                 "[[plane]]\npoint = [0, 0, -1]\nmaterial = \"b\"\n"
                 "[[grain]]\nposition = [0, 0, 1]\nradius = 0.1\nmaterial = \"b\"\n"
                 "[[grain]]\nposition = [1, 0, 1]\nradius = 0.1\nmaterial = \"a\"\n",
                 "pairs.toml");
  EXPECT_EQ(partnersOf(scene),
            (std::vector<std::string>{"b (b)", "a (a)", "a plane (c)", "belt (a)", "a plane (b)", "lid (b)"}));
  const ContactPairs pairs(scene);
  const auto planes = std::count_if(pairs.partners.begin(), pairs.partners.end(),
                                    [&](const ContactPartner& p) { return pairs.isPlane(p); });
  EXPECT_EQ(planes, 3) << "including the belt";
  EXPECT_EQ(pairs.partners[0].share(), 0.5);
  EXPECT_EQ(pairs.partners[2].share(), 1);
}

TEST(ContactPairs, OfABedHaveWallsFloorAndVehicle) {
  const scene::Scene scene = loadScene(GROUSER_SOURCE_DIR "/tests/scenes/coupled.toml", {"terrain.wall_friction=0.1"});
  EXPECT_EQ(partnersOf(scene), (std::vector<std::string>{"soil (soil)", "a wall of the terrain (soil)",
                                                         "the floor (soil)", "the vehicle ()"}));
  const ContactPairs pairs(scene);
  EXPECT_EQ(pairs.partners[1].friction, 0.1);
  EXPECT_EQ(pairs.partners.back().materialAgainst("soil"), "soil");
}

} // namespace
} // namespace grouser::setup
