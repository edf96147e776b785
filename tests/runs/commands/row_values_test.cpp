// SPDX-License-Identifier: BSD-3-Clause
// Output of a run of grains and surfaces against closed forms: rows, frames, grains.csv and manifest.
#include "base/math.hpp"
#include "base/sphere.hpp"
#include "base/vec.hpp"
#include "runs/support/hdf5_file.hpp"
#include "tests/runs/csv_fixture.hpp"
#include "tests/runs/program_fixture.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <thread>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

using base::Vec3d;

const std::string kBare = "[output]\nplots = false\npicture = false\n";

class RowValues : public ProgramTest {
protected:
  /// Runs `scene`; its results are in r.
  void run(const std::string& scene, const std::string& words = "") const {
    put(folder_ / "scene.toml", "version = 1\n" + scene);
    const Outcome o = call("run scene.toml --out r" + words);
    ASSERT_EQ(o.code, 0) << o.errors;
  }
  support::Hdf5File results() const { return support::Hdf5File::open(folder_ / "r" / "results.h5"); }
  std::vector<double> series(const std::string& path) const { return results().numbers("/" + path + "/value"); }
};

struct Thrown {
  Vec3d position, velocity, spin;
  double radius;
};
const std::array<Thrown, 3> kThrown = {Thrown{{0.1, 0.2, 0.3}, {1, -2, 3}, {5, 6, -7}, 0.01},
                                       {{-0.5, 0.7, 0.9}, {0.5, 0.25, -1}, {0, -8, 9}, 0.02},
                                       {{1.5, -0.4, 2}, {-3, 0.125, 0.75}, {1, 2, 3}, 0.03}};
const Vec3d kGravity{0.5, -0.25, -9.81};
constexpr double kStep = 1e-4;

std::string thrownScene() {
  std::string text = "[run]\nduration = 0.05\ntime_step = 1e-4\noutput_interval = 0.01\nframe_interval = 0.025\n"
                     "gravity = [0.5, -0.25, -9.81]\n[material.glass]\nstiffness = 1e4\n";
  const auto vec = [](const Vec3d& v) { return fmt::format("[{}, {}, {}]\n", v.x, v.y, v.z); };
  for (const Thrown& t : kThrown)
    text += fmt::format("[[grain]]\nposition = {}velocity = {}spin = {}radius = {}\nmaterial = \"glass\"\n",
                        vec(t.position), vec(t.velocity), vec(t.spin), t.radius);
  return text + kBare + "contact_forces = true\n";
}

/// Symplectic Euler in free flight: v_n = v + n g dt, x_n = x + n v dt + n (n + 1) / 2 g dt^2.
Vec3d placeOf(const Thrown& t, int n) {
  return t.position + t.velocity * (n * kStep) + kGravity * (0.5 * n * (n + 1) * kStep * kStep);
}
Vec3d velocityOf(const Thrown& t, int n) { return t.velocity + kGravity * (n * kStep); }

TEST_F(RowValues, GrainsCsvHasEachGrainWhereItFlies) {
  run(thrownScene());
  const Csv csv(folder_ / "r" / "grains.csv");
  ASSERT_EQ(csv.rows.size(), 6u * 3);
  for (std::size_t r = 0; r < csv.rows.size(); ++r) {
    const int n = 100 * static_cast<int>(r / 3);
    const Thrown& t = kThrown[r % 3];
    EXPECT_EQ(csv.number(r, "step"), n);
    EXPECT_NEAR(csv.number(r, "time [s]"), n * kStep, 1e-15);
    EXPECT_EQ(csv.number(r, "id"), static_cast<double>(r % 3));
    EXPECT_NEAR(csv.number(r, "radius [m]"), t.radius, 1e-8); // a float
    const Vec3d p = placeOf(t, n), v = velocityOf(t, n);
    for (int a = 0; a < 3; ++a) {
      const std::string axis(1, "xyz"[a]);
      // Positions are whole units of 1e-8 of a diameter or so, with remainders; velocities and spins are floats.
      EXPECT_NEAR(csv.number(r, "position." + axis + " [m]"), p[a], 2e-8);
      EXPECT_NEAR(csv.number(r, "velocity." + axis + " [m/s]"), v[a], 4e-7);
      EXPECT_NEAR(csv.number(r, "spin." + axis + " [rad/s]"), t.spin[a], 1e-6);
    }
  }
}

TEST_F(RowValues, FramesHaveEachGrainWhereItFlies) {
  run(thrownScene());
  const support::Hdf5File file = support::Hdf5File::open(folder_ / "r" / "frames.h5");
  for (int f = 0; f < 3; ++f) {
    const std::string group = "/00000" + std::to_string(f), at = group + "/grains/";
    const int n = 250 * f;
    EXPECT_EQ(file.number(group, "step"), n);
    EXPECT_NEAR(file.number(group, "time"), n * kStep, 1e-15);
    const auto position = file.numbers(at + "position"), velocity = file.numbers(at + "velocity"),
               speed = file.numbers(at + "speed"), radius = file.numbers(at + "radius"), id = file.numbers(at + "id"),
               force = file.numbers(at + "contact_force");
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d p = placeOf(kThrown[i], n), v = velocityOf(kThrown[i], n);
      EXPECT_EQ(id[i], static_cast<double>(i));
      EXPECT_NEAR(radius[i], kThrown[i].radius, 1e-8);
      EXPECT_NEAR(speed[i], norm(v), 1e-6);
      for (int a = 0; a < 3; ++a) {
        EXPECT_NEAR(position[3 * i + static_cast<std::size_t>(a)], p[a], 2e-7);
        EXPECT_NEAR(velocity[3 * i + static_cast<std::size_t>(a)], v[a], 4e-7);
        if (f > 0) {
          // Computed from the change of a float's speed over a step of 1e-4 s; the weights are 0.1 to 2.8 N.
          EXPECT_NEAR(force[3 * i + static_cast<std::size_t>(a)], 0, 1e-3) << "weight is not a contact force";
        }
      }
    }
  }
  EXPECT_TRUE(std::isnan(file.numbers("/000000/grains/contact_force")[0])) << "before the first step";
}

TEST_F(RowValues, FastestGrainIsThatOfTheRow) {
  run(thrownScene());
  const std::vector<double> speed = series("terrain/max_speed"), time = results().numbers("/series/time"),
                            step = results().numbers("/series/step");
  ASSERT_EQ(speed.size(), 6u);
  for (std::size_t r = 0; r < 6; ++r) {
    double fastest = 0;
    for (const Thrown& t : kThrown) fastest = std::max(fastest, norm(velocityOf(t, 100 * static_cast<int>(r))));
    EXPECT_NEAR(speed[r], fastest, 1e-6);
    EXPECT_EQ(step[r], 100.0 * static_cast<double>(r));
    EXPECT_NEAR(time[r], 0.01 * static_cast<double>(r), 1e-15);
  }
  EXPECT_EQ(series("terrain/contacts"), std::vector<double>(6, 0));
}

/// Three balls in line, the middle one overlaps both neighbours, and a pair beside them; no gravity.
const std::string kPressed = "[run]\nduration = 1e-6\ntime_step = 1e-6\noutput_interval = 1e-6\ngravity = [0, 0, 0]\n"
                             "[material.glass]\nstiffness = 1e4\n"
                             "[[grain]]\nposition = [0, 0, 0]\nradius = 0.01\nmaterial = \"glass\"\n"
                             "[[grain]]\nposition = [0.0299, 0, 0]\nradius = 0.02\nmaterial = \"glass\"\n"
                             "[[grain]]\nposition = [0.0597, 0, 0]\nradius = 0.01\nmaterial = \"glass\"\n"
                             "[[grain]]\nposition = [0, 1, 0]\nradius = 0.01\nmaterial = \"glass\"\n"
                             "[[grain]]\nposition = [0, 1.01995, 0]\nradius = 0.01\nmaterial = \"glass\"\n" +
                             kBare + "contact_forces = true\n";

TEST_F(RowValues, OverlapIsThatOfTheDeepestContactInRadiiOfTheLargestGrain) {
  run(kPressed);
  const std::vector<double> overlap = series("terrain/max_overlap"), contacts = series("terrain/contacts");
  // 0.1 mm, 0.2 mm and 0.05 mm; a step of 1 us moves a grain of 10 g by 1e-10 m. Positions are whole units of 4e-10 m.
  EXPECT_NEAR(overlap.back(), 0.0002 / 0.02, 1e-6);
  EXPECT_EQ(contacts.back(), 3);
  // F = k overlap, dashpots at rest; the middle one has both contacts.
  const support::Hdf5File file = support::Hdf5File::open(folder_ / "r" / "frames.h5");
  const std::vector<double> force = file.numbers("/000001/grains/contact_force");
  const double tolerance = 2e-4;
  EXPECT_NEAR(force[0], -1, tolerance);
  EXPECT_NEAR(force[3], 1 - 2, tolerance);
  EXPECT_NEAR(force[6], 2, tolerance);
  EXPECT_NEAR(force[10], -0.5, tolerance);
  EXPECT_NEAR(force[13], 0.5, tolerance);
}

/// Two smooth boxes, each under its own grain: one rises steadily, one is shaken.
const std::string kLifts = R"([run]
duration = 0.3
time_step = 2e-5
output_interval = 0.013
[material.glass]
stiffness = 1e5
restitution = 0.3
[[box]]
name = "lift"
position = [0, 0, -0.01]
size = [0.2, 0.2, 0.02]
velocity = [0, 0, 0.2]
material = "glass"
[[box]]
name = "shaker"
position = [1, 0, -0.01]
size = [0.2, 0.2, 0.02]
amplitude = [0, 0, 1e-3]
frequency = 10
phase = -90
material = "glass"
[[grain]]
position = [0.03, -0.02, 0.01]
velocity = [0, 0, 0.2]
radius = 0.01
material = "glass"
[[grain]]
position = [1.01, 0.04, 0.01]
radius = 0.01
material = "glass"
)" + kBare;

TEST_F(RowValues, ForceAndTorqueOnASurfaceAreMeansSinceTheLastRow) {
  run(kLifts);
  const Csv grains(folder_ / "r" / "grains.csv");
  const std::vector<double> time = results().numbers("/series/time");
  const double mass = base::sphereMass(2500, 0.01);
  for (std::size_t which = 0; which < 2; ++which) {
    const std::string group = which == 0 ? "surfaces/lift/" : "surfaces/shaker/";
    const std::vector<double> force = series(group + "force"), torque = series(group + "torque");
    const Vec3d arm = which == 0 ? Vec3d{0.03, -0.02, 0} : Vec3d{0.01, 0.04, 0};
    double least = 0, most = 0;
    for (std::size_t r = 1; r < time.size(); ++r) {
      // The impulse on the grain is its change of momentum minus gravity's impulse; the surface receives the opposite.
      const double v0 = grains.number(2 * (r - 1) + which, "velocity.z [m/s]"),
                   v1 = grains.number(2 * r + which, "velocity.z [m/s]"), span = time[r] - time[r - 1];
      const double mean = -mass * ((v1 - v0) / span + 9.81);
      // Velocities are floats: a row's difference over 13 ms is accurate to 1e-5 m/s2.
      EXPECT_NEAR(force[3 * r + 2], mean, 1e-4 * mass * 9.81) << group << r;
      EXPECT_NEAR(force[3 * r], 0, 1e-9);
      EXPECT_NEAR(torque[3 * r], arm.y * force[3 * r + 2], 1e-9) << group << r;
      EXPECT_NEAR(torque[3 * r + 1], -arm.x * force[3 * r + 2], 1e-9) << group << r;
      EXPECT_NEAR(torque[3 * r + 2], 0, 1e-12);
      if (r > 10) least = std::min(least, mean), most = std::max(most == 0 ? mean : most, mean);
    }
    EXPECT_LT(least, -mass * 9.8);
    if (which == 1) {
      EXPECT_GT(most - least, mass * 3) << "the shaken one's force changes";
    }
  }
}

TEST_F(RowValues, PowerIsOfWhatMovesASurfaceAndPositionOfItsCentre) {
  run(kLifts);
  const std::vector<double> time = results().numbers("/series/time"), force = series("surfaces/lift/force"),
                            power = series("surfaces/lift/power"), place = series("surfaces/lift/position"),
                            shaken = series("surfaces/shaker/position");
  double lifted = 0;
  for (std::size_t r = 1; r < time.size(); ++r) {
    EXPECT_NEAR(power[r], -0.2 * force[3 * r + 2], 1e-9) << "it lifts the load";
    lifted += power[r] * (time[r] - time[r - 1]);
    EXPECT_NEAR(place[3 * r], 0, 1e-15);
    EXPECT_NEAR(place[3 * r + 2], -0.01 + 0.2 * time[r], 1e-12);
    EXPECT_NEAR(shaken[3 * r], 1, 1e-15);
    // Its initial position follows from the phase of the sine: -0.01.
    EXPECT_NEAR(shaken[3 * r + 2], -0.01 + 1e-3 * (1 - base::cos(20 * base::kPi * time[r])), 1e-9);
  }
  const double mass = base::sphereMass(2500, 0.01);
  EXPECT_NEAR(lifted, mass * 9.81 * 0.2 * 0.3, 5e-3 * mass * 9.81 * 0.06) << "the grain's height at the end";
}

TEST_F(RowValues, ATurningSurfaceIsGivenTorqueTimesSpin) {
  // A rotating wheel below a grain held by a smooth stop: friction brakes the wheel until the grain rolls, after 15 ms.
  run(R"([run]
duration = 0.01
time_step = 1e-5
output_interval = 0.0025
[material.glass]
stiffness = 1e5
restitution = 0.3
friction = 0.4
[material.slick]
stiffness = 1e5
restitution = 0.3
friction = 0
[contact."glass|slick"]
friction = 0
[[cylinder]]
name = "wheel"
position = [0, 0, -0.05]
axis = [0, 1, 0]
radius = 0.05
length = 0.1
spin = [0, 3, 0]
material = "glass"
[[plane]]
name = "stop"
point = [0.01, 0, 0]
normal = [-1, 0, 0]
material = "slick"
[[grain]]
position = [0, 0, 0.00999897]
radius = 0.01
material = "glass"
)" + kBare);
  const std::vector<double> force = series("surfaces/wheel/force"), torque = series("surfaces/wheel/torque"),
                            power = series("surfaces/wheel/power"), stop = series("surfaces/stop/force");
  const std::size_t r = power.size() - 1;
  // The wheel's top moves forward (+x) and is braked there, 50 mm above its axle.
  EXPECT_NEAR(force[3 * r], 0.4 * force[3 * r + 2], 1e-2 * std::fabs(force[3 * r]));
  ASSERT_LT(force[3 * r], -0.03);
  EXPECT_NEAR(torque[3 * r + 1], 0.05 * force[3 * r], 2e-3 * 0.05 * std::fabs(force[3 * r])) << "z x F = y";
  EXPECT_NEAR(power[r], -3 * torque[3 * r + 1], 1e-12) << "3 rad/s about y";
  EXPECT_GT(power[r], 0);
  EXPECT_GT(stop[3 * r], 0) << "the stop is pushed forward";
}

TEST_F(RowValues, ResultsOfAVehicleHaveItsConstantsAndWhereItStands) {
  const std::string scene = std::string(GROUSER_SOURCE_DIR) + "/tests/scenes/rigid.toml";
  const Outcome o =
      call("run " + scene + " --out r --steps 20 --set vehicle.sphere_radius=0.04 --set " +
           "run.output_interval=1e-3 --set 'vehicle.position=[2, 0.1]' --set output.picture=false --set " +
           "output.plots=false --set output.frames=false");
  ASSERT_EQ(o.code, 0) << o.errors;
  // Ten teeth of 154 mm a turn; the vehicle's masses as its file has them.
  EXPECT_NEAR(results().numbers("/vehicle/pitch_radius")[0], 1.54 / (2 * base::kPi), 1e-12);
  EXPECT_NEAR(results().numbers("/vehicle/mass")[0], 5018, 1e-9);
  const std::vector<double> position = series("vehicle/position"), heading = series("vehicle/heading");
  ASSERT_EQ(position.size(), 9u) << "at 0, 1 and 2 ms";
  EXPECT_NEAR(position[0], 2, 1e-9);
  EXPECT_NEAR(position[1], 0.1, 1e-9);
  EXPECT_NEAR(heading[0], 0, 1e-9);
}

TEST_F(RowValues, ManifestHasTheRunsOwnFigures) {
  run(thrownScene(), " --hash --steps 300 --set run.seed=3"); // out of 500
  const nlohmann::json json = nlohmann::json::parse(contents(folder_ / "r" / "manifest.json"));
  EXPECT_EQ(json["status"], "finished");
  EXPECT_EQ(json["steps"], 300);
  EXPECT_NEAR(json["simulated_time_s"].get<double>(), 0.03, 1e-12);
  EXPECT_EQ(json["overrides"], nlohmann::json::array({"run.seed=3"}));
  EXPECT_EQ(json["state_hash"].get<std::string>().size(), 16u);
  const nlohmann::json& f = json["figures"];
  const double wall = json["wall_time_s"].get<double>(), steps = f["wall_steps_s"].get<double>();
  EXPECT_NEAR(f["microseconds_a_step"].get<double>(), 1e6 * steps / 300, 1e-6 * f["microseconds_a_step"].get<double>());
  EXPECT_GE(wall, steps + f["wall_preparation_s"].get<double>());
  const double cpu = f["cpu_steps_s"].get<double>(), threads = std::thread::hardware_concurrency();
  EXPECT_GT(cpu, 0);
  EXPECT_LE(cpu, (steps + 0.02) * threads) << "clocks are read one after the other";
  for (const auto& [name, entry] : json["files"].items())
    EXPECT_EQ(entry["bytes"], std::filesystem::file_size(folder_ / "r" / name)) << name;
  EXPECT_TRUE(json["files"].contains("grains.csv"));
}

} // namespace
} // namespace grouser::commands
