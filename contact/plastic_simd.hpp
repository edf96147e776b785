// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/simd.hpp"
#include "contact/plastic_law.hpp"

#include <type_traits>

namespace grouser::contact {

/// SIMD version of plasticForce(): the same operations in the same order, so bitwise identical. First loading and the
/// steep line are computed in all lanes, then selected. The few contacts on the adhesive branch, or with decreasing
/// EEPA force, are computed separately.
template <base::SimdVector T>
GROUSER_SIMD BasicPlasticForce<T> plasticForce(const BasicPlasticity<base::ScalarOf<T>>& p,
                                               const BasicElasticSpring<T>& spring, const T& overlap,
                                               BasicPlasticState<T>& state) {
  static_assert(std::is_same_v<base::ScalarOf<T>, float>, "cube roots and single contacts are of float numbers");
  const bool luding = p.fullDepth > 0;
  const BasicPlasticState<T> before = state;
  const T radius = spring.effectiveRadius, elastic = spring.force(overlap), zero{};
  T steep = detail::steepness(p, before.deepest, radius);
  const T line = steep * (elastic - before.origin);
  const auto loads = line >= elastic;
  T yielded{};
  if (base::any(loads)) {
    const T steepNow = luding ? detail::steepness(p, overlap, radius) : steep;
    const detail::Loading<T> loaded = detail::firstLoading(p, spring, overlap, elastic, steep, steepNow, before);
    yielded = loads ? loaded.yielded : zero, steep = loads ? steepNow : steep;
    state.deepest = loads ? overlap : before.deepest;
    state.origin = loads ? loaded.state.origin : before.origin;
  }
  T pull{};
  std::remove_cvref_t<decltype(loads)> turned{};
  if (luding) {
    pull = detail::ludingPull(p, elastic, steep, state.origin);
  } else {
    const T perRoot = detail::pullPerRoot(p, radius);
    const detail::PullOff<T> off = detail::pullOff(p, spring, steep, perRoot, state.deepest);
    pull = perRoot > zero ? off.force : zero, turned = (perRoot > zero) & (elastic < off.turn);
  }
  BasicPlasticForce<T> bent{loads ? elastic : line, pull, yielded};
  unsigned alone = base::laneBits(turned | (line < -pull)) & ~base::laneBits(loads);
  for (; alone != 0; alone &= alone - 1) {
    const int l = __builtin_ctz(alone);
    BasicPlasticState<float> one{before.deepest[l], before.origin[l]};
    const BasicPlasticForce<float> found =
        plasticForceAlone(p, {spring.stiffness, radius[l], spring.hertz}, overlap[l], one);
    bent.force[l] = found.force, bent.adhesion[l] = found.adhesion, bent.yielded[l] = found.yielded;
    state.deepest[l] = one.deepest, state.origin[l] = one.origin;
  }
  return bent;
}

} // namespace grouser::contact
