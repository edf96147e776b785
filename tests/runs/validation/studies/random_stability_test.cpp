// SPDX-License-Identifier: BSD-3-Clause
// Random scenes: valid, within the documented ranges, stable at automatic steps and step limits; trials distinguish
// stable from unstable steps.
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/validation/studies/random_stability.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace grouser::studies {
namespace {

scene::Scene parsed(const RandomScene& random) { return setup::parseScene(random.toml, "random.toml"); }

TEST(RandomScenes, AreValidAndSpreadOverSixDecadesOfStiffnessAndTwoOfRadiusAndDensity) {
  double low[4] = {1e300, 1e300, 1e300, 1e300}, high[4] = {};
  std::set<std::string> kinds;
  int hertz = 0, single = 0, sticky = 0, rolling = 0, lossy = 0;
  for (int k = 0; k < 200; ++k) {
    const RandomScene random = randomScene(1, k);
    const scene::Scene scene = parsed(random);
    EXPECT_GT(setup::chooseTimeStep(scene), 0) << k;
    EXPECT_EQ(random.toml, randomScene(1, k).toml);
    EXPECT_NE(random.toml, randomScene(2, k).toml);
    const scene::Material& m = scene.materials.front();
    double smallest = 1e300;
    for (const scene::Grain& g : scene.grains) smallest = std::min(smallest, g.radius);
    const double values[4] = {m.stiffness.value_or(1e6), m.young.value_or(1e8), smallest, m.density};
    for (int a = 0; a < 4; ++a) low[a] = std::min(low[a], values[a]), high[a] = std::max(high[a], values[a]);
    kinds.insert(random.kind);
    hertz += random.hertz, single += random.single, sticky += random.sticks, rolling += random.rolls;
    lossy += random.restitution < 0.1;
  }
  const double decades[4] = {6, 6, 2, 2};
  for (int a = 0; a < 4; ++a) {
    EXPECT_GT(std::log10(high[a] / low[a]), 0.9 * decades[a]) << a;
    EXPECT_LE(std::log10(high[a] / low[a]), 1.0001 * decades[a]) << a;
  }
  EXPECT_EQ(kinds.size(), kRandomKinds.size());
  for (const int count : {hertz, single, sticky, rolling, lossy}) EXPECT_GT(count, 20);
}

TEST(RandomScenes, AreSoundAtTheirAutomaticStepAndBoundedAtTheirLimit) {
  for (int k = 0; k < 40; ++k) {
    const RandomScene random = randomScene(3, k);
    const scene::Scene scene = parsed(random);
    const setup::StepLimit limit = setup::stepLimit(scene);
    const StepTrial automatic = tryStep(random, scene, setup::chooseTimeStep(scene), 0.1);
    EXPECT_FALSE(automatic.alarmed) << k << " " << automatic.why;
    EXPECT_LE(automatic.growth, 0.02) << k << ": phase error of an elastic impact at 20 steps";
    const StepTrial longest = tryStep(random, scene, limit.step, 0.3);
    EXPECT_FALSE(longest.blewUp) << k << " " << longest.why;
    const StepTrial calm = tryStep(random, scene, std::min(limit.calm, limit.step), 0.3);
    EXPECT_FALSE(calm.alarmed) << k << " " << calm.why;
  }
}

TEST(RandomScenes, BlowUpFarBeyondTheirLimit) {
  int bounded = 0;
  for (int k = 0; k < 40; ++k) {
    const RandomScene random = randomScene(3, k);
    const scene::Scene scene = parsed(random);
    bounded += !tryStep(random, scene, 12 * setup::stepLimit(scene).step, 0.5).blewUp;
  }
  EXPECT_LE(bounded, 2) << "out of 40: grains that hardly touch";
}

TEST(StepMargins, FindTheLimitOfOneElasticContact) {
  // A ball on a plane: rebounds are exact at whole phases and gain energy beyond 0.5 to 0.85 of 2 / omega.
  RandomScene random;
  random.toml = "version = 1\n[run]\nduration = 1\ngravity = [0, 0, -10]\nprecision = \"double\"\nthreads = 1\n"
                "[material.m]\nstiffness = 1e5\nrestitution = 1\nfriction = 0\n[[plane]]\nmaterial = \"m\"\n"
                "[[grain]]\nposition = [0, 0, 0.03]\nvelocity = [0, 0, -1]\nradius = 0.02\nmaterial = \"m\"\n";
  const double mass = 2500 * 4.0 / 3 * 3.14159265358979 * 8e-6, omega = std::sqrt(1e5 / mass);
  random.grains = 1, random.contacts = 2000, random.speed = std::sqrt(1 + 20 * 0.03);
  random.energy = 0.5 * mass * random.speed * random.speed;
  const StepMargins margins = stepMargins(random, 0.05);
  EXPECT_NEAR(margins.limit * omega, 1, 1e-6);
  EXPECT_GT(margins.bounded, margins.limit);
  EXPECT_LT(margins.bounded * omega, 2);
  EXPECT_LE(margins.silent, margins.bounded);
  EXPECT_FALSE(margins.atAutomatic.alarmed || margins.atLimit.alarmed);
}

} // namespace
} // namespace grouser::studies
