// SPDX-License-Identifier: BSD-3-Clause
// Valid scenes at 50, 75 and 100 % of their limit step: no alarm, and identical results for all output intervals.
#include "base/error.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/setup/time_scales.hpp"
#include "tests/system/guard_scenes.hpp"
#include "tests/vehicle/spec_variant.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace grouser::coupling {
namespace {

using namespace grouser::test; // pieces of scenes

struct Sound {
  const char* name;
  std::string text;
  double limit = 0; ///< longest step tested, for mechanisms [s]
};
std::ostream& operator<<(std::ostream& out, const Sound& s) { return out << s.name; }

/// Largest shares of the exchanged energy that the steps created or lost between two checks, above the fixed allowance.
struct Shares {
  double made = 0, gained = 0, lost = 0;
};

scene::Scene sceneOf(const Sound& sound, const std::vector<std::string>& sets = {}) {
  return setup::parseScene(sound.text, GROUSER_SOURCE_DIR "/tests/scenes/sound.toml", sets);
}

double limitOf(const Sound& sound) {
  if (sound.limit > 0) return sound.limit;
  const scene::Scene scene = sceneOf(sound);
  return std::min(setup::stepLimit(scene).step,
                  setup::resolvingStep(setup::timeScales(scene), scene.run.stepsPerPeriod));
}

/// Result of a run with rows every `row` steps: its hash, or its error.
std::string driven(const Sound& sound, double step, std::int64_t row, int threads, Shares* shares = nullptr) {
  try {
    const scene::Scene scene = sceneOf(sound, {fmt::format("run.time_step={:.17g}", step)});
    Simulation simulation(setup::simulationSetup(scene), base::cpuExec(threads), [](double, double) {});
    const auto total = static_cast<std::int64_t>(std::llround(scene.run.duration / step));
    EnergyGuard watch;
    const double kinetic = simulation.ledger().kinetic;
    while (simulation.steps() < total) {
      simulation.advance(std::min(total - simulation.steps(), row - simulation.steps() % row));
      if (simulation.steps() % row == 0) {
        simulation.ledger();
        if (simulation.vehicle()) simulation.vehicle()->observe();
        simulation.restartMeans();
      }
      if (!shares || simulation.steps() % EnergyGuard::kInterval != 0) continue;
      const Ledger now = simulation.ledger();
      const EnergyGuard::Exchange x = watch.since(now, kinetic + std::fabs(now.kinetic) + std::fabs(now.elastic));
      shares->made = std::max(shares->made, x.share(-x.lost));
      shares->lost = std::max(shares->lost, x.share(x.lost));
      shares->gained = std::max(shares->gained, x.share(x.gained));
      watch.look(now);
    }
    simulation.checkEnergy();
    return simulation.stateHash();
  } catch (const std::exception& error) {
    return error.what();
  }
}

constexpr double kShares[] = {0.5, 0.75, 1};
constexpr std::int64_t kRows[] = {11, 16, 77, 512, 1'000'000}; // steps

class SoundScenes : public ::testing::TestWithParam<Sound> {
protected:
  /// The claim of docs/steps.md#energy-ledger for all of them.
  static void TearDownTestSuite() {
    std::cout << fmt::format("sound scenes: of what was exchanged between two looks the steps have made up to {:.1f} % "
                             "({}), {:.1f} % that was not dissipated at once ({}), lost up to {:.1f} % ({})\n",
                             100 * worst.made, maker, 100 * worst.gained, gainer, 100 * worst.lost, loser);
  }
  static void note(const Shares& s, const std::string& name) {
    if (s.made > worst.made) worst.made = s.made, maker = name;
    if (s.lost > worst.lost) worst.lost = s.lost, loser = name;
    if (s.gained > worst.gained) worst.gained = s.gained, gainer = name;
  }
  inline static Shares worst;
  inline static std::string maker, gainer, loser;
};

TEST_P(SoundScenes, RaiseNoAlarmAndHaveOneAnswer) {
  const double limit = limitOf(GetParam());
  ASSERT_TRUE(std::isfinite(limit));
  for (const double share : kShares) {
    Shares shares;
    const std::string first = driven(GetParam(), share * limit, kRows[0], 1, &shares);
    EXPECT_EQ(first.size(), 16u) << share << ": " << first;
    note(shares, fmt::format("{} at {:g}", GetParam().name, share));
    for (const std::int64_t row : kRows)
      if (row != kRows[0]) {
        EXPECT_EQ(driven(GetParam(), share * limit, row, 1), first) << share << " " << row;
      }
    if (share == 1) {
      EXPECT_EQ(driven(GetParam(), limit, kRows[4], 2), first) << "two threads";
    }
  }
}

const std::string kShearing = "periodic = [true, true]\ndomain_x = [-0.03, 0.03]\ndomain_y = [-0.03, 0.03]\n";
const char* const kEuler = "integrator = \"symplectic_euler\"\n";

INSTANTIATE_TEST_SUITE_P(
    Grains, SoundScenes,
    ::testing::Values(
        Sound{"Gas", run(0.2, kNoGravity) + soil(1, 0) + floor() + walls(0.04) + plane("[0, 0, 0.08]", "[0, 0, -1]") +
                         grains({25, 0.04, 0, 0.08, "0.005", "velocity = [1, 0.4, 0.2]\n"})},
        Sound{"RoughGas", run(0.2, kNoGravity) + soil(1, 0.5) + floor() + walls(0.04) +
                              plane("[0, 0, 0.08]", "[0, 0, -1]") +
                              grains({25, 0.04, 0, 0.08, "0.005", "velocity = [1, 0.4, 0.2]\n"})},
        Sound{"Heap", heap(0.2, soil(0.5, 0.5))}, Sound{"ElasticHeap", heap(0.3, soil(1, 0.9))},
        Sound{"LossyHeap", heap(0.06, soil(0.05, 0.9), {40})},
        Sound{"HeapOfStrongTangentialDashpots", heap(0.1, soil(0.02, 1.5, "tangential_damping_ratio = 1\n"), {40})},
        Sound{"Attraction", heap(0.08, soil(0, 0.5, "attraction = true\n"), {40})},
        Sound{"Cohesion", heap(0.2, soil(0.5, 0.5, "cohesion = 0.1\n"))},
        Sound{"Rolling", heap(0.15, soil(0.5, 0.5, "rolling_friction = 0.3\n"))},
        Sound{"Hertz", heap(0.2, hertz(0.5, 0.5))},
        Sound{"HertzFasterThanSaid",
              heap(0.1, hertz(0.8, 0.3, "1e8"), {40, 0.03, 0, 0.07, "0.005", "velocity = [0, 0, -2]\n"})},
        Sound{"Mixture", heap(0.1, soil(0.5, 0.5) + soil(0.8, 0.3, "density = 7800\n", "5e4", "steel"),
                              {30, 0.03, 0, 0.05, "0.003", "radius_to = 0.007\n"}) +
                             grains({20, 0.03, 0.05, 0.08, "0.004", "", "steel"})},
        Sound{"Stack", run(0.3) + soil(0.5, 0.5) + floor() + grain("[0, 0, 0.005]") + grain("[0, 0, 0.015]") +
                           grain("[0, 0, 0.025]") + grain("[0, 0, 0.035]") + grain("[0, 0, 0.045]") +
                           grain("[0, 0, 0.055]") + grain("[0, 0, 0.065]") + grain("[0, 0, 0.075]") +
                           grain("[0, 0, 0.085]") + grain("[0, 0, 0.095]") + grain("[0, 0, 0.105]") +
                           grain("[0, 0, 0.115]")},
        Sound{"Bounce",
              run(0.5) + soil(1, 0.5) + floor() + grain("[0, 0, 0.1]", "velocity = [1, 0, 0]\nspin = [0, -100, 0]\n")}),
    [](const auto& tested) { return std::string(tested.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Surfaces, SoundScenes,
    ::testing::Values(
        Sound{"Drum",
              run(0.2) + soil(0.5, 0.5, "", "1e4") +
                  "[[cylinder]]\nposition = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 0.05\nlength = 0.06\nhollow = "
                  "true\nspin = [0, 8, 0]\nmaterial = \"soil\"\n" +
                  plane("[0, -0.03, 0]", "[0, 1, 0]") + plane("[0, 0.03, 0]", "[0, -1, 0]") +
                  grains({60, 0.028, -0.03, 0.04, "0.004", "radius_to = 0.005\n"})},
        Sound{"Shaker", run(0.3) + soil(0.5, 0.5, "", "1e4") + floor("amplitude = [0, 0, 0.003]\nfrequency = 20\n") +
                            walls(0.03) + grains({40, 0.03, 0.01, 0.08})},
        Sound{"Lid",
              heap(0.15, soil(0.5, 0.5, "", "1e5")) + box("[0, 0, 0.08]", "[0.058, 0.058, 0.01]",
                                                          "free = \"z\"\nmass = 0.05\nload = -2\nload_ramp = 0.1\n")},
        Sound{"Shear", run(0.15, kShearing) + soil(0.5, 0.5, "", "1e5") + floor() +
                           plane("[0, 0, 0.072]", "[0, 0, -1]",
                                 "free = \"z\"\nmass = 0.05\nload = -2\nvelocity = [0.5, 0, 0]\n") +
                           grains({60})},
        Sound{"Mixer", run(0.2) + soil(0.5, 0.5) + floor() + walls(0.04) +
                           box("[0, 0, 0.01]", "[0.06, 0.006, 0.018]", "spin = [0, 0, 8]\n") +
                           grains({60, 0.035, 0.025, 0.09})},
        Sound{"Obstacles", run(0.15) + soil(0.5, 0.5) + floor() + walls(0.04) +
                               box("[0, 0, 0.02]", "[0.03, 0.03, 0.02]", "axis = [1, 0, 0]\nangle = 30\n") +
                               "[[mesh]]\nfile = \"meshes/roller.obj\"\nscale = 0.1\nposition = [0.02, 0.02, 0.01]\n"
                               "material = \"soil\"\n" +
                               grains({40, 0.035, 0.05, 0.12})},
        Sound{"Source", run(0.2) + soil(0.5, 0.5) + floor() + walls(0.03) +
                            "[[source]]\nlow = [-0.02, -0.02, 0.06]\nhigh = [0.02, 0.02, 0.09]\nvelocity = [0, 0, -1]\n"
                            "radius = 0.004\nmaterial = \"soil\"\nnumber = 2\nevery = 0.02\ntotal = 20\n"},
        Sound{"Hills",
              run(0.4) + soil(0.5, 0.5, "", "1e6") +
                  "[terrain]\nheightmap = \"heightmaps/hills.png\"\nsize = [0.6, 0.6]\nheight_range = [0, 0.1]\n"
                  "material = \"soil\"\ngrain_radius = 0.04\nlayers = 2\narrangement = \"lattice\"\nfloor_grains = "
                  "false\nwall_friction = 0.5\nsettle_time_limit = 0\n"}),
    [](const auto& tested) { return std::string(tested.param.name); });

const std::string kSwing = "[[spring]]\nname = \"bar\"\nbodies = [\"world\", \"block\"]\npoint_a = [0, 0, 1]\n";

INSTANTIATE_TEST_SUITE_P(
    Mechanisms, SoundScenes,
    ::testing::Values(
        Sound{"Pendulum", run(4) + pendulum(), 2e-3}, Sound{"PendulumEuler", run(4, kEuler) + pendulum(), 2e-3},
        Sound{"Chain", run(2) + chain(6), 1e-3}, Sound{"ChainEuler", run(2, kEuler) + chain(6), 1e-3},
        Sound{"Rotor", run(2) + rotor("imposes = \"torque\"\namplitude = 5\nfrequency = 10\n"), 2.5e-3},
        Sound{"Speed", run(2) + rotor("time = [0, 0.5, 1]\nvalues = [0, 60, -60]\n"), 2.5e-3},
        Sound{"Position", run(2) + rotor("imposes = \"position\"\ntime = [0, 0.5, 1]\nvalues = [0, 2, 0]\n"), 2.5e-3},
        Sound{"Stops", run(3) + pendulum("limits = [-0.5, 0.7]\nstop_stiffness = 2e3\n"), 1e-3},
        Sound{"DampedStops",
              run(3, kEuler) + pendulum("limits = [-0.5, 0.7]\nstop_stiffness = 2e3\nstop_damping = 5\n"), 1e-3},
        Sound{"Spring", run(2) + body("block", "[0, 0, 0]") + kSwing + "stiffness = 1e3\ndamping = 2\n", 1e-3},
        Sound{"SpringEuler", run(2, kEuler) + body("block", "[0, 0, 0]") + kSwing + "stiffness = 1e3\n", 1e-3},
        Sound{"Damper", run(2, kEuler) + pendulum("damping = 1e4\n"), 1e-3},
        Sound{"Top",
              run(2) +
                  body("top", "[0, 0, 0.3]", "spin = [0, 3, 40]\nvelocity = [0.9, 0, 0]\n", 1, "[0.02, 0.02, 0.01]") +
                  joint("tip", "world", "top", "[0, 0, 0]", "type = \"spherical\"\n"),
              2.5e-3},
        Sound{"Door",
              run(2) + body("door", "[0.45, 0, 1]", "", 20, "[6.7, 8, 1.4]") +
                  joint("hinge", "world", "door", "[0, 0, 1]",
                        "axis = [0, 0, 1]\nlimits = [-0.1, 1]\nstop_stiffness = 2e3\nstop_damping = 50\n") +
                  "[[drive]]\nname = \"wind\"\njoint = \"hinge\"\nimposes = \"torque\"\ntime = [0, 0.5, 1]\nvalues = "
                  "[0, 8, 0]\n",
              1e-3}),
    [](const auto& tested) { return std::string(tested.param.name); });

} // namespace
} // namespace grouser::coupling
