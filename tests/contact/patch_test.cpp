// SPDX-License-Identifier: BSD-3-Clause
// Extended surfaces: the pressure law does not depend on the sphere set, loads balance, friction sticks and slides.
#include "contact/patch_contacts.hpp"

#include "part_fixture.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace grouser::contact::testing {
namespace {

using base::Vec3d;

struct PlateOnPlate {
  base::Exec exec = testExec();
  PartPartContacts::Model model;
  base::SphereSet small, large;
  std::unique_ptr<PartPartContacts> contacts;
  base::Array<PartMotion> motion;
  base::Array<PartLoad> loads;

  PlateOnPlate(double spacing, double friction) : small(plate(0.05, 0.005, spacing)), large(plate(0.2, 0.005, 0.008)) {
    model.law = {1e9, 0, friction, 0.8};
    model.quanta.force = model.quanta.torque = model.quanta.moment = model.quanta.energy = base::fixedPointFor(1e6, 44);
    model.quanta.area = base::fixedPointFor(1, 40);
    model.timeStep = 1e-4, model.margin = 0.003;
    contacts = std::make_unique<PartPartContacts>(exec, model, std::vector<const base::SphereSet*>{&small, &large},
                                                  std::vector<int>{0, 1}, std::vector<PartPair>{{0, 1}});
    loads = base::Array<PartLoad>(exec, 2);
  }
  /// Small plate (a) rests on its lower face, 30 mm below its origin, inclined about y; `v` is its velocity.
  void step(const Vec3d& origin, const Vec3d& v, double tilt = 0) {
    PartMotion a = atRest(origin, {std::sqrt(1 - tilt * tilt / 4), 0, tilt / 2, 0}), b = atRest({});
    a.velocity = v;
    motion = base::Array<PartMotion>(exec, std::vector<PartMotion>{a, b});
    if (contacts->samplesListed() == 0) contacts->refresh(motion);
    loads.zero();
    const base::Array<double> travelled(exec, std::vector<double>{model.margin});
    contacts->compute(motion, travelled.data(), loads.data());
  }
  Vec3d force(int part) const { return model.quanta.force.value(loads.at(static_cast<std::size_t>(part)).force); }
  Vec3d torque(int part) const { return model.quanta.torque.value(loads.at(static_cast<std::size_t>(part)).torque); }
  double area() const {
    double sum = 0;
    for (const base::SetSphere& s : small.spheres)
      if (s.normal.z < 0) sum += s.area;
    return sum;
  }
};

TEST(PlateOnPlate, PressureTimesAreaWhateverTheCut) {
  const double overlap = 1e-4;
  for (const double spacing : {0.003, 0.005, 0.01}) {
    PlateOnPlate bench(spacing, 0);
    bench.step({0.0123, 0.0071, 0.03 - overlap}, {});
    EXPECT_NEAR(bench.force(0).z, 1e9 * bench.area() * overlap, 2e-4 * 1e9 * bench.area() * overlap)
        << "float distances, 1e-8 m of 1e-4 m";
    EXPECT_EQ(bench.force(0) + bench.force(1), Vec3d{});
  }
}

TEST(PlateOnPlate, TorquesBalanceAboutOnePoint) {
  PlateOnPlate bench(0.005, 0.5);
  const Vec3d origin{0.05, -0.02, 0.0298};
  bench.step(origin, {0.1, 0, 0});
  const Vec3d total = bench.torque(0) + cross(origin, bench.force(0)) + bench.torque(1); // b's centre is the origin
  EXPECT_LT(norm(total), 1e-6 * norm(bench.torque(1))) << "quanta";
}

TEST(PlateOnPlate, SticksOnItsSpringThenSlidesAtCoulombsLimit) {
  PlateOnPlate bench(0.005, 0.5);
  const double overlap = 1e-4, speed = 0.01;
  double x = 0;
  const double kt = 0.8 * 1e9 * bench.area();
  for (int k = 1; k <= 100; ++k) {
    bench.step({x, 0, 0.03 - overlap}, {speed, 0, 0});
    const double spring = kt * speed * bench.model.timeStep * k, limit = 0.5 * bench.force(0).z;
    EXPECT_NEAR(bench.force(0).x, -std::min(spring, limit), 1e-6 * limit + 1e-3 * std::min(spring, limit));
    x += speed * bench.model.timeStep;
  }
  // Friction work equals dissipation plus the elastic energy of the spring.
  const double slid = x - 0.5 * 1e9 * bench.area() * overlap / kt;
  const auto ledger = bench.contacts->ledger();
  EXPECT_NEAR(ledger.dissipated, 0.5 * bench.force(0).z * slid, 0.03 * ledger.dissipated) << "one step of 100";
}

TEST(PlateOnPlate, ChangingAreaGivesNoEnergy) {
  // Tilts until half of the face lifts off, shears, levels, shears back on the whole face: friction may only dissipate.
  PlateOnPlate bench(0.005, 5.0);
  const double overlap = 1e-4, reach = 2e-5, tilt = 4e-3;
  const int n = 40;
  double x = 0, work = 0, worst = -1;
  const auto slide = [&](double to, double angle) {
    const double dx = (to - x) / n;
    for (int k = 0; k < n; ++k) {
      x += dx;
      bench.step({x, 0, 0.03 - overlap}, {dx / bench.model.timeStep, 0, 0}, angle);
      work += bench.force(0).x * dx;
    }
  };
  for (int cycle = 0; cycle < 3; ++cycle) {
    const double before = work;
    bench.step({x, 0, 0.03 - overlap}, {}, tilt);
    slide(reach, tilt);
    bench.step({x, 0, 0.03 - overlap}, {}, 0);
    slide(0, 0);
    worst = std::max(worst, work - before);
  }
  const double stored = 0.5 * 0.8 * 1e9 * bench.area() * reach * reach;
  EXPECT_LT(worst, 0.03 * stored) << "one step of " << n << "; the tilt turns the pull by 4 mrad";
}

TEST(PlateOnPlate, PulledFastAndPushedBackSlowlyGivesNoEnergy) {
  // At high speed, the dashpot force by itself exceeds Coulomb's limit with hardly any spring elongation.
  PlateOnPlate bench(0.005, 0.1);
  bench.model.law.relaxation = 0.1;
  bench.contacts = std::make_unique<PartPartContacts>(bench.exec, bench.model,
                                                      std::vector<const base::SphereSet*>{&bench.small, &bench.large},
                                                      std::vector<int>{0, 1}, std::vector<PartPair>{{0, 1}});
  const double overlap = 1e-4, reach = 1e-5;
  double x = 0, work = 0, dissipated = 0;
  const auto slide = [&](double way, int steps) {
    for (int k = 0; k < steps; ++k) {
      x += way / steps;
      bench.step({x, 0, 0.03 - overlap}, {way / steps / bench.model.timeStep, 0, 0});
      work += bench.force(0).x * way / steps;
      const double now = bench.contacts->ledger().dissipated;
      EXPECT_GE(now, dissipated * (1 - 1e-9)) << "step " << k;
      dissipated = now;
    }
  };
  for (int cycle = 0; cycle < 3; ++cycle) {
    work = 0;
    slide(reach, 3), slide(-reach, 300);
  }
  EXPECT_LT(work, 0);
}

} // namespace
} // namespace grouser::contact::testing
