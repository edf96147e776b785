// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/applied_loads.hpp"

#include "base/error.hpp"

namespace grouser::coupling {

void AppliedLoads::set(const Inputs& inputs) {
  loads_.clear();
  for (const Input& i : inputs.acting())
    if (i.kind == InputKind::bodyLoad)
      loads_.push_back({static_cast<std::size_t>(i.target),
                        {{i.value[0], i.value[1], i.value[2]}, {i.value[3], i.value[4], i.value[5]}},
                        {}});
}

void AppliedLoads::add(const multibody::State& state, multibody::Loads& loads) {
  for (Load& l : loads_) {
    l.before = state.twist[l.body];
    loads.external[l.body].force += l.wrench.force, loads.external[l.body].torque += l.wrench.torque;
  }
}

void AppliedLoads::accountWork(const multibody::State& state, double dt) {
  for (const Load& l : loads_) {
    const multibody::Twist& now = state.twist[l.body];
    work_ += (dot(l.wrench.force, l.before.v + now.v) + dot(l.wrench.torque, l.before.w + now.w)) * (0.5 * dt);
  }
}

void AppliedLoads::restore(const std::vector<double>& saved) {
  if (saved.empty()) return; // written by a version without applied loads
  if (saved.size() != save().size())
    throw base::InputError("the checkpoint contains a different number of applied-load work values; resume with the "
                           "program version that wrote it");
  work_.sum = saved[0], work_.lost = saved[1];
}

} // namespace grouser::coupling
