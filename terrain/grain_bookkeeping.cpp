// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grain_bookkeeping.hpp"

#include "base/error.hpp"
#include "base/summed_banks.hpp"
#include "contact/strongest_force.hpp"
#include "terrain/grain_constants.hpp"
#include "terrain/grain_kernel_data.cuh"

#include <algorithm>

namespace grouser::terrain {

namespace {

/// Quanta per unit for which `most` is 2^50 quanta.
double quantaPer(double most) { return base::fixedPointFor(most, 50).perUnit; }

/// Upper bounds per step: the work on a grain is far below the work of the strongest force along one radius; a wall
/// force is below eight such forces, and its torque about the origin below their torque at the ends of the scene.
LedgerScale scaleOf(const GrainConstants& c) {
  double force = 0;
  const auto consider = [&](const contact::ContactLaw& law) {
    force = std::max(force, contact::strongestForce(law, c.model.radius, contact::kForcePress));
  };
  consider(c.model.law);
  for (const contact::ContactLaw& law : c.model.materials.grains) consider(law);
  for (const contact::ContactLaw& law : c.model.materials.boundaries) consider(law);
  consider(c.model.floorLaw);
  return {quantaPer(force * c.model.radius), 1 / (c.model.mass * c.scale.unit), quantaPer(8 * force),
          quantaPer(8 * force * c.scale.limit())};
}

} // namespace

GrainEnergyAccounting::GrainEnergyAccounting(const base::Exec& exec, const GrainConstants& c)
    : massQuantum_(c.model.mass / kMassQuanta), sums_(exec) {
  if (!c.model.ledger) return;
  scale_ = scaleOf(c);
  sums_ = base::Array<base::WideSum>(exec, std::size_t{kLedgerBanks} * kLedgerSums);
}

void GrainEnergyAccounting::describe(GrainKernelData& d) {
  d.ledgerSums = kept() ? sums_.data() : nullptr, d.ledgerScale = scale_;
}

GrainEnergyAccounting::Sums GrainEnergyAccounting::sums(const base::Comm& comm) const {
  return kept() ? base::summedBanks(sums_.toHost(), kLedgerSums, comm) : Sums(kLedgerSums);
}

GrainEnergyAccounting::Totals GrainEnergyAccounting::totals(const base::Comm& comm) const {
  const Sums s = sums(comm);
  const auto energy = [&](int sum) { return s[static_cast<std::size_t>(sum)].value() / scale_.perEnergy; };
  const auto vector = [&](int sum, double perUnit) {
    const auto b = static_cast<std::size_t>(sum);
    return base::Vec3d{s[b].value(), s[b + 1].value(), s[b + 2].value()} * (1 / perUnit);
  };
  return {energy(kWork),
          energy(kTurnover),
          energy(kDashpotDissipation),
          energy(kSlidingDissipation),
          energy(kRollingDissipation),
          energy(kMicroSlipDissipation),
          energy(kPlasticDissipation),
          energy(kStabilisation),
          s[kMass].value() * massQuantum_,
          vector(kMoment, scale_.perMoment),
          vector(kWallForce, scale_.perForce),
          vector(kWallTorque, scale_.perTorque)};
}

std::vector<std::int64_t> GrainEnergyAccounting::save(const base::Comm& comm) const {
  std::vector<std::int64_t> words;
  if (!kept()) return words;
  for (const base::WideSum& sum : sums(comm)) {
    words.push_back(static_cast<std::int64_t>(sum.low));
    words.push_back(sum.high);
  }
  return words;
}

void GrainEnergyAccounting::restore(const std::vector<std::int64_t>& saved, const base::Comm& comm) {
  // Files of versions without complementarity contacts lack the last sum.
  if (saved.size() != words() && !(kept() && saved.size() == 2 * std::size_t{kStabilisation}))
    throw base::InputError(
        "the checkpoint has another energy accounting of the grains; resume with the scene that was run");
  if (!kept()) return;
  std::vector<base::WideSum> banks(sums_.size());
  if (comm.first())
    for (std::size_t b = 0; b < saved.size() / 2; ++b)
      banks[b] = {static_cast<std::uint64_t>(saved[2 * b]), saved[2 * b + 1]};
  sums_.assign(banks);
}

} // namespace grouser::terrain
