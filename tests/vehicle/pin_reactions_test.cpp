// SPDX-License-Identifier: BSD-3-Clause
// Reactions of the pins of a closed track: least norm, and no trace of the self-stress of the ring.
#include "vehicle/pin_reactions.hpp"

#include "ride.hpp"
#include "vehicle/travel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

using namespace grouser;
using base::Vec3d;
using vehicle::PinReaction;

namespace {

/// Middle of the pin ahead of a shoe.
Vec3d pinOf(const vehicle::Assembly& v, const multibody::State& state, int shoe) {
  return state.pose[shoe].toWorld({0.5 * v.spec.shoe.pitch, 0, 0});
}

/// Adds the same wrench to all pins of a track: a force along the pins, and a moment across them about a point.
void addSelfStress(const vehicle::Assembly& v, const vehicle::Track& t, double force, const Vec3d& moment,
                   multibody::State& state) {
  const Vec3d axis = base::rotate(state.pose[t.shoes[0]].orientation, {0, 1, 0});
  for (std::size_t i = 0; i < t.shoes.size(); ++i) {
    multibody::JointReading& pin = state.joint[t.shoeJoints[i]];
    pin.force += force * axis;
    pin.torque += moment + base::cross(-pinOf(v, state, t.shoes[i]), force * axis);
  }
}

/// sum of |F|^2 + |M / L|^2.
double normOf(const std::vector<PinReaction>& pins, double length) {
  double sum = 0;
  for (const PinReaction& pin : pins) sum += base::norm2(pin.force) + base::norm2(pin.moment) / (length * length);
  return sum;
}

/// Largest second difference in time of a quantity of all pins: |(a + c) / 2 - b|.
class Kink {
public:
  void add(std::vector<double> now) {
    for (std::size_t i = 0; i < before_.size() && before_.size() == last_.size(); ++i)
      most_ = std::max(most_, std::fabs(0.5 * (before_[i] + now[i]) - last_[i]));
    before_ = std::move(last_), last_ = std::move(now);
  }
  double most() const { return most_; }

private:
  std::vector<double> before_, last_;
  double most_ = 0;
};

} // namespace

TEST(PinReactions, SelfStressOfTheRingIsNotPartOfThem) {
  const vehicle::Assembly v = vehicle::assemble(test::readySpec());
  multibody::State state = multibody::makeState(v.model);
  const vehicle::Track& t = v.tracks[1];
  for (std::size_t i = 0; i < t.shoes.size(); ++i) {
    const auto k = static_cast<double>(i), third = static_cast<double>(i % 3), fourth = static_cast<double>(i % 4);
    state.joint[t.shoeJoints[i]].force = {3000 - 40 * k, 300 * third, -20 * k};
    state.joint[t.shoeJoints[i]].torque = {70 - k, 0, 5 * fourth};
  }
  const auto bare = vehicle::pinReactions(v, 1, state, 0);
  addSelfStress(v, t, 5e6, {-2e5, 0, 3e5}, state);
  const auto stressed = vehicle::pinReactions(v, 1, state, 0);
  // Round-off of 5 MN at levers of 3 m.
  constexpr double kRound = 1e-7;
  for (std::size_t i = 0; i < bare.size(); ++i) {
    EXPECT_NEAR(base::norm(stressed[i].force - bare[i].force), 0, kRound);
    EXPECT_NEAR(base::norm(stressed[i].moment - bare[i].moment), 0, kRound);
    EXPECT_NEAR(stressed[i].tension, bare[i].tension, kRound);
    EXPECT_EQ(stressed[i].lateral, stressed[i].force.y);
  }
}

TEST(PinReactions, NoSelfStressReducesTheirNorm) {
  const vehicle::Assembly v = vehicle::assemble(test::readySpec());
  multibody::State state = multibody::makeState(v.model);
  const vehicle::Track& t = v.tracks[0];
  for (std::size_t i = 0; i < t.shoes.size(); ++i) {
    state.joint[t.shoeJoints[i]].force.y = 100 * static_cast<double>(i % 5);
    state.joint[t.shoeJoints[i]].torque.x = 30 * static_cast<double>(i % 7);
  }
  const double length = v.spec.shoe.padHalfWidth;
  const auto least = vehicle::pinReactions(v, 0, state, 0);
  for (std::size_t i = 0; i < t.shoes.size(); ++i)
    state.joint[t.shoeJoints[i]].force = least[i].force, state.joint[t.shoeJoints[i]].torque = least[i].moment;
  const multibody::State shared = state;
  for (const double force : {-1.0, 0.0, 1.0})
    for (const double moment : {-1.0, 0.0, 1.0}) {
      if (force == 0 && moment == 0) continue;
      state = shared;
      addSelfStress(v, t, force, {moment, 0, 0.5 * moment}, state);
      std::vector<PinReaction> other(t.shoes.size());
      for (std::size_t i = 0; i < other.size(); ++i)
        other[i].force = state.joint[t.shoeJoints[i]].force, other[i].moment = state.joint[t.shoeJoints[i]].torque;
      EXPECT_GT(normOf(other, length), normOf(least, length));
    }
}

/// In this turn the axis released by the universal joint of the left track points at the spherical joint at 1.41 s. The
/// solver's reactions then contain a self-stress of 10 MN, a constant / sin(angle between them); the chain pulls with
/// 15 kN.
TEST(PinReactions, PassThePoleOfTheSelfStressWithoutASpike) {
  constexpr double kStep = 5e-5;
  test::Ride ride = test::rideOnGround(test::readySpec("m113_like"), {.speeds = {{0}, {6}, {9}}}, {.step = kStep});
  ride.until(1.405);
  const vehicle::Assembly& v = ride.vehicle();
  const vehicle::Track& t = v.tracks[0];
  const std::size_t universal = t.shoes.size() / 2, count = t.shoes.size();
  ASSERT_EQ(v.model.joints()[t.shoeJoints[0]].type, multibody::JointType::kSpherical);
  ASSERT_EQ(v.model.joints()[t.shoeJoints[universal]].type, multibody::JointType::kUniversal);
  Kink tension, lateral, meanTension;
  double raw = 0, mean = 0, steps = 0, mostTension = 0, mostLateral = 0, least = 1e99, most = 0;
  ride.until(1.42, [&] {
    const base::Pose& released = ride.state.pose[t.shoes[universal + 1]];
    const Vec3d axis = base::rotate(released.orientation, {1, 0, 0}),
                left = base::rotate(released.orientation, {0, 1, 0});
    const Vec3d line = pinOf(v, ride.state, t.shoes[0]) - pinOf(v, ride.state, t.shoes[universal]);
    const double sine = base::dot(base::cross(axis, line), left) / base::norm(line);
    double solver = 0;
    for (const int pin : t.shoeJoints) solver += base::dot(ride.state.joint[pin].force, left);
    solver /= static_cast<double>(count);
    if (std::fabs(sine) > 1e-3 && std::fabs(sine) < 1e-2)
      least = std::min(least, std::fabs(solver * sine)), most = std::max(most, std::fabs(solver * sine));
    raw = std::max(raw, std::fabs(solver));

    std::vector<double> pulls, sides;
    double sum = 0;
    for (const PinReaction& pin : vehicle::pinReactions(v, 0, ride.state, kStep)) {
      pulls.push_back(pin.tension), sides.push_back(pin.lateral), sum += pin.tension;
      mostTension = std::max(mostTension, std::fabs(pin.tension));
      mostLateral = std::max(mostLateral, std::fabs(pin.lateral));
    }
    tension.add(pulls), lateral.add(sides), meanTension.add({sum / static_cast<double>(count)});
    mean += sum / static_cast<double>(count), ++steps;
  });
  std::printf(
      "solver: lateral up to %.3g N, x sin(angle) %.1f to %.1f N; tension: mean %.0f N, up to %.0f N, kinks of a "
      "pin %.0f N, of the mean %.0f N; lateral: up to %.0f N, kinks %.0f N\n",
      raw, least, most, mean / steps, mostTension, tension.most(), meanTension.most(), mostLateral, lateral.most());
  EXPECT_GT(raw, 1e6) << "the turn no longer passes the pole; choose another one";
  EXPECT_GT(least / most, 0.75) << "the self-stress changes by an order of magnitude";
  // No section of the chain carries more than the friction of the ground on its track, 0.8 of half the weight.
  const double friction = 0.8 * 0.5 * v.mass * base::norm(test::kRideGravity);
  EXPECT_LT(mostTension, friction + v.spec.idler.preload);
  EXPECT_LT(mostLateral, friction);
  // A few iterations of a step at the pole use rows of several positions, with an error of 2 %.
  EXPECT_LT(meanTension.most(), 0.05 * mean / steps);
}

namespace {

/// Sections through both strands beside a wheel, at the nearest pins beyond `reach` on the side of the other wheel.
struct Strands {
  double alongHull = 0; ///< sum of the pulls, components along the hull's x axis [N]
  double moment = 0;    ///< of the pulls of both strands about the wheel's axle [N m]
};

Strands cutBeside(const vehicle::Assembly& v, int track, const multibody::State& state, double step, int wheel,
                  double reach, double side) {
  const vehicle::Track& t = v.tracks[static_cast<std::size_t>(track)];
  const base::Pose hull = vehicle::vehiclePose(v, state);
  const Vec3d axle = hull.toBody(state.pose[wheel].position);
  const auto pins = vehicle::pinReactions(v, track, state, step);
  Strands strands;
  for (const bool lower : {false, true}) {
    double nearest = std::numeric_limits<double>::infinity(), pull = 0, along = 0, lever = 0;
    for (std::size_t i = 0; i < pins.size(); ++i) {
      const int behind = t.shoes[i], ahead = t.shoes[(i + 1) % pins.size()];
      const Vec3d from = hull.toBody(pinOf(v, state, behind)) - axle;
      const double distance = std::hypot(from.x, from.z);
      if (from.x * side < 0 || (from.z < 0) != lower || distance < reach || distance > nearest) continue;
      const Vec3d way = hull.toBody(state.pose[ahead].position) - hull.toBody(state.pose[behind].position);
      const Vec3d direction = way * (1 / base::norm(way));
      nearest = distance, pull = pins[i].tension, along = std::fabs(direction.x);
      lever = from.z * direction.x - from.x * direction.z;
    }
    strands.alongHull += pull * along;
    strands.moment += (lower ? -side : side) * pull * lever;
  }
  return strands;
}

class PinTension : public ::testing::TestWithParam<const char*> {};

/// A slow turn, in which one sprocket drives and the other one brakes: the tension of the strands balances the
/// tensioner on the idler, and the drive torque on the sprocket. Means over a tooth passage of the faster track.
TEST_P(PinTension, BalancesIdlerAndSprocket) {
  const vehicle::VehicleSpec spec = test::readySpec(GetParam());
  const double scale = spec.shoe.pitch / 0.154;
  constexpr double kStep = 1e-4, kLeft = 0.5, kRight = 1.5; // [s], [rad/s]
  test::Ride ride = test::rideOnGround(spec, {.speeds = {{0}, {kLeft}, {kRight}}}, {1e7 * scale * scale, kStep});
  ride.until(1.0);
  const vehicle::Assembly& v = ride.vehicle();
  const double side = spec.idler.x > 0 ? 1 : -1;
  struct Sums {
    double idler = 0, strands = 0, torque = 0, moment = 0;
  } sums[2];
  int steps = 0;
  ride.until(1.0 + 2 * base::kPi / (spec.sprocket.teeth * kRight), [&] {
    ++steps;
    for (int track = 0; track < 2; ++track) {
      const vehicle::Track& t = v.tracks[static_cast<std::size_t>(track)];
      Sums& sum = sums[track];
      sum.idler += ride.state.joint[t.slideJoint].springForce;
      sum.torque += ride.state.joint[t.sprocketJoint].driveForce;
      const double pitch = spec.shoe.pitch;
      sum.strands += cutBeside(v, track, ride.state, kStep, t.idler, spec.idler.radius + 0.75 * pitch, -side).alongHull;
      sum.moment +=
          cutBeside(v, track, ride.state, kStep, t.sprocket, spec.sprocketPinRadius() + 0.6 * pitch, side).moment;
    }
  });
  for (const Sums& sum : sums) {
    std::printf("%s: idler %.1f N, strands %.1f N; torque %.1f N m, strands %.1f N m\n", GetParam(), sum.idler / steps,
                sum.strands / steps, sum.torque / steps, sum.moment / steps);
    EXPECT_NEAR(sum.strands / sum.idler, 1, 0.02);
    EXPECT_NEAR(sum.moment / sum.torque, 1, 0.02);
  }
}

INSTANTIATE_TEST_SUITE_P(Vehicles, PinTension, ::testing::Values("light_tracked", "m113_like", "robot"));

} // namespace
