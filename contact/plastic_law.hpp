// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "base/number.hpp"

#include <cmath>

namespace grouser::contact {

/// Elastic-plastic normal spring of a contact. First loading follows the elastic law,
///
///   F = k1 x^m      (m = 1: linear;  m = 3/2: Hertz)
///
/// unloading and reloading follow a steeper line from a plastic overlap x_p, at which the force is zero:
///
///   F = k2 (x^m - x_p^m),  at the turning point x_m equal to the elastic force: x_p^m = (1 - k1/k2) x_m^m
///
/// Beyond the pull-off force P the force follows an adhesive branch -a(x), and x_p decreases with it, so that reloading
/// follows a steep line from the current point; a(x) starts at P and decreases to zero at x = 0, where the contact
/// ends. Two laws:
///
/// - EEPA, the Edinburgh elasto-plastic adhesion model (Morrissey 2013; Thakur et al. 2014, Granular Matter 16:383):
///   k2 is constant, k1/k2 = 1 - share; P = 1.5 pi gamma sqrt(2 x_p R_eff), at most half the attraction of the steep
///   line at x = 0; a(x) = P (x / x_min)^chi, x_min the overlap at which the steep line reaches -P.
/// - Luding (2008, Granular Matter 10:235): linear; k2 grows with the maximum overlap from k1 to k1 / (1 - share) at
///   x* and beyond, x* proportional to R_eff; a(x) = k_c x. On the adhesive branch the maximum overlap is reduced to
///   the value from which unloading would reach the current point, and k2 with it.
///
/// This struct contains the constants of the law; BasicPlasticState is the state of a contact.
template <class T> struct BasicPlasticity {
  T share{};       ///< lambda = 1 - k1/k2 [-], in [0, 1); Luding: its maximum; 0: elastic contact
  T depthShare{};  ///< x_p / x_m on the first loading: lambda^(1/m) [-] (EEPA)
  T lossShare{};   ///< fraction of F x dissipated in first loading from x = 0 [-] (EEPA)
  T pull{};        ///< EEPA: P over sqrt(x_m R_eff) [N/m], >= 0
  T pullGrowth{};  ///< EEPA, adhesion that grows with the radius: P over sqrt(x_m R_eff) R_eff [Pa], >= 0
  T fullDepth{};   ///< Luding: x* / R_eff [-], > 0; 0: EEPA
  T adhesion{};    ///< Luding: k_c / k1 [-], >= 0
  int exponent{2}; ///< EEPA: 2 chi

  template <class U> GROUSER_HD BasicPlasticity<U> as() const {
    const auto u = [](T value) { return static_cast<U>(value); };
    return {u(share), u(depthShare), u(lossShare), u(pull), u(pullGrowth), u(fullDepth), u(adhesion), exponent};
  }
};

/// History of an elastic-plastic contact; zero-initialised for a new one.
template <class T> struct BasicPlasticState {
  T deepest{}; ///< overlap at the last departure from first loading, x_m [m]
  T origin{};  ///< elastic force at the plastic overlap, k1 x_p^m [N]
};

/// Number of history values.
inline constexpr int kPlasticNumbers = 2;

/// Normal spring of an elastic contact: F = k1 x^m [N] at an overlap [m]; with SIMD numbers, one contact per lane.
template <class T> struct BasicElasticSpring {
  base::ScalarOf<T> stiffness; ///< linear: k [N/m];  Hertz: (4/3) E_eff [Pa]
  T effectiveRadius;           ///< [m]
  bool hertz;

  GROUSER_HD T force(T overlap) const {
    return hertz ? stiffness * base::squareRoot(effectiveRadius * overlap) * overlap : stiffness * overlap;
  }
  /// x_a / x_b if the force at x_a is `ratio` (>= 0) times the force at x_b.
  GROUSER_HD T overlapRatio(T ratio) const {
    if (!hertz) return ratio;
    const T root = base::cubeRootOf(ratio);
    return root * root;
  }
};

/// Normal force of an elastic-plastic contact at one overlap.
template <class T> struct BasicPlasticForce {
  T force;    ///< [N], negative: attraction
  T adhesion; ///< maximum attraction at this overlap [N], >= 0; friction is limited by the force plus this
  T yielded;  ///< plastic work of this step [J], >= 0 except for rounding
};

namespace detail {

/// k2 / k1 for a maximum overlap `deepest`. SIMD types are allowed here and where stated below.
template <class T> GROUSER_HD T steepness(const BasicPlasticity<base::ScalarOf<T>>& p, T deepest, T radius) {
  using Scalar = base::ScalarOf<T>;
  const Scalar most = Scalar(1) / (Scalar(1) - p.share);
  const T one = base::broadcast<T>(1);
  if (p.fullDepth <= 0) return base::broadcast<T>(most);
  const T part = deepest / (p.fullDepth * radius);
  return Scalar(1) + (most - Scalar(1)) * (part < one ? part : one);
}

/// EEPA: plastic work of first loading up to this overlap [J], from the intersection of the steep line of `origin` with
/// the elastic law. With SIMD numbers, one contact per lane.
template <class T> GROUSER_HD T yieldedSince(const BasicPlasticity<base::ScalarOf<T>>& p,
                                             const BasicElasticSpring<T>& spring, T overlap, T elastic, T origin) {
  const T start = origin / p.share; // elastic force at the intersection
  return p.lossShare * overlap * (elastic - start * spring.overlapRatio(start / elastic));
}

/// EEPA: pull-off force P / sqrt(x_m R_eff) [N/m]; <= 0: no attraction.
template <class T> GROUSER_HD T pullPerRoot(const BasicPlasticity<base::ScalarOf<T>>& p, T effectiveRadius) {
  return p.pull + p.pullGrowth * effectiveRadius;
}

/// EEPA: pull-off force for a maximum overlap, and its intersection with the steep line.
template <class T> struct PullOff {
  T force; ///< P [N]
  T turn;  ///< elastic force at x_min [N]
};

/// `perRoot`: pullPerRoot(), > 0. With SIMD numbers, one contact per lane.
template <class T> GROUSER_HD PullOff<T> pullOff(const BasicPlasticity<base::ScalarOf<T>>& p,
                                                 const BasicElasticSpring<T>& spring, T steep, T perRoot, T deepest) {
  const T origin = p.share * spring.force(deepest); // before any attraction
  const T half = base::ScalarOf<T>(0.5) * steep * origin;
  const T pull = perRoot * base::squareRoot(deepest * spring.effectiveRadius);
  const T most = pull < half ? pull : half;
  return {most, origin - most / steep};
}

/// Luding: k_c x up to the intersection of -k_c x with the steep line, constant beyond it [N]. SIMD allowed.
template <class T> GROUSER_HD T ludingPull(const BasicPlasticity<base::ScalarOf<T>>& p, T elastic, T steep, T origin) {
  const T most = steep * origin / (steep + p.adhesion);
  return p.adhesion * (elastic < most ? elastic : most);
}

/// Adhesive branch of a contact at an overlap.
template <class T> struct AdhesiveBranch {
  T pull;  ///< a(x) before its intersection with the steep line, P beyond it [N], >= 0
  T slope; ///< d ln a / d ln F_elastic
};

template <class T> GROUSER_HD AdhesiveBranch<T> adhesiveBranch(const BasicPlasticity<T>& p,
                                                               const BasicElasticSpring<T>& spring, T elastic, T steep,
                                                               const BasicPlasticState<T>& state) {
  if (p.fullDepth > 0) return {ludingPull(p, elastic, steep, state.origin), T(1)};
  const T perRoot = pullPerRoot(p, spring.effectiveRadius);
  if (perRoot <= 0) return {T(0), T(1)};
  const auto [most, turn] = pullOff(p, spring, steep, perRoot, state.deepest);
  if (elastic >= turn) return {most, T(0)};
  // (x / x_min)^chi from the square root of x / x_min, itself a power of the force ratio.
  const T ratio = elastic / turn;
  T root = base::squareRoot(ratio), share = 1;
  if (spring.hertz) root = base::cubeRoot(ratio);
  for (int k = 0; k < p.exponent; ++k) share = share * root;
  return {most * share, T(p.exponent) / T(spring.hertz ? 3 : 2)};
}

/// State after first loading to this overlap, and plastic work since the intersection of the steep line of `before`
/// with the elastic law [J]. `steepBefore`, `steepNow`: steepness() before and after. SIMD allowed.
template <class T> struct Loading {
  BasicPlasticState<T> state;
  T yielded;
};

template <class T> GROUSER_HD Loading<T> firstLoading(const BasicPlasticity<base::ScalarOf<T>>& p,
                                                      const BasicElasticSpring<T>& spring, T overlap, T elastic,
                                                      T steepBefore, T steepNow, const BasicPlasticState<T>& before) {
  using Scalar = base::ScalarOf<T>;
  if (p.fullDepth <= 0) return {{overlap, p.share * elastic}, yieldedSince(p, spring, overlap, elastic, before.origin)};
  const T from = before.deepest, lost = Scalar(1) - Scalar(1) / steepNow;
  return {{overlap, lost * elastic},
          Scalar(0.5) * (elastic * overlap * lost - spring.force(from) * from * (Scalar(1) - Scalar(1) / steepBefore))};
}

/// Luding: maximum overlap for which unloading reaches -k_c x at this overlap.
template <class T> GROUSER_HD T deepestBehind(const BasicPlasticity<T>& p, T overlap, T radius) {
  const T most = T(1) / (T(1) - p.share), full = p.fullDepth * radius;
  const T beyond = (most + p.adhesion) / (most - T(1)) * overlap;
  if (beyond >= full) return beyond;
  const T half = T(0.5) * overlap;
  return half + base::squareRoot(half * half + (T(1) + p.adhesion) * overlap * full / (most - T(1)));
}

/// Luding: energy dissipated while the maximum overlap decreases along the adhesive branch. `former`, `present`: k2 /
/// k1 before and after.
template <class T> GROUSER_HD T yieldedByPulling(const BasicPlasticity<T>& p, T stiffness, T overlap,
                                                 const BasicPlasticState<T>& before, T former, T present) {
  const T start = former * before.origin / (stiffness * (former + p.adhesion));
  const auto part = [&](T x, T ratio) { return p.adhesion * stiffness * x * x * (T(1) + p.adhesion / ratio); };
  return T(0.5) * (part(start, former) - part(overlap, present));
}

} // namespace detail

/// Returns the force at `overlap` > 0 of a contact with p.share > 0 and updates its state. The plastic work is the
/// integral of -dU/dx_p^m (U: elastic energy): in closed form on first loading and on Luding's branch, by the
/// trapezoidal rule over the step on EEPA's adhesive branch.
template <class T> GROUSER_HD BasicPlasticForce<T>
plasticForce(const BasicPlasticity<T>& p, const BasicElasticSpring<T>& spring, T overlap, BasicPlasticState<T>& state) {
  const T radius = spring.effectiveRadius, elastic = spring.force(overlap);
  const BasicPlasticState<T> before = state;
  const T steep = detail::steepness(p, before.deepest, radius), line = steep * (elastic - before.origin);
  if (line >= elastic) {
    const T steepNow = detail::steepness(p, overlap, radius);
    const detail::Loading<T> loaded = detail::firstLoading(p, spring, overlap, elastic, steep, steepNow, before);
    state = loaded.state;
    return {elastic, detail::adhesiveBranch(p, spring, elastic, steepNow, state).pull, loaded.yielded};
  }
  const detail::AdhesiveBranch<T> branch = detail::adhesiveBranch(p, spring, elastic, steep, before);
  if (line >= -branch.pull) return {line, branch.pull, T(0)};
  if (p.fullDepth > 0) {
    state.deepest = detail::deepestBehind(p, overlap, radius);
    const T steepNow = detail::steepness(p, state.deepest, radius);
    state.origin = (T(1) - T(1) / steepNow) * spring.force(state.deepest);
    return {-branch.pull, branch.pull, detail::yieldedByPulling(p, spring.stiffness, overlap, before, steep, steepNow)};
  }
  state.origin = elastic + branch.pull / steep;
  // The branch starts where the force leaves the steep line (found by one Newton step), or at the previous step.
  T start = elastic - (line + branch.pull) / (steep + branch.slope * branch.pull / elastic);
  start = start < before.origin ? start : before.origin;
  const auto place = [&](T force) { return overlap * spring.overlapRatio(force / elastic); };
  const T stretched = (place(before.origin) - place(start)) + (place(state.origin) - overlap);
  return {-branch.pull, branch.pull, T(0.5) * steep * stretched * (before.origin - state.origin)};
}

/// Same for one contact of a SIMD batch. Not inlined, so it is never compiled for an unsupported instruction set.
BasicPlasticForce<float> plasticForceAlone(const BasicPlasticity<float>& p, const BasicElasticSpring<float>& spring,
                                           float overlap, BasicPlasticState<float>& state);

/// Releasable energy of an elastic-plastic contact [J]: its elastic energy plus the plastic work of a change to this
/// overlap.
template <class T> GROUSER_HD T plasticEnergy(const BasicPlasticity<T>& p, const BasicElasticSpring<T>& spring,
                                              T overlap, BasicPlasticState<T> state) {
  const T yielded = plasticForce(p, spring, overlap, state).yielded;
  const T elastic = spring.force(overlap), steep = detail::steepness(p, state.deepest, spring.effectiveRadius);
  const T zero = overlap * spring.overlapRatio(state.origin / elastic); // x_p
  const T share = spring.hertz ? T(0.4) : T(0.5);                       // 1 / (m + 1)
  return steep * (share * (elastic * overlap - state.origin * zero) - state.origin * (overlap - zero)) + yielded;
}

} // namespace grouser::contact
