// SPDX-License-Identifier: BSD-3-Clause
// The light vehicle on deformable soil: it sinks to Bekker's sinkage, drives, leaves ruts, and resumes
// bitwise identically.
#include "coupling/ledger_entries.hpp"
#include "coupling/scm_ground.hpp"
#include "coupling/simulation.hpp"
#include "tests/coupling/one_track.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::coupling::scm_ground {
namespace {

constexpr double kStep = 1e-4;

scm::SoilConstants lete() {
  scm::SoilConstants s;
  s.exponent = 0.793, s.kc = 102e3, s.kphi = 5301e3, s.cohesion = 1300, s.friction = std::tan(31.1 * base::kPi / 180);
  s.shearDisplacement = 0.012, s.damping = 3e4;
  return s;
}

SimulationSetup onSoil() {
  SimulationSetup setup = oneTrack(kStep);
  setup.ground.area = terrain::Rectangle{-5, 20, -3, 3};
  setup.ground.surface = terrain::HeightField::flat(*setup.ground.area, 0);
  setup.ground.otherKind = [](const GroundSetup& ground, const base::Exec&) {
    return std::make_unique<ScmGround>(ScmSetup{lete(), {}, 0.034, 0.5}, *ground.surface);
  };
  setup.vehicle->driver.driveStart = 0.3;
  return setup;
}

void advanceTo(Simulation& simulation, double time) {
  while (simulation.time() < time - 0.5 * kStep) simulation.step();
}

const scm::SoilContacts& padsOf(const Simulation& simulation) {
  return dynamic_cast<const ScmGround&>(*simulation.actingGround()).contacts();
}

TEST(ScmGround, CarriesTheVehicleWithItsBooksClosed) {
  Simulation simulation(
      onSoil(), base::cpuExec(1), [](double, double) {}, {}, nullptr, cutOnce());
  advanceTo(simulation, 0.9);
  const auto upward = [&] { // momentum of the bodies [N s]
    double sum = 0;
    const auto& bodies = simulation.vehicle()->assembly().model.bodies();
    for (std::size_t b = 0; b < bodies.size(); ++b) sum += simulation.vehicle()->state().twist[b].v.z * bodies[b].mass;
    return sum;
  };
  const double before = upward();
  double pressed = 0, area = 0, deepest = 0;
  int rows = 0;
  for (; rows < 1000; ++rows) {
    simulation.step();
    for (const scm::PadLoad& load : padsOf(simulation).pads().loads())
      pressed += load.force.z, area += load.area, deepest = std::max(deepest, load.sinkage);
  }
  const double weight = 9.81 * simulation.vehicle()->assembly().mass;
  const double swing = (upward() - before) / (rows * kStep);
  EXPECT_NEAR(pressed / rows, weight + swing, 0.005 * weight) << "weight plus the inertia force of the swinging hull";
  // Loads concentrate under the road wheels, and the maximum sinkage is the initial one: between the sinkage at
  // the mean pressure and eight times that.
  const double k = lete().modulusAt(0.28), mean = std::pow(weight / (area / rows) / k, 1 / 0.793);
  EXPECT_GT(deepest, mean);
  EXPECT_LT(deepest, 8 * mean);
  const Ledger ledger = simulation.ledger();
  EXPECT_LT(std::fabs(ledger.residual), 1e-9 * ledger.turnover);
  EXPECT_LT(std::fabs(ledger.integrationError), 1e-3 * ledger.turnover);
  const scm::SoilEnergy& energy = padsOf(simulation).energy();
  EXPECT_GT(energy.compaction, 0);
  EXPECT_GT(energy.shear, 0);
  EXPECT_GT(energy.elastic, 0);
  EXPECT_EQ(ledger.soil.compaction, energy.compaction);
  EXPECT_EQ(ledger.dissipated.soil, energy.lost()) << "except for the contacts of parts with each other";
  EXPECT_LT(ledger.dissipated.parts, ledger.dissipated.total() - energy.lost() + 1e-9);
}

TEST(ScmGround, ReportsItsSurfaceAndStresses) {
  Simulation simulation(
      onSoil(), base::cpuExec(1), [](double, double) {}, {}, nullptr, cutOnce());
  const auto fieldsNow = [&] { return *simulation.actingGround()->fieldsNow(); };
  EXPECT_TRUE(fieldsNow().nodes.empty());
  advanceTo(simulation, 0.35);
  const GroundFields fields = fieldsNow();
  EXPECT_EQ(fields.spacing, 0.034);
  EXPECT_EQ(fields.constants.kc, lete().kc);
  double carried = 0, pressed = 0, deepest = 0;
  for (std::size_t n = 0; n < fields.nodes.size(); ++n) {
    const SoilNode& node = fields.nodes[n];
    if (n > 0) {
      EXPECT_LT(std::pair(fields.nodes[n - 1].j, fields.nodes[n - 1].i), std::pair(node.j, node.i));
    }
    EXPECT_LE(node.pressure, node.maxPressure * (1 + 1e-12));
    if (node.pressure > 0) deepest = std::max(deepest, node.sinkage);
    carried += node.pressure * fields.spacing * fields.spacing;
  }
  double most = 0;
  for (const scm::PadLoad& load : padsOf(simulation).pads().loads())
    pressed += load.pressed, most = std::max(most, load.sinkage);
  EXPECT_NEAR(carried, pressed, 0.05 * pressed) << "except for damping and the pitch of the shoes";
  EXPECT_GT(fields.deepest, 0.9 * most) << "z_u of the most loaded node";
  EXPECT_LT(fields.deepest, 1.5 * most);
  EXPECT_NEAR(deepest, most, 1e-12) << "under a shoe the surface is at the shoe, not at the rebound level";
}

TEST(ScmGround, GoesOnFromASavedStateWithTheSameBits) {
  Simulation straight(
      onSoil(), base::cpuExec(1), [](double, double) {}, {}, nullptr, cutOnce());
  advanceTo(straight, 0.25);
  const SimulationState saved = straight.save();
  Simulation resumed(onSoil(), base::cpuExec(1), saved, {}, cutOnce());
  EXPECT_EQ(resumed.stateHash(), straight.stateHash());
  SimulationState firmer = saved;
  (*firmer.ground)[11] *= 0.5; // maximum sinkage of the first node
  Simulation elsewhere(onSoil(), base::cpuExec(1), firmer, {}, cutOnce());
  for (Simulation* s : {&straight, &resumed, &elsewhere}) advanceTo(*s, 0.28);
  EXPECT_EQ(resumed.stateHash(), straight.stateHash());
  EXPECT_NE(elsewhere.stateHash(), straight.stateHash());
  SimulationState other = saved;
  other.ground->pop_back();
  EXPECT_THROW(Simulation(onSoil(), base::cpuExec(1), other, {}, cutOnce()), base::InputError);
}

} // namespace
} // namespace grouser::coupling::scm_ground
