// SPDX-License-Identifier: BSD-3-Clause
// A custom ground model outside the library, with the library's interface: the steps of
// CONTRIBUTING.md#adding-a-ground.
#include "coupling/ground_kinds.hpp"
#include "coupling/ledger_entries.hpp"
#include "coupling/simulation.hpp"
#include "tests/coupling/one_track.hpp"
#include "tests/message_of.hpp"
#include "tests/terrain/grain_fixture.hpp"
#include "vehicle/spec_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace grouser::coupling {
namespace {

using base::Vec3d;

constexpr double kStep = 1e-4;               // [s]
constexpr double kStiffness = 1e5;           // per edge [N/m]: the vehicle sinks by some millimetres
constexpr double kDamping = 1e3;             // [N s/m]
constexpr double kGravity = 9.81;            // [m/s2]
constexpr double kEdges[] = {-0.045, 0.045}; // positions of a shoe's grousers, from its centre [m]

/// Winkler's ground in its simplest form: level, at height 0, with a spring and a dashpot under both edges of each
/// shoe. Springs tie an edge to its touchdown point; these points are the ground's state. Runs on one CPU
/// thread only.
class SpringGround : public Ground {
public:
  void restore(const SimulationState& state) override {
    if (!state.ground) throw base::InputError("the saved state has no springs; resume it with its own ground");
    state_ = *state.ground;
  }
  void save(SimulationState& state) const override { state.ground = state_; }
  std::function<double(double, double)> surface() const override {
    return [](double, double) { return 0.0; };
  }
  LoadQuanta meet(const PartsOnGround& on) override {
    const vehicle::ShoeSpec& spec = on.vehicle->spec.shoe;
    for (std::size_t part = 0; part < on.parts.count(); ++part)
      for (const double x : kEdges)
        if (on.parts.parts[part].canTouchGround) edges_.push_back({part, {x, 0, spec.padBottom - spec.grouserHeight}});
    // Per edge: contact flag, x and y of the touchdown [m]; at the end the dissipated energy [J].
    const std::size_t numbers = 3 * edges_.size() + 1;
    if (!state_.empty() && state_.size() != numbers)
      throw base::InputError("the saved state is of another vehicle on springs; resume it with that");
    state_.resize(numbers);
    timeStep_ = on.timeStep;
    return quanta_ = {on.quanta.force, on.quanta.torque};
  }
  void refreshContacts(const base::Array<contact::PartMotion>&) override {} // all shoes are checked in every step
  void compute(const base::Exec&, const base::Array<contact::PartMotion>& motion, const double*,
               contact::PartLoad* loads) override {
    elastic_ = 0;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const contact::PartMotion& shoe = motion.data()[edges_[e].part];
      const Vec3d p = shoe.toWorld(edges_[e].place), v = shoe.velocityAt(p);
      double* held = &state_[3 * e];
      if (p.z < 0 && held[0] == 0) held[1] = p.x, held[2] = p.y;
      held[0] = p.z < 0 ? 1 : 0;
      if (held[0] == 0) continue;
      const Vec3d spring{held[1] - p.x, held[2] - p.y, -p.z}, force = spring * kStiffness - v * kDamping;
      elastic_ += 0.5 * kStiffness * norm2(spring);
      state_.back() += kDamping * norm2(v) * timeStep_;
      loads[edges_[e].part].force += quanta_.force.quantise(force);
      loads[edges_[e].part].torque += quanta_.torque.quantise(cross(p - shoe.centre, force));
    }
  }
  void addContactsTo(ContactLedger& ledger) const override {
    ledger.rigid.elastic += elastic_, ledger.rigid.dissipated += state_.back();
  }
  double elastic() const { return elastic_; }

private:
  struct Edge {
    std::size_t part; ///< index of the contact part
    Vec3d place;      ///< position in its frame [m]
  };
  std::vector<Edge> edges_;
  std::vector<double> state_;
  LoadQuanta quanta_;
  double elastic_{}, timeStep_{};
};

/// One track of the light vehicle, placed on springs; with short ramps.
SimulationSetup onSprings() {
  SimulationSetup setup = oneTrack(kStep);
  setup.ground.otherKind = [](const GroundSetup&, const base::Exec&) { return std::make_unique<SpringGround>(); };
  setup.vehicle->driver.driveStart = 0.16;
  return setup;
}

void advanceTo(Simulation& simulation, double time) {
  while (simulation.time() < time - 0.5 * kStep) simulation.step();
}

/// Total momentum of the bodies [N s].
Vec3d momentum(const VehicleRig& rig) {
  Vec3d sum;
  for (std::size_t b = 0; b < rig.assembly().model.bodies().size(); ++b)
    sum += rig.state().twist[b].v * rig.assembly().model.bodies()[b].mass;
  return sum;
}

TEST(OtherGround, CarriesTheVehicleThatSettlesOnIt) {
  Simulation simulation(
      onSprings(), base::cpuExec(1), [](double, double) {}, {}, nullptr, cutOnce());
  advanceTo(simulation, 1);
  simulation.restartMeans();
  const VehicleRig& rig = *simulation.vehicle();
  const Vec3d before = momentum(rig);
  advanceTo(simulation, 1.2);
  const double weight = kGravity * rig.assembly().mass;
  const Vec3d force = rig.meanGroundForce();
  const Vec3d swing = (momentum(rig) - before) * (1 / 0.2);
  // The rails carry the hull's guide, 1e-4 of the hull's mass.
  EXPECT_NEAR(force.z, weight + swing.z, 1e-4 * weight) << "weight plus the inertia force of the swinging hull";
  EXPECT_NEAR(force.z, weight, 0.03 * weight);
  const Ledger ledger = simulation.ledger();
  EXPECT_LT(norm(ledger.momentumResidual), 1e-6);
  EXPECT_LT(std::fabs(ledger.residual), 1e-9 * ledger.turnover);
  EXPECT_LT(std::fabs(ledger.integrationError), 0.1 * ledger.turnover);
  EXPECT_NEAR(force.x, 0, 0.01 * weight);
  // Springs that evenly share a load W store W^2 / (2 n k).
  const auto& ground = dynamic_cast<const SpringGround&>(*simulation.actingGround());
  const double carrying = 2 * 14; // edges, at most, of the shoes between first and last road wheel
  EXPECT_GT(ground.elastic(), 0.99 * weight * weight / (2 * carrying * kStiffness));
  EXPECT_EQ(simulation.granularGround(), nullptr);
  EXPECT_EQ(simulation.ground().grains, nullptr);
}

TEST(OtherGround, GoesOnFromASavedStateWithTheSameBits) {
  Simulation straight(
      onSprings(), base::cpuExec(1), [](double, double) {}, {}, nullptr, cutOnce());
  advanceTo(straight, 0.2);
  const SimulationState saved = straight.save();
  Simulation resumed(onSprings(), base::cpuExec(1), saved, {}, cutOnce());
  EXPECT_EQ(resumed.stateHash(), straight.stateHash());
  SimulationState moved = saved;
  for (std::size_t k = 0; k + 3 < moved.ground->size(); k += 3) (*moved.ground)[k + 1] += 1e-4;
  Simulation elsewhere(onSprings(), base::cpuExec(1), moved, {}, cutOnce());
  for (Simulation* s : {&straight, &resumed, &elsewhere}) advanceTo(*s, 0.25);
  EXPECT_EQ(resumed.stateHash(), straight.stateHash());
  EXPECT_NE(elsewhere.vehicle()->save().words(), straight.vehicle()->save().words()) << "the touchdown points differ";
}

TEST(OtherGround, IsRefusedBesideGrains) {
  LaidGround laid;
  laid.grains = std::make_unique<terrain::Grains>(base::cpuExec(1), terrain::testing::ball(1e-5), terrain::Boundaries{},
                                                  std::vector<terrain::GrainSpec>{{{0, 0, 1}, {}, {}}});
  const SimulationSetup setup = onSprings();
  const std::string message = test::messageOf([&] { makeGround(laid, setup.ground, base::cpuExec(1)); });
  EXPECT_NE(message.find("remove one of them"), std::string::npos) << message;
}

} // namespace
} // namespace grouser::coupling
