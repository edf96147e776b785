// SPDX-License-Identifier: BSD-3-Clause
// The running gear from its shapes: sampled meshes converge to it under refinement, loads are opposite, a stationary
// vehicle is supported.
#include "coupling/shaped_gear.hpp"

#include "base/math.hpp"
#include "base/random.hpp"
#include "contact/gear_surfaces.hpp"
#include "contact/patch_contacts.hpp"
#include "spheredecomp/decompose.hpp"
#include "tests/contact/part_fixture.hpp"
#include "vehicle/spec_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace grouser::coupling {
namespace {

using base::Vec3d;
using contact::PartLoad;
using contact::PartMotion;

constexpr double kModulus = 1e10, kTimeStep = 1e-4;

contact::PatchQuanta quanta() {
  contact::PatchQuanta q;
  q.force = q.torque = q.moment = base::fixedPointFor(1e7, 46);
  q.energy = base::fixedPointFor(1e3, 50), q.area = base::fixedPointFor(1, 40);
  return q;
}

/// A prism from y = -half to y = half over a convex polygon in x-z, counter-clockwise with x to the right and z up.
base::TriangleMesh prism(const std::vector<std::pair<double, double>>& polygon, double half) {
  base::TriangleMesh mesh;
  const auto n = static_cast<std::uint32_t>(polygon.size());
  for (const double y : {-half, half})
    for (const auto& [x, z] : polygon) mesh.vertices.push_back({x, y, z});
  double x = 0, z = 0;
  for (const auto& [px, pz] : polygon) x += px / n, z += pz / n;
  mesh.vertices.push_back({x, -half, z}), mesh.vertices.push_back({x, half, z});
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    for (const std::uint32_t k : {i, i + n, j + n, i, j + n, j, 2 * n, i, j, 2 * n + 1, j + n, i + n})
      mesh.indices.push_back(k);
  }
  return mesh;
}

/// Force of a wheel of radius 0.19 m on an overlapping plate, both converted to spheres of `radius`.
double forceOfSamples(double radius, double overlap) {
  // Its lowest part, 15 degrees to either side, in facets of a quarter degree.
  std::vector<std::pair<double, double>> segment;
  for (int i = -60; i <= 60; ++i) {
    const double angle = 0.25 * i * base::kPi / 180;
    segment.emplace_back(0.19 * std::sin(angle), -0.19 * std::cos(angle));
  }
  spheredecomp::DecompositionOptions options;
  options.radius = radius, options.interior = false;
  const base::SphereSet wheel = spheredecomp::decompose(prism(segment, 0.05), "wheel", options);
  const base::SphereSet plate = spheredecomp::decompose(
      prism({{-0.068, -0.015}, {0.068, -0.015}, {0.068, 0.015}, {-0.068, 0.015}}, 0.04), "plate", options);
  const base::Exec exec = base::cpuExec(1);
  contact::PartPartContacts contacts(exec, {{kModulus, 0, 0, 0.8}, quanta(), kTimeStep, 0.004}, {&plate, &wheel},
                                     {0, 1}, {{0, 1}});
  const base::Array<PartMotion> motion(
      exec, std::vector<PartMotion>{contact::testing::atRest({}),
                                    contact::testing::atRest({0.002, 0, 0.015 + 0.19 - overlap})});
  contacts.refresh(motion);
  base::Array<PartLoad> loads(exec, 2);
  const base::Array<double> travelled(exec, std::vector<double>{0.004});
  contacts.compute(motion, travelled.data(), loads.data());
  return -quanta().force.value(loads.at(0).force).z;
}

TEST(ShapedGear, SamplesComeToItAsTheyGetFiner) {
  const double overlap = 1e-3, r = 0.19, h = r - overlap, a = std::sqrt(r * r - h * h);
  const double exact = kModulus * 0.08 * h * 2 * (r * std::asinh(a / h) - a);
  double former = 0;
  for (const double radius : {0.008, 0.004, 0.002}) {
    const double error = std::fabs(forceOfSamples(radius, overlap) / exact - 1);
    RecordProperty("error with spheres of " + std::to_string(radius), std::to_string(error));
    EXPECT_LT(error, 10 * radius);
    if (former > 0) {
      EXPECT_GT(std::log2(former / error), 0.8) << "first order, at spheres of " << radius << " m";
    }
    former = error;
  }
}

/// The assembled default vehicle, with movable parts.
struct Vehicle {
  vehicle::Assembly assembly =
      vehicle::assemble(vehicle::readVehicleSpec({GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml", {}}));
  VehicleSetup setup = [] {
    VehicleSetup s;
    s.shapes = true;
    return s;
  }();
  VehicleParts parts{assembly, setup, base::Comm(), nullptr, base::kInfinity, true};
  ShapedGear gear{assembly, parts, {{kModulus, 2e-4, 0.35, 0.8}, quanta(), kTimeStep}};
  std::vector<PartMotion> motion = [this] {
    const multibody::State state = multibody::makeState(assembly.model);
    std::vector<PartMotion> all;
    for (std::size_t c = 0; c < parts.contactParts(); ++c) {
      const vehicle::Part& part = assembly.parts[parts.partOf(c)];
      const base::Pose pose = vehicle::partPose(part, state);
      all.push_back(
          {pose.position, pose.orientation.matrix(), state.pose[static_cast<std::size_t>(part.body)].position, {}, {}});
    }
    return all;
  }();
  std::vector<PartLoad> loads = std::vector<PartLoad>(parts.contactParts());

  void step() {
    loads.assign(loads.size(), {});
    gear.compute(motion.data(), loads.data());
  }
  std::size_t partOf(vehicle::PartKind kind, int track) const {
    for (std::size_t c = 0; c < parts.contactParts(); ++c)
      if (const vehicle::Part& p = assembly.parts[parts.partOf(c)]; p.kind == kind && p.track == track) return c;
    return 0;
  }
  Vec3d force(std::size_t c) const { return quanta().force.value(loads[c].force); }
  Vec3d torque(std::size_t c) const { return quanta().torque.value(loads[c].torque); }
};

TEST(VehicleParts, ShoesOnTheGroundHaveTheModulusOfTheirPads) {
  Vehicle v;
  const double foundation = v.assembly.spec.contact.foundationModulus;
  for (const std::optional<double> pads : {std::optional<double>(), std::optional<double>(3e8)}) {
    v.assembly.spec.contact.padModulus = pads;
    int shoes = 0;
    for (const ContactPart& part : v.parts.touching(v.assembly, false).parts) {
      shoes += part.canTouchGround ? 1 : 0;
      EXPECT_EQ(part.foundation.modulus, part.canTouchGround ? pads.value_or(foundation) : foundation) << part.name;
    }
    EXPECT_EQ(shoes, 92);
  }
}

TEST(ShapedGear, LoadsAreOpposite) {
  Vehicle v;
  const std::size_t idler = v.partOf(vehicle::PartKind::kIdler, 0),
                    sprocket = v.partOf(vehicle::PartKind::kSprocket, 1);
  v.motion[idler].origin += Vec3d{1e-3, 2e-4, 0}, v.motion[idler].centre = v.motion[idler].origin;
  v.motion[idler].spin = {0, 3, 0};
  v.motion[sprocket].origin += Vec3d{-2e-3, 0, 0}, v.motion[sprocket].centre = v.motion[sprocket].origin;
  for (int k = 0; k < 3; ++k) v.step();
  base::Vec3l sum{};
  Vec3d moment;
  for (std::size_t c = 0; c < v.loads.size(); ++c) {
    sum += v.loads[c].force;
    moment += v.torque(c) + cross(v.motion[c].centre, v.force(c));
  }
  EXPECT_EQ(sum, base::Vec3l{}) << "to the last bit";
  EXPECT_LT(norm(moment), 1e-7 * norm(v.force(idler)));
  EXPECT_LT(v.force(idler).x, -1e4) << "the track pushes the idler back";
  EXPECT_GT(v.force(sprocket).x, 1e3) << "bosses hold the sprocket";
  EXPECT_GT(std::fabs(v.torque(idler).y), 10) << "plates brake its spin";
}

TEST(ShapedGear, AHornHoldsAWheelThatShiftsAcross) {
  Vehicle v;
  const std::size_t wheel = v.partOf(vehicle::PartKind::kRoadWheel, 0);
  // 27 mm from the middle to a disc, 15 mm of horn, 3 mm of chamfer on a horn with a taper of 1 in 10.
  for (const double shift : {0.0, 0.011}) {
    v.motion[wheel].origin.y = v.motion[wheel].centre.y = v.assembly.spec.trackOffset + shift;
    v.step();
    EXPECT_NEAR(v.force(wheel).y, 0, 1) << shift;
  }
  for (const double side : {-1.0, 1.0}) {
    v.motion[wheel].origin.y = v.motion[wheel].centre.y = v.assembly.spec.trackOffset + side * 0.014;
    v.step();
    EXPECT_GT(-side * v.force(wheel).y, 100) << side;
  }
}

TEST(ShapedGear, GoesOnFromWhatWasSaved) {
  Vehicle v, resumed;
  for (Vehicle* u : {&v, &resumed}) {
    const std::size_t idler = u->partOf(vehicle::PartKind::kIdler, 0);
    u->motion[idler].origin.x += 1e-3, u->motion[idler].centre = u->motion[idler].origin;
    u->motion[idler].spin = {0, 0.1, 0};
  }
  for (int k = 0; k < 4; ++k) v.step();
  resumed.gear.restore(v.gear.save());
  EXPECT_EQ(resumed.gear.ledger().elastic, v.gear.ledger().elastic);
  EXPECT_EQ(resumed.gear.ledger().patches, v.gear.ledger().patches);
  for (int k = 0; k < 4; ++k) v.step(), resumed.step();
  for (std::size_t c = 0; c < v.loads.size(); ++c) EXPECT_EQ(v.loads[c].force, resumed.loads[c].force) << c;
  EXPECT_EQ(resumed.gear.ledger().dissipated, v.gear.ledger().dissipated);
}

/// Without damping and friction no motion may create energy, however deep the parts overlap.
TEST(ShapedGear, ForcesAreTheSlopeOfTheElasticEnergy) {
  Vehicle v;
  ShapedGear gear{v.assembly, v.parts, {{kModulus, 0, 0, 0.8}, quanta(), kTimeStep}};
  std::size_t moved = 0;
  const auto energy = [&](const Vec3d& shift, const Vec3d& turn, Vec3d& force, Vec3d& torque) {
    std::vector<PartMotion> motion = v.motion;
    motion[moved].origin += shift, motion[moved].centre += shift;
    motion[moved].rotation =
        base::Quat{1, 0.5 * turn.x, 0.5 * turn.y, 0.5 * turn.z}.normalized().matrix() * motion[moved].rotation;
    std::vector<PartLoad> loads(motion.size());
    gear.compute(motion.data(), loads.data());
    force = quanta().force.value(loads[moved].force), torque = quanta().torque.value(loads[moved].torque);
    return gear.ledger().elastic;
  };
  std::uint64_t drawn = 0;
  const auto within = [&drawn](double size) { return size * (2 * base::uniform(7, 0, 0, ++drawn) - 1); };
  const auto vector = [&within](double x, double y, double z) { return Vec3d{within(x), within(y), within(z)}; };
  using vehicle::PartKind;
  for (const PartKind kind : {PartKind::kSprocket, PartKind::kRoadWheel, PartKind::kRoller, PartKind::kIdler}) {
    moved = v.partOf(kind, 0);
    // A wheel that shifts sideways loses the plate at its rim's end, where no force acts.
    const double bar = kind == PartKind::kSprocket ? 0.02 : 0.12;
    double worst = 0;
    for (int k = 0; k < 200; ++k) {
      const double size = k < 100 ? 1e-3 : 4e-3;
      const Vec3d shift = vector(size, 2e-3, size), turn = vector(0.003, 0.3, 0.003);
      const Vec3d way = vector(5e-7, 5e-7, 5e-7), angle = vector(5e-6, 5e-6, 5e-6);
      Vec3d f0, f1, t0, t1;
      const double e0 = energy(shift - way, turn - angle, f0, t0), e1 = energy(shift + way, turn + angle, f1, t1);
      const double most = norm(f0 + f1) * norm(way) + norm(t0 + t1) * norm(angle);
      worst = std::max(worst, std::fabs(e1 - e0 + dot(f0 + f1, way) + dot(t0 + t1, angle)) / (most + 1e-9));
    }
    EXPECT_LT(worst, bar) << static_cast<int>(kind);
  }
}

} // namespace
} // namespace grouser::coupling
