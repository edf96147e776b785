// SPDX-License-Identifier: BSD-3-Clause
// A vehicle on rigid ground: weight, track tension, maximum grade, turning resistance.
#include "runs/setup/load_scene.hpp"
#include "tests/system/driven_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>

namespace grouser::coupling {
namespace {

using base::Vec3d;

constexpr double kGravity = 9.81; // [m/s2]

/// Sprockets locked, gravity inclined by (x, y) of its magnitude.
scene::Scene standing(double x, double y) {
  const double z = -std::sqrt(1 - x * x - y * y);
  return setup::parseScene(
      fmt::format(
          "version = 1\n[run]\nduration = 6\ntime_step = 1e-4\ngravity = [{}, {}, {}]\n[material.steel]\n"
          "stiffness = 1e6\nfriction = 0.5\n[terrain]\nkind = \"rigid\"\nheightmap = \"heightmaps/flat.png\"\n"
          "size = [12, 12]\nheight_range = [0, 0]\nmaterial = \"steel\"\n[vehicle]\n"
          "spec = \"vehicles/light_tracked.toml\"\nsphere_radius = 0.03\nhull_touches = false\n"
          "position = [4, 0]\nclearance = 0\n[driver]\nsprocket_speed = 0\ntension_ramp = 0.05\nweight_ramp = 0.2\n"
          "rest_time_limit = 100\n",
          kGravity * x, kGravity * y, kGravity * z),
      GROUSER_SOURCE_DIR "/tests/scenes/rigid.toml");
}

/// sin of a slope with tangent t.
double sinOf(double t) { return t / std::sqrt(1 + t * t); }

TEST(AtRest, GroundForceOverASecondIsTheWeight) {
  Simulation simulation = begin(standing(0, 0));
  advance(simulation, 1);
  simulation.restartMeans();
  advance(simulation, 2);
  const Vec3d force = simulation.vehicle()->meanGroundForce();
  const double weight = simulation.vehicle()->assembly().mass * kGravity;
  std::printf("ground force / weight = %.6f\n", force.z / weight);
  EXPECT_NEAR(force.z / weight, 1, 1e-3) << "the bar; the residual oscillation is far smaller";
  EXPECT_LT(std::hypot(force.x, force.y), 1e-3 * weight);
}

/// Section through both strands between the idler and the next contact of the track: only the tensioner holds the part
/// in front along its slide. The idler turns freely, so both strands have equal tension except for their weight.
TEST(AtRest, BothStrandsPullAsTheIdlerDemands) {
  Simulation simulation = begin(standing(0, 0));
  advance(simulation, 2);
  const vehicle::Assembly& assembly = simulation.vehicle()->assembly();
  const multibody::State& state = simulation.vehicle()->state();
  const vehicle::VehicleSpec& spec = assembly.spec;
  const base::Pose hull = state.pose[static_cast<std::size_t>(assembly.chassis)];
  const double lastRoller = spec.roller.x.back() + spec.roller.radius;
  for (const vehicle::Track& track : assembly.tracks) {
    const multibody::JointReading& slide = state.joint[static_cast<std::size_t>(track.slideJoint)];
    // The pins nearest to the section, at the front of the rearmost shoe ahead of it.
    const double cut = lastRoller + spec.shoe.pitch;
    double topGap = 1e9, lowGap = 1e9;
    Vec3d top, low;
    for (std::size_t i = 0; i < track.shoes.size(); ++i) {
      const base::Pose& shoe = state.pose[static_cast<std::size_t>(track.shoes[i])];
      const Vec3d pin = hull.toBody(shoe.toWorld({0.5 * spec.shoe.pitch, 0, 0})) + spec.chassis.centre;
      const Vec3d force = hull.toBody(hull.position + state.joint[static_cast<std::size_t>(track.shoeJoints[i])].force);
      const double from = spec.roadWheel.firstX + (spec.roadWheel.count - 1) * spec.roadWheel.spacing;
      // The lower strand rises from the last wheel to the idler; its middle has no contact.
      const double middle = 0.5 * (from + spec.idler.x);
      if (pin.z > 0 && std::fabs(pin.x - cut) < topGap) topGap = std::fabs(pin.x - cut), top = force;
      if (pin.z < spec.roadWheel.z && std::fabs(pin.x - middle) < lowGap)
        lowGap = std::fabs(pin.x - middle), low = force;
    }
    const double together = std::fabs(top.x) + std::fabs(low.x);
    std::printf("%s: tensioner %.1f N, strands %.1f + %.1f N along it, tensions %.1f and %.1f N\n",
                vehicle::sideName(track.side), slide.springForce, std::fabs(top.x), std::fabs(low.x), norm(top),
                norm(low));
    EXPECT_NEAR(together / slide.springForce, 1, 1e-3) << "residual oscillation";
    // Equal except for the weight of the half metre of chain that the lower strand hangs below the upper: 0.3 kN,
    // i.e. half of that on either side of the mean.
    const double demanded = slide.springForce / (std::fabs(top.x) / norm(top) + std::fabs(low.x) / norm(low));
    EXPECT_NEAR(norm(top), demanded, 0.05 * demanded);
    EXPECT_NEAR(norm(low), demanded, 0.05 * demanded);
    EXPECT_NEAR(slide.springForce, spec.idler.preload - spec.idler.stiffness * slide.position,
                0.001 * spec.idler.preload);
  }
}

/// As the weight is applied the tracks yield and the vehicle starts to slide. Below the friction limit it slows by
/// g (mu cos - sin) = 0.12 m/s2 at 0.98 of the limit, and stops; above it the speed keeps growing.
TEST(AtRest, TheGradeThatItHoldsIsItsFriction) {
  constexpr double kFriction = 0.8;
  const auto hull = [](const Simulation& s) { return s.vehicle()->state().pose[0].position.x; };
  Simulation held = begin(standing(-sinOf(0.98 * kFriction), 0));
  advance(held, 3.4);
  const double rests = hull(held);
  advance(held, 3.9);
  std::printf("at 0.98 of the friction the hull moves by %.2g m in half a second\n", rests - hull(held));
  EXPECT_LT(std::fabs(rests - hull(held)), 3e-3) << "it oscillates on its track by a millimetre or two";

  Simulation slides = begin(standing(-sinOf(1.02 * kFriction), 0));
  advance(slides, 1.2);
  slides.restartMeans();
  const double before = slides.ledger().momentum.x;
  advance(slides, 1.7);
  const vehicle::Observation seen = slides.vehicle()->observe();
  EXPECT_NEAR(seen.groundForce.x / seen.groundForce.z, kFriction, 1e-4 * kFriction) << "each shoe slides";
  const double gained = (before - slides.ledger().momentum.x) / slides.vehicle()->assembly().mass;
  // Downhill, in the sliding direction, the ground decelerates it; the excess of its weight accelerates it.
  EXPECT_NEAR(seen.netThrust, -seen.groundForce.x, 1e-9 * seen.groundForce.x);
  const double weight = slides.vehicle()->assembly().mass * kGravity;
  EXPECT_NEAR(seen.drawbarPull, gained / 0.5 * slides.vehicle()->assembly().mass, 1e-6 * weight)
      << "round-off, and a heading of 1e-4 rad";
  std::printf("at 1.02 it gains %.4f m/s in half a second\n", gained);
  EXPECT_GT(gained, 0.01);
}

/// In a pivot turn each shoe slides sideways, and slightly along its track: friction opposes this motion. The moments
/// are those of the lateral forces, about the hull's vertical axis.
struct Turning {
  double measured = 0;  ///< moment of the shoes' measured forces [N m]
  double corrected = 0; ///< sum of mu N_i x_i, as far as shoe i slides across
  double plain = 0;     ///< sum of mu N_i |x_i|, x from the middle of the turn
};

Turning turningOf(const VehicleRig& rig, double friction) {
  Turning t;
  const vehicle::Assembly& assembly = rig.assembly();
  const multibody::State& state = rig.state();
  const base::Pose hull = state.pose[static_cast<std::size_t>(assembly.chassis)];
  const vehicle::Observation seen = rig.observe();
  const Vec3d ahead{std::cos(seen.heading), std::sin(seen.heading), 0}, left{-ahead.y, ahead.x, 0};
  const multibody::Twist& turn = state.twist[static_cast<std::size_t>(assembly.chassis)];
  const double middle = -dot(turn.v, left) / turn.w.z; // ahead of the hull's centre of mass
  for (std::size_t k = 0; k < assembly.tracks.size(); ++k)
    for (std::size_t i = 0; i < assembly.tracks[k].shoes.size(); ++i) {
      if (seen.tracks[k].onGround[i] == 0) continue;
      const auto body = static_cast<std::size_t>(assembly.tracks[k].shoes[i]);
      const base::Pose& shoe = state.pose[body];
      const Vec3d sole = base::rotate(shoe.orientation, {0, 0, assembly.spec.shoe.padBottom});
      const Vec3d v = state.twist[body].v + cross(state.twist[body].w, sole);
      const double x = dot(shoe.position - hull.position, ahead), across = dot(v, left);
      const Vec3d force = base::rotate(shoe.orientation, {seen.tracks[k].forwardForce[i], seen.tracks[k].leftForce[i],
                                                          seen.tracks[k].normalForce[i]});
      const double sliding = std::hypot(v.x, v.y);
      t.measured -= dot(force, left) * x;
      t.corrected += friction * force.z * across / std::max(sliding, 1e-9) * x;
      t.plain += friction * force.z * std::fabs(x - middle);
    }
  return t;
}

TEST(OnRigidGround, TurningResistanceIsTheFrictionOfTheShoesAcrossTheirWay) {
  scene::Scene scene = standing(0, 0);
  scene.driver.sprocketSpeed.reset(), scene.driver.left = -1.5, scene.driver.right = 1.5;
  Simulation simulation = begin(scene);
  advance(simulation, 1.5);
  Turning sum;
  for (int k = 1; k <= 100; ++k) { // over six teeth
    simulation.restartMeans();
    advance(simulation, 1.5 + 0.004 * k);
    const Turning t = turningOf(*simulation.vehicle(), 0.8);
    sum.measured += t.measured, sum.corrected += t.corrected, sum.plain += t.plain;
  }
  const vehicle::Assembly& assembly = simulation.vehicle()->assembly();
  const double length = assembly.spec.roadWheel.spacing * (assembly.spec.roadWheel.count - 1);
  const double formula = 0.8 * assembly.mass * kGravity * length / 4;
  std::printf("turning resistance %.1f N m, of friction across the way %.1f, all of it across %.1f, mu W L / 4 = %.1f; "
              "%.3f rad/s\n",
              std::fabs(sum.measured) / 100, std::fabs(sum.corrected) / 100, sum.plain / 100, formula,
              simulation.vehicle()->state().twist[0].w.z);
  EXPECT_NEAR(sum.measured / sum.corrected, 1, 0.05);
  EXPECT_LT(std::fabs(sum.measured), sum.plain);
}

} // namespace
} // namespace grouser::coupling
