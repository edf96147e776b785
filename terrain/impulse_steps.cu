// SPDX-License-Identifier: BSD-3-Clause
// The solver of complementarity contacts; see impulse_solver.hpp.
#include "terrain/impulse_solver.hpp"

#include "base/error.hpp"
#include "base/summed_banks.hpp"
#include "terrain/grain_system.hpp"
#include "terrain/impulse_advance.cuh"
#include "terrain/impulse_bodies.cuh"
#include "terrain/impulse_parts.cuh"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

namespace grouser::terrain {

namespace {

using contact::ComplementarityOptions;

/// Device memory of the rows of one kind.
template <class Real> struct RowMemory {
  using Vectors = base::Array<base::Vec3<Real>>;
  explicit RowMemory(const base::Exec& exec)
      : row(exec), other(exec), rolling(exec), end(exec),
        part(exec), impulse{Vectors(exec), Vectors(exec), Vectors(exec)}, gradient{Vectors(exec), Vectors(exec),
                                                                                   Vectors(exec)},
        turning{Vectors(exec), Vectors(exec), Vectors(exec)}, turnGradient{Vectors(exec), Vectors(exec),
                                                                           Vectors(exec)} {}

  base::Array<ImpulseRowRecord<Real>> row;
  base::Array<ImpulseRowOther<Real>> other;
  base::Array<RollingRowRecord<Real>> rolling;
  base::Array<ImpulseRowEnd<Real>> end;
  base::Array<PartRowRecord<Real>> part; ///< empty without parts
  std::array<Vectors, 3> impulse, gradient, turning, turnGradient;

  void resize(std::size_t places, bool rolls) {
    row.resize(places), other.resize(places), end.resize(places);
    for (auto* three : {&impulse, &gradient})
      for (Vectors& v : *three) v.resize(places);
    if (!rolls) return;
    rolling.resize(places);
    for (auto* three : {&turning, &turnGradient})
      for (Vectors& v : *three) v.resize(places);
  }
  ImpulseRowsView<Real> view() {
    ImpulseRowsView<Real> v{};
    v.row = row.data(), v.other = other.data(), v.rolling = rolling.data(), v.end = end.data(), v.part = part.data();
    for (std::size_t k = 0; k < 3; ++k) {
      v.impulse[k] = impulse[k].data(), v.gradient[k] = gradient[k].data();
      v.turning[k] = turning[k].data(), v.turnGradient[k] = turnGradient[k].data();
    }
    return v;
  }
  std::size_t bytes() const {
    std::size_t sum = row.bytes() + other.bytes() + rolling.bytes() + end.bytes() + part.bytes();
    for (const auto* three : {&impulse, &gradient, &turning, &turnGradient})
      for (const Vectors& v : *three) sum += v.bytes();
    return sum;
  }
};

template <class Real> class ImpulseSolverOf : public ImpulseSolver {
public:
  ImpulseSolverOf(const base::Exec& exec, const GrainConstants& c)
      : exec_(exec), options_(*c.model.complementarity), grains_(exec), bounds_(exec), onParts_(exec), bodies_(exec),
        partRows_(exec), grainRows_(exec), boundRows_(exec), degree_(exec),
        free_(exec), motion_{Motions(exec), Motions(exec), Motions(exec)},
        sums_(exec, std::size_t{kSumBanks} * SumBanks<Real>::kCount), evaluation_(exec, 1), worst_(exec, 1),
        rounding_(exec, 1), found_(exec, 1), control_(exec, 1), surfaceRows_(exec),
        surfacePushes_(exec), surfaceChange_{Reals(exec), Reals(exec), Reals(exec)} {
    const auto real = [](double value) { return static_cast<Real>(value); };
    const ContactLaw& law = c.model.materials.count() > 0 ? c.model.materials.grains.front() : c.model.law;
    data_.rules = {real(c.model.timeStep), real(options_.recovery), real(options_.impact), real(law.stiffness),
                   options_.compliance == contact::Compliance::rigid};
    data_.margin = c.marginUnits;
    data_.minMargin = c.scale.inUnits(c.minMargin());
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
    return grains_.bytes() + bounds_.bytes() + onParts_.bytes() + partRows_.bytes() + grainRows_.bytes() +
           boundRows_.bytes() + degree_.bytes() + free_.bytes() + 3 * motion_[0].bytes();
  }

private:
  using ContactLaw = contact::ContactLaw;
  using Motions = base::Array<ImpulseMotion<Real>>;
  using Reals = base::Array<Real>;

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
    data_.rolls = rolls;
    hertz_ = !data_.rules.rigid && (d.features & contact::kHertz) != 0;
    const std::size_t near = system.boundaries.grainsListed();
    grains_.resize(system.neighbours.places(), rolls);
    bounds_.resize(near * static_cast<std::size_t>(d.boundaryCount), rolls);
    grainRows_.resize(slots), boundRows_.resize(near), degree_.resize(slots), free_.resize(slots);
    for (Motions& m : motion_) m.resize(slots);
    data_.grains = grains_.view(), data_.bounds = bounds_.view();
    data_.grainRows = grainRows_.data(), data_.boundRows = boundRows_.data(), data_.degree = degree_.data();
    data_.near = static_cast<std::int64_t>(near), data_.free = free_.data();
    for (std::size_t k = 0; k < motion_.size(); ++k) data_.motion[k] = motion_[k].data();
    data_.ghost = system.ghosts(), data_.sums = sums_.data(), data_.worst = worst_.data();
    data_.rounding = rounding_.data();
    rounding_.zero();
    data_.now = 0, data_.control = control_.data();
    force_ = system.forceData<Real>();
    setUpSurfaces(system);
    setUpParts(system, d);
    forSlots("rows of grains", d, kernel<MakeGrainRows<Real>>(d));
    base::forEach(exec_, "rows at boundaries", data_.near, kernel<MakeBoundaryRows<Real>>(d));
    base::forEach(exec_, "rows at parts", data_.patches.pairs, kernel<MakePartRows<Real>>(d));
    forSlots("count rows", d, kernel<CountRows<Real>>(d));
    exchange(system, contact::fieldOf(degree_));
    if (!inverseMass_.empty()) sumCounts(surfaceRows_, system.comm);
    if (parts_.contacts) bodies_.sumRows(system.comm);
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
    surfacePushes_.resize(masses.size());
    for (std::size_t k = 0; k < surfaceChange_.size(); ++k) {
      surfaceChange_[k].assign(std::vector<Real>(masses.size()));
      data_.surfaceChange[k] = surfaceChange_[k].data();
      surfaceImpulses_[k].assign(masses.size(), 0);
    }
    data_.push = base::fixedPointFor(system.boundaries.strongest() * system.constants.model.timeStep, 40);
    data_.surfaceRows = surfaceRows_.data(), data_.surfacePushes = surfacePushes_.data();
  }

  /// Computes the speeds of the surfaces in buffer `generation` from the impulses of all ranks. Collective.
  void moveSurfaces(int generation, const base::Comm& comm) {
    if (inverseMass_.empty()) return;
    std::vector<std::int64_t> quanta = surfacePushes_.toHost();
    comm.sum(quanta.data(), quanta.size());
    std::vector<Real> change;
    for (std::size_t k = 0; k < quanta.size(); ++k) {
      surfaceImpulses_[generation][k] = data_.push.checked(quanta[k], "impulses on a surface");
      change.push_back(static_cast<Real>(surfaceImpulses_[generation][k] * inverseMass_[k]));
    }
    surfaceChange_[generation].assign(change);
  }

  /// Share of the surfaces in the curvature of the step from the extrapolated impulses to the trial [J].
  double curvatureOfSurfaces(const ImpulseControl<Real>& c) const {
    double sum = 0;
    for (std::size_t k = 0; k < inverseMass_.size(); ++k) {
      const double step = c.stepOf([&](int buffer) { return surfaceImpulses_[buffer][k]; });
      sum += step * step * inverseMass_[k];
    }
    return sum;
  }

  bool bodiesMove() const { return parts_.contacts && bodies_.anyMovable(); }

  /// Each body has the same velocity on all ranks, computed from the impulses of all rows.
  void setUpParts(const GrainSystem& system, const GrainKernelData& d) {
    data_.patches = {}, data_.parts = {};
    if (!parts_.contacts) return;
    contact::GrainPartContacts& contacts = *parts_.contacts;
    const base::Parcel cleared = contacts.clearedSums();
    base::setZero(exec_, cleared.to, cleared.bytes);
    data_.patches = contacts.patches({d.position, d.motion, d.id, static_cast<std::size_t>(d.count), system.ghosts()},
                                     *parts_.motion, parts_.loads);
    // Must not depend on whether a rank has pairs: the call is collective.
    const bool rolls = std::any_of(contacts.laws().begin(), contacts.laws().end(),
                                   [](const ContactLaw& law) { return law.rollingFriction > 0; });
    hertz_ = !data_.rules.rigid && (hertz_ || std::any_of(contacts.laws().begin(), contacts.laws().end(),
                                                          [](const ContactLaw& law) { return law.hertz; }));
    onParts_.resize(contacts.pairs() * contact::kPatches, rolls);
    onParts_.part.resize(contacts.pairs() * contact::kPatches);
    partRows_.resize(contacts.pairs());
    data_.parts = onParts_.view(), data_.partRows = partRows_.data();
    data_.rolls = data_.rolls || rolls;
    bodies_.begin(*parts_.bodies, contacts, system.constants.model.timeStep);
    bodies_.into(data_);
  }

  /// Sends the values of masters to their ghosts on other ranks.
  static void exchange(GrainSystem& system, const contact::ExchangeField& field) {
    if (system.distribution) system.distribution->subdomain().haloExchange().run({&field, 1});
  }

  static std::int64_t bytesSent(const GrainSystem& system) {
    return system.distribution ? system.distribution->subdomain().haloExchange().bytesSent() : 0;
  }

  template <class Kernel> void forGrains(const char* name, const GrainKernelData& d) const {
    Kernel body = kernel<Kernel>(d);
    body.count = d.count;
    base::forEach(exec_, name, exec_.onCpu() ? (d.count + Kernel::kOnCpu - 1) / Kernel::kOnCpu : d.count, body);
  }
  /// Enqueues an iteration.
  void iterate(const GrainKernelData& d) { data_.rolls ? iterate<true>(d) : iterate<false>(d); }
  template <bool kRolls> void iterate(const GrainKernelData& d) {
    forGrains<FindGradient<Real, kRolls>>("gradient of rows", d);
    forGrains<StepImpulses<Real, kRolls>>("step impulses", d);
    base::forEach(exec_, "sum rows", SumBanks<Real>::kCount + 1, SumBanks<Real>{data_, evaluation_.data()});
  }

  void clearPushes() {
    if (!inverseMass_.empty()) surfacePushes_.zero();
    if (bodiesMove()) bodies_.clearPushes();
  }
  /// Exchanges the velocities of ghosts in buffer `generation`, and computes those of surfaces and bodies. Collective.
  void moveOthers(GrainSystem& system, int generation) {
    exchange(system, contact::fieldOf(motion_[generation]));
    moveSurfaces(generation, system.comm);
    if (bodiesMove()) bodies_.move(generation, system.comm);
  }

  /// Returns the sums over all ranks.
  IterationSums summed(const base::Comm& comm) {
    IterationTotals totals = evaluation_.at(0);
    if (!comm.alone()) {
      const std::vector<base::WideSum> mine(std::begin(totals.of), std::end(totals.of));
      const std::vector<base::WideSum> all = base::summedBanks(mine, mine.size(), comm);
      std::copy(all.begin(), all.end(), totals.of);
      std::uint64_t least[] = {~std::uint64_t{totals.worst}, ~std::uint64_t{totals.rounding}};
      comm.minimum(least, 2);
      totals.worst = static_cast<std::uint32_t>(~least[0]), totals.rounding = static_cast<std::uint32_t>(~least[1]);
    }
    return iterationSums(data_, totals);
  }

  void solve(GrainSystem& system, const GrainKernelData& d) {
    ImpulseControl<Real> control;
    control.residual = options_.residual, control.maxIterations = options_.iterations;
    control.tau = static_cast<Real>(totals_.tau), control.resolution = 1 / (data_.perEnergy * kFinerSums);
    control.associated = options_.friction == contact::ImpulseFriction::associated;
    control_.assign({control});
    sums_.zero(), worst_.zero();
    const auto start = std::chrono::steady_clock::now();
    const std::int64_t sent = bytesSent(system);
    clearPushes();
    forSlots("move by impulses", d, kernel<MoveByImpulses<Real>>(d));
    moveOthers(system, control.now);
    // Ranks, bodies and force-driven surfaces need the host in each iteration.
    iterateToTheEnd(system, d, control);
    bool relaxed = control.relaxed, bends = followHertz(system, d, control);
    for (int k = 0; bends && k < kMostTangents && control.iterations < options_.iterations; ++k) {
      control.restart(), control.associated = options_.friction == contact::ImpulseFriction::associated;
      control_.assign({control});
      iterateToTheEnd(system, d, control);
      relaxed = relaxed || control.relaxed, bends = followHertz(system, d, control);
    }
    control.relaxed = relaxed;
    data_.now = control.now;
    cost_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    cost_.evaluations += control.evaluations, cost_.bytes += bytesSent(system) - sent;
    note(control);
    report_.met = report_.met && !bends;
    totals_.add(report_);
    checkReport(report_, options_, system.steps);
  }

  void iterateToTheEnd(GrainSystem& system, const GrainKernelData& d, ImpulseControl<Real>& control) {
    if (system.distribution || !system.comm.alone() || bodiesMove() || !inverseMass_.empty())
      iterateFromHost(system, d, control);
    else
      control = iterateOnDevice(d);
  }

  /// Linearises Hertz contacts at the end of the step. Returns true if any row on any rank has changed, and the
  /// iterations must go on. Collective.
  bool followHertz(GrainSystem& system, const GrainKernelData& d, const ImpulseControl<Real>& control) {
    if (!hertz_) return false;
    found_.zero();
    FollowHertz<Real> follow = kernel<FollowHertz<Real>>(d);
    follow.now = control.now, follow.tolerance = static_cast<Real>(control.tolerance(control.last));
    follow.found = found_.data();
    forSlots("follow Hertz's law", d, follow);
    std::uint64_t none = 1 - std::uint64_t{found_.at(0)};
    system.comm.minimum(&none, 1);
    if (none == 0) forSlots("weigh rows", d, kernel<WeighRows<Real>>(d));
    return none == 0;
  }

  void iterateFromHost(GrainSystem& system, const GrainKernelData& d, ImpulseControl<Real>& control) {
    while (!control.done) {
      control_.assign({control});
      clearPushes();
      iterate(d);
      IterationSums sums = summed(system.comm);
      if (!control.endsWith(sums)) {
        moveOthers(system, control.tried);
        if (bodiesMove()) sums.curvature += bodies_.curvature(control);
        sums.curvature += curvatureOfSurfaces(control);
      }
      control.take(sums);
    }
  }

  /// Launches several iterations at once; those after convergence return immediately. The first launch has as many as
  /// the last step needed, later ones have kAhead.
  ImpulseControl<Real> iterateOnDevice(const GrainKernelData& d) {
    int ahead = exec_.onCpu() ? 1 : report_.iterations + 1;
    for (;;) {
      for (int k = 0; k < ahead; ++k) {
        iterate(d);
        base::forEach(exec_, "decide", 1, Decide<Real>{data_, evaluation_.data()});
      }
      const ImpulseControl<Real> control = control_.at(0);
      if (control.done) return control;
      ahead = exec_.onCpu() ? 1 : kAhead;
    }
  }

  void note(const ImpulseControl<Real>& control) {
    const IterationSums& last = control.last;
    const double tolerance = control.tolerance(last);
    report_ = {control.iterations,          last.worst, 0, last.contacts, control.relaxed, last.worst <= tolerance,
               tolerance > control.residual};
    report_.rms = report_.rows > 0 ? std::sqrt(last.squares / report_.rows) : 0;
    totals_.tau = static_cast<double>(control.tau);
  }

  void advance(const GrainKernelData& d) {
    using Body = AdvanceByImpulses<Real>;
    const Body body = kernel<Body>(d);
    if (d.ledgerSums)
      base::forEach(exec_, "advance by impulses", WithEnergyAccounting<Body>::items(exec_, d.count),
                    WithEnergyAccounting<Body>{body, d.count});
    else
      forSlots("advance by impulses", d, body);
  }

  static constexpr int kAhead = 4;         ///< iterations per launch
  static constexpr int kMostTangents = 50; ///< linearisations of Hertz contacts per step

  base::Exec exec_;
  ComplementarityOptions options_;
  ImpulseData<Real> data_{};
  ForceData<Real> force_{};
  RowMemory<Real> grains_, bounds_, onParts_;
  ImpulseBodies<Real> bodies_;
  base::Array<std::uint32_t> partRows_;
  base::Array<std::uint32_t> grainRows_, boundRows_, degree_;
  base::Array<ImpulseMotion<Real>> free_;
  std::array<Motions, 3> motion_;
  base::Array<base::WideSum> sums_;
  base::Array<IterationTotals> evaluation_; ///< one element
  base::Array<std::uint32_t> worst_, rounding_, found_;
  bool hertz_{false};                         ///< some contacts follow Hertz's law
  base::Array<ImpulseControl<Real>> control_; ///< one element
  std::vector<double> inverseMass_;           ///< [surface] [1/kg]; empty without force-driven surfaces
  base::Array<std::uint32_t> surfaceRows_;
  base::Array<std::int64_t> surfacePushes_;
  std::array<base::Array<Real>, 3> surfaceChange_;     ///< [m/s]
  std::array<std::vector<double>, 3> surfaceImpulses_; ///< [buffer][surface] [N s]
};

} // namespace

std::unique_ptr<ImpulseSolver> ImpulseSolver::make(const base::Exec& exec, const GrainConstants& constants) {
  if (!constants.model.complementarity) return nullptr;
  if (constants.model.precision == Precision::single) return std::make_unique<ImpulseSolverOf<float>>(exec, constants);
  return std::make_unique<ImpulseSolverOf<double>>(exec, constants);
}

} // namespace grouser::terrain
