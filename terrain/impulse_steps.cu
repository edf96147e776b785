// SPDX-License-Identifier: BSD-3-Clause
// The solver of complementarity contacts; see impulse_solver.hpp.
#include "terrain/impulse_solver.hpp"

#include "base/error.hpp"
#include "base/summed_banks.hpp"
#include "terrain/grain_system.hpp"
#include "terrain/impulse_advance.cuh"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace grouser::terrain {

namespace {

using contact::ComplementarityOptions;

/// Device memory of rows of one kind.
template <class Real> struct RowMemory {
  using Vectors = base::Array<base::Vec3<Real>>;
  explicit RowMemory(const base::Exec& exec)
      : row(exec), rolling(exec),
        end(exec), impulse{Vectors(exec), Vectors(exec), Vectors(exec)}, gradient{Vectors(exec), Vectors(exec),
                                                                                  Vectors(exec)},
        turning{Vectors(exec), Vectors(exec), Vectors(exec)}, turnGradient{Vectors(exec), Vectors(exec),
                                                                           Vectors(exec)} {}

  base::Array<ImpulseRowRecord<Real>> row;
  base::Array<RollingRowRecord<Real>> rolling;
  base::Array<ImpulseRowEnd<Real>> end;
  std::array<Vectors, 3> impulse, gradient, turning, turnGradient;

  void resize(std::size_t places, bool rolls) {
    row.resize(places), end.resize(places);
    for (auto* three : {&impulse, &gradient})
      for (Vectors& v : *three) v.resize(places);
    if (!rolls) return;
    rolling.resize(places);
    for (auto* three : {&turning, &turnGradient})
      for (Vectors& v : *three) v.resize(places);
  }
  ImpulseRowsView<Real> view() {
    ImpulseRowsView<Real> v{};
    v.row = row.data(), v.rolling = rolling.data(), v.end = end.data();
    for (std::size_t k = 0; k < 3; ++k) {
      v.impulse[k] = impulse[k].data(), v.gradient[k] = gradient[k].data();
      v.turning[k] = turning[k].data(), v.turnGradient[k] = turnGradient[k].data();
    }
    return v;
  }
  std::size_t bytes() const {
    std::size_t sum = row.bytes() + rolling.bytes() + end.bytes();
    for (const auto* three : {&impulse, &gradient, &turning, &turnGradient})
      for (const Vectors& v : *three) sum += v.bytes();
    return sum;
  }
};

/// Sums of an iteration over all ranks.
struct IterationSums {
  double curvature, length, against, squares, contacts, worst;
};

template <class Real> class ImpulseSolverOf : public ImpulseSolver {
public:
  ImpulseSolverOf(const base::Exec& exec, const GrainConstants& c)
      : exec_(exec), options_(*c.model.complementarity), grains_(exec), bounds_(exec), grainRows_(exec),
        boundRows_(exec), degree_(exec), free_(exec), motion_(exec),
        sums_(exec, std::size_t{kSumBanks} * kImpulseSums * kSumSizes), worst_(exec, 1), surfaceRows_(exec),
        surfacePushes_(exec), surfaceChange_(exec) {
    const auto real = [](double value) { return static_cast<Real>(value); };
    const ContactLaw& law = c.model.materials.count() > 0 ? c.model.materials.grains.front() : c.model.law;
    data_.rules = {real(c.model.timeStep),
                   real(options_.recovery),
                   real(options_.impact),
                   real(law.stiffness),
                   options_.compliance == contact::Compliance::rigid,
                   false};
    data_.margin = c.marginUnits;
    data_.leastMargin = c.scale.inUnits(GrainConstants::kLeastMargin * c.smallestRadius);
    // Range of the sums: velocity changes that would move a grain by 16 radii in a step.
    const double fastest = 16 * c.model.radius / c.model.timeStep;
    data_.perEnergy = base::fixedPointFor(c.model.mass * fastest * fastest, 50).perUnit;
    data_.perSquare = base::fixedPointFor(fastest * fastest, 50).perUnit;
  }

  void step(GrainSystem& system, const GrainKernelData& d) override {
    setUp(system, d);
    solve(system, d);
    advance(d);
  }

  std::size_t bytes() const override {
    return grains_.bytes() + bounds_.bytes() + grainRows_.bytes() + boundRows_.bytes() + degree_.bytes() +
           free_.bytes() + motion_.bytes();
  }

private:
  using ContactLaw = contact::ContactLaw;

  template <class Body> void forSlots(const char* name, const GrainKernelData& d, const Body& body) const {
    base::forEach(exec_, name, d.count, body);
  }
  template <class Kernel> Kernel kernel(const GrainKernelData& d) const {
    Kernel k;
    k.d = d, k.f = force_, k.s = data_;
    return k;
  }

  void setUp(GrainSystem& system, const GrainKernelData& d) {
    const auto slots = static_cast<std::size_t>(d.count);
    const bool rolls = (d.features & contact::kRollingFriction) != 0;
    const std::size_t near = system.boundaries.grainsListed();
    grains_.resize(system.neighbours.places(), rolls);
    bounds_.resize(near * static_cast<std::size_t>(d.boundaryCount), rolls);
    grainRows_.resize(slots), boundRows_.resize(near), degree_.resize(slots), free_.resize(slots);
    motion_.resize(slots);
    data_.grains = grains_.view(), data_.bounds = bounds_.view();
    data_.grainRows = grainRows_.data(), data_.boundRows = boundRows_.data(), data_.degree = degree_.data();
    data_.near = static_cast<std::int64_t>(near), data_.free = free_.data(), data_.motion = motion_.data();
    data_.ghost = system.ghosts(), data_.sums = sums_.data(), data_.worst = worst_.data();
    data_.now = data_.before = 0, data_.tried = 2;
    data_.rules.associated = options_.friction == contact::ImpulseFriction::associated;
    force_ = system.forceData<Real>();
    setUpSurfaces(system);
    forSlots("rows of grains", d, kernel<MakeGrainRows<Real>>(d));
    base::forEach(exec_, "rows at boundaries", data_.near, kernel<MakeBoundaryRows<Real>>(d));
    forSlots("count rows", d, CountRows<Real>{d, data_});
    exchange(system, contact::fieldOf(degree_));
    countOnSurfaces(system.comm);
    forSlots("weigh rows", d, kernel<WeighRows<Real>>(d));
  }

  // Force-driven surfaces: each has one speed, the same on all ranks.

  void setUpSurfaces(const GrainSystem& system) {
    inverseMass_.clear();
    std::vector<double> masses;
    for (const SurfacePose& pose : system.boundaries.surfacePoses()) masses.push_back(pose.inverseMass);
    if (std::all_of(masses.begin(), masses.end(), [](double m) { return m == 0; })) return;
    inverseMass_ = masses;
    surfaceRows_.assign(std::vector<std::uint32_t>(masses.size()));
    surfacePushes_.resize(masses.size()), surfaceChange_.assign(std::vector<Real>(masses.size()));
    data_.push = base::fixedPointFor(system.boundaries.strongest() * system.constants.model.timeStep, 40);
    data_.surfaceRows = surfaceRows_.data(), data_.surfacePushes = surfacePushes_.data();
    data_.surfaceChange = surfaceChange_.data();
  }

  void countOnSurfaces(const base::Comm& comm) {
    if (inverseMass_.empty() || comm.alone()) return;
    const std::vector<std::uint32_t> mine = surfaceRows_.toHost();
    std::vector<std::int64_t> all(mine.begin(), mine.end());
    comm.sum(all.data(), all.size());
    surfaceRows_.assign(std::vector<std::uint32_t>(all.begin(), all.end()));
  }

  void moveSurfaces(const base::Comm& comm) {
    if (inverseMass_.empty()) return;
    std::vector<std::int64_t> pushes = surfacePushes_.toHost();
    comm.sum(pushes.data(), pushes.size());
    std::vector<Real> change;
    for (std::size_t k = 0; k < pushes.size(); ++k)
      change.push_back(static_cast<Real>(data_.push.checked(pushes[k], "impulses on a surface") * inverseMass_[k]));
    surfaceChange_.assign(change);
  }

  /// Sends the values of masters to their ghosts on other ranks.
  static void exchange(GrainSystem& system, const contact::ExchangeField& field) {
    if (system.distribution) system.distribution->subdomain().haloExchange().run({&field, 1});
  }

  template <bool kTry> IterationSums evaluate(GrainSystem& system, const GrainKernelData& d) {
    using Gradient = FindGradient<Real, kTry>;
    if (!inverseMass_.empty()) surfacePushes_.zero();
    forSlots("move by impulses", d, kernel<MoveByImpulses<Real, kTry>>(d));
    exchange(system, contact::fieldOf(motion_));
    moveSurfaces(system.comm);
    sums_.zero(), worst_.zero();
    Gradient gradient = kernel<Gradient>(d);
    gradient.count = d.count;
    base::forEach(exec_, "gradient of rows",
                  exec_.onCpu() ? (d.count + Gradient::kOnCpu - 1) / Gradient::kOnCpu : d.count, gradient);
    return summed(system.comm);
  }

  IterationSums summed(const base::Comm& comm) const {
    const std::vector<base::WideSum> sums =
        base::summedBanks(sums_.toHost(), std::size_t{kImpulseSums} * kSumSizes, comm);
    const auto sum = [&](int which, double perUnit) {
      const std::size_t k = static_cast<std::size_t>(which) * kSumSizes;
      return sums[k].value() / perUnit + sums[k + 1].value() / (perUnit * kFinerSums);
    };
    std::uint64_t least = ~std::uint64_t{worst_.toHost().front()};
    comm.minimum(&least, 1);
    const auto worst = base::bitsAs<float>(static_cast<std::uint32_t>(~least));
    return {sum(kCurvature, data_.perEnergy), sum(kLength, data_.perEnergy), sum(kAgainst, data_.perEnergy),
            sum(kSquares, data_.perSquare),   sum(kContacts, kPerContact),   static_cast<double>(worst)};
  }

  void solve(GrainSystem& system, const GrainKernelData& d) {
    report_ = {};
    IterationSums last = evaluate<false>(system, d);
    data_.tau = Real(kSafeTau), data_.ahead = 0;
    double theta = 1, halved = last.worst;
    int halvedAt = 0;
    while (last.worst > options_.residual && report_.iterations < options_.iterations) {
      const IterationSums tried = evaluate<true>(system, d);
      if (data_.tau < kSafeTau && tried.curvature > static_cast<double>(data_.tau) * tried.length) {
        data_.tau = std::min(2 * data_.tau, Real(kSafeTau)); // the step was too long: repeat it
        continue;
      }
      const double next = tried.against > 0 ? 1 : 0.5 * theta * (std::sqrt(theta * theta + 4) - theta);
      data_.ahead = tried.against > 0 ? Real(0) : static_cast<Real>(theta * (1 - theta) / (theta * theta + next));
      theta = next;
      data_.tau *= Real(kLongerStep);
      accept();
      last = tried;
      ++report_.iterations;
      if (last.worst < 0.5 * halved) halved = last.worst, halvedAt = report_.iterations;
      if (report_.iterations - halvedAt > kPatience && !data_.rules.associated) relax(system, d, last, theta);
    }
    report_.residual = last.worst, report_.met = last.worst <= options_.residual;
    report_.rows = last.contacts;
    report_.rms = report_.rows > 0 ? std::sqrt(last.squares / report_.rows) : 0;
    totals_.add(report_);
    checkReport(report_, options_, system.steps);
  }

  /// Coulomb's own law has no potential: where it does not converge, the step ends with the relaxation, which does.
  void relax(GrainSystem& system, const GrainKernelData& d, IterationSums& last, double& theta) {
    report_.relaxed = true, data_.rules.associated = true;
    data_.before = data_.now, data_.ahead = 0, theta = 1;
    last = evaluate<false>(system, d);
  }

  /// Makes the trial the current iteration, and that the previous one.
  void accept() {
    const int old = std::exchange(data_.now, data_.tried);
    data_.before = old;
    data_.tried = 3 - data_.now - data_.before;
  }

  void advance(const GrainKernelData& d) {
    using Body = AdvanceByImpulses<Real>;
    const Body body = kernel<Body>(d);
    if (d.books)
      base::forEach(exec_, "advance by impulses", Booked<Body>::items(exec_, d.count), Booked<Body>{body, d.count});
    else
      forSlots("advance by impulses", d, body);
  }

  static constexpr double kSafeTau = 1, kLongerStep = 0.97; ///< the metric bounds the curvature at tau = 1
  static constexpr int kPatience = 50;                      ///< iterations within which the residual must halve

  base::Exec exec_;
  ComplementarityOptions options_;
  ImpulseData<Real> data_{};
  ForceData<Real> force_{};
  RowMemory<Real> grains_, bounds_;
  base::Array<std::uint32_t> grainRows_, boundRows_, degree_;
  base::Array<ImpulseMotion<Real>> free_, motion_;
  base::Array<base::WideSum> sums_;
  base::Array<std::uint32_t> worst_;
  std::vector<double> inverseMass_; ///< [surface] [1/kg]; empty without force-driven surfaces
  base::Array<std::uint32_t> surfaceRows_;
  base::Array<std::int64_t> surfacePushes_;
  base::Array<Real> surfaceChange_; ///< [m/s]
};

} // namespace

std::unique_ptr<ImpulseSolver> ImpulseSolver::make(const base::Exec& exec, const GrainConstants& constants) {
  if (!constants.model.complementarity) return nullptr;
  if (constants.model.precision == Precision::single) return std::make_unique<ImpulseSolverOf<float>>(exec, constants);
  return std::make_unique<ImpulseSolverOf<double>>(exec, constants);
}

} // namespace grouser::terrain
