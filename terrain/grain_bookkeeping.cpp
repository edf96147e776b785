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

/// Quanta a unit: `most` takes 2^50 of them.
double quantaPer(double most) { return base::fixedPointFor(most, 50).perUnit; }

/// A step's work on one grain lies far below that of the strongest force along a radius, a force of walls below eight
/// of the strongest, its torque about the origin below that at the ends of the scene's range.
BookScale scaleOf(const GrainConstants& c) {
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

GrainBookkeeping::GrainBookkeeping(const base::Exec& exec, const GrainConstants& c)
    : massQuantum_(c.model.mass / kMassQuanta), books_(exec) {
  if (!c.model.ledger) return;
  scale_ = scaleOf(c);
  books_ = base::Array<base::WideSum>(exec, std::size_t{kBookBanks} * kBooks);
}

void GrainBookkeeping::describe(GrainKernelData& d) {
  d.books = kept() ? books_.data() : nullptr, d.bookScale = scale_;
}

GrainBookkeeping::Sums GrainBookkeeping::sums(const base::Comm& comm) const {
  return kept() ? base::summedBanks(books_.toHost(), kBooks, comm) : Sums(kBooks);
}

GrainBookkeeping::Totals GrainBookkeeping::totals(const base::Comm& comm) const {
  const Sums s = sums(comm);
  const auto energy = [&](int book) { return s[static_cast<std::size_t>(book)].value() / scale_.perEnergy; };
  const auto vector = [&](int book, double perUnit) {
    const auto b = static_cast<std::size_t>(book);
    return base::Vec3d{s[b].value(), s[b + 1].value(), s[b + 2].value()} * (1 / perUnit);
  };
  return {energy(kWork),
          energy(kTurnover),
          energy(kDamped),
          energy(kRubbed),
          energy(kRolled),
          energy(kSlipped),
          energy(kYielded),
          energy(kStabilised),
          s[kMass].value() * massQuantum_,
          vector(kMoment, scale_.perMoment),
          vector(kWallForce, scale_.perForce),
          vector(kWallTorque, scale_.perTorque)};
}

std::vector<std::int64_t> GrainBookkeeping::save(const base::Comm& comm) const {
  std::vector<std::int64_t> words;
  if (!kept()) return words;
  for (const base::WideSum& sum : sums(comm)) {
    words.push_back(static_cast<std::int64_t>(sum.low));
    words.push_back(sum.high);
  }
  return words;
}

void GrainBookkeeping::restore(const std::vector<std::int64_t>& saved, const base::Comm& comm) {
  // Files of programs without complementarity contacts end before their book.
  if (saved.size() != words() && !(kept() && saved.size() == 2 * std::size_t{kStabilised}))
    throw base::InputError("the checkpoint keeps other books of the grains; resume with the scene that was run");
  if (!kept()) return;
  std::vector<base::WideSum> banks(books_.size());
  if (comm.first())
    for (std::size_t b = 0; b < saved.size() / 2; ++b)
      banks[b] = {static_cast<std::uint64_t>(saved[2 * b]), saved[2 * b + 1]};
  books_.assign(banks);
}

} // namespace grouser::terrain
