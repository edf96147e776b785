// SPDX-License-Identifier: BSD-3-Clause
// Mechanisms on settled beds: a wheel as a body and as a surface, and random mechanisms.
#include "base/error.hpp"
#include "coupling/mechanism.hpp"
#include "coupling/simulation.hpp"
#include "coupling/surfaces.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/runs/shared_cache.hpp"
#include "tests/system/scene_simulation.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace grouser::coupling::on_settled_beds {
namespace {

using base::Vec3d;

std::string bedHead(double duration, const std::string& size, double radius, double depth) {
  return fmt::format("version = 1\n[run]\nduration = {:g}\noutput_interval = 0.01\n[material.sand]\ndensity = 2600\n"
                     "stiffness = 2e4\nrestitution = 0.3\nfriction = 0.5\n[terrain]\nheightmap = "
                     "\"heightmaps/flat.png\"\nsize = {}\nheight_range = [0, 0]\nmaterial = \"sand\"\ngrain_radius = "
                     "{:g}\ndepth = {:g}\n",
                     duration, size, radius, depth);
}

SimulationSetup setupOf(const std::string& text) {
  return setup::simulationSetup(setup::parseScene(text, "on_beds.toml"));
}
std::unique_ptr<Simulation> made(const std::string& text, int threads = 1) {
  return std::make_unique<Simulation>(
      setupOf(text), base::cpuExec(threads), [](double, double) {}, base::Comm{}, sharedBeds());
}

/// A wheel of 0.1 m at 20 % slip under its weight and a load of 60 N.
struct Wheel {
  double height, pull, carried, torque; ///< [m] at the end; [N], [N], [N m]: means over the drive
};
constexpr double kMass = 3, kLoad = 60, kWeight = kMass * 9.81 + kLoad, kSpeed = 0.16, kSpin = 2;

/// Start of the drive, start of averaging, end of the run [s].
struct Times {
  double start, mean, end;
};

Wheel asSurface(const std::string& ground, const std::string& place, const Times& t) {
  const auto s = made(ground + fmt::format("[[cylinder]]\nname = \"wheel\"\n{}\naxis = [0, 1, 0]\nradius = 0.1\nlength "
                                           "= 0.1\nmaterial = \"sand\"\nfree = \"z\"\nmass = {}\nload = {}\nvelocity = "
                                           "[{}, 0, 0]\nspin = [0, {}, 0]\nstart = {}\n",
                                           place, kMass, -kLoad, kSpeed, kSpin, t.start));
  advanceTo(*s, t.mean);
  s->restartMeans();
  advanceTo(*s, t.end);
  const Surfaces::Observation mean = s->surfaces()->observe(0, s->steps());
  return {mean.position.z, mean.force.x, mean.force.z, mean.torque.y};
}

/// The wheel turns on an axle that slides along z on a carriage.
Wheel asBody(const std::string& ground, double z, const Times& t) {
  const std::string place = fmt::format("[0.15, 0, {}]", z);
  const auto s = made(
      ground +
      fmt::format("[[body]]\nname = \"carriage\"\nmass = 1\nbox = [0.02, 0.02, 0.02]\nposition = [0.15, 0, 0.3]\n"
                  "[[body]]\nname = \"axle\"\nmass = 1\nbox = [0.02, 0.02, 0.02]\nposition = {0}\n"
                  "[[body]]\nname = \"wheel\"\nmass = {1}\nbox = [0.1, 0.1, 0.1]\nposition = {0}\nmaterial = \"sand\"\n"
                  "[[body.shape]]\nkind = \"cylinder\"\nradius = 0.1\nlength = 0.1\naxis = [0, 1, 0]\n"
                  "[[joint]]\nname = \"rail\"\ntype = \"prismatic\"\nbodies = [\"world\", \"carriage\"]\npoint = "
                  "[0.15, 0, 0.3]\naxis = [1, 0, 0]\n"
                  "[[joint]]\nname = \"guide\"\ntype = \"prismatic\"\nbodies = [\"carriage\", \"axle\"]\npoint = {0}\n"
                  "axis = [0, 0, 1]\n"
                  "[[joint]]\nname = \"hub\"\ntype = \"revolute\"\nbodies = [\"axle\", \"wheel\"]\npoint = {0}\naxis = "
                  "[0, 1, 0]\n",
                  place, kMass - 1) +
      fmt::format(
          "[[drive]]\nname = \"load\"\njoint = \"guide\"\nimposes = \"torque\"\nvalue = {}\n"
          "[[drive]]\nname = \"carry\"\njoint = \"rail\"\nimposes = \"speed\"\ntime = [0, {}, {}]\nvalues = [0, "
          "0, {}]\n[[drive]]\nname = \"turn\"\njoint = \"hub\"\nimposes = \"speed\"\ntime = [0, {}, {}]\n"
          "values = [0, 0, {}]\n",
          -kLoad, t.start, t.start + 1e-3, kSpeed, t.start, t.start + 1e-3, kSpin));
  const Mechanism& m = *s->mechanism();
  const int wheel = 2;
  advanceTo(*s, t.mean);
  s->restartMeans();
  double torque = 0;
  int steps = 0;
  for (; s->time() < t.end - 0.5 * s->timeStep(); ++steps) s->step(), torque += m.drive(2).torque;
  const Vec3d force = m.contactForces()[wheel];
  return {m.state().pose[wheel].position.z, force.x, force.z, -torque / steps};
}

/// Fixed grains make the motion deterministic without chaos.
TEST(WheelOnFixedGrains, IsTheSameAsABodyAndAsAFreeSurface) {
  std::string ground = "version = 1\n[run]\nduration = 1\nprecision = \"double\"\n[material.sand]\ndensity = 2600\n"
                       "stiffness = 2e4\nrestitution = 0.3\nfriction = 0.5\n";
  for (int x = 0; x < 20; ++x)
    for (int y = -2; y <= 2; ++y)
      ground += fmt::format("[[grain]]\nposition = [{}, {}, 0]\nradius = 0.01\nmaterial = \"sand\"\nfixed = true\n",
                            0.02 * x, 0.02 * y);
  const Times times{0.1, 0.15, 0.6};
  const Wheel surface = asSurface(ground, "position = [0.15, 0, 0.111]", times), body = asBody(ground, 0.111, times);
  EXPECT_NEAR(surface.carried, kWeight, 0.1 * kWeight);
  EXPECT_GT(std::fabs(surface.torque), 1);
  EXPECT_NEAR(body.height, surface.height, 1e-5);
  EXPECT_NEAR(body.carried, surface.carried, 0.002 * kWeight);
  EXPECT_NEAR(body.pull, surface.pull, 0.005 * kWeight);
  EXPECT_NEAR(body.torque, surface.torque, 0.005 * std::fabs(surface.torque));
}

/// The motion on loose grains is chaotic: compares means over drops from slightly different heights.
TEST(WheelOnABed, IsTheSameAsABodyAndAsAFreeSurface) {
  const std::string bed = bedHead(0.7, "[0.42, 0.16]", 0.01, 0.07);
  constexpr int kFalls = 5;
  struct Sum {
    double mean = 0, square = 0;
    void add(double x) { mean += x / kFalls, square += x * x / kFalls; }
    double variance() const { return (square - mean * mean) / (kFalls - 1); } ///< variance of the mean
  } pull[2], torque[2];
  for (int k = 0; k < kFalls; ++k) {
    const Times times{0.2, 0.25, 0.7};
    const std::string above = fmt::format("above_bed = {}\n", 0.001 + 0.0005 * k);
    const Wheel both[] = {asSurface(bed, "position = [0.15, 0, 0]\n" + above, times),
                          asBody(bed + "[mechanism]\n" + above, 0.1, times)};
    for (int b = 0; b < 2; ++b) {
      EXPECT_NEAR(both[b].carried, kWeight, 0.03 * kWeight);
      pull[b].add(both[b].pull), torque[b].add(both[b].torque);
    }
  }
  EXPECT_LT(std::fabs(pull[1].mean - pull[0].mean), 3 * std::sqrt(pull[0].variance() + pull[1].variance()));
  EXPECT_LT(std::fabs(torque[1].mean - torque[0].mean), 3 * std::sqrt(torque[0].variance() + torque[1].variance()));
  EXPECT_LT(std::sqrt(pull[0].variance()), 0.06 * kWeight) << "the comparison is significant";
}

constexpr double kRun = 0.1; ///< duration of random mechanisms [s]

/// A chain of two to four bodies with shapes on a bed, with random joints, drives and positions.
std::string randomMechanism(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto one = [&](int choices) { return static_cast<int>(random() % static_cast<unsigned>(choices)); };
  std::string text = bedHead(kRun, "[0.4, 0.24]", 0.012, 0.04) + "[mechanism]\nabove_bed = 0.002\n";
  const int bodies = 2 + one(3);
  const char* joints[] = {"revolute", "prismatic", "spherical", "cylindrical", "fixed"};
  for (int b = 0; b < bodies; ++b) {
    const double x = 0.08 + 0.07 * b, z = 0.1 + between(0, 0.02);
    text +=
        fmt::format("[[body]]\nname = \"body {}\"\ndensity = {}\nposition = [{}, {}, {}]\nmaterial = \"sand\"\n"
                    "axis = [{}, {}, 1]\nangle = {}\n[[body.shape]]\n",
                    b, between(400, 8000), x, between(-0.02, 0.02), z, between(-1, 1), between(-1, 1), between(0, 90));
    switch (one(5)) {
    case 0:
      text += fmt::format("kind = \"sphere\"\nradius = {}\n", between(0.015, 0.03));
      break;
    case 1:
      text += fmt::format("kind = \"box\"\nsize = [{}, {}, {}]\n", between(0.03, 0.05), between(0.03, 0.08),
                          between(0.02, 0.05));
      break;
    case 2:
      text +=
          fmt::format("kind = \"cylinder\"\nradius = {}\nlength = {}\n", between(0.015, 0.025), between(0.03, 0.06));
      break;
    case 3:
      text += fmt::format("kind = \"capsule\"\nradius = {}\nlength = {}\n", between(0.015, 0.02), between(0.02, 0.04));
      break;
    default:
      text += fmt::format("kind = \"cylinder\"\nradius = {}\nlength = {}\naxis = [0, 1, 0]\n", between(0.02, 0.03),
                          between(0.02, 0.05));
    }
    if (b == 0) continue;
    const int joint = one(5);
    text += fmt::format("[[joint]]\nname = \"joint {}\"\ntype = \"{}\"\nbodies = [\"body {}\", \"body {}\"]\npoint = "
                        "[{}, 0, {}]\n{}",
                        b, joints[joint], b - 1, b, x - 0.035, z, joint == 2 || joint == 4 ? "" : "axis = [0, 1, 0]\n");
    if (joint == 0 && one(2) == 0)
      text += fmt::format("[[drive]]\nname = \"drive {0}\"\njoint = \"joint {0}\"\nimposes = \"speed\"\ntime = [0, "
                          "0.05]\nvalues = [0, {1}]\n",
                          b, between(-4, 4));
    if (joint == 1)
      text += fmt::format("[[spring]]\nname = \"spring {0}\"\njoint = \"joint {0}\"\nstiffness = {1}\ndamping = 1\n", b,
                          between(10, 500));
  }
  return text;
}

/// Runs a mechanism and returns its state hash, or the error message. The energy ledger of a finished run closes.
std::string ending(const std::string& text, int threads, bool resumed) {
  try {
    auto s = made(text, threads);
    if (resumed) {
      advanceTo(*s, 0.5 * kRun);
      const SimulationState saved = s->save();
      s = std::make_unique<Simulation>(setupOf(text), base::cpuExec(threads), saved);
    }
    advanceTo(*s, kRun);
    s->checkEnergy();
    const multibody::Balance bodies = s->mechanism()->bodiesBalance();
    EXPECT_LE(std::fabs(bodies.leftOver), 1e-9 * bodies.turnover);
    for (const base::Pose& pose : s->mechanism()->state().pose) EXPECT_TRUE(std::isfinite(norm(pose.position)));
    return s->stateHash();
  } catch (const base::InputError& error) {
    return std::string("refused: ") + error.what();
  } catch (const std::exception& error) {
    return std::string("stopped: ") + error.what();
  }
}

class RandomMechanismOnABed : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomMechanismOnABed, IsSoundAndHasOneAnswer) {
  const std::string text = randomMechanism(GetParam());
  const std::string first = ending(text, 1, false);
  ASSERT_EQ(first.size(), 16u) << first << "\n" << text;
  EXPECT_EQ(ending(text, 2, false), first);
  EXPECT_EQ(ending(text, 1, true), first);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomMechanismOnABed, ::testing::Range(1u, 11u));

} // namespace
} // namespace grouser::coupling::on_settled_beds
