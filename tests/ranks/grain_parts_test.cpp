// SPDX-License-Identifier: BSD-3-Clause
// Grains that slide over a part and migrate: their contact springs migrate with them.
#include "contact/grain_part_contacts.hpp"
#include "terrain/grains.hpp"
#include "tests/contact/part_fixture.hpp"
#include "tests/ranks/ranks.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

using contact::GrainPartContacts;

GrainModel pebbles() {
  GrainModel m;
  m.radius = 0.02;
  m.mass = 0.08;
  m.timeStep = 1e-4;
  m.gravity = {0, 0, -9.81};
  m.law.stiffness = 1e5f, m.law.damping = 1000;
  m.law.tangentialStiffness = 3e4f, m.law.friction = 0.5f;
  m.skin = 0.2;
  return m;
}

/// 48 pebbles on a level and rough plate; all slide along it, most across a subdomain border.
std::vector<GrainSpec> sliding() {
  std::vector<GrainSpec> start;
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 8; ++x) start.push_back({{-0.25 + 0.05 * x, -0.15 + 0.05 * y, 0.02 - 8e-6}, {1.5, 0.3, 0}, {}});
  return start;
}

enum class Contacts { springs, rolling, solved };

GrainModel pebbles(Contacts contacts) {
  GrainModel m = pebbles();
  if (contacts != Contacts::solved) return m;
  contact::ComplementarityOptions& o = m.complementarity.emplace();
  o.residual = 0.01 * 9.81 * m.timeStep, o.iterations = 60, o.impact = 5 * 9.81 * m.timeStep;
  return m;
}

/// A plate lighter than the pebbles. It starts each step at rest.
class LightPlate : public contact::BodyResponse {
public:
  const std::vector<std::uint32_t>& bodyOfPart() const override { return body_; }
  const std::vector<Inverse>& inverses() const override { return inverses_; }
  void respond(const std::vector<contact::BodyImpulse>& impulses,
               std::vector<contact::BodyVelocity>& velocities) override {
    velocities = {{impulses[0].linear * inverses_[0].mass, inverses_[0].inertia * impulses[0].angular}};
  }

private:
  std::vector<std::uint32_t> body_{0};
  std::vector<Inverse> inverses_{{0.5, base::Mat3d::diagonal({8, 8, 4})}};
};

struct Ground {
  explicit Ground(const PartitionOptions& partition, Contacts contacts)
      : solved(contacts == Contacts::solved), plate(contact::testing::plate(0.6, 0.01, 0.02)),
        grains(exec, pebbles(contacts), {}, sliding(), partition),
        motion(exec, std::vector<contact::PartMotion>{contact::testing::atRest({})}), loads(exec, 1) {
    contact::GrainPartModel model;
    model.radius = grains.model().radius, model.mass = grains.model().mass, model.timeStep = grains.model().timeStep;
    model.margin = 0.012, model.law = grains.model().law, model.scale = grains.scale();
    model.gap = static_cast<double>(grains.system().constants.marginUnits) * grains.scale().unit;
    if (contacts != Contacts::springs) model.law.rollingFriction = 0.1f, model.law.rollingDamping = 0.3f;
    model.force = model.torque = base::fixedPointFor(2e3, 36), model.energy = base::fixedPointFor(40, 36);
    part = std::make_unique<GrainPartContacts>(exec, model, std::vector<const base::SphereSet*>{&plate},
                                               std::vector<contact::GrainPart>{{0, {}, {}}}, partition.comm);
    if (grains.distribution())
      grains.distribution()->onMigrate([this](const std::uint32_t* destination) { part->migrate(destination); });
  }

  void step() {
    if (grains.refreshNeighbours()) part->refresh(grains.view(), motion);
    if (solved) {
      loads.zero();
      grains.system().impulses->setParts({part.get(), &motion, loads.data(), &response});
      return grains.step();
    }
    part->compute(grains.view(), motion, loads.data());
    const contact::GrainLoadsView onGrains = part->grainLoads();
    grains.step(&onGrains);
  }

  bool solved;
  base::Exec exec = base::cpuExec(1);
  LightPlate response;
  base::SphereSet plate;
  Grains grains;
  base::Array<contact::PartMotion> motion;
  base::Array<contact::PartLoad> loads;
  std::unique_ptr<GrainPartContacts> part;
};

void expectSame(const GrainPartContacts& onRanks, const GrainPartContacts& alone, std::int64_t step) {
  const contact::SavedGrainPatches a = onRanks.save(), b = alone.save();
  EXPECT_EQ(a.memories, b.memories) << "step " << step;
  EXPECT_EQ(a.angles, b.angles) << "step " << step;
  EXPECT_EQ(a.sums, b.sums) << "step " << step;
}

class PartsOnRanks : public ::testing::TestWithParam<Contacts> {};
INSTANTIATE_TEST_SUITE_P(Contacts, PartsOnRanks,
                         ::testing::Values(Contacts::springs, Contacts::rolling, Contacts::solved));

TEST_P(PartsOnRanks, SavedRightAfterAHandOverNothingIsMissingOrTwice) {
  Ground alone({}, GetParam()), shared({test::comm(), {}, {}, false}, GetParam());
  int handOvers = 0;
  for (int step = 1; step <= 1500; ++step) {
    alone.step(), shared.step();
    const std::int64_t before = shared.grains.system().rebuilds;
    shared.grains.ledger(); // an output row: rebuilds stale lists
    if (shared.grains.system().rebuilds == before) continue;
    ++handOvers;
    expectSame(*shared.part, *alone.part, step);
  }
  EXPECT_GE(handOvers, 10);
}

TEST_P(PartsOnRanks, HandedOverTwiceBetweenTwoStepsNothingIsLost) {
  Ground alone({}, GetParam()), shared({test::comm(), {}, {}, false}, GetParam());
  GrainDistribution* ranks = shared.grains.distribution();
  for (int step = 1; step <= 600; ++step) {
    alone.step(), shared.step();
    if (step % 150 != 0 || !ranks) continue;
    // The cuts jump, twice before the next step: nearly all grains migrate, some twice.
    for (const double cut : {-0.2, 0.3}) {
      std::array<std::vector<std::int64_t>, 3> weights;
      for (auto& w : weights) w.assign(contact::kPartitionBins, 1);
      for (auto& w : weights) w[static_cast<std::size_t>((cut + 1) / 2 * contact::kPartitionBins)] = 1000000;
      const auto units = [&](double metres) {
        return static_cast<std::int64_t>(metres * shared.grains.scale().perMetre);
      };
      ranks->setPartition({ranks->subdomain().partition().shape(),
                           {units(-1), units(-1), units(-1)},
                           {units(1), units(1), units(1)},
                           weights});
      shared.grains.invalidateNeighbours();
      shared.grains.ledger();
      expectSame(*shared.part, *alone.part, step);
    }
  }
  expectSame(*shared.part, *alone.part, 600);
}

} // namespace
} // namespace grouser::terrain::testing
