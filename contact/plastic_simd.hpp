// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/simd.hpp"
#include "contact/plastic_law.hpp"

#include <type_traits>

namespace grouser::contact {

/// plasticForce() of many contacts side by side, by EEPA's law (p.fullDepth 0): the same operations in the same order,
/// so the same bits. First loading and the steep line are computed for all, and one is taken; the few contacts that are
/// pulled towards their end, on the adhesive branch or where its force falls, are taken one by one.
template <base::SimdVector T>
GROUSER_SIMD BasicPlasticForce<T> plasticForce(const BasicPlasticity<base::ScalarOf<T>>& p,
                                               const BasicElasticSpring<T>& spring, const T& overlap,
                                               BasicPlasticState<T>& state) {
  using Scalar = base::ScalarOf<T>;
  static_assert(std::is_same_v<Scalar, float>, "cube roots and single contacts are of float numbers");
  const BasicPlasticState<T> before = state;
  const Scalar steep = Scalar(1) / (Scalar(1) - p.share);
  const T elastic = spring.force(overlap), line = steep * (elastic - before.origin), zero{};
  const auto loads = line >= elastic;
  T yielded{};
  if (base::any(loads)) {
    yielded = loads ? detail::yieldedSince(p, spring, overlap, elastic, before.origin) : zero;
    state.deepest = loads ? overlap : before.deepest;
    state.origin = loads ? p.share * elastic : before.origin;
  }
  const T perRoot = detail::pullPerRoot(p, spring.effectiveRadius);
  const detail::PullOff<T> off = detail::pullOff(p, spring, steep, perRoot, state.deepest);
  const T pull = perRoot > zero ? off.force : zero;
  BasicPlasticForce<T> bent{loads ? elastic : line, pull, yielded};
  const auto turned = (perRoot > zero) & (elastic < off.turn);
  unsigned alone = base::laneBits(turned | (line < -pull)) & ~base::laneBits(loads);
  for (; alone != 0; alone &= alone - 1) {
    const int l = __builtin_ctz(alone);
    BasicPlasticState<float> one{before.deepest[l], before.origin[l]};
    const BasicPlasticForce<float> found =
        plasticForceAlone(p, {spring.stiffness, spring.effectiveRadius[l], spring.hertz}, overlap[l], one);
    bent.force[l] = found.force, bent.adhesion[l] = found.adhesion, bent.yielded[l] = found.yielded;
    state.deepest[l] = one.deepest, state.origin[l] = one.origin;
  }
  return bent;
}

} // namespace grouser::contact
