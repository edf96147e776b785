// SPDX-License-Identifier: BSD-3-Clause
// One grain that a mesh crushes on a plane: force, ledger, removal, and identical results of all runs.
#include "ledger_fixture.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace grouser::coupling::ledgers {
namespace {

constexpr double kStiffness = 1e5, kYield = 1e-3, kCap = kStiffness * kYield; // 100 N at an overlap of 1 mm
constexpr double kSpeed = 0.05;                                               // plate speed [m/s]

// Dashpots under external load dissipate gamma dt / 2 = 2.2 % of the 0.1 J of the springs in a way that differs from
// the steps' own loss (docs/steps.md#energy-ledger); of the plate's 0.7 J. A separate test covers the order.
constexpr double kDashpots = 6e-3;

class CrushingScene : public grouser::test::FolderTest {
protected:
  void SetUp() override {
    FolderTest::SetUp();
    // A block of 40 x 40 x 20 mm about its origin.
    std::string obj;
    for (int k = 0; k < 8; ++k)
      obj += fmt::format("v {} {} {}\n", k & 1 ? 0.02 : -0.02, k & 2 ? 0.02 : -0.02, k & 4 ? 0.01 : -0.01);
    for (const char* face : {"1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"}) {
      int v[4];
      std::sscanf(face, "%d %d %d %d", v, v + 1, v + 2, v + 3);
      obj += fmt::format("f {0} {1} {2}\nf {0} {2} {3}\n", v[0], v[1], v[2], v[3]);
    }
    grouser::test::put(folder_ / "block.obj", obj);
  }
  /// A grain on a plane under a descending block; `more`: keys of the material.
  scene::Scene scene(double step, const std::string& more, const std::string& run = "precision = \"double\"") const {
    return sceneOf(
        material(0.3, 0, more, kStiffness) + oneBall(kRadius, "") +
            fmt::format("[[mesh]]\nname = \"plate\"\nfile = \"{}\"\nposition = [0, 0, 0.0301]\nvelocity = [0, 0, {}]\n"
                        "sphere_radius = 0.004\nmaterial = \"soil\"\n",
                        (folder_ / "block.obj").string(), -kSpeed),
        1, step, run + "\ngravity = [0, 0, 0]");
  }
  static std::string crushing() { return fmt::format("crushing_strength = {}", kCap / (4 * kRadius * kRadius)); }
};

TEST_F(CrushingScene, TheForceStaysAtTheCapAndTheLedgerCloses) {
  const auto s = made(scene(2e-5, crushing()));
  double before = 0;
  while (s->time() < 0.16) {
    s->step();
    if (s->time() < 0.1) continue;
    if (before == 0) before = s->ledger().dissipated.crushing;
    s->restartMeans();
  }
  const Ledger l = s->ledger();
  // 0.06 s at 50 mm/s on the plateau: all of the plate's work is crushing. A step is 1 um of 3 mm.
  EXPECT_NEAR((l.dissipated.crushing - before) / (kCap * kSpeed * 0.06), 1, 1e-3);
  EXPECT_EQ(l.cappedNow, 1);
  // Plate and plane each store the elastic energy at yield.
  EXPECT_NEAR(l.elastic / (kCap * kYield), 1, 1e-3);
  EXPECT_NEAR((l.elastic + l.dissipated.total() + l.kinetic) / l.driveWork, 1, kDashpots);
  EXPECT_LT(std::fabs(l.residual), 1e-11) << "a few quanta of 2e-12 J";
  // Without crushing, the spring would store k x overlap, less its part cut by the cap: speed times time since then.
  const double overlap = kSpeed * s->time() - 1e-4 - kYield; // less the plane's share
  EXPECT_NEAR(l.cutImpulse / (0.5 * kStiffness * (overlap - kYield) * (overlap - kYield) / kSpeed), 1, 5e-3);
}

TEST_F(CrushingScene, TheIntegrationErrorFallsWithTheStep) {
  const auto error = [&](double step) {
    const auto s = made(scene(step, crushing()));
    while (s->time() < 0.12 - 0.5 * step) s->step();
    return std::fabs(s->ledger().integrationError);
  };
  const double coarse = error(4e-5), fine = error(1e-5);
  EXPECT_GT(coarse / fine, 3) << "first order: a quarter of the step, a quarter of the error";
}

TEST_F(CrushingScene, AGrainCrushedToItsMiddleIsTakenOutAndBooked) {
  const auto s = made(scene(2e-5, crushing()));
  while (s->time() < 0.26 && s->crushedGrains().grains == 0) s->step();
  ASSERT_EQ(s->crushedGrains().grains, 1);
  // Its middle: 10 mm of the plate, 1 mm of the plane, 0.1 mm of way before.
  EXPECT_NEAR(s->time() * kSpeed, 0.0111, 5e-5);
  EXPECT_EQ(s->ground().grains->count(), 0u);
  EXPECT_NEAR(s->crushedGrains().mass, ballMass(), 1e-9 * ballMass());
  // The energy stored at the plane leaves with the grain; the energy stored at the plate is dissipated.
  EXPECT_NEAR(s->crushedGrains().energy / (0.5 * kCap * kYield), 1, 1e-2);
  for (int k = 0; k < 100; ++k) s->step();
  const Ledger l = s->ledger();
  EXPECT_NEAR(l.dissipated.crushing / (kCap * (kRadius - kYield) + 0.5 * kCap * kYield), 1, 1e-3);
  EXPECT_NEAR(l.elastic / (0.5 * kCap * kYield), 1, 1e-2) << "energy stored at the plane when the grain was removed";
  EXPECT_LT(std::fabs(l.kinetic + l.potential), 1e-3 * kCap * kYield) << "it was nearly at rest";
  EXPECT_LT(std::fabs(l.residual), 1e-11) << "a few quanta of 2e-12 J";
  EXPECT_LT(norm(l.momentumResidual), 1e-6 * kCap * s->time()) << "rounding of the sums";
  EXPECT_NEAR((l.elastic + l.dissipated.total()) / l.driveWork, 1, kDashpots);
}

TEST_F(CrushingScene, WithoutStrengthItPassesThroughAndTheRunSaysWhere) {
  const auto s = made(scene(2e-5, ""));
  try {
    while (s->time() < 0.9) s->step();
    FAIL() << "no error";
  } catch (const base::SimulationError& error) {
    const std::string said = error.what();
    EXPECT_NE(said.find("grain 0"), std::string::npos) << said;
    EXPECT_NE(said.find("mm of its radius of 10 mm"), std::string::npos) << said;
    EXPECT_NE(said.find("mesh 'plate'"), std::string::npos) << said;
  }
}

TEST_F(CrushingScene, AStrengthThatIsNotReachedChangesNoBit) {
  const auto hash = [&](const std::string& more) {
    const auto s = made(scene(2e-5, more, "precision = \"single\""));
    while (s->time() < 0.03) s->step();
    return s->stateHash();
  };
  // The state includes the dents, so the hash differs: compares positions, velocities and forces.
  const auto state = [&](const std::string& more) {
    const auto s = made(scene(2e-5, more, "precision = \"single\""));
    while (s->time() < 0.03) s->step();
    return s->save().grains->words();
  };
  EXPECT_EQ(state("crushing_strength = 1e12"), state(""));
  EXPECT_NE(hash(crushing()), hash(""));
}

/// Many grains that a roller presses into a floor.
std::string bed(const std::string& more) {
  std::string text = material(0.5, 0.5, more, 1e5) + planeThrough("[0, 0, 0]", "[0, 0, 1]");
  for (int k = 0; k < 36; ++k)
    text += ballAt(fmt::format("[{}, {}, {}]", 0.0201 * (k % 6) - 0.05, 0.0203 * (k / 6) - 0.05 + 0.0004 * (k % 5),
                               0.0105 + 0.0005 * (k % 3)));
  return text + "[[mesh]]\nname = \"roller\"\nfile = \"meshes/roller.obj\"\nposition = [0, 0, 0.2]\nvelocity = [0, 0, "
                "-1]\nsphere_radius = 0.01\nmaterial = \"soil\"\n";
}

struct End {
  std::string hash;
  double grains, energy, mass;
  bool operator==(const End&) const = default;
};
std::ostream& operator<<(std::ostream& out, const End& e) {
  return out << e.hash << ' ' << e.grains << ' ' << e.energy << ' ' << e.mass;
}
End endOf(const Simulation& s) {
  return {s.stateHash(), s.crushedGrains().grains, s.crushedGrains().energy, s.crushedGrains().mass};
}

TEST(CrushedBed, HasOneAnswerForThreadsSkinsKernelsAndResumedRuns) {
  const std::string text = bed("crushing_strength = 1e5");
  const auto run = [&](const std::string& more, int threads, bool special, std::int64_t stop) {
    const std::string keys = "precision = \"single\"\n" + more;
    const auto setup = [&] {
      SimulationSetup made = setup::simulationSetup(sceneOf(text, 0.3, 1e-4, keys));
      made.ground.grains->model.specialised = special;
      return made;
    };
    auto s = std::make_unique<Simulation>(setup(), base::cpuExec(threads), [](double, double) {});
    while (s->steps() < 2400) {
      s->step();
      if (s->steps() == stop) s = std::make_unique<Simulation>(setup(), base::cpuExec(threads), s->save());
    }
    return endOf(*s);
  };
  const End one = run("", 1, true, 0);
  EXPECT_GE(one.grains, 2) << "no grain was crushed";
  EXPECT_EQ(run("", 2, true, 0), one) << "threads";
  EXPECT_EQ(run("skin = 0.7", 1, true, 0), one) << "skin";
  EXPECT_EQ(run("", 1, false, 0), one) << "general kernel";
  for (const std::int64_t stop : {900, 1500, 2000}) EXPECT_EQ(run("", 1, true, stop), one) << "resumed at " << stop;
}

} // namespace
} // namespace grouser::coupling::ledgers
