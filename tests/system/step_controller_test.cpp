// SPDX-License-Identifier: BSD-3-Clause
// Error-controlled steps of mechanisms: the final error is proportional to the tolerance.
#include "base/math.hpp"
#include "coupling/mechanism.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/mechanism_setup.hpp"
#include "runs/setup/step_limit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string>
#include <vector>

namespace grouser::coupling {
namespace {

struct End {
  std::vector<base::Vec3d> places;
  StepController::Record record;
};

/// The scene at `time`.
End endOf(const std::string& name, double time, const std::vector<std::string>& overrides) {
  std::vector<std::string> all = {fmt::format("run.duration={}", time),
                                  fmt::format("run.output_interval={}", time / 10),
                                  fmt::format("run.frame_interval={}", time)};
  all.insert(all.end(), overrides.begin(), overrides.end());
  const scene::Scene scene = setup::loadScene(GROUSER_SOURCE_DIR "/runs/mechanisms/" + name, all);
  const double step = setup::chooseTimeStep(scene);
  Mechanism mechanism(setup::mechanismSetup(scene), step);
  for (std::int64_t i = 0; i < std::llround(time / step); ++i) mechanism.advance();
  EXPECT_NEAR(mechanism.state().time, time, 1e-11); // a sum of up to 150,000 fixed steps
  End end;
  for (const base::Pose& pose : mechanism.state().pose) end.places.push_back(pose.position);
  if (mechanism.controller()) end.record = mechanism.controller()->record();
  return end;
}

double distance(const End& a, const End& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.places.size(); ++i) most = std::max(most, norm(a.places[i] - b.places[i]));
  return most;
}

/// A scene's own `time_step` is removed: it is incompatible with a tolerance.
const std::string kAuto = "run.time_step=auto";

struct Case {
  const char* scene;
  double time;                     ///< [s]
  double first;                    ///< tolerance; three more are each ten times smaller [m/s, rad/s]
  int order;                       ///< order of the fixed reference steps
  double step;                     ///< reference step [s]
  double most;                     ///< error at the end over the tolerance [s]
  const char* more = "run.seed=1"; ///< an additional key
};

class Tolerance : public ::testing::TestWithParam<Case> {};

TEST_P(Tolerance, ErrorAtTheEndGoesWithIt) {
  const Case& c = GetParam();
  const End reference =
      endOf(c.scene, c.time,
            {c.more, fmt::format("run.integrator_order={}", c.order), fmt::format("run.time_step={}", c.step)});
  std::vector<double> errors;
  double tolerance = c.first;
  for (int i = 0; i < 4; ++i, tolerance *= 0.1) {
    const End end = endOf(c.scene, c.time, {kAuto, c.more, fmt::format("run.tolerance={}", tolerance)});
    errors.push_back(distance(end, reference));
    // Several times the measured value: the phase of steps in an oscillation or bounce has an effect of this size.
    EXPECT_LT(errors.back(), c.most * tolerance) << tolerance;
    EXPECT_GT(end.record.largest, end.record.smallest);
  }
  // Over three decades, except for the same random effect.
  EXPECT_GT(errors.front() / errors.back(), 30);
}

// A pendulum; an accelerating squeezer; a door driven by wind against a damped stop.
INSTANTIATE_TEST_SUITE_P(Mechanisms, Tolerance,
                         ::testing::Values(Case{"pendulum.toml", 5, 1e-3, 6, 1e-3, 3},
                                           Case{"andrews.toml", 0.03, 1e-1, 6, 2e-6, 1e-3},
                                           Case{"door.toml", 1.5, 1e-4, 2, 1e-5, 2, "joint.0.limits=[-0.1, 0.5]"}),
                         [](const ::testing::TestParamInfo<Case>& one) {
                           const std::string name = one.param.scene;
                           return name.substr(0, name.find('.'));
                         });

} // namespace
} // namespace grouser::coupling
