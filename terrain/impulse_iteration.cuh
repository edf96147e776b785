// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/impulse_setup.cuh"

/// An iteration has two kernels. In the first, each grain computes the gradient of its rows from the velocities of all
/// grains, and their residual; in the second, it steps along the gradient from the extrapolated impulses, and adds the
/// new impulses to its velocity.
namespace grouser::terrain {

/// Velocities due to impulses. `kRolls`: whether any row has rolling resistance.
template <class Real, bool kRolls> struct ImpulsePushes : ImpulseKernel<Real> {
  static constexpr double kNanoseconds = 150;
  using Base = ImpulseKernel<Real>;
  using Base::d, Base::s;
  using typename Base::Kernel, typename Base::Vec;
  using Impulse = contact::Impulse<Real, TurnOf<Real, kRolls>>;

protected:
  /// Sum of impulses on a grain.
  struct Push {
    Vec linear{}, angular{}; ///< [N s], [N m s]
    GROUSER_HD void add(const ImpulseRowRecord<Real>& row, const Impulse& x) {
      linear += x.linear, angular -= cross(row.push, x.linear) * row.armOwn;
      if constexpr (kRolls) angular += x.rolling;
    }
  };

  /// Sets the velocity of a free grain in an iteration.
  GROUSER_HD void move(int i, const Push& sum, int generation) const {
    const GrainSize<Real> size = Kernel::sizeOf(i);
    const ImpulseMotion<Real>& free = s.free[i];
    s.motion[generation][i] = {free.velocity + sum.linear * (Real(1) / size.mass),
                               free.spin + sum.angular * (Real(1) / Base::inertiaOf(size))};
  }

  /// Adds the opposite of an impulse on a grain to the impulses on a force-driven surface or a body.
  GROUSER_HD void pushOther(const ImpulseRowsView<Real>& rows, std::int64_t at, const ImpulseRowRecord<Real>& row,
                            const Impulse& x) const {
    int surface = 0;
    if (const SurfacePose* const pose = freeSurface(d, s, rows, at, surface))
      base::atomicAdd64(
          s.surfacePushes + surface,
          -s.push.quantise(dot((x.linear - row.push * rows.end[at].pull).template as<double>(), pose->axis)));
    if (!rows.part || !s.bodyPushes) return;
    const PartRowRecord<Real> on = rows.part[at];
    const Vec impulse = x.linear - row.push * rows.end[at].pull;
    Vec moment = cross(on.arm, impulse);
    if constexpr (kRolls) moment += x.rolling;
    const base::Vec3l linear = s.bodyPush.quantise(-impulse.template as<double>()),
                      angular = s.bodyTurn.quantise(-moment.template as<double>());
    std::int64_t* const pushes = s.bodyPushes + std::int64_t{6} * on.body;
    for (int a = 0; a < 3; ++a) base::atomicAdd64(pushes + a, linear[a]), base::atomicAdd64(pushes + 3 + a, angular[a]);
  }
};

/// Adds the current impulses of a grain to its velocity.
template <class Real> struct MoveByImpulses : ImpulsePushes<Real, true> {
  using Base = ImpulsePushes<Real, true>;
  using Base::d, Base::s;
  using typename Base::Impulse, typename Base::Push;

  GROUSER_HD void operator()(int i) const {
    if (s.ghost && s.ghost[i] != 0) return; // set by the halo exchange
    const int now = s.control->now;
    if (hasNoRows(d, s, i)) {
      s.motion[now][i] = {}; // fixed
      return;
    }
    Push sum;
    forRowsOf(d, s, i, [&](const ImpulseRowsView<Real>& rows, std::int64_t at) {
      const ImpulseRowRecord<Real> row = rows.row[at];
      const Impulse x = impulseAt<true>(rows, now, at);
      sum.add(row, x);
      Base::pushOther(rows, at, row, x);
    });
    Base::move(i, sum, now);
  }
};

/// Residual, and squared residual, of a row with a NaN or an infinite gradient [m/s], [m2/s2].
inline constexpr float kNoResidual = 3e38f;

/// Scale of a sum [large quanta per unit].
template <class Real> GROUSER_HD double perUnitOf(const ImpulseData<Real>& s, int sum) {
  return sum == kContacts ? 1.0 : sum == kSquares ? s.perSquare : s.perEnergy;
}

/// Kernel of an iteration that sums over the rows of each grain, and these sums over grains as integers.
template <class Real, bool kRolls> struct IterationKernel : ImpulsePushes<Real, kRolls> {
  using Base = ImpulsePushes<Real, kRolls>;
  using Base::s;
  static constexpr int kOnCpu = 32; ///< grains per CPU task

  std::int64_t count;
  double nanoseconds() const { return kOnCpu * Base::kNanoseconds; }

  /// Sums over the rows of a grain.
  struct RowSums {
    double of[kImpulseSums] = {};
    float worst = 0; ///< maximum squared residual [m2/s2]
  };
  /// Sums over grains [quanta].
  struct Sums {
    std::int64_t of[kImpulseSums * kSumSizes] = {};
    float worst = 0;
    GROUSER_HD void add(int sum, double value, double perUnit) {
      if (value == 0) return;
      const double large = value * perUnit, small = large * kFinerSums;
      const bool fits = fabs(small) < 0x1p50;
      const std::int64_t quanta = wholeQuanta(fits ? small : large);
      of[sum * kSumSizes] += fits ? 0 : quanta, of[sum * kSumSizes + 1] += fits ? quanta : 0;
    }
  };

protected:
  /// Calls `run` for the grains of an item, and adds the sums.
  template <class Run> GROUSER_HD void forGrains(int item, const Run& run) const {
    if (s.control->done) return;
    Sums sums;
#if defined(__CUDA_ARCH__)
    run(item, sums);
    base::atomicAddTogether(s.sums + static_cast<int>(blockIdx.x % kSumBanks) * kImpulseSums * kSumSizes, sums.of);
#else
    const std::int64_t first = std::int64_t{item} * kOnCpu, last = first + kOnCpu < count ? first + kOnCpu : count;
    for (std::int64_t i = first; i < last; ++i) run(static_cast<int>(i), sums);
    base::WideSum* const bank = s.sums + (item % kSumBanks) * kImpulseSums * kSumSizes;
    for (int k = 0; k < kImpulseSums * kSumSizes; ++k)
      if (sums.of[k] != 0) base::atomicAddWide(bank + k, sums.of[k]);
#endif
    if (sums.worst > 0) base::atomicMax32(s.worst, base::bitsAs<std::uint32_t>(sums.worst));
  }

  /// Adds the sums over a grain's rows: those from `kFirst` to before `kEnd`.
  template <int kFirst, int kEnd> GROUSER_HD void add(Sums& sums, const RowSums& mine) const {
    for (int k = kFirst; k < kEnd; ++k) sums.add(k, mine.of[k], perUnitOf(s, k));
    const float worst = mine.worst < kNoResidual ? sqrtf(mine.worst) : kNoResidual;
    if (worst > sums.worst) sums.worst = worst;
  }
};

/// Computes the gradient of each row from the velocities, and its residual.
template <class Real, bool kRolls> struct FindGradient : IterationKernel<Real, kRolls> {
  using Base = IterationKernel<Real, kRolls>;
  using Base::d, Base::s;
  using typename Base::Impulse;
  using typename Base::RowSums, typename Base::Sums, typename Base::Vec;

  GROUSER_HD void operator()(int item) const {
    Base::forGrains(item, [&](int i, Sums& sums) { run(i, sums); });
  }

private:
  GROUSER_HD void run(int i, Sums& sums) const {
    if (hasNoRows(d, s, i)) return;
    const ImpulseMotion<Real> own = s.motion[s.control->now][i];
    RowSums mine;
    forRowsOf(d, s, i, [&](const ImpulseRowsView<Real>& rows, std::int64_t at) { find(rows, at, own, mine); });
    Base::template add<kSquares, kImpulseSums>(sums, mine);
  }

  GROUSER_HD void find(const ImpulseRowsView<Real>& rows, std::int64_t at, const ImpulseMotion<Real>& own,
                       RowSums& sums) const {
    const int now = s.control->now;
    const ImpulseRowRecord<Real> row = readOnly(rows.row + at);
    const ImpulseRowOther<Real> side = readOnly(rows.other + at);
    const ImpulseMotion<Real> other =
        side.slot == kFixedPartner ? ImpulseMotion<Real>{} : readOnly(s.motion[now] + side.slot);
    const Impulse x = impulseAt<kRolls>(rows, now, at);
    Impulse a;
    a.linear = relativeVelocity(own, other, row.push, row.armOwn, side.arm) + x.linear * row.shearSoftness +
               row.push * ((row.softness - row.shearSoftness) * dot(x.linear, row.push)) + side.offset;
    int surface = 0;
    if (const SurfacePose* const pose = freeSurface(d, s, rows, at, surface))
      a.linear -= pose->axis.template as<Real>() * s.surfaceChange[now][surface];
    Vec turns = other.spin;
    if (rows.part) {
      const BodyMotion<Real> body = s.bodyMotion[now][rows.part[at].body];
      a.linear -= body.at(rows.part[at].arm), turns = body.spin;
    }
    rows.gradient[now][at] = a.linear;
    if constexpr (kRolls)
      if (rows.rolling) {
        const RollingRowRecord<Real>& roll = rows.rolling[at];
        a.rolling = contact::detail::tangentOf(own.spin - turns, row.push) + x.rolling * roll.softness + roll.offset;
        rows.turnGradient[now][at] = a.rolling;
      }
    if (row.counts()) addResidual(rows, at, row, side, x, a, sums);
  }

  /// Natural map residual: change of the impulse by a projected gradient step, in units of velocity.
  GROUSER_HD void addResidual(const ImpulseRowsView<Real>& rows, std::int64_t at, const ImpulseRowRecord<Real>& row,
                              const ImpulseRowOther<Real>& side, const Impulse& x, const Impulse& a,
                              RowSums& sums) const {
    Impulse z{x.linear - a.linear * side.inertia, {}};
    contact::ImpulseMetric<Real> metric{Real(1), Real(0)};
    if constexpr (kRolls)
      if (rows.rolling) {
        const Real arm = row.armOwn > side.arm ? row.armOwn : side.arm;
        metric.rolling = Real(2.5) / (arm * arm); // mass / moment of inertia of a solid sphere
        z.rolling = x.rolling - a.rolling * (Real(1) / (side.mobility * metric.rolling));
      }
    const Impulse off = x - contact::allowed(z, row.push, coneAt<kRolls>(rows, at, row), metric, s.control->associated);
    Real square = norm2(off.linear * side.mobility);
    if constexpr (kRolls) square += metric.rolling * norm2(off.rolling * side.mobility);
    sums.of[kSquares] += static_cast<double>(square), sums.of[kContacts] += 1;
    const bool sound = square + 0 * norm2(a.linear) == square; // a NaN would be projected to zero
    const auto residual2 = sound ? static_cast<float>(square) : kNoResidual;
    if (residual2 > sums.worst) sums.worst = residual2;
  }
};

/// Takes a step in each row, and computes the velocities. Adds the curvature, length and direction of the step to the
/// sums.
template <class Real, bool kRolls> struct StepImpulses : IterationKernel<Real, kRolls> {
  using Base = IterationKernel<Real, kRolls>;
  using Base::d, Base::s;
  using typename Base::Impulse;
  static constexpr Real kShearWeight = shearWeight<Real>(kRolls);
  using typename Base::Kernel, typename Base::Push, typename Base::RowSums, typename Base::Sums, typename Base::Vec;

  GROUSER_HD void operator()(int item) const {
    Base::forGrains(item, [&](int i, Sums& sums) { run(i, sums); });
  }

private:
  GROUSER_HD void run(int i, Sums& sums) const {
    if (s.ghost && s.ghost[i] != 0) return; // set by the halo exchange
    const int now = s.control->now, before = s.control->before, tried = s.control->tried;
    const Real ahead = s.control->ahead;
    if (hasNoRows(d, s, i)) {
      s.motion[tried][i] = {}; // fixed
      return;
    }
    Push sum, steps;
    RowSums mine;
    forRowsOf(d, s, i, [&](const ImpulseRowsView<Real>& rows, std::int64_t at) {
      const ImpulseRowRecord<Real> row = readOnly(rows.row + at);
      const Impulse current = impulseAt<kRolls>(rows, now, at), g = gradientAt<kRolls>(rows, now, at);
      const Impulse y = current + (current - impulseAt<kRolls>(rows, before, at)) * ahead;
      const Impulse x = stepped(rows, at, row, y, g + (g - gradientAt<kRolls>(rows, before, at)) * ahead);
      rows.impulse[tried][at] = x.linear;
      if constexpr (kRolls)
        if (rows.rolling) rows.turning[tried][at] = x.rolling;
      sum.add(row, x), steps.add(row, x - y);
      Base::pushOther(rows, at, row, x);
      if (row.counts()) addStep(rows, at, row, x - y, x - current, mine);
    });
    Base::move(i, sum, tried);
    const GrainSize<Real> size = Kernel::sizeOf(i);
    const Vec change = steps.linear * (Real(1) / size.mass), turn = steps.angular * (Real(1) / Base::inertiaOf(size));
    mine.of[kCurvature] += static_cast<double>(dot(change, steps.linear) + dot(turn, steps.angular));
    Base::template add<kCurvature, kSquares>(sums, mine);
  }

  /// Takes the projected gradient step from the extrapolated impulse `y` with the gradient `g`.
  GROUSER_HD Impulse stepped(const ImpulseRowsView<Real>& rows, std::int64_t at, const ImpulseRowRecord<Real>& row,
                             Impulse y, const Impulse& g) const {
    const Real step = Real(1) / (s.control->tau * row.weight());
    const Real along = dot(g.linear, row.push);
    y.linear -= (g.linear - row.push * along) * (step * (Real(1) / kShearWeight)) + row.push * (along * step);
    contact::ImpulseMetric<Real> metric{kShearWeight, Real(0)};
    if constexpr (kRolls)
      if (rows.rolling) {
        const Real weight = rows.rolling[at].weight;
        y.rolling -= g.rolling * (Real(1) / (s.control->tau * weight));
        metric.rolling = weight / row.weight();
      }
    return contact::allowed(y, row.push, coneAt<kRolls>(rows, at, row), metric, s.control->associated);
  }

  /// Adds the share of the contact's compliance in the curvature step N step, the squared length of the step in the
  /// metric, and its product with the change `way` since the last iteration. A negative product restarts the
  /// extrapolation (O'Donoghue and Candes 2015, Found. Comput. Math. 15:715; with the step instead of the gradient,
  /// which Coulomb's law does not follow).
  GROUSER_HD void addStep(const ImpulseRowsView<Real>& rows, std::int64_t at, const ImpulseRowRecord<Real>& row,
                          const Impulse& step, const Impulse& way, RowSums& sums) const {
    const Real along = dot(step.linear, row.push);
    const Vec shear = step.linear - row.push * along;
    const Vec measured = (row.push * along + shear * kShearWeight) * row.weight(); // [m/s]
    Real curvature = row.softness * along * along + dot(shear * row.shearSoftness, shear),
         length = dot(measured, step.linear), product = dot(measured, way.linear);
    if constexpr (kRolls)
      if (rows.rolling) {
        const RollingRowRecord<Real>& roll = rows.rolling[at];
        const Vec turned = step.rolling * roll.weight;
        curvature += dot(step.rolling * roll.softness, step.rolling);
        length += dot(turned, step.rolling), product += dot(turned, way.rolling);
      }
    sums.of[kCurvature] += static_cast<double>(curvature);
    sums.of[kLength] += static_cast<double>(length), sums.of[kAgainst] -= static_cast<double>(product);
  }
};

/// Linearises the rows of Hertz contacts where the last iteration ended, unless the velocity error of the linearisation
/// is within the tolerance.
template <class Real> struct FollowHertz : ImpulseKernel<Real> {
  static constexpr double kNanoseconds = 80;
  using Base = ImpulseKernel<Real>;
  using Base::d, Base::s;
  int now = 0;          ///< buffer of the last iteration
  Real tolerance = 0;   ///< [m/s]
  std::uint32_t* found; ///< set to 1 if a row has changed

  GROUSER_HD void operator()(int i) const {
    if (hasNoRows(d, s, i)) return;
    bool any = false;
    forRowsOf(d, s, i, [&](const ImpulseRowsView<Real>& rows, std::int64_t at) { any = follow(rows, at) || any; });
    if (any) base::atomicMax32(found, 1u);
  }

private:
  /// Both sides of a pair compute the same bits.
  GROUSER_HD bool follow(const ImpulseRowsView<Real>& rows, std::int64_t at) const {
    ImpulseRowEnd<Real>& end = rows.end[at];
    if (!(end.hertz.elastic > 0)) return false;
    ImpulseRowRecord<Real>& row = rows.row[at];
    const Real along = dot(rows.impulse[now][at], row.push),
               parting = dot(rows.gradient[now][at], row.push) - row.softness * along - end.normalOffset;
    const contact::NormalRow<Real> former{row.softness, end.normalOffset, end.damping};
    const contact::HertzError<Real> error =
        contact::hertzError(end.hertz, former, end.overlap, along, parting, s.rules.timeStep);
    if (!(error.speed > tolerance) || !(error.deep > 0)) return false;
    const contact::NormalRow<Real> next = contact::linearised(end.hertz, error.deep, -end.overlap, s.rules.timeStep);
    rows.other[at].offset += row.push * (next.offset - end.normalOffset);
    row.softness = next.softness, end.normalOffset = next.offset, end.damping = next.damping;
    return true;
  }
};

/// Sums of an iteration.
struct IterationTotals {
  base::WideSum of[kImpulseSums * kSumSizes];
  std::uint32_t worst, rounding; ///< see ImpulseData
};

/// Sums the banks of an iteration and clears them.
template <class Real> struct SumBanks {
  static constexpr int kCount = kImpulseSums * kSumSizes;
  ImpulseData<Real> s;
  IterationTotals* totals;
  GROUSER_HD void operator()(int k) const {
    if (k == kCount) {
      totals->worst = *s.worst, totals->rounding = *s.rounding, *s.worst = 0;
      return;
    }
    base::WideSum total;
    for (int bank = 0; bank < kSumBanks; ++bank) {
      base::WideSum& share = s.sums[bank * kCount + k];
      total += share, share = {};
    }
    totals->of[k] = total;
  }
};

/// Converts the sums of an iteration to real numbers.
template <class Real>
GROUSER_HD IterationSums iterationSums(const ImpulseData<Real>& s, const IterationTotals& totals) {
  const auto sum = [&](int which) {
    const base::WideSum* const of = totals.of + which * kSumSizes;
    const double perUnit = perUnitOf(s, which);
    return of[0].toDouble() / perUnit + of[1].toDouble() / (perUnit * kFinerSums);
  };
  return {sum(kCurvature),
          sum(kLength),
          sum(kAgainst),
          sum(kSquares),
          sum(kContacts),
          static_cast<double>(base::bitsAs<float>(totals.worst)),
          static_cast<double>(base::bitsAs<float>(totals.rounding))};
}

/// Updates the iteration control on the device.
template <class Real> struct Decide {
  ImpulseData<Real> s;
  const IterationTotals* totals;
  GROUSER_HD void operator()(int) const {
    if (!s.control->done) s.control->take(iterationSums(s, *totals));
  }
};

} // namespace grouser::terrain
