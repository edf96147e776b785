// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/fluid_cases.hpp"

#include "base/math.hpp"
#include "fluid/fluid.hpp"
#include "fluid/lattice.hpp"
#include "runs/jobs/study_place.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace grouser::studies {

using base::kPi;
using base::Vec3d;
using fluid::Fluid;
using fluid::FluidSetup;
using fluid::FluidSnapshot;

namespace {

/// Advances a fluid to the time `end` [s], and calls `look` after each step.
template <class Look>
void drive(const FluidSetup& setup, double end, const base::Exec& exec, FluidPoint& point, const Look& look) {
  Fluid fluid(setup, exec);
  point.timeStep = setup.model.timeStep, point.particles = fluid.particles();
  double seconds = 0;
  while (fluid.time() < end - 1e-9) {
    jobs::stopStudyOnRequest();
    const auto begin = std::chrono::steady_clock::now();
    fluid.step();
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    look(fluid);
  }
  point.steps = fluid.steps(), point.seconds = seconds;
}

/// Two-dimensional flow in the xz plane, or in the xy plane if x and y are periodic.
FluidSetup planar(double spacing) {
  FluidSetup setup;
  setup.model.dimensions = 2, setup.model.spacing = spacing;
  return setup;
}

std::int64_t cellsOf(double length, double spacing) { return std::llround(length / spacing); }
double centre(std::int64_t k, double spacing) { return (static_cast<double>(k) + 0.5) * spacing; }

/// Zero crossings of a signal, by linear interpolation between steps.
class ZeroCrossings {
public:
  void add(double time, double value) {
    if (before_ * value < 0) times_.push_back(time_ + (time - time_) * before_ / (before_ - value));
    time_ = time, before_ = value;
  }
  /// Mean time between crossings; 0 if there are fewer than two.
  double meanDistance() const {
    return times_.size() < 2 ? 0 : (times_.back() - times_.front()) / static_cast<double>(times_.size() - 1);
  }

private:
  std::vector<double> times_;
  double time_ = 0, before_ = 0;
};

double relative(double measured, double exact) { return std::abs(measured - exact) / std::abs(exact); }

/// Water at rest in a tank: the pressure is rho g (H - z), and the force on the floor is the weight.
void stillTank(const base::Exec& exec, FluidPoint& point) {
  constexpr double kDepth = 0.5, kWidth = 0.5, kEnd = 2, kSpare = 0.3, kWall = 0.3; // [m], [s]
  FluidSetup setup = planar(point.spacing);
  fluid::FluidModel& m = setup.model;
  m.gravity = {0, 0, -jobs::kGravity};
  m.soundSpeed = fluid::soundSpeedFor(std::sqrt(2 * jobs::kGravity * kDepth), 0, m.density);
  m.timeStep = fluid::stepLimits(m, 0.1 * m.soundSpeed, jobs::kGravity).least();
  const auto distance = fluid::tank({0, -1, 0}, {kWidth, 1, kDepth + kSpare});
  const Vec3d low{-kWall, 0, -kWall}, high{kWidth + kWall, 0, kDepth + kSpare};
  setup.markers = fluid::wallMarkers(m, distance, low, high);
  setup.particles = fluid::stillFluid(m, distance, low, high, kDepth);
  const double bottom = m.density * jobs::kGravity * kDepth;
  double force = 0, square = 0, worst = 0;
  int looks = 0;
  drive(setup, kEnd, exec, point, [&](Fluid& f) {
    if (f.time() < kEnd / 2 || f.steps() % 10 != 0) return;
    force += f.totals().wallForce.z, ++looks;
    if (f.time() < kEnd - 20 * m.timeStep) return;
    const FluidSnapshot s = f.snapshot();
    square = worst = 0;
    for (std::size_t i = 0; i < s.position.size(); ++i) {
      const double error = pressureAt(m, s.compression[i]) / bottom - (1 - s.position[i].z / kDepth);
      square += error * error, worst = std::max(worst, std::abs(error));
    }
  });
  const double n = static_cast<double>(point.particles), weight = m.mass() * n * jobs::kGravity;
  point.errors = {std::sqrt(square / n), worst, relative(-force / looks, weight)};
}

/// A plane sound wave 1 m long on a square lattice. From the linear equations, its speed on the lattice is c D(k)/k,
/// where D(k) is the sum of V F x sin(k x).
void soundWave(const base::Exec& exec, FluidPoint& point) {
  constexpr double kSpeed = 10, kAmplitude = 1e-3, kEnd = 0.5; // [m/s], [m/s], [s]
  FluidSetup setup = planar(point.spacing);
  fluid::FluidModel& m = setup.model;
  m.soundSpeed = kSpeed, m.artificialViscosity = m.diffusion = 0;
  m.timeStep = 0.25 * m.kernel().length() / kSpeed;
  const std::int64_t along = cellsOf(1, point.spacing), across = 20;
  setup.periodHigh = {1, static_cast<double>(across) * point.spacing, 0};
  for (std::int64_t i = 0; i < along; ++i)
    for (std::int64_t j = 0; j < across; ++j) {
      const double x = centre(i, point.spacing);
      setup.particles.push_back({{x, centre(j, point.spacing), 0}, {kAmplitude * std::sin(2 * kPi * x), 0, 0}, 0});
    }
  ZeroCrossings crossings;
  drive(setup, kEnd, exec, point, [&](Fluid& f) {
    const FluidSnapshot s = f.snapshot();
    double signal = 0;
    for (std::size_t i = 0; i < s.position.size(); ++i) signal += s.velocity[i].x * std::sin(2 * kPi * s.position[i].x);
    crossings.add(f.time(), signal);
  });
  const fluid::Wendland kernel = m.kernel();
  double dispersion = 0;
  for (int i = -4; i <= 4; ++i)
    for (int j = -4; j <= 4; ++j) {
      const double x = i * point.spacing, y = j * point.spacing;
      dispersion -= m.volume() * kernel.slope(std::hypot(x, y)) * x * std::sin(2 * kPi * x);
    }
  const double speed = 0.5 / crossings.meanDistance(); // half a wavelength / half a period
  point.errors = {relative(speed, kSpeed * dispersion / (2 * kPi)), relative(speed, kSpeed)};
}

/// Decaying vortices in a periodic square (Taylor and Green 1937) at Re 100; energy ~ exp(-16 pi^2 t/Re).
void taylorGreen(const base::Exec& exec, FluidPoint& point) {
  constexpr double kReynolds = 100, kEnd = 0.5, kDisorder = 1e-3; // [-], [s], spacings
  FluidSetup setup = planar(point.spacing);
  fluid::FluidModel& m = setup.model;
  m.density = 1, m.soundSpeed = 10, m.viscosity = 1 / kReynolds, m.artificialViscosity = 0;
  m.smoothing = 2, m.shifting = 20;
  m.timeStep = 0.25 * m.kernel().length() / m.soundSpeed;
  setup.periodHigh = {1, 1, 0};
  const std::int64_t cells = cellsOf(1, point.spacing);
  for (std::int64_t i = 0; i < cells; ++i)
    for (std::int64_t j = 0; j < cells; ++j) {
      const double x = centre(i, point.spacing), y = centre(j, point.spacing), k = 2 * kPi;
      // The lattice is perturbed, because exact sums would preserve the (unstable) symmetry of a perfect lattice.
      const double dx = kDisorder * point.spacing * std::sin(static_cast<double>(37 * i + 91 * j * j));
      const double dy = kDisorder * point.spacing * std::sin(static_cast<double>(53 * j + 71 * i * i));
      const double pressure = -0.25 * (std::cos(2 * k * x) + std::cos(2 * k * y));
      setup.particles.push_back({{x + dx, y + dy, 0},
                                 {-std::cos(k * x) * std::sin(k * y), std::sin(k * x) * std::cos(k * y), 0},
                                 compressionAt(m, pressure)});
    }
  double energy = 0, momentum = 0;
  drive(setup, kEnd, exec, point, [&](Fluid& f) {
    if (f.time() < kEnd - 1e-9) return;
    const fluid::FluidTotals t = f.totals();
    energy = t.kinetic / (0.25 * std::exp(-16 * kPi * kPi * f.time() / kReynolds));
    momentum = base::norm(t.momentum);
  });
  point.errors = {relative(energy, 1), momentum};
}

/// Flow that starts from rest in a channel 0.2 m wide; viscosity 1e-3 m2/s.
FluidSetup channel(double spacing, double wallSpeed, double pull) {
  constexpr double kGap = 0.2, kLength = 0.2; // [m]
  FluidSetup setup = planar(spacing);
  fluid::FluidModel& m = setup.model;
  m.viscosity = 1, m.soundSpeed = 2.5, m.artificialViscosity = 0, m.smoothing = 1.5, m.gravity = {pull, 0, 0};
  m.timeStep = fluid::stepLimits(m, 0.25, pull).least();
  setup.periodHigh = {kLength, 0, 0};
  const std::int64_t layers = static_cast<std::int64_t>(std::ceil(2 * m.smoothing)), across = cellsOf(kGap, spacing);
  for (std::int64_t i = 0; i < cellsOf(kLength, spacing); ++i)
    for (std::int64_t k = -layers; k < across + layers; ++k) {
      const Vec3d at{centre(i, spacing), 0, centre(k, spacing)};
      if (k >= 0 && k < across)
        setup.particles.push_back({at, {}, 0});
      else
        setup.markers.push_back({at, {k < 0 ? 0 : wallSpeed, 0, 0}});
    }
  return setup;
}

/// RMS difference between the velocity and `exact(z, t)` at the time `end` / maximum velocity.
template <class Exact> double profileError(const FluidSetup& setup, double end, const base::Exec& exec,
                                           FluidPoint& point, const Exact& exact) {
  double square = 0, greatest = 0;
  drive(setup, end, exec, point, [&](Fluid& f) {
    if (f.time() < end - 1e-9) return;
    const FluidSnapshot s = f.snapshot();
    for (std::size_t i = 0; i < s.position.size(); ++i) {
      const double u = exact(s.position[i].z, f.time()), error = s.velocity[i].x - u;
      square += error * error, greatest = std::max(greatest, std::abs(u));
    }
  });
  return std::sqrt(square / static_cast<double>(point.particles)) / greatest;
}

void poiseuille(const base::Exec& exec, FluidPoint& point) {
  constexpr double kPull = 0.05, kGap = 0.2, kNu = 1e-3, kEnd = 5;
  point.errors = {profileError(channel(point.spacing, 0, kPull), kEnd, exec, point, [](double z, double t) {
    double u = kPull / (2 * kNu) * z * (kGap - z);
    for (int k = 1; k < 100; k += 2)
      u -= 4 * kPull * kGap * kGap / (kNu * std::pow(kPi * k, 3)) * std::sin(kPi * k * z / kGap) *
           std::exp(-k * k * kPi * kPi * kNu * t / (kGap * kGap));
    return u;
  })};
}

void couette(const base::Exec& exec, FluidPoint& point) {
  constexpr double kSpeed = 0.2, kGap = 0.2, kNu = 1e-3, kEnd = 5;
  point.errors = {profileError(channel(point.spacing, kSpeed, 0), kEnd, exec, point, [](double z, double t) {
    double u = kSpeed * z / kGap;
    for (int n = 1; n < 100; ++n)
      u += 2 * kSpeed * (n % 2 ? -1 : 1) / (n * kPi) * std::sin(n * kPi * z / kGap) *
           std::exp(-n * n * kPi * kPi * kNu * t / (kGap * kGap));
    return u;
  })};
}

/// Standing wave of small amplitude in water 1 m deep and 2 m long, g = 1 m/s2, Re 250: half period
/// pi/sqrt(g k tanh kH), kinetic energy ~ exp(-4 nu k^2 t).
void standingWave(const base::Exec& exec, FluidPoint& point) {
  constexpr double kDepth = 1, kLength = 2, kGravity = 1, kAmplitude = 0.05, kReynolds = 250, kHalfPeriods = 4;
  FluidSetup setup = planar(point.spacing);
  fluid::FluidModel& m = setup.model;
  const double k = 2 * kPi / kLength, omega = std::sqrt(kGravity * k * std::tanh(k * kDepth)), half = kPi / omega;
  m.gravity = {0, 0, -kGravity}, m.artificialViscosity = 0;
  m.centralViscosity = true, m.smoothing = 1.5; // with a smoothing of 1.3, the period is 5 % too short
  m.viscosity = m.density * kDepth * std::sqrt(kGravity * kDepth) / kReynolds;
  m.soundSpeed = fluid::soundSpeedFor(std::sqrt(2 * kGravity * kDepth), 0, m.density);
  m.timeStep = fluid::stepLimits(m, 0.1 * m.soundSpeed, kGravity).least();
  setup.periodHigh = {kLength, 0, 0};
  const auto floor = [](const Vec3d& p) { return p.z; };
  const Vec3d low{0, 0, -0.5}, high{kLength, 0, kDepth};
  setup.markers = fluid::wallMarkers(m, floor, low, high);
  setup.particles = fluid::stillFluid(m, floor, low, high, kDepth);
  const double potential = kAmplitude * kGravity * k / omega / std::cosh(k * kDepth);
  for (fluid::FluidParticle& p : setup.particles)
    p.velocity = {-potential * std::cosh(k * p.position.z) * std::sin(k * p.position.x), 0,
                  potential * std::sinh(k * p.position.z) * std::cos(k * p.position.x)};
  ZeroCrossings crossings;
  double start = 0, last = 0;
  drive(setup, (kHalfPeriods + 0.25) * half, exec, point, [&](Fluid& f) {
    const FluidSnapshot s = f.snapshot();
    double signal = 0, energy = 0;
    for (std::size_t i = 0; i < s.position.size(); ++i)
      signal += s.velocity[i].z * std::cos(k * s.position[i].x), energy += norm2(s.velocity[i]);
    crossings.add(f.time(), signal);
    if (f.steps() == 1) start = energy;
    if (f.time() > (kHalfPeriods - 0.25) * half) last = std::max(last, energy);
  });
  const double rate = std::log(start / last) / (kHalfPeriods * half), nu = m.viscosity / m.density;
  point.errors = {relative(crossings.meanDistance(), half), relative(rate, 4 * nu * k * k)};
}

/// A drop of radius 1 m under the central force -r per mass. It starts with the velocity (x, -y) and stays an ellipse,
/// which oscillates with the period 4.8274 s, from a' = s a, s' = (s^2 + 1)(b^2 - a^2)/(a^2 + b^2), b = 1/a.
void oscillatingDrop(const base::Exec& exec, FluidPoint& point) {
  constexpr double kPeriod = 4.8274, kEnd = 10; // [s]
  FluidSetup setup = planar(point.spacing);
  fluid::FluidModel& m = setup.model;
  m.soundSpeed = 15, m.attraction = 1;
  m.timeStep = fluid::stepLimits(m, 1.5, 1).least();
  const std::int64_t n = cellsOf(1, point.spacing) + 1;
  for (std::int64_t i = -n; i < n; ++i)
    for (std::int64_t j = -n; j < n; ++j) {
      const double x = centre(i, point.spacing), y = centre(j, point.spacing), r2 = x * x + y * y;
      if (r2 < 1) setup.particles.push_back({{x, y, 0}, {x, -y, 0}, compressionAt(m, m.density * (1 - r2))});
    }
  ZeroCrossings crossings;
  double momentum = 0;
  drive(setup, kEnd, exec, point, [&](Fluid& f) {
    const FluidSnapshot s = f.snapshot();
    double x2 = 0, y2 = 0;
    Vec3d sum{};
    for (std::size_t i = 0; i < s.position.size(); ++i)
      x2 += s.position[i].x * s.position[i].x, y2 += s.position[i].y * s.position[i].y, sum += s.velocity[i];
    crossings.add(f.time(), x2 - y2);
    momentum = base::norm(sum) / static_cast<double>(s.position.size());
  });
  point.errors = {relative(2 * crossings.meanDistance(), kPeriod), momentum};
}

/// A square of fluid that spins at 1 rad/s without walls. It keeps its angular momentum and most of its energy.
void rotatingPatch(const base::Exec& exec, FluidPoint& point) {
  constexpr double kEnd = 2; // [s], [rad]
  FluidSetup setup = planar(point.spacing);
  fluid::FluidModel& m = setup.model;
  m.soundSpeed = 7, m.timeStep = fluid::stepLimits(m, 0.7, 0.7).least();
  const std::int64_t n = cellsOf(0.5, point.spacing);
  for (std::int64_t i = -n; i < n; ++i)
    for (std::int64_t j = -n; j < n; ++j) {
      const double x = centre(i, point.spacing), y = centre(j, point.spacing);
      setup.particles.push_back({{x, y, 0}, {-y, x, 0}, 0});
    }
  const auto spinOf = [](const FluidSnapshot& s) {
    double spin = 0;
    for (std::size_t i = 0; i < s.position.size(); ++i)
      spin += s.position[i].x * s.velocity[i].y - s.position[i].y * s.velocity[i].x;
    return spin;
  };
  double firstSpin = 0, spin = 0, energy = 0, firstEnergy = 0;
  drive(setup, kEnd, exec, point, [&](Fluid& f) {
    if (f.steps() == 1) firstSpin = spinOf(f.snapshot()), firstEnergy = f.totals().kinetic;
    if (f.time() < kEnd - m.timeStep) return;
    spin = spinOf(f.snapshot());
    energy = f.totals().kinetic;
  });
  point.errors = {relative(energy, firstEnergy), relative(spin, firstSpin)};
}

} // namespace

std::vector<FluidCase> fluidCases() {
  return {
      {"tank",
       "tank at rest, 0.5 m deep, 2 s",
       {{"pressure, rms", 0.01}, {"pressure, worst", 0.025}, {"base force", 0.002}},
       {0.04, 0.02, 0.01},
       stillTank},
      {"sound",
       "plane sound wave of 1 m",
       {{"speed on the lattice", 0.002}, {"speed", 0}},
       {0.1, 0.05, 0.025},
       soundWave},
      {"taylor-green",
       "Taylor-Green vortices, Re 100, 0.5 s",
       {{"energy", 0.02}, {"momentum", 1e-9}},
       {0.04, 0.02, 0.01},
       taylorGreen},
      {"poiseuille", "Poiseuille flow from rest, 5 s", {{"velocity, rms", 0.01}}, {0.02, 0.01, 0.005}, poiseuille},
      {"couette", "Couette flow from rest, 5 s", {{"velocity, rms", 0.01}}, {0.02, 0.01, 0.005}, couette},
      {"wave",
       "standing wave, 2 m long, Re 250",
       {{"half period", 0.005}, {"decay rate", 0.15}},
       {0.08, 0.04, 0.02},
       standingWave},
      {"drop",
       "oscillating drop of radius 1 m",
       {{"period", 0.01}, {"momentum", 1e-9}},
       {0.1, 0.05, 0.025},
       oscillatingDrop},
      {"patch", "rotating square, 2 rad", {{"energy", 0.05}, {"spin", 1e-6}}, {0.04, 0.02, 0.01}, rotatingPatch},
  };
}

support::LineFit fluidOrder(const std::vector<FluidPoint>& points, std::size_t quantity) {
  std::vector<double> spacing, error;
  for (const FluidPoint& p : points) spacing.push_back(p.spacing), error.push_back(p.errors.at(quantity));
  return support::fitPower(spacing, error);
}

} // namespace grouser::studies
