// SPDX-License-Identifier: BSD-3-Clause
// Every column of a mechanism's rows against its closed form, or against the law of the part at the positions
// and velocities of the same row.
#include "runs/output/mechanism_output.hpp"

#include "base/math.hpp"
#include "coupling/mechanism.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/mechanism_setup.hpp"
#include "tests/message_of.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace grouser::output {
namespace {

using base::Vec3d;
using namespace test; // messageOf()

const std::string kHead = "version = 1\n[run]\nduration = 1\ntime_step = 1e-3\n";

/// A scene's mechanism, and its rows by their columns' names.
class Rows {
public:
  explicit Rows(const std::string& scene)
      : setup_(setup::mechanismSetup(setup::parseScene(kHead + scene, "rows.toml"))), mechanism_(setup_, 1e-3) {}

  void advance(int steps) {
    for (int i = 0; i < steps; ++i) mechanism_.advance();
    const Columns<MechanismReading> columns = mechanismColumns(mechanism_.model(), mechanism_.touchingBodies(), {});
    std::vector<double> values;
    columns.append(MechanismReading(mechanism_), values);
    std::size_t at = 0;
    for (const Channel& c : columns.channels()) {
      const auto first = values.begin() + static_cast<std::ptrdiff_t>(at);
      columns_[c.path].assign(first, first + c.width);
      at += static_cast<std::size_t>(c.width);
    }
  }
  double time() const { return mechanism_.state().time; }
  const std::vector<double>& all(const std::string& path) const { return columns_.at(path); }
  double operator()(const std::string& path) const { return all(path).at(0); }
  Vec3d vector(const std::string& path) const { return {all(path).at(0), all(path).at(1), all(path).at(2)}; }
  coupling::Mechanism& mechanism() { return mechanism_; }

private:
  coupling::MechanismSetup setup_;
  coupling::Mechanism mechanism_;
  std::map<std::string, std::vector<double>> columns_;
};

void expectNear(const Vec3d& is, const Vec3d& wanted, double tolerance, const char* what) {
  EXPECT_NEAR(norm(is - wanted), 0, tolerance) << what << ": " << is.x << " " << is.y << " " << is.z << " instead of "
                                               << wanted.x << " " << wanted.y << " " << wanted.z;
}

std::string body(const std::string& name, double mass, const std::string& inertia, const std::string& position,
                 const std::string& more = "") {
  return "[[body]]\nname = \"" + name + "\"\nmass = " + std::to_string(mass) + "\ninertia = " + inertia +
         "\nposition = " + position + "\n" + more;
}

TEST(MechanismColumns, ReactionsAreThoseOnTheSecondBodyAboutTheJoint) {
  Rows rows("gravity = [1, 2, -9.81]\n" + body("a", 2, "[1, 1, 1]", "[0.3, 0, 0.1]") +
            body("b", 5, "[1, 1, 1]", "[0.9, 0.2, -0.4]") +
            "[[joint]]\nname = \"base\"\ntype = \"fixed\"\nbodies = [\"world\", \"a\"]\npoint = [0, 0.1, 0]\n"
            "[[joint]]\nname = \"mid\"\ntype = \"fixed\"\nbodies = [\"a\", \"b\"]\npoint = [0.5, 0, 0]\n");
  rows.advance(1);
  const Vec3d g{1, 2, -9.81}, a{0.3, 0, 0.1}, b{0.9, 0.2, -0.4}, base{0, 0.1, 0}, mid{0.5, 0, 0};
  // Statics; the joints are closed to 1e-10 m and carry 70 N.
  const double tolerance = 1e-7;
  expectNear(rows.vector("joints/mid/force"), g * -5.0, tolerance, "mid force");
  expectNear(rows.vector("joints/mid/torque"), cross(b - mid, g * -5.0), tolerance, "mid torque");
  expectNear(rows.vector("joints/base/force"), g * -7.0, tolerance, "base force");
  expectNear(rows.vector("joints/base/torque"), cross(a - base, g * -2.0) + cross(b - base, g * -5.0), tolerance,
             "base torque");
}

/// A sled of 2 kg on a slope, with all options of an axis.
const std::string kSled =
    "gravity = [0, -9.81, 0]\nsprings = \"explicit\"\n" +
    body("sled", 2, "[1, 1, 1]", "[1, 2, 3]", "velocity = [0.18, 0, 0.24]\n") +
    "[[joint]]\nname = \"rail\"\ntype = \"prismatic\"\nbodies = [\"world\", \"sled\"]\npoint = [1, 2, 3]\n"
    "axis = [0.6, 0, 0.8]\ndamping = 1.5\n"
    "[[spring]]\nname = \"coil\"\njoint = \"rail\"\nstiffness = 50\ndamping = 3\nfree_position = 0.1\npreload = 4\n"
    "[[drive]]\nname = \"pull\"\njoint = \"rail\"\nimposes = \"torque\"\npolynomial = [5, 2]\n";

TEST(MechanismColumns, AnAxisHasPositionRateAndTheForcesAlongIt) {
  Rows rows(kSled);
  const Vec3d axis{0.6, 0, 0.8};
  rows.advance(199);
  const double rateBefore = rows("joints/rail/rate");
  rows.advance(1);
  const double q = dot(rows.vector("bodies/sled/position") - Vec3d{1, 2, 3}, axis),
               v = dot(rows.vector("bodies/sled/velocity"), axis), t = 0.2;
  const double along = rows("joints/rail/force_along");
  ASSERT_GT(std::fabs(v), 0.2);
  EXPECT_NEAR(rows("joints/rail/position"), q, 1e-10) << "the joint's tolerance";
  EXPECT_NEAR(rows("joints/rail/rate"), v, 1e-10);
  EXPECT_NEAR(rows("springs/coil/force"), 4 - 50 * (q - 0.1) - 3 * v, 1e-8);
  EXPECT_NEAR(rows("drives/pull/value"), 5 + 2 * t, 1e-12);
  EXPECT_NEAR(rows("drives/pull/torque"), 5 + 2 * t, 1e-12);
  EXPECT_NEAR(rows("drives/pull/power"), (5 + 2 * t) * v, 1e-9);
  // A step of 1 ms changes the damping loss by less than 4.5 N s/m x 6 m/s2 x 1e-3 s.
  EXPECT_NEAR(along, 4 - 50 * (q - 0.1) - 4.5 * v + 5 + 2 * t, 0.03);
  rows.advance(1);
  EXPECT_NEAR((rows("joints/rail/rate") - rateBefore) / 2e-3, along / 2, 0.02) << "half a step's change of 2 m/s2";
  const double now = rows("joints/rail/force_along");
  expectNear(rows.vector("joints/rail/force"), axis * now + Vec3d{0, 2 * 9.81, 0}, 1e-8, "rail force");
}

TEST(MechanismColumns, SledFollowsTheClosedFormOfADampedSwing) {
  Rows rows(kSled);
  rows.advance(700);
  // 2 q'' + 4.5 q' + 50 q = 4 + 50 x 0.1 + 5 + 2 t: the particular solution (14 + 2 t - 4.5 x 2 / 50) / 50 and the
  // swing that fits q = 0, q' = 0.3 at the start. Order 2: error some (omega dt)^2 / 24 of 0.3 m.
  const double k = 25, c = 2.25, w = std::sqrt(k - c * c / 4), t = 0.7;
  const double p0 = (14 - 4.5 * 2 / 50) / 50, p1 = 2.0 / 50, A = -p0, B = (0.3 - p1 + c / 2 * A) / w;
  const double e = base::exp(-c / 2 * t), cosine = base::cos(w * t), sine = base::sin(w * t);
  EXPECT_NEAR(rows("joints/rail/position"), p0 + p1 * t + e * (A * cosine + B * sine), 2e-6);
}

TEST(MechanismColumns, ADriveOfPositionSaysWhatItImposesTakesAndGives) {
  Rows rows("gravity = [0, 0, 0]\n" +
            body("rotor", 3, "[0.3, 0.4, 0.5]", "[0.4, 0, 0]", "velocity = [0, 0.12, 0]\nspin = [0, 0, 0.3]\n") +
            "[[joint]]\nname = \"axle\"\nbodies = [\"world\", \"rotor\"]\npoint = [0, 0, 0]\naxis = [0, 0, 1]\n"
            "damping = 0.8\n[[drive]]\nname = \"motor\"\njoint = \"axle\"\nimposes = \"position\"\n"
            "polynomial = [0, 0.3, 0.7]\n");
  rows.advance(500);
  const double t = 0.5, rate = 0.3 + 1.4 * t, inertia = 0.5 + 3 * 0.4 * 0.4, torque = inertia * 1.4 + 0.8 * rate;
  EXPECT_NEAR(rows("drives/motor/value"), 0.3 * t + 0.7 * t * t, 1e-12);
  EXPECT_NEAR(rows("joints/axle/position"), 0.3 * t + 0.7 * t * t, 1e-9);
  EXPECT_NEAR(rows("joints/axle/rate"), rate, 1e-9);
  // Order 2: the discrete rotor's acceleration differs by (rate dt)^2 / 12 or so of itself.
  EXPECT_NEAR(rows("drives/motor/torque"), torque, 2e-3 * torque);
  EXPECT_NEAR(rows("drives/motor/power"), rows("drives/motor/torque") * rate, 1e-8);
  EXPECT_NEAR(rows("joints/axle/force_along"), inertia * 1.4, 2e-3 * torque) << "drive less damping";
  // Forces that hold the rotor on its circle and accelerate it: m (alpha d, omega^2 d).
  const double phi = 0.3 * t + 0.7 * t * t;
  const Vec3d radial{base::cos(phi), base::sin(phi), 0}, ahead{-base::sin(phi), base::cos(phi), 0};
  expectNear(rows.vector("joints/axle/force"), ahead * (3 * 1.4 * 0.4) - radial * (3 * rate * rate * 0.4), 5e-3,
             "force of the axle");
  EXPECT_NEAR(rows.all("bodies/rotor/spin")[2], rate, 1e-9);
  EXPECT_NEAR(rows.all("bodies/rotor/orientation")[0], base::cos(phi / 2), 1e-9);
  EXPECT_NEAR(rows.all("bodies/rotor/orientation")[3], base::sin(phi / 2), 1e-9);
}

TEST(MechanismColumns, ABearingHoldsARotorThatIsOutOfBalance) {
  // Its principal axes lean by 30 degrees about y: I_xz = (0.4 - 0.3) sin cos, and the bearing gives omega x I omega.
  Rows rows("gravity = [0, 0, 0]\n" +
            body("rotor", 3, "[0.3, 0.5, 0.4]", "[0, 0, 0]", "axis = [0, 1, 0]\nangle = 30\nspin = [0, 0, 10]\n") +
            "[[joint]]\nname = \"axle\"\nbodies = [\"world\", \"rotor\"]\npoint = [0, 0, 0]\naxis = [0, 0, 1]\n"
            "[[drive]]\nname = \"motor\"\njoint = \"axle\"\nimposes = \"speed\"\nvalue = 10\n");
  rows.advance(100);
  const double size = 100 * 0.1 * base::sin(base::kPi / 6) * base::cos(base::kPi / 6), phi = 1;
  // Order 2, 0.01 rad a step.
  expectNear(rows.vector("joints/axle/torque"), {-size * base::sin(phi), size * base::cos(phi), 0}, 2e-3 * size,
             "torque of the axle");
  expectNear(rows.vector("joints/axle/force"), {}, 1e-9, "force of the axle");
}

TEST(MechanismColumns, APointSpringPushesApartByItsOwnLaw) {
  Rows rows("gravity = [0, 0, 0]\nsprings = \"explicit\"\n" +
            body("a", 1, "[1, 1, 1]", "[0, 0, 0]", "velocity = [0.2, 0.1, 0]\n") +
            body("b", 3, "[1, 1, 1]", "[1, 0.5, 0.2]", "velocity = [-0.4, 0.3, 0.5]\n") +
            "[[spring]]\nname = \"coil\"\nbodies = [\"a\", \"b\"]\npoint_a = [0, 0, 0]\npoint_b = [0, 0, 0]\n"
            "stiffness = 40\ndamping = 2\nfree_position = 0.9\npreload = 7\n");
  rows.advance(150);
  const Vec3d apart = rows.vector("bodies/b/position") - rows.vector("bodies/a/position");
  const Vec3d v = rows.vector("bodies/b/velocity") - rows.vector("bodies/a/velocity");
  const double length = norm(apart);
  EXPECT_NEAR(rows("springs/coil/length"), length, 1e-12);
  // The damper's contribution refers to the middle of a step: 2 N s/m x 30 m/s2 x 1e-3 s.
  EXPECT_NEAR(rows("springs/coil/force"), 7 - 40 * (length - 0.9) - 2 * dot(v, apart) / length, 0.06);
  ASSERT_GT(std::fabs(dot(v, apart)), 0.1);
  // Momentum of both, which no spring changes, and angular momentum about the origin: neither body rotates.
  expectNear(rows.vector("momentum/linear"), {0.2 - 1.2, 0.1 + 0.9, 1.5}, 1e-12, "momentum");
  expectNear(rows.vector("momentum/angular"), cross(Vec3d{1, 0.5, 0.2}, Vec3d{-1.2, 0.9, 1.5}), 1e-12, "about origin");
}

TEST(MechanismColumns, ABushingIsReadInTheAxesOfItsFirstBody) {
  const double turning = 2;
  // The first body is heavy and turns steadily; the second one has been pushed.
  Rows rows("gravity = [0, 0, 0]\nsprings = \"explicit\"\n" +
            body("heavy", 1e9, "[1e9, 1e9, 1e9]", "[1, 0, 0]", "spin = [0, 0, 2]\n") +
            body("light", 2, "[0.5, 0.6, 0.7]", "[1, 0, 0]", "velocity = [0.3, -0.2, 0.5]\nspin = [0, 0, 3.5]\n") +
            "[[bushing]]\nname = \"rubber\"\nbodies = [\"heavy\", \"light\"]\npoint = [1, 0, 0]\n"
            "stiffness = [100, 200, 400]\ndamping = [0, 0, 0]\nrotation_stiffness = [3, 5, 8]\n"
            "rotation_damping = [0, 0, 0]\n");
  rows.advance(80);
  const double phi = turning * 0.08, c = base::cos(phi), s = base::sin(phi);
  const Vec3d apart = rows.vector("bodies/light/position") - Vec3d{1, 0, 0};
  const Vec3d d{c * apart.x + s * apart.y, -s * apart.x + c * apart.y, apart.z};
  const Vec3d f{-100 * d.x, -200 * d.y, -400 * d.z};
  ASSERT_GT(std::fabs(d.y), 0.005);
  expectNear(rows.vector("bushings/rubber/translation"), d, 1e-9, "translation");
  expectNear(rows.vector("bushings/rubber/force"), {c * f.x - s * f.y, s * f.x + c * f.y, f.z}, 1e-6, "force");
  // Both turn about z; the bearing twists by the difference.
  const std::vector<double>& q = rows.all("bodies/light/orientation");
  const double twist = 2 * base::atan2(q[3], q[0]) - phi;
  ASSERT_GT(twist, 0.05);
  expectNear(rows.vector("bushings/rubber/rotation"), {0, 0, twist}, 1e-9, "rotation");
  expectNear(rows.vector("bushings/rubber/torque"), {0, 0, -8 * twist}, 1e-7, "torque");
}

TEST(MechanismColumns, ABushingIsAtRestWhereItsBodiesStandAtTheStart) {
  Rows rows("gravity = [0, 0, 0]\nsprings = \"explicit\"\n" + body("a", 1, "[1, 1, 1]", "[0, 0, 0]") +
            body("b", 2, "[1, 1, 1]", "[0.3, 0.4, 0]", "axis = [0, 0, 1]\nangle = 40\n") +
            "[[bushing]]\nname = \"rubber\"\nbodies = [\"a\", \"b\"]\npoint = [0.1, 0, 0]\n"
            "stiffness = [100, 200, 400]\nrotation_stiffness = [3, 5, 8]\n"
            "[[spring]]\nname = \"coil\"\nbodies = [\"a\", \"b\"]\npoint_a = [0, 0, 0]\npoint_b = [0, 0, 0]\n"
            "stiffness = 40\n");
  rows.advance(20);
  expectNear(rows.vector("bushings/rubber/translation"), {}, 1e-12, "translation");
  expectNear(rows.vector("bushings/rubber/rotation"), {}, 1e-12, "rotation");
  expectNear(rows.vector("bushings/rubber/force"), {}, 1e-9, "force");
  EXPECT_NEAR(rows("springs/coil/length"), 0.5, 1e-12);
  EXPECT_NEAR(rows("springs/coil/force"), 0, 1e-9) << "without free_position the spring is relaxed at the start";
}

TEST(MechanismColumns, ACouplingsForceIsWhatTurnsTheSecondAxis) {
  Rows rows("gravity = [0, 0, 0]\n" + body("pinion", 1, "[0.2, 0.2, 0.3]", "[0, 0, 0]") +
            body("gear", 1, "[0.4, 0.4, 0.7]", "[1, 0, 0]") +
            "[[joint]]\nname = \"first\"\nbodies = [\"world\", \"pinion\"]\npoint = [0, 0, 0]\naxis = [0, 0, 1]\n"
            "[[joint]]\nname = \"second\"\nbodies = [\"world\", \"gear\"]\npoint = [1, 0, 0]\naxis = [0, 0, 1]\n"
            "[[coupling]]\nname = \"teeth\"\njoints = [\"first\", \"second\"]\nratio = -1.5\n"
            "[[drive]]\nname = \"motor\"\njoint = \"first\"\nimposes = \"torque\"\nvalue = 2\n"
            "[[drive]]\nname = \"brake\"\njoint = \"second\"\nimposes = \"torque\"\nvalue = 0.25\n");
  rows.advance(100);
  // tau1 + n tau2 = (I1 + n^2 I2) alpha1.
  const double n = -1.5, alpha = (2 + n * 0.25) / (0.3 + n * n * 0.7), t = 0.1;
  EXPECT_NEAR(rows("couplings/teeth/force"), 0.7 * n * alpha - 0.25, 1e-9);
  EXPECT_NEAR(rows("joints/first/rate"), alpha * t, 1e-9);
  EXPECT_NEAR(rows("joints/second/rate"), n * alpha * t, 1e-9);
  EXPECT_NEAR(rows("joints/second/position"), n * 0.5 * alpha * t * t, 1e-9);
  EXPECT_NEAR(rows("drives/motor/power"), 2 * alpha * t, 1e-9);
  EXPECT_NEAR(rows("drives/brake/torque"), 0.25, 1e-12);
  EXPECT_NEAR(rows("drives/brake/power"), 0.25 * n * alpha * t, 1e-9);
}

TEST(MechanismColumns, ACylindricalsAngleAndSlideAreTwoAxes) {
  Rows rows("gravity = [0, 0, 0]\n" +
            body("bolt", 2, "[0.2, 0.2, 0.3]", "[0, 0, 0]", "velocity = [0, 0, 0.5]\nspin = [0, 0, -4]\n") +
            "[[joint]]\nname = \"hole\"\ntype = \"cylindrical\"\nbodies = [\"world\", \"bolt\"]\npoint = [0, 0, 0]\n"
            "axis = [0, 0, 1]\ndamping = 0.6\nslide_damping = 1.6\n");
  rows.advance(200);
  // Each decays independently: exp(-c t / I) and exp(-c t / m), of order 2 in 1e-3 s.
  const double turn = -4 * base::exp(-0.6 * 0.2 / 0.3), slide = 0.5 * base::exp(-1.6 * 0.2 / 2);
  EXPECT_NEAR(rows("joints/hole/angle_rate"), turn, 1e-5);
  EXPECT_NEAR(rows("joints/hole/slide_rate"), slide, 1e-6);
  EXPECT_NEAR(rows("joints/hole/angle_position"), (turn + 4) * -0.3 / 0.6, 1e-5);
  EXPECT_NEAR(rows("joints/hole/slide_position"), (0.5 - slide) * 2 / 1.6, 1e-6);
  // Values refer to the middle of the last step: half of 1e-3 s times c / I or c / m.
  EXPECT_NEAR(rows("joints/hole/angle_force_along"), -0.6 * turn, 2e-3 * 1.7);
  EXPECT_NEAR(rows("joints/hole/slide_force_along"), -1.6 * slide, 1e-3 * 0.7);
  EXPECT_NEAR(rows.all("joints/hole/torque")[2], -0.6 * turn, 2e-3 * 1.7);
  EXPECT_NEAR(rows.all("joints/hole/force")[2], -1.6 * slide, 1e-3 * 0.7);
}

TEST(MechanismColumns, MomentaTurnTheInertiaWithTheBody) {
  // The second one's x axis points along the world's y: the axis of its largest moment, too.
  Rows rows("gravity = [0, 0, 0]\n" + body("a", 2, "[3, 4, 5]", "[1, 0, 0]", "velocity = [0, 3, 0]\n") +
            body("b", 4, "[9, 2, 8]", "[0, 2, 1]",
                 "velocity = [1, 0, -1]\nspin = [0, 0.5, 0]\naxis = [0, 0, 1]\nangle = 90\n"));
  rows.advance(0);
  expectNear(rows.vector("momentum/linear"), {4, 6, -4}, 1e-14, "linear");
  // (1,0,0) x (0,6,0) + (0,2,1) x (4,0,-4) + (0, 9 x 0.5, 0)
  expectNear(rows.vector("momentum/angular"), {-8, 4 + 4.5, 6 - 8}, 1e-13, "angular");
  EXPECT_NEAR(rows.mechanism().bodiesBalance().now.kinetic, 0.5 * 2 * 9 + 0.5 * 4 * 2 + 0.5 * 9 * 0.25, 1e-13);
}

TEST(MechanismColumns, HowWellTheJointsCloseIsOfTheStepsSinceTheLastRow) {
  Rows rows("gravity = [0, 0, -9.81]\n" + body("bob", 1, "[1, 1, 1]", "[1, 0, 0]") +
            "[[joint]]\nname = \"pin\"\nbodies = [\"world\", \"bob\"]\npoint = [0, 0, 0]\naxis = [0, 1, 0]\n");
  rows.advance(100);
  EXPECT_GE(rows("constraints/iterations"), 1);
  EXPECT_LT(rows("constraints/position_error"), 1e-9);
  EXPECT_LT(rows("constraints/velocity_error"), 1e-9);
  EXPECT_EQ(rows("constraints/singular_steps"), 0);
  rows.mechanism().restartMeans();
  rows.advance(0);
  EXPECT_EQ(rows("constraints/iterations"), 0);
  EXPECT_EQ(rows("constraints/position_error"), 0);
}

TEST(MechanismColumns, VelocityErrorIsHowFastJointsOpenNow) {
  // After a step of symplectic Euler the twist is the mean over the step that led to the pose: half a step behind it,
  // omega^2 L dt / 2 at the pin, in one or two of its axes.
  Rows rows("gravity = [0, 0, 0]\nintegrator = \"symplectic_euler\"\n" +
            body("bar", 1, "[1, 1, 1]", "[1, 0, 0]", "velocity = [0, 2, 0]\nspin = [0, 0, 2]\n") +
            "[[joint]]\nname = \"pin\"\nbodies = [\"world\", \"bar\"]\npoint = [0, 0, 0]\naxis = [0, 0, 1]\n");
  rows.advance(100);
  EXPECT_GT(rows("constraints/velocity_error"), 0.7 * 2e-3);
  EXPECT_LT(rows("constraints/velocity_error"), 1.01 * 2e-3);
  EXPECT_LT(rows("constraints/position_error"), 1e-9);
}

TEST(MechanismColumns, IterationsAreTheMostOfAnyStepSinceTheLastRow) {
  // A bar stopped by a brake: the first steps turn by 0.2 rad and need more iterations than the last.
  const std::string scene = "gravity = [0, 0, 0]\n" +
                            body("bar", 1, "[1, 1, 1]", "[1, 0, 0]", "velocity = [0, 200, 0]\nspin = [0, 0, 200]\n") +
                            "[[joint]]\nname = \"pin\"\nbodies = [\"world\", \"bar\"]\npoint = [0, 0, 0]\n"
                            "axis = [0, 0, 1]\ndamping = 20\n";
  Rows whole(scene), steps(scene);
  double most = 0;
  for (int n = 0; n < 800; ++n) {
    steps.mechanism().restartMeans();
    steps.advance(1);
    most = std::max(most, steps("constraints/iterations"));
  }
  ASSERT_GT(most, steps("constraints/iterations"));
  whole.advance(800);
  EXPECT_EQ(whole("constraints/iterations"), most);
}

TEST(MechanismColumns, ACouplingWithAnOffsetThatIsNotMetIsRefused) {
  const auto geared = [](const std::string& offset) {
    return kHead + "gravity = [0, 0, 0]\n" + body("pinion", 1, "[0.2, 0.2, 0.3]", "[0, 0, 0]") +
           body("gear", 1, "[0.4, 0.4, 0.7]", "[1, 0, 0]") +
           "[[joint]]\nname = \"first\"\nbodies = [\"world\", \"pinion\"]\npoint = [0, 0, 0]\naxis = [0, 0, 1]\n"
           "[[joint]]\nname = \"second\"\nbodies = [\"world\", \"gear\"]\npoint = [1, 0, 0]\naxis = [0, 0, 1]\n"
           "[[coupling]]\nname = \"teeth\"\njoints = [\"first\", \"second\"]\nratio = 2\noffset = " +
           offset + "\n";
  };
  EXPECT_NO_THROW(setup::parseScene(geared("0"), "geared.toml"));
  EXPECT_EQ(messageOf([&] {
              setup::parseScene(geared("0.3"), "geared.toml");
            }).rfind("geared.toml:26: coupling.0 (\"teeth\"): has a gap of -0.3 ", 0),
            0u);
}

} // namespace
} // namespace grouser::output
