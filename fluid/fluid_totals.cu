// SPDX-License-Identifier: BSD-3-Clause
// Energies, momentum and losses: exact integer sums, identical in any order, on any device and number of ranks.
#include "base/summed_banks.hpp"
#include "fluid/fluid.hpp"
#include "fluid/fluid_kernels.cuh"

#include <array>
#include <cmath>

namespace grouser::fluid {

namespace {

struct AddTotals {
  static constexpr double kNanoseconds = 60;
  enum Sum {
    kinetic,
    internal,
    attraction,
    viscous,
    diffusion,
    wall,
    momentum,
    place = momentum + 3,
    kSums = place + 3
  };
  static constexpr int kBanks = 16; ///< copies of the sums, to reduce conflicts of concurrent threads

  FluidView f;
  base::FixedPoint energy; ///< [J/kg]
  base::FixedPoint speed;  ///< [m/s]
  base::WideSum* sums;     ///< [kBanks][kSums]
  std::uint64_t* slowest;  ///< minimum of the inverted bits of the squared speed, a positive double

  GROUSER_HD void operator()(int i) const {
    if (f.isGhost(i)) return;
    const PreciseMotion& m = f.precise[i];
    const Losses& lost = f.losses[i];
    const double speed2 = norm2(m.velocity);
    const base::Vec3l u = base::toUnits(f.position[i]);
    std::int64_t share[kSums];
    share[kinetic] = energy.quantise(0.5 * speed2);
    share[internal] = energy.quantise(internalEnergy(static_cast<double>(f.constants.sound2), m.compression));
    share[attraction] = energy.quantise(0.5 * f.attraction * norm2(f.constants.scale.toMetres(f.position[i])));
    share[viscous] = energy.quantise(lost.viscous), share[diffusion] = energy.quantise(lost.diffusion);
    share[wall] = energy.quantise(lost.wall);
    for (int a = 0; a < 3; ++a) share[momentum + a] = speed.quantise(m.velocity[a]), share[place + a] = u[a];
    base::WideSum* const bank = sums + (i / 256 % kBanks) * kSums;
#if defined(__CUDA_ARCH__)
    base::atomicAddTogether(bank, share);
#else
    for (int k = 0; k < kSums; ++k) base::atomicAddWide(bank + k, share[k]);
#endif
    base::atomicMin64(slowest, ~base::bitsAs<std::uint64_t>(speed2));
  }
};

} // namespace

FluidTotals Fluid::totals() {
  using Sum = AddTotals;
  constexpr int kBits = 50; // 32 terms of 2^50 quanta, the sum of a warp, fit into 64 bits
  const double c = model_.soundSpeed;
  const base::FixedPoint energy = base::fixedPointFor(c * c, kBits), speed = base::fixedPointFor(c, kBits);
  base::Array<base::WideSum> banks(exec_, std::size_t{Sum::kBanks} * Sum::kSums);
  base::Array<std::uint64_t> slowest(exec_, std::vector<std::uint64_t>{~std::uint64_t{0}});
  base::forEach(exec_, "totals of the fluid", static_cast<std::int64_t>(slots_),
                AddTotals{view(), energy, speed, banks.data(), slowest.data()});
  const std::vector<base::WideSum> all = base::summedBanks(banks.toHost(), Sum::kSums, comm_);
  std::uint64_t fastest = slowest.at(0);
  comm_.minimum(&fastest, 1);

  const double mass = model_.mass(), perEnergy = energy.quantum * mass;
  FluidTotals t;
  base::Vec3d place;
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    t.momentum[a] = all[Sum::momentum + axis].value() * speed.quantum * mass;
    place[a] = all[Sum::place + axis].value() * constants_.scale.unit;
  }
  t.kinetic = all[Sum::kinetic].value() * perEnergy, t.internal = all[Sum::internal].value() * perEnergy;
  t.potential = all[Sum::attraction].value() * perEnergy - mass * dot(model_.gravity, place);
  t.viscousLoss = all[Sum::viscous].value() * perEnergy, t.diffusionLoss = all[Sum::diffusion].value() * perEnergy;
  t.wallLoss = all[Sum::wall].value() * perEnergy;
  t.fastest = particles_ > 0 ? std::sqrt(base::bitsAs<double>(~fastest)) : 0.0;
  for (const base::Vec3d& f : markerForces()) t.wallForce += f;
  return t;
}

} // namespace grouser::fluid
