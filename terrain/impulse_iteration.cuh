// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/impulse_setup.cuh"

/// An iteration has two kernels. In the first, each grain steps in its own rows and adds their impulses to its
/// velocity; in the second, it computes the gradient of its rows from the velocities of all grains.
namespace grouser::terrain {

/// Adds the impulses of a grain to its velocity. `kTry`: after a gradient step from the extrapolated impulses;
/// otherwise the current impulses.
template <class Real, bool kTry> struct MoveByImpulses : ImpulseKernel<Real> {
  static constexpr double kNanoseconds = 150;
  using Base = ImpulseKernel<Real>;
  using Base::d, Base::s;
  using typename Base::Kernel, typename Base::Vec;

  GROUSER_HD void operator()(int i) const {
    if (s.control->done || (s.ghost && s.ghost[i] != 0)) return; // ghosts are set by the halo exchange
    if (hasNoRows(d, s, i)) {
      s.motion[i] = {}; // fixed
      return;
    }
    const GrainSize<Real> size = Kernel::sizeOf(i);
    Vec pushed{}, turned{};
    forRowsOf(d, s, i, [&](const ImpulseRowsView<Real>& rows, std::int64_t at) {
      const ImpulseRowRecord<Real> row = rows.row[at];
      contact::Impulse<Real> x;
      if constexpr (kTry) {
        x = stepped(rows, at, row);
        rows.impulse[s.control->tried][at] = x.linear;
        if (rows.rolling) rows.turning[s.control->tried][at] = x.rolling;
      } else {
        x = impulseAt(rows, s.control->now, at);
      }
      pushed += x.linear;
      int surface = 0;
      if (const SurfacePose* const pose = freeSurface(d, row, rows.row == s.bounds.row, surface))
        base::atomicAdd64(
            s.surfacePushes + surface,
            -s.push.quantise(dot((x.linear - row.push * rows.end[at].pull).template as<double>(), pose->axis)));
      if (rows.part && s.bodyPushes) pushBody(rows.part[at], x.linear - row.push * rows.end[at].pull, x.rolling);
      turned += x.rolling - cross(row.push, x.linear) * row.armOwn;
    });
    const ImpulseMotion<Real>& free = s.free[i];
    s.motion[i] = {free.velocity + pushed * (Real(1) / size.mass),
                   free.spin + turned * (Real(1) / Base::inertiaOf(size))};
  }

private:
  /// Adds the opposite of an impulse on a grain to the impulse on a body.
  GROUSER_HD void pushBody(const PartRowRecord<Real>& on, const Vec& impulse, const Vec& rolling) const {
    const base::Vec3l linear = s.bodyPush.quantise(-impulse.template as<double>()),
                      angular = s.bodyTurn.quantise(-(cross(on.arm, impulse) + rolling).template as<double>());
    std::int64_t* const pushes = s.bodyPushes + std::int64_t{6} * on.body;
    for (int a = 0; a < 3; ++a) base::atomicAdd64(pushes + a, linear[a]), base::atomicAdd64(pushes + 3 + a, angular[a]);
  }

  GROUSER_HD contact::Impulse<Real> stepped(const ImpulseRowsView<Real>& rows, std::int64_t at,
                                            const ImpulseRowRecord<Real>& row) const {
    auto [y, gy] = Base::ahead(rows, at);
    const Real shearWeight = WeighRows<Real>::shearWeight(s), step = Real(1) / (s.control->tau * row.weight);
    const Real along = dot(gy.linear, row.push);
    y.linear -= (gy.linear - row.push * along) * (step / shearWeight) + row.push * (along * step);
    contact::ImpulseMetric<Real> metric{shearWeight, Real(0)};
    if (rows.rolling) {
      const Real weight = rows.rolling[at].weight;
      y.rolling -= gy.rolling * (Real(1) / (s.control->tau * weight));
      metric.rolling = weight / row.weight;
    }
    return contact::allowed(y, row.push, coneAt(rows, at), metric, s.control->associated);
  }
};

/// Residual of a row with a NaN or an infinite gradient [m/s].
inline constexpr float kNoResidual = 3e38f;

/// Scale of a sum [large quanta per unit].
template <class Real> GROUSER_HD double perUnitOf(const ImpulseData<Real>& s, int sum) {
  return sum == kContacts ? 1.0 : sum == kSquares ? s.perSquare : s.perEnergy;
}

/// Computes the gradient of each row from the velocities, and the sums that control the next iteration. `kTry` as in
/// MoveByImpulses.
template <class Real, bool kTry> struct FindGradient : ImpulseKernel<Real> {
  static constexpr double kNanoseconds = 150;
  using Base = ImpulseKernel<Real>;
  using Base::d, Base::s;
  using typename Base::Kernel, typename Base::Vec;
  static constexpr int kOnCpu = 32; ///< grains per CPU task

  std::int64_t count;
  double nanoseconds() const { return kOnCpu * kNanoseconds; }

  /// Sums over the rows of a grain.
  struct RowSums {
    double of[kImpulseSums] = {};
    float worst = 0;
  };
  /// Sums over grains [quanta].
  struct Sums {
    std::int64_t of[kImpulseSums * kSumSizes] = {};
    float worst = 0;
    GROUSER_HD void add(int sum, double value, double perUnit) {
      if (value == 0) return;
      const double large = value * perUnit, small = large * kFinerSums;
      const bool fits = fabs(small) < 0x1p50;
      of[sum * kSumSizes + fits] += wholeQuanta(fits ? small : large);
    }
  };

  GROUSER_HD void operator()(int item) const {
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

private:
  GROUSER_HD void run(int i, Sums& sums) const {
    if (hasNoRows(d, s, i)) return;
    const ImpulseMotion<Real> own = s.motion[i];
    RowSums mine;
    forRowsOf(d, s, i, [&](const ImpulseRowsView<Real>& rows, std::int64_t at) { find(rows, at, own, mine); });
    for (int k = 0; k < kImpulseSums; ++k) sums.add(k, mine.of[k], perUnitOf(s, k));
    if (mine.worst > sums.worst) sums.worst = mine.worst;
  }

  GROUSER_HD void find(const ImpulseRowsView<Real>& rows, std::int64_t at, const ImpulseMotion<Real>& own,
                       RowSums& sums) const {
    const ImpulseRowRecord<Real> row = rows.row[at];
    const bool alone = row.other == kFixedPartner;
    const ImpulseMotion<Real> other = alone ? ImpulseMotion<Real>{} : s.motion[row.other];
    const int made = kTry ? s.control->tried : s.control->now;
    const contact::Impulse<Real> x = impulseAt(rows, made, at);
    contact::Impulse<Real> a;
    a.linear = relativeVelocity(own, other, row.push, row.armOwn, row.armOther) + x.linear * row.shearSoftness +
               row.push * ((row.softness - row.shearSoftness) * dot(x.linear, row.push)) + row.offset;
    int surface = 0;
    if (const SurfacePose* const pose = freeSurface(d, row, rows.row == s.bounds.row, surface))
      a.linear -= pose->axis.template as<Real>() * s.surfaceChange[surface];
    Vec turns = other.spin;
    if (rows.part) {
      const BodyMotion<Real> body = s.bodyMotion[rows.part[at].body];
      a.linear -= body.at(rows.part[at].arm), turns = body.spin;
    }
    rows.gradient[made][at] = a.linear;
    if (rows.rolling) {
      const RollingRowRecord<Real>& roll = rows.rolling[at];
      a.rolling = contact::detail::tangentOf(own.spin - turns, row.push) + x.rolling * roll.softness + roll.offset;
      rows.turnGradient[made][at] = a.rolling;
    }
    if (!(row.place & kCountsBit)) return;
    addResidual(rows, at, row, x, a, sums);
    if constexpr (kTry) addProducts(rows, at, row, x, a, sums);
  }

  /// Natural map residual: change of the impulse by a projected gradient step, in units of velocity.
  GROUSER_HD void addResidual(const ImpulseRowsView<Real>& rows, std::int64_t at, const ImpulseRowRecord<Real>& row,
                              const contact::Impulse<Real>& x, const contact::Impulse<Real>& a, RowSums& sums) const {
    contact::Impulse<Real> z{x.linear - a.linear * (Real(1) / row.mobility), {}};
    contact::ImpulseMetric<Real> metric{Real(1), Real(0)};
    if (rows.rolling) {
      const Real arm = row.armOwn > row.armOther ? row.armOwn : row.armOther;
      metric.rolling = Real(2.5) / (arm * arm); // mass / moment of inertia of a solid sphere
      z.rolling = x.rolling - a.rolling * (Real(1) / (row.mobility * metric.rolling));
    }
    const contact::Impulse<Real> off =
        x - contact::allowed(z, row.push, coneAt(rows, at), metric, s.control->associated);
    const double mobility = static_cast<double>(row.mobility);
    const double square = mobility * mobility *
                          (norm2(off.linear.template as<double>()) +
                           static_cast<double>(metric.rolling) * norm2(off.rolling.template as<double>()));
    sums.of[kSquares] += square, sums.of[kContacts] += 1;
    const bool sound = square + 0 * norm2(a.linear.template as<double>()) == square; // a NaN would be projected to zero
    const float residual = sound ? static_cast<float>(sqrt(square)) : kNoResidual;
    if (residual > sums.worst) sums.worst = residual;
  }

  /// Adds the curvature d N d and squared length of the step d from y to x, and its product with the change since the
  /// last iteration, in the metric. A negative product restarts the extrapolation (O'Donoghue and Candes 2015, Found.
  /// Comput. Math. 15:715; with the step instead of the gradient, which Coulomb's law does not follow).
  GROUSER_HD void addProducts(const ImpulseRowsView<Real>& rows, std::int64_t at, const ImpulseRowRecord<Real>& row,
                              const contact::Impulse<Real>& x, const contact::Impulse<Real>& a, RowSums& sums) const {
    const auto [y, gy] = Base::ahead(rows, at);
    const contact::Impulse<Real> step = x - y, way = x - impulseAt(rows, s.control->now, at);
    const auto product = [](const Vec& p, const Vec& q) {
      return dot(p.template as<double>(), q.template as<double>());
    };
    const double along = static_cast<double>(dot(step.linear, row.push)), weight = static_cast<double>(row.weight),
                 shearWeight = WeighRows<Real>::shearWeight(s);
    const auto inMetric = [&](const contact::Impulse<Real>& other) {
      double sum = weight * (along * static_cast<double>(dot(other.linear, row.push)) * (1 - shearWeight) +
                             shearWeight * product(step.linear, other.linear));
      if (rows.rolling) sum += static_cast<double>(rows.rolling[at].weight) * product(step.rolling, other.rolling);
      return sum;
    };
    const contact::Impulse<Real> change = a - gy;
    sums.of[kCurvature] += product(step.linear, change.linear) + product(step.rolling, change.rolling);
    sums.of[kLength] += inMetric(step), sums.of[kAgainst] -= inMetric(way);
  }
};

/// Sums the banks of an iteration and clears them.
template <class Real> struct SumBanks {
  static constexpr int kCount = kImpulseSums * kSumSizes;
  ImpulseData<Real> s;
  base::WideSum* totals;
  GROUSER_HD void operator()(int k) const {
    base::WideSum total;
    for (int bank = 0; bank < kSumBanks; ++bank) {
      base::WideSum& share = s.sums[bank * kCount + k];
      total += share, share = {};
    }
    totals[k] = total;
  }
};

/// Converts the sums of an iteration to real numbers. `worst`: see ImpulseData.
template <class Real>
GROUSER_HD IterationSums iterationSums(const ImpulseData<Real>& s, const base::WideSum* totals, std::uint32_t worst) {
  const auto sum = [&](int which) {
    const base::WideSum* const of = totals + which * kSumSizes;
    const double perUnit = perUnitOf(s, which);
    return of[0].toDouble() / perUnit + of[1].toDouble() / (perUnit * kFinerSums);
  };
  return {sum(kCurvature), sum(kLength),   sum(kAgainst),
          sum(kSquares),   sum(kContacts), static_cast<double>(base::bitsAs<float>(worst))};
}

/// Updates the iteration control on the device.
template <class Real> struct Decide {
  ImpulseData<Real> s;
  const base::WideSum* totals;
  bool first;
  GROUSER_HD void operator()(int) const {
    if (s.control->done) return;
    const IterationSums sums = iterationSums(s, totals, *s.worst);
    *s.worst = 0;
    if (first)
      s.control->begin(sums);
    else
      s.control->take(sums);
  }
};

} // namespace grouser::terrain
