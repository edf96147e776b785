// SPDX-License-Identifier: BSD-3-Clause
#include "contact/host_patches.hpp"

#include "base/error.hpp"

namespace grouser::contact {

void HostPatches::beginStep() {
  ++count_;
  elastic_ = 0;
  hadSpring_.swap(pressed_);
  pressed_.clear();
}

void HostPatches::press(std::size_t patch, const PatchLaw& law, const PartMotion* motion, int a, int b,
                        const PatchPressure& pressure, PartLoad* loads) {
  if (!(pressure.area > 0)) return;
  elastic_ += quanta_.energy.quantise(pressure.elastic);
  states_[patch].dissipated += pressure.dissipated;
  if (!(pressure.weight > 0)) return; // the surfaces separate faster than the foundation relaxes
  lastStep_[patch] = count_;
  pressed_.push_back(static_cast<std::uint32_t>(patch));
  PatchState& state = states_[patch];
  base::Vec3d force = pressure.force, torque = pressure.torque;
  if (const double pressing = norm(pressure.force); law.friction > 0 && pressing > 0) {
    const base::Vec3d lever = pressure.place * (1 / pressure.weight), x = motion[a].centre + lever;
    base::Vec3d relative = motion[a].velocityAt(x);
    if (b >= 0) relative -= motion[b].velocityAt(x);
    const PatchSlide slid =
        slide(law, state, pressure.force * (1 / pressing), relative, pressure.weight, pressure.area, timeStep_);
    force += slid.force;
    torque += cross(lever, slid.force);
    state.dissipated += slid.dissipated;
    elastic_ += quanta_.energy.quantise(slid.elastic);
  }
  const base::Vec3l given = quanta_.force.quantise(force);
  loads[a].force += given;
  loads[a].torque += quanta_.torque.quantise(torque);
  if (b < 0) return;
  loads[b].force -= given;
  loads[b].torque -= quanta_.torque.quantise(torque + cross(motion[a].centre - motion[b].centre, force));
}

void HostPatches::endStep() {
  for (const std::uint32_t patch : hadSpring_)
    if (lastStep_[patch] != count_) endContact(states_[patch]);
}

PatchBuffers::Ledger HostPatches::ledger() const {
  PatchBuffers::Ledger ledger;
  ledger.elastic = quanta_.energy.value(elastic_);
  ledger.patches = static_cast<std::int64_t>(pressed_.size());
  for (const PatchState& s : states_) ledger.dissipated += s.dissipated;
  return ledger;
}

SavedPatches HostPatches::save() const {
  PatchSums sums{};
  sums.weight = static_cast<std::int64_t>(pressed_.size()), sums.elastic = elastic_;
  return {states_, {sums}};
}

void HostPatches::restore(const SavedPatches& saved) {
  if (saved.states.size() != states_.size() || saved.sums.size() != 1)
    throw base::InputError("the checkpoint belongs to another vehicle; resume with the scene that was run");
  states_ = saved.states;
  elastic_ = saved.sums[0].elastic;
  pressed_.clear();
  for (std::size_t p = 0; p < states_.size(); ++p)
    if (states_[p].stiffness > 0) pressed_.push_back(static_cast<std::uint32_t>(p));
  // With friction every touching patch has a spring; without friction only the count matters.
  pressed_.resize(static_cast<std::size_t>(saved.sums[0].weight));
}

} // namespace grouser::contact
