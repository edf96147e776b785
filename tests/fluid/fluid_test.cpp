// SPDX-License-Identifier: BSD-3-Clause
// The particle fluid against closed forms of its own discrete equations, exact balances, and identical results.
#include "base/error.hpp"
#include "base/math.hpp"
#include "tests/fluid/water.hpp"
#include "tests/message_of.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace grouser::fluid {
namespace {

using base::Vec3d;

// --- kernel

/// Sums over a cubic lattice [-]: of V W, and of V r.grad W in the bulk and in the first and second layer of a half
/// space. Digits of an independent computation.
TEST(Wendland, HasTheSumsOfACubicLattice) {
  struct Row {
    double smoothing, volume, first, second;
  };
  for (const Row& row : {Row{1.2, 1.017, 2.08, 2.93}, Row{1.3, 1.009, 2.03, 2.88}, Row{1.5, 1.003, 2.00, 2.83},
                         Row{2, 1.0006, 1.87, 2.57}}) {
    const Wendland kernel(row.smoothing, 3); // spacing 1
    double volume = 0, first = 0, second = 0;
    for (int x = -4; x <= 4; ++x)
      for (int y = -4; y <= 4; ++y)
        for (int z = -4; z <= 4; ++z) {
          const double r2 = x * x + y * y + z * z, r = std::sqrt(r2);
          volume += kernel.value(r);
          if (z <= 0) first -= kernel.slope(r) * r2;
          if (z <= 1) second -= kernel.slope(r) * r2;
        }
    EXPECT_NEAR(volume, row.volume, row.smoothing == 2 ? 6e-5 : 6e-4) << row.smoothing;
    EXPECT_NEAR(first, row.first, 5.1e-3) << row.smoothing;
    EXPECT_NEAR(second, row.second, 5.1e-3) << row.smoothing;
  }
}

TEST(Wendland, IntegratesToOneAndItsSlopeIsItsDerivative) {
  for (const int d : {2, 3}) {
    const Wendland kernel(0.3, d);
    double integral = 0;
    constexpr int kParts = 20000;
    const double dr = kernel.support() / kParts;
    for (int k = 0; k < kParts; ++k) {
      const double r = (k + 0.5) * dr;
      integral += kernel.value(r) * (d == 2 ? 2 * base::kPi * r : 4 * base::kPi * r * r) * dr;
    }
    EXPECT_NEAR(integral, 1, 1e-7) << d; // midpoint rule: (dr/h)^2
    for (const double r : {0.05, 0.2, 0.45, 0.59}) {
      const double e = 1e-6, slope = (kernel.value(r + e) - kernel.value(r - e)) / (2 * e);
      EXPECT_NEAR(kernel.slope(r) * r / slope, 1, 1e-5) << d << " " << r;
    }
    EXPECT_EQ(kernel.value(0.6), 0);
    EXPECT_EQ(kernel.slope(0.6), 0);
    for (double r = 0.01; r < 0.6; r += 0.01) EXPECT_LE(-kernel.slope(r) * r, kernel.steepest()) << r;
  }
}

// --- state

TEST(FluidModel, PressureAndCompressionAreInversesAndTheEnergyIsTheWorkOfPressure) {
  const FluidModel m = water(3, 0.1);
  for (const double s : {-0.1, -1e-3, 1e-6, 0.02, 0.14}) {
    EXPECT_NEAR(compressionAt(m, pressureAt(m, s)) / s, 1, 1e-12);
    // de = p/rho^2 drho = p/(rho0 (1 + s)^2) ds
    const double e = 1e-5, rate = (internalEnergy(m.soundSpeed * m.soundSpeed, s + e) -
                                   internalEnergy(m.soundSpeed * m.soundSpeed, s - e)) /
                                  (2 * e);
    EXPECT_NEAR(rate * m.density * (1 + s) * (1 + s), pressureAt(m, s), 1e-6 * m.density * m.soundSpeed * m.soundSpeed);
  }
  EXPECT_NEAR(internalEnergy(m.soundSpeed * m.soundSpeed, 0.1), 100 * (std::log(1.1) + 1 / 1.1 - 1), 1e-12);
}

TEST(StepLimits, AreThoseOfSoundForceAndViscosity) {
  FluidModel m = water(3, 0.1); // h = 0.13 m
  m.gravity = {0, 0, -kGravity};
  const StepLimits inviscid = stepLimits(m, 2, 0);
  EXPECT_DOUBLE_EQ(inviscid.sound, 0.25 * 0.13 / 12);
  EXPECT_DOUBLE_EQ(inviscid.force, 0.25 * std::sqrt(0.13 / kGravity)); // gravity where less is expected
  EXPECT_EQ(inviscid.viscous, base::kInfinity);
  m.viscosity = 5000;
  EXPECT_DOUBLE_EQ(stepLimits(m, 2, 40).viscous, 0.125 * 0.13 * 0.13 / 5);
  EXPECT_DOUBLE_EQ(stepLimits(m, 2, 40).force, 0.25 * std::sqrt(0.13 / 40));
  EXPECT_EQ(stepLimits(m, 2, 40).least(), stepLimits(m, 2, 40).viscous);
}

// --- motion

TEST(Fluid, ALoneParticleFallsFreely) {
  FluidSetup s;
  s.model = water(3, 0.1);
  s.model.gravity = {0.5, 0, -kGravity};
  s.particles = {{{0.2, -0.3, 1}, {1, 2, 3}, 0.01}};
  Fluid fluid(s, testExec());
  for (int k = 0; k < 1000; ++k) fluid.step();
  const double t = fluid.time();
  const FluidSnapshot end = fluid.snapshot();
  // Each half step rounds positions to units of 2e-8 spacings.
  EXPECT_NEAR(end.position[0].x, 0.2 + t + 0.25 * t * t, 2e-7);
  EXPECT_NEAR(end.position[0].z, 1 + 3 * t - 0.5 * kGravity * t * t, 2e-7);
  EXPECT_NEAR(end.velocity[0].z, 3 - kGravity * t, 1e-12);
  EXPECT_EQ(end.compression[0], 0.01) << "no neighbours";
}

/// Half a period of a plane wave between lattice points: k c D(k)/k, D(k) = sum V F x sin(k x).
TEST(Fluid, SoundHasTheSpeedOfTheLattice) {
  for (const auto& [smoothing, figure] : {std::pair{1.3, 0.9513}, std::pair{1.5, 0.9661}}) {
    FluidSetup s;
    FluidModel& m = s.model = water(2, 0.05);
    m.smoothing = smoothing, m.artificialViscosity = m.diffusion = 0;
    m.timeStep = 0.25 * m.kernel().length() / m.soundSpeed;
    s.periodHigh = {1, 1, 0};
    const double k = 2 * base::kPi;
    for (int i = 0; i < 20; ++i)
      for (int j = 0; j < 20; ++j) {
        const double x = (i + 0.5) * 0.05;
        s.particles.push_back({{x, (j + 0.5) * 0.05, 0}, {1e-3 * std::sin(k * x), 0, 0}, 0});
      }
    double dispersion = 0;
    for (int i = -3; i <= 3; ++i)
      for (int j = -3; j <= 3; ++j) {
        const double x = 0.05 * i, r = 0.05 * std::hypot(i, j);
        dispersion -= m.volume() * m.kernel().slope(r) * x * std::sin(k * x);
      }
    EXPECT_NEAR(dispersion / k, figure, 2e-4) << "an independent computation";
    Fluid fluid(s, testExec());
    double before = 1, first = 0, last = 0;
    int crossings = 0;
    for (int step = 0; step < 400; ++step) {
      fluid.step();
      const FluidSnapshot now = fluid.snapshot();
      double signal = 0;
      for (std::size_t i = 0; i < now.position.size(); ++i)
        signal += now.velocity[i].x * std::sin(k * now.position[i].x);
      if (before * signal < 0) {
        last = fluid.time() - m.timeStep * signal / (signal - before);
        if (crossings++ == 0) first = last;
      }
      before = signal;
    }
    const double speed = 0.5 * (crossings - 1) / (last - first);
    EXPECT_NEAR(speed / m.soundSpeed, dispersion / k, 1e-3) << smoothing; // time-step error (omega dt)^2/24
  }
}

TEST(Fluid, AStillTankStaysStillAndItsFloorBearsTheWeight) {
  FluidSetup s = tankOfWater();
  s.model.diffusion = 0.5; // without the gravity term the water expands, five times as fast as by default
  Fluid fluid(s, testExec());
  const double bottom = fluid.model().density * kGravity * 0.5;
  double force = 0;
  int looks = 0;
  while (fluid.time() < 0.6) {
    fluid.step();
    if (fluid.time() > 0.2) force += fluid.totals().wallForce.z, ++looks;
  }
  const FluidSnapshot end = fluid.snapshot();
  double square = 0, fastest = 0;
  for (std::size_t i = 0; i < end.position.size(); ++i) {
    const double error = pressureAt(fluid.model(), end.compression[i]) / bottom - (1 - end.position[i].z / 0.5);
    square += error * error, fastest = std::max(fastest, base::norm(end.velocity[i]));
  }
  EXPECT_LT(std::sqrt(square / static_cast<double>(end.position.size())), 0.03); // 10 spacings deep
  EXPECT_LT(fastest, 0.05);
  const double weight = fluid.model().mass() * static_cast<double>(fluid.particles()) * kGravity;
  EXPECT_NEAR(-force / looks / weight, 1, 0.01);
}

TEST(Fluid, ForcesOfParticlesAndWallsCancelToTheLastBit) {
  for (const auto& [viscosity, central] : {std::pair{0.0, false}, {0.5, false}, {0.5, true}}) {
    FluidSetup s = damBreak();
    s.model.viscosity = viscosity, s.model.centralViscosity = central;
    Fluid fluid(s, testExec());
    for (int k = 0; k < 200; ++k) {
      fluid.step();
      ASSERT_EQ(fluid.forceBalance(), (base::Vec3l{})) << "step " << k;
    }
    EXPECT_GT(fluid.totals().fastest, 0.1) << "the column collapses";
    EXPECT_NE(fluid.totals().wallForce.x, 0);
  }
}

/// Relative decay [1/s] of the velocity sin(wave z) along x under a viscous operator on a resting square lattice.
double latticeDecay(const FluidModel& m, double wave) {
  const Wendland kernel = m.kernel();
  const double h2 = kernel.length() * kernel.length(), nu = m.viscosity / m.density;
  double rate = 0;
  for (int i = -4; i <= 4; ++i)
    for (int j = -4; j <= 4; ++j) {
      const double x = i * m.spacing, y = j * m.spacing, r2 = x * x + y * y;
      const double factor = m.centralViscosity ? 2 * (m.dimensions + 2) * x * x / (r2 + 0.01 * h2) : 2;
      rate -= factor * nu * m.volume() * kernel.slope(std::sqrt(r2)) * (1 - std::cos(wave * y));
    }
  return rate;
}

/// A shear wave of 20 spacings: each operator decays at its sum over the lattice, which is that of the viscosity but
/// for the spacing (the central one loses x^2/(r^2 + h^2/100) where neighbours are near).
TEST(Fluid, ShearDecaysAtTheRateOfTheViscosity) {
  for (const bool central : {false, true}) {
    FluidSetup s;
    FluidModel& m = s.model = water(2, 0.05);
    m.smoothing = 1.5, m.viscosity = 10, m.centralViscosity = central, m.artificialViscosity = 0;
    s.periodHigh = {1, 1, 0};
    const double k = 2 * base::kPi, nu = m.viscosity / m.density;
    for (int i = 0; i < 20; ++i)
      for (int j = 0; j < 20; ++j)
        s.particles.push_back(
            {{(i + 0.5) * 0.05, (j + 0.5) * 0.05, 0}, {0.01 * std::sin(k * (j + 0.5) * 0.05), 0, 0}, 0});
    Fluid fluid(s, testExec());
    const double start = fluid.totals().kinetic;
    for (int step = 0; step < 1000; ++step) fluid.step();
    const double rate = std::log(start / fluid.totals().kinetic) / (2 * fluid.time());
    EXPECT_NEAR(rate / latticeDecay(m, k), 1, 5e-4) << central;
    EXPECT_NEAR(rate / (nu * k * k), 1, central ? 0.15 : 0.05);
  }
}

/// In a periodic lattice shifting moves a displaced particle back; without it the particle stays.
TEST(Fluid, ShiftingRestoresTheLattice) {
  for (const double shifting : {0.0, 2.0}) {
    FluidSetup s;
    FluidModel& m = s.model = water(2, 0.05);
    m.shifting = shifting, m.diffusion = m.artificialViscosity = 0;
    s.periodHigh = {1, 1, 0};
    for (int i = 0; i < 20; ++i)
      for (int j = 0; j < 20; ++j) s.particles.push_back({{(i + 0.5) * 0.05, (j + 0.5) * 0.05, 0}, {0.5, 0, 0}, 0});
    s.particles[210].position.x += 0.01;
    Fluid fluid(s, testExec());
    for (int k = 0; k < 40; ++k) fluid.step();
    const FluidSnapshot now = fluid.snapshot();
    const double gap = now.position[210].x - now.position[211].x; // beside it in y, not displaced
    if (shifting > 0)
      EXPECT_LT(gap, 0.0095);
    else
      EXPECT_NEAR(gap, 0.01, 1e-4);
  }
}

/// A viscous square with a rotation that grows with the radius: central forces have no moment, Morris forces have.
TEST(Fluid, CentralViscosityConservesAngularMomentum) {
  double change[2];
  for (const bool central : {false, true}) {
    FluidSetup s;
    FluidModel& m = s.model = water(2, 0.1);
    m.viscosity = 20, m.centralViscosity = central, m.timeStep = 2e-4;
    for (int i = -5; i < 5; ++i)
      for (int j = -5; j < 5; ++j) {
        const double x = 0.1 * (i + 0.5), y = 0.1 * (j + 0.5), turn = 1 + 4 * (x * x + y * y);
        s.particles.push_back({{x, y, 0}, {-y * turn, x * turn, 0}, 0});
      }
    Fluid fluid(s, testExec());
    const auto angularMomentum = [&] {
      const FluidSnapshot now = fluid.snapshot();
      double sum = 0;
      for (std::size_t i = 0; i < now.position.size(); ++i)
        sum += now.position[i].x * now.velocity[i].y - now.position[i].y * now.velocity[i].x;
      return sum;
    };
    const double start = angularMomentum();
    while (fluid.time() < 0.3) fluid.step();
    change[central] = std::abs(angularMomentum() / start - 1);
    EXPECT_GT(fluid.totals().viscousLoss, 0) << central;
  }
  EXPECT_LT(change[1], 1e-6); // single precision of pairs
  EXPECT_GT(change[0], 1e-3);
}

/// Without walls, gravity, viscosity and diffusion only the time step changes the energy: a second-order error.
TEST(Fluid, TheErrorOfEnergyIsOfSecondOrderInTheStep) {
  std::vector<double> errors;
  for (const int finer : {1, 2, 4}) {
    FluidSetup s;
    FluidModel& m = s.model = water(2, 0.1);
    m.attraction = 1, m.soundSpeed = 15, m.diffusion = m.artificialViscosity = 0;
    m.timeStep = stepLimits(m, 1.5, 1).least() / finer;
    for (int i = -6; i < 6; ++i)
      for (int j = -6; j < 6; ++j) {
        const double x = 0.1 * (i + 0.5), y = 0.1 * (j + 0.5), r2 = x * x + y * y;
        if (r2 < 0.3) s.particles.push_back({{x, y, 0}, {x, -y, 0}, compressionAt(m, m.density * (0.3 - r2))});
      }
    Fluid fluid(s, testExec());
    const double start = fluid.totals().total();
    double worst = 0;
    while (fluid.time() < 0.5) fluid.step(), worst = std::max(worst, std::abs(fluid.totals().total() - start));
    errors.push_back(worst / start);
  }
  EXPECT_LT(errors[0], 1e-5);
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2, 0.1);
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2, 0.1); // single precision of pairs: 1e-7
}

TEST(Fluid, LossesOfViscosityAndDiffusionCloseTheEnergyOfACollapse) {
  FluidSetup s = damBreak();
  s.model.viscosity = 0, s.model.artificialViscosity = 0.1;
  Fluid fluid(s, testExec());
  const FluidTotals start = fluid.totals();
  while (fluid.time() < 0.4) fluid.step();
  const FluidTotals end = fluid.totals();
  const double fallen = start.potential - end.potential;
  EXPECT_GT(end.kinetic, 0.2 * fallen);
  EXPECT_GT(end.viscousLoss, 0.02 * fallen);
  EXPECT_GT(end.diffusionLoss, 0);
  EXPECT_NEAR((end.total() - start.total()) / fallen, 0, 0.05) << "residual";
}

// --- one answer

TEST(Fluid, HasOneAnswerOnAnyThreadsAndOrderOfParticles) {
  FluidSetup s = damBreak();
  s.model.shifting = 2, s.surfaceDivergence = 2.5;
  std::uint64_t hash = 0;
  for (const int threads : {1, 3}) {
    Fluid fluid(s, testExec(threads));
    for (int k = 0; k < 150; ++k) fluid.step();
    EXPECT_GT(fluid.rebuilds(), 2);
    if (threads == 1) hash = fluid.hash();
    EXPECT_EQ(fluid.hash(), hash);
  }
  // Particles in another order move bitwise identically.
  FluidSetup shuffled = s;
  std::reverse(shuffled.particles.begin(), shuffled.particles.end());
  Fluid first(s, testExec()), second(shuffled, testExec());
  for (int k = 0; k < 150; ++k) first.step(), second.step();
  const FluidSnapshot a = first.snapshot();
  FluidSnapshot b = second.snapshot();
  std::reverse(b.position.begin(), b.position.end());
  std::reverse(b.velocity.begin(), b.velocity.end());
  std::reverse(b.compression.begin(), b.compression.end());
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.compression, b.compression);
}

/// A channel of fluid between a fixed and a moving wall, periodic along x.
FluidSetup movingWall() {
  FluidSetup s;
  FluidModel& m = s.model = water(2, 0.05);
  m.viscosity = 5, m.centralViscosity = true;
  s.periodHigh = {1, 0, 0};
  for (int i = 0; i < 20; ++i)
    for (int k = -3; k < 13; ++k) {
      const Vec3d at{(i + 0.5) * 0.05, 0, (k + 0.5) * 0.05};
      if (k >= 0 && k < 10)
        s.particles.push_back({at, {}, 0});
      else
        s.markers.push_back({at, {k < 0 ? 0.0 : 1.0, 0, 0}});
    }
  return s;
}

TEST(Fluid, HasTheSameBitsOnCuda) {
  if (!base::cudaAvailable()) GTEST_SKIP() << "no CUDA device";
  FluidSetup inviscid = damBreak(), viscous = damBreak();
  inviscid.model.viscosity = 0;
  for (FluidSetup* s : {&inviscid, &viscous}) s->model.shifting = 2, s->surfaceDivergence = 2.5;
  for (const FluidSetup& s : {inviscid, viscous, movingWall()}) {
    Fluid host(s, base::cpuExec(2)), device(s, base::cudaExec());
    for (int k = 0; k < 300; ++k) host.step(), device.step();
    EXPECT_EQ(host.hash(), device.hash());
    EXPECT_EQ(host.markerForces(), device.markerForces());
  }
}

// --- errors

TEST(Fluid, RefusesValuesOutOfRange) {
  const auto messageOf = [](auto change) {
    FluidSetup s;
    s.model = water(3, 0.1);
    s.particles = {{{0, 0, 0}, {}, 0}};
    change(s);
    return test::messageOf([&] { Fluid fluid(s, base::cpuExec(1)); });
  };
  EXPECT_NE(messageOf([](FluidSetup& s) { s.model.dimensions = 1; }).find("dimensions"), std::string::npos);
  EXPECT_NE(messageOf([](FluidSetup& s) { s.model.spacing = 0; }).find("spacing"), std::string::npos);
  EXPECT_NE(messageOf([](FluidSetup& s) { s.model.smoothing = 0.9; }).find("smoothing"), std::string::npos);
  EXPECT_NE(messageOf([](FluidSetup& s) { s.model.diffusion = -1; }).find("negative"), std::string::npos);
  EXPECT_NE(messageOf([](FluidSetup& s) { s.particles.clear(); }).find("no particles"), std::string::npos);
  EXPECT_NE(messageOf([](FluidSetup& s) { s.particles[0].velocity.x = 11; }).find("faster"), std::string::npos);
  EXPECT_NE(messageOf([](FluidSetup& s) { s.particles[0].position.y = NAN; }).find("range"), std::string::npos);
  EXPECT_NE(messageOf([](FluidSetup& s) { s.markers = {{{1e9, 0, 0}}}; }).find("marker"), std::string::npos);
  EXPECT_NE(messageOf([](FluidSetup& s) { s.markers = {{{0, 0, 0}, {0, NAN, 0}}}; }).find("wall"), std::string::npos);
  EXPECT_NE(messageOf([](FluidSetup& s) { s.model.gravity.x = NAN; }).find("finite"), std::string::npos);
  EXPECT_NE(messageOf([](FluidSetup& s) { s.periodHigh.z = 9; }).find("along z"), std::string::npos);
  EXPECT_NE(messageOf([](FluidSetup& s) { s.periodHigh.x = 2, s.particles[0].position.x = -1; }).find("periodic"),
            std::string::npos);
  // h = 0.13 m: lists reach 0.26 m and the skin of 0.03 m.
  EXPECT_NE(messageOf([](FluidSetup& s) { s.periodHigh.x = 0.86; }).find("periodic"), std::string::npos);
  EXPECT_EQ(messageOf([](FluidSetup& s) { s.periodHigh.x = 0.88; }), "");
}

TEST(Fluid, AFaultNamesStepParticleAndRemedy) {
  const auto messageOf = [](const FluidSetup& s, int steps) -> std::string {
    Fluid fluid(s, testExec());
    try {
      for (int k = 0; k < steps; ++k) fluid.step();
    } catch (const base::SimulationError& error) {
      return error.what();
    }
    return "";
  };
  FluidSetup alone;
  alone.model = water(3, 0.1);
  alone.particles = {{{0, 0, 0}, {}, 0}, {{5, 0, 0}, {}, 0}};
  alone.model.gravity = {0, 0, -1e4};
  EXPECT_EQ(messageOf(alone, 9), "");
  const std::string fast = messageOf(alone, 20);
  EXPECT_EQ(fast.find("step 10, time 0.001 s: fluid particle 0 at ("), 0u) << fast;
  EXPECT_NE(fast.find(" m moves at "), std::string::npos) << fast;
  alone.model.gravity = {}, alone.particles[1].velocity = {9, 0, 0}, alone.model.timeStep = 0.01;
  EXPECT_NE(messageOf(alone, 9).find("m moved by more than half the skin"), std::string::npos) << messageOf(alone, 9);
  FluidSetup pressed = tankOfWater();
  pressed.model.timeStep *= 9;
  EXPECT_NE(messageOf(pressed, 300).find("smaller time step"), std::string::npos) << messageOf(pressed, 300);
  // Neighbours that approach compress a particle.
  FluidSetup met = alone;
  met.model = water(3, 0.1), met.model.diffusion = 0;
  met.particles = {{{0, 0, 0}, {8, 0, 0}, 0.295}, {{0.1, 0, 0}, {-8, 0, 0}, 0}};
  EXPECT_NE(messageOf(met, 50).find(", 0, 0) m is compressed by 30."), std::string::npos) << messageOf(met, 50);
  for (FluidParticle& p : met.particles) p.velocity = -p.velocity, p.compression = -p.compression;
  EXPECT_NE(messageOf(met, 50).find(", 0, 0) m is stretched by 30."), std::string::npos) << messageOf(met, 50);
  // 2^41 units of about 2e-9 m.
  FluidSetup lost = alone;
  const double limit = base::positionScale(alone.model.kernel().support()).limit();
  lost.model = water(3, 0.1), lost.particles = {{{0.999999999 * limit, 0, 0}, {9, 0, 0}, 0}};
  EXPECT_NE(messageOf(lost, 9000).find("left the walls or the range of positions; close the gap in the walls"),
            std::string::npos)
      << messageOf(lost, 9000);
  // A particle falls beside a wall.
  lost.model = water(3, 0.1), lost.particles = {{{0, 0, 0}, {0, 0, -9}, 0}}, lost.markers = {{{1, 0, 0}}};
  EXPECT_NE(messageOf(lost, 900).find("m left the walls"), std::string::npos) << messageOf(lost, 900);
}

// --- lattice

TEST(Lattice, FillsATankAndItsWallsWithoutGapsOrOverlaps) {
  const FluidSetup s = tankOfWater();
  EXPECT_EQ(s.particles.size(), 12u * 8 * 10);
  const std::size_t layers = 3; // 2 x 1.3 spacings
  // Rounded edges: points deeper than the support behind an edge are left out.
  std::size_t inBox = (12 + 2 * layers) * (8 + 2 * layers) * (18 + layers);
  EXPECT_LT(s.markers.size(), inBox - 12u * 8 * 18);
  for (const WallMarker& m : s.markers)
    EXPECT_TRUE(m.position.x < 0 || m.position.x > 0.6 || m.position.y < 0 || m.position.y > 0.4 || m.position.z < 0);
  // A particle at the floor has as many neighbours as one in the bulk: the sum of V W is the same as for the lattice.
  const Wendland kernel = s.model.kernel();
  const auto sumAt = [&](const Vec3d& p) {
    double sum = 0;
    for (const FluidParticle& f : s.particles) sum += s.model.volume() * kernel.value(base::norm(f.position - p));
    for (const WallMarker& m : s.markers) sum += s.model.volume() * kernel.value(base::norm(m.position - p));
    return sum;
  };
  EXPECT_NEAR(sumAt({0.025, 0.025, 0.025}), sumAt({0.325, 0.225, 0.225}), 1e-3);
  EXPECT_NEAR(sumAt({0.325, 0.225, 0.225}), 1.009, 6e-4);
}

} // namespace
} // namespace grouser::fluid
