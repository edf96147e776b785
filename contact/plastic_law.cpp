// SPDX-License-Identifier: BSD-3-Clause
#include "contact/plastic_law.hpp"

namespace grouser::contact {

BasicPlasticForce<float> plasticForceAlone(const BasicPlasticity<float>& p, const BasicElasticSpring<float>& spring,
                                           float overlap, BasicPlasticState<float>& state) {
  return plasticForce(p, spring, overlap, state);
}

} // namespace grouser::contact
