// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "mechanisms.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <ios>
#include <limits>
#include <string>

namespace grouser::multibody::test {
namespace {

const Mat3d kArmInertia = Mat3d::diagonal({0.4, 0.7, 0.5});

/// A model with all features: ring, chassis with sprung arms and wheels, slide with stops, drive, point spring.
Mechanism vehicleLike() {
  Mechanism m;
  RingSpec ring;
  ring.links = 12, ring.spin = 2, ring.damping = 5, ring.centre = {0, 2, 0};
  addRing(m.model, ring);
  const int chassis = m.model.addBody(makeBody("chassis", 100, Mat3d::diagonal({20, 30, 25}), {}));
  for (int i = 0; i < 3; ++i) {
    const std::string n = std::to_string(i);
    const int arm = m.model.addBody(makeBody("arm " + n, 5, kArmInertia, {{i + 0.2, 0, -0.1}, {}}));
    const int wheel = m.model.addBody(makeBody("wheel " + n, 8, kArmInertia, {{i + 0.4, 0, -0.2}, {}}));
    const int pivot =
        m.model.addJointAt("pivot " + n, JointType::kRevolute, chassis, arm, frameWithZ({1.0 * i, 0, 0}, kY));
    m.model.addJointAt("axle " + n, JointType::kRevolute, arm, wheel, frameWithZ({i + 0.4, 0, -0.2}, kY), 0.1);
    m.model.addAxisSpring({"torsion " + n, pivot, 7700, 300, 0, -60});
  }
  m.model.addDrive({"motor", m.model.jointIndex("axle 0"), 3, true});
  const int idler = m.model.addBody(makeBody("idler", 8, kArmInertia, {{3, 0, 0}, {}}));
  const int slide =
      m.model.addJointAt("slide", JointType::kPrismatic, chassis, idler, frameWithZ({3, 0, 0}, {1, 0, 0}));
  AxisSpring tensioner;
  tensioner.name = "tensioner", tensioner.joint = slide, tensioner.stiffness = 3e5, tensioner.damping = 4000;
  tensioner.preload = 9200, tensioner.lowerLimit = -0.015, tensioner.upperLimit = 0.02, tensioner.stopStiffness = 5e6;
  m.model.addAxisSpring(tensioner);
  PointSpring rope;
  rope.name = "rope", rope.bodyB = chassis, rope.point_A = {0, 0, 3}, rope.point_B = {1, 0, 0.2};
  rope.stiffness = 2e4, rope.damping = 100, rope.restLength = 2.9;
  m.model.addPointSpring(rope);
  m.start();
  return m;
}

void runSteps(Mechanism& m, Solver& solver, int from, int to) {
  for (int i = from; i < to; ++i) {
    m.loads.drives[0].speed = 3 + 0.001 * i;
    m.loads.external[2].force = {0.01 * i, 1, 0};
    solver.step(m.state, m.loads, 1e-3);
  }
}

TEST(MultibodyState, ResumedRunEqualsTheStraightRunToTheLastBit) {
  Mechanism straight = vehicleLike();
  Solver solver(straight.model);
  runSteps(straight, solver, 0, 150);
  const std::vector<double> saved = straight.state.save();
  runSteps(straight, solver, 150, 300);

  Mechanism resumed = vehicleLike();
  resumed.state.restore(saved);
  Solver another(resumed.model);
  runSteps(resumed, another, 150, 300);
  const std::vector<double> a = straight.state.save(), b = resumed.state.save();
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)), 0);
}

TEST(MultibodyState, HashOfARunIsTheSameOnEveryMachineAndBuild) {
  // FNV-1a over the bytes of the state without the ledger. A change needs a reason in its commit.
  Mechanism m = vehicleLike();
  Solver solver(m.model);
  runSteps(m, solver, 0, 300);
  std::uint64_t hash = 14695981039346656037ull;
  std::vector<double> saved = m.state.save();
  saved.resize(saved.size() - State::kBooks);
  for (const double x : saved) {
    unsigned char bytes[sizeof x];
    std::memcpy(bytes, &x, sizeof x);
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211ull;
  }
  EXPECT_EQ(hash, 0x22a8b4b384c6136cull) << std::hex << hash;
}

TEST(MultibodyState, EveryNumberOfTheBooksIsSavedAndRestored) {
  // Numbers that differ from each other and from the defaults.
  Mechanism m = vehicleLike();
  double next = 1;
  Ledger& l = m.state.ledger;
  const auto set = [&](CompensatedSum& s) { s = {next, next + 0.5}, ++next; };
  for (CompensatedSum* s :
       {&l.gravityWork, &l.externalWork, &l.driveWork, &l.springWork, &l.dissipated, &l.kineticWork, &l.potentialGain,
        &l.elasticGain, &l.turnover, &l.jointDamping, &l.springDamping, &l.stopDamping})
    set(*s);
  for (CompensatedVector* v : {&l.linearImpulse, &l.angularImpulse}) set(v->x), set(v->y), set(v->z);
  l.begun = 1, l.startKinetic = 77, l.startLinear = {78, 79, 80}, l.startAngular = {81, 82, 83};
  const std::vector<double> saved = m.state.save();

  Mechanism other = vehicleLike();
  other.state.restore(saved);
  const auto numbers = [](const Ledger& ledger) {
    static_assert(sizeof(Ledger) % sizeof(double) == 0);
    std::array<double, sizeof(Ledger) / sizeof(double)> all;
    std::memcpy(all.data(), &ledger, sizeof ledger);
    return all;
  };
  EXPECT_EQ(numbers(other.state.ledger), numbers(l));
  // The last State::kBooks numbers are the ledger without its five plain sums.
  const std::vector<double> fresh = vehicleLike().state.save();
  std::size_t changed = 0;
  for (std::size_t i = saved.size() - State::kBooks; i < saved.size(); ++i) changed += saved[i] != fresh[i];
  EXPECT_EQ(changed, State::kBooks);
  for (std::size_t i = 0; i < saved.size() - State::kBooks; ++i) changed += saved[i] != fresh[i];
  EXPECT_EQ(changed, State::kBooks + 5);
  EXPECT_EQ(sizeof(Ledger), (State::kBooks + 5) * sizeof(double));
}

TEST(MultibodyState, RestoreRefusesAnotherModelsState) {
  Mechanism m = vehicleLike();
  std::vector<double> flat = m.state.save();
  flat.pop_back();
  EXPECT_THROW(m.state.restore(flat), base::InputError);
}

TEST(MultibodyState, LedgerOfAVehicleClosesWithTheStep) {
  const auto residual = [](double dt) {
    Mechanism m = vehicleLike();
    Solver solver(m.model);
    const double start = totals(m.model, m.state, m.loads).kinetic;
    const int steps = static_cast<int>(std::lround(0.5 / dt));
    for (int i = 0; i < steps; ++i) solver.step(m.state, m.loads, dt);
    const Ledger& l = m.state.ledger;
    const Balance b = balance(m.model, m.state, m.loads);
    EXPECT_LE(std::fabs(b.leftOver), 1e-9 * b.turnover) << "rounding";
    EXPECT_NEAR(b.dissipated(), l.dissipated, 1e-12 * b.turnover);
    return std::fabs(totals(m.model, m.state, m.loads).kinetic - start - l.gravityWork - l.externalWork - l.driveWork -
                     l.springWork + l.dissipated);
  };
  const double coarse = residual(1e-3), fine = residual(2.5e-4);
  EXPECT_LT(coarse, 1);
  EXPECT_LT(fine, 0.4 * coarse);
}

TEST(MultibodyState, IndependentPartsDoNotInfluenceEachOther) {
  // The ring of the vehicle-like model moves exactly as it does without the other bodies.
  Mechanism both = vehicleLike(), alone;
  RingSpec ring;
  ring.links = 12, ring.spin = 2, ring.damping = 5, ring.centre = {0, 2, 0};
  addRing(alone.model, ring);
  alone.start();
  Solver a(both.model), b(alone.model);
  for (int i = 0; i < 200; ++i) a.step(both.state, both.loads, 1e-3), b.step(alone.state, alone.loads, 1e-3);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(both.state.pose[i].position, alone.state.pose[i].position);
}

/// The message of the InputError that `f` throws; empty if it throws none.
std::string errorOf(const std::function<void()>& f) {
  try {
    f();
  } catch (const base::InputError& e) {
    return e.what();
  }
  return "";
}

TEST(MultibodyErrors, NameThePartAndWhatIsWrong) {
  const auto expectMessage = [](const std::function<void()>& f, const std::string& part, const std::string& why) {
    const std::string message = errorOf(f);
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_NE(message.find(why), std::string::npos) << message;
  };
  Model model;
  const auto body = [&](double mass, const Mat3d& I) { model.addBody(makeBody("shoe 3", mass, I, {})); };
  expectMessage([&] { body(0, kArmInertia); }, "shoe 3", "mass");
  expectMessage([&] { body(std::numeric_limits<double>::quiet_NaN(), kArmInertia); }, "shoe 3", "mass");
  expectMessage(
      [&] {
        body(1, Mat3d::diagonal({1, -1, 1}));
      },
      "shoe 3", "positive definite; every principal moment must be > 0, but they are -1, 1, 1");
  expectMessage([&] { body(1, Mat3d::diagonal({1, 1, 2.1})); }, "shoe 3", "triangle");
  expectMessage([&] { body(1, {{{1, 0.6, 0}, {0.6, 1, 0}, {0, 0, 1}}}); }, "shoe 3", "they are 0.4, 1, 1.6");
  expectMessage([&] { body(1, {{{1, 0.1, 0}, {0, 1, 0}, {0, 0, 1}}}); }, "shoe 3", "symmetric");
  body(1, Mat3d::diagonal({1, 1, 2})); // a flat plate is valid
  expectMessage([&] { body(1, kArmInertia); }, "shoe 3", "duplicate");
  Body ground = makeBody("ground", 1, kArmInertia, {});
  ground.fixed = true;
  model.addBody(ground);
  expectMessage([&] { model.addJointAt("a", JointType::kRevolute, kWorld, 1, {}); }, "joint 'a'", "fixed");
  expectMessage([&] { model.addJointAt("a", JointType::kRevolute, 0, 7, {}); }, "joint 'a'", "outside");
  expectMessage([&] { model.addJointAt("a", JointType::kRevolute, 0, 0, {}); }, "joint 'a'", "itself");
  expectMessage([&] { model.addJointAt("a", JointType::kSpherical, 1, 0, {}, 1); }, "joint 'a'", "damping");
  expectMessage([&] { model.addJointAt("a", JointType::kRevolute, 1, 0, {}, -1); }, "joint 'a'", "damping");
  const int ball = model.addJointAt("ball", JointType::kSpherical, 1, 0, {});
  expectMessage([&] { model.addDrive({"motor", ball, 1, true}); }, "motor", "free axis");
  expectMessage([&] { model.addAxisSpring({"torsion", 9, 1, 0, 0, 0}); }, "torsion", "joint index");
  expectMessage([&] { model.bodyIndex("sho 3"); }, "sho 3", "does not exist");
  Model open;
  open.addBody(makeBody("link", 1, kArmInertia, {}));
  open.addJoint({"pin", JointType::kRevolute, kWorld, 0, {{0, 0, 0.01}, {}}, {}, 0});
  expectMessage([&] { const Solver solver(open); }, "joint 'pin'", "gap");
}

TEST(MultibodyErrors, AStepTooLongForTheMotionIsRefusedWithTheBodysName) {
  Mechanism m;
  m.model.addBody(makeBody("rod", 1, kArmInertia, {{1, 0, 0}, {}}));
  m.model.addJointAt("pin", JointType::kRevolute, kWorld, 0, frameWithZ({}, kY));
  m.start();
  m.loads.external[0].force = {0, 0, 1e9};
  Solver solver(m.model);
  try {
    for (int i = 0; i < 10; ++i) solver.step(m.state, m.loads, 1e-2);
    FAIL() << "no error";
  } catch (const base::SimulationError& e) {
    EXPECT_NE(std::string(e.what()).find("body 'rod' turns by"), std::string::npos) << e.what();
  }
}

TEST(MultibodyState, TolerancesThatAreNotGivenAreTheDocumentedOnes) {
  for (const Integrator integrator : {Integrator::kSymplecticEuler, Integrator::kRattle}) {
    const auto stateWith = [&](double tolerance) {
      Mechanism m;
      m.model.addBody(makeBody("rod", 1, kArmInertia, {{1, 0, 0}, {}}));
      m.model.addJointAt("pin", JointType::kRevolute, kWorld, 0, frameWithZ({}, kY));
      m.start();
      SolverOptions options;
      options.integrator = integrator, options.positionTolerance = tolerance;
      Solver solver(m.model, options);
      for (int i = 0; i < 100; ++i) solver.step(m.state, m.loads, 1e-2);
      return m.state.save();
    };
    const double documented = integrator == Integrator::kRattle ? kRattleTolerance : kEulerTolerance;
    EXPECT_EQ(stateWith(0), stateWith(documented));
    EXPECT_NE(stateWith(0), stateWith(100 * documented));
  }
}

TEST(MultibodyErrors, NotANumberIsReportedWithItsPlace) {
  Mechanism m;
  m.model.addBody(makeBody("free", 1, kArmInertia, {}));
  m.start();
  m.loads.external[0].force = {std::numeric_limits<double>::quiet_NaN(), 0, 0};
  Solver solver(m.model);
  EXPECT_THROW(solver.step(m.state, m.loads, 1e-3), base::SimulationError);
}

// Two rods in the y-z plane on ball joints in the world's axes; a drive pulls their end out of reach: no gap opens
// along x.
TEST(MultibodyErrors, ADriveOutOfReachNamesARowThatStaysOpen) {
  for (const Integrator integrator : {Integrator::kSymplecticEuler, Integrator::kRattle}) {
    Mechanism m;
    const Pose elbow{{0, 0.6, 0.8}, {}}, end{{0, 1.2, 0}, {}};
    m.model.addBody(makeBody("upper", 1, kArmInertia, {{0, 0.3, 0.4}, {}}));
    m.model.addBody(makeBody("lower", 1, kArmInertia, {{0, 0.9, 0.4}, {}}));
    m.model.addBody(makeBody("slide", 1, kArmInertia, end));
    m.model.addJointAt("shoulder", JointType::kSpherical, kWorld, 0, {});
    m.model.addJointAt("elbow", JointType::kSpherical, 0, 1, elbow);
    m.model.addJointAt("wrist", JointType::kSpherical, 1, 2, end);
    const int rail = m.model.addJointAt("rail", JointType::kPrismatic, kWorld, 2, frameWithZ(end.position, kY));
    m.model.addDrive({.name = "winch", .joint = rail, .speed = 1});
    m.start();
    m.loads.gravity = {};
    SolverOptions options;
    options.integrator = integrator, options.startVelocities = StartVelocities::kAccept;
    Solver solver(m.model, options);
    try {
      while (m.state.time < 1) solver.step(m.state, m.loads, 1e-2);
      FAIL() << "the rods are only 2 m long";
    } catch (const base::SimulationError& e) {
      const std::string what = e.what();
      EXPECT_GT(m.state.time, 0.7) << what;
      EXPECT_NE(what.find(": translation along "), std::string::npos) << what;
      EXPECT_EQ(what.find("along x"), std::string::npos) << what;
    }
  }
}

} // namespace
} // namespace grouser::multibody::test
