// SPDX-License-Identifier: BSD-3-Clause
// Error-controlled steps are as long as their error allows.
#include "coupling/step_controller.hpp"
#include "multibody/solver.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/mechanism_setup.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace grouser::coupling {
namespace {

using multibody::State;

constexpr double kTolerance = 1e-4; ///< [m/s, rad/s]

/// A scene of runs/mechanisms with error-controlled steps.
struct Controlled {
  explicit Controlled(const std::string& scene) : setup(setupOf(scene)) {
    loads.gravity = setup.gravity, kept.push_back(state);
  }

  static MechanismSetup setupOf(const std::string& scene) {
    return setup::mechanismSetup(
        setup::loadScene(GROUSER_SOURCE_DIR "/runs/mechanisms/" + scene + ".toml",
                         {"run.time_step=auto", "run.integrator_order=2", "run.tolerance=1e-4"}));
  }

  MechanismSetup setup;
  multibody::Solver solver{setup.model, setup.solver};
  State state = multibody::makeState(setup.model);
  multibody::Loads loads = multibody::makeLoads(setup.model);
  StepController controller{*setup.control, setup.largestTurn};
  std::vector<State> kept; ///< after every interval

  void advance(double until) {
    controller.advance(solver, state, loads, until, [this] { kept.push_back(state); });
  }
  double stretch(std::size_t i) const { return kept[i].time - kept[i - 1].time; }
};

/// Error of positions and rotations of one interval against 32 times shorter steps, as in step_controller.hpp.
double errorOf(Controlled& p, const State& before, const State& after) {
  State fine = before;
  const double h = after.time - before.time;
  for (int i = 0; i < 64; ++i) p.solver.step(fine, p.loads, h / 64);
  double most = 0;
  for (std::size_t b = 0; b < fine.pose.size(); ++b) {
    const base::Quat turn = fine.pose[b].orientation * after.pose[b].orientation.conjugate();
    most = std::max(
        {most, norm(fine.pose[b].position - after.pose[b].position) + h * norm(fine.twist[b].v - after.twist[b].v),
         2 * norm(base::Vec3d{turn.x, turn.y, turn.z}) + h * norm(fine.twist[b].w - after.twist[b].w)});
  }
  return most;
}

TEST(StepControl, EveryStretchAddsNearlyWhatTheToleranceAllows) {
  // A pendulum has an error in position, a disc on a torsion spring only in rotation.
  for (const char* scene : {"pendulum", "spring_torsion"}) {
    Controlled p(scene);
    p.advance(3);
    ASSERT_GT(p.kept.size(), 40u) << scene;
    double sum = 0;
    int counted = 0;
    for (std::size_t i = 10; i + 1 < p.kept.size(); ++i, ++counted) {
      const double share = errorOf(p, p.kept[i - 1], p.kept[i]) / (kTolerance * p.stretch(i));
      EXPECT_LT(share, 1.1) << scene << ", interval " << i << ": third order, by difference from the half step";
      sum += share;
    }
    // The target is 0.9 of the longest step, i.e. 0.81 of the error; less if the error has just decreased.
    EXPECT_GT(sum / counted, 0.6) << scene;
  }
}

TEST(StepControl, FewStretchesAreTriedInVain) {
  Controlled p("pendulum");
  p.advance(3);
  EXPECT_LT(static_cast<double>(p.controller.record().rejected), 0.1 * static_cast<double>(p.kept.size()));
}

TEST(StepControl, AStretchThatARowCutsShortDoesNotShortenTheNext) {
  Controlled p("pendulum");
  p.advance(1);
  const double wanted = p.controller.record().next;
  p.advance(1 + 0.01 * wanted);
  EXPECT_GE(p.controller.record().next, wanted);
}

} // namespace
} // namespace grouser::coupling
