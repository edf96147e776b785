// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/comm.hpp"
#include "terrain/grain_books.hpp"
#include "terrain/grain_model.hpp"

#include <array>
#include <vector>

namespace grouser::terrain {

struct GrainConstants;
struct GrainKernelData;

/// Energy accounting of a scene's grains since the start; empty if the model has no ledger. Each rank has partial sums.
class GrainEnergyAccounting {
public:
  GrainEnergyAccounting(const base::Exec& exec, const GrainConstants& constants);

  void describe(GrainKernelData& d);
  bool kept() const { return !sums_.empty(); }

  /// Sums over all ranks; totals() is collective.
  struct Totals {
    double work{}, turnover{}, damped{}, rubbed{}, rolled{}, slipped{}, yielded{}, stabilised{}; ///< [J]
    double mass{};                     ///< sum over steps and grains [kg]
    base::Vec3d moment;                ///< sum over steps and grains of mass times position [kg m]
    base::Vec3d wallForce, wallTorque; ///< sums over steps [N], [N m] about the world origin
  };
  Totals totals(const base::Comm& comm) const;

  /// Number of words in a checkpoint: two per sum.
  std::size_t words() const { return kept() ? 2 * std::size_t{kLedgerSums} : 0; }
  /// Returns the sums of all ranks as two words each, low and high, for checkpoints. Empty without a ledger.
  std::vector<std::int64_t> save(const base::Comm& comm) const;
  /// Throws InputError if only one of the checkpoint and the model has a ledger.
  void restore(const std::vector<std::int64_t>& saved, const base::Comm& comm);

private:
  using Sums = std::vector<base::WideSum>;
  Sums sums(const base::Comm& comm) const;

  LedgerScale scale_;
  double massQuantum_;              ///< [kg]
  base::Array<base::WideSum> sums_; ///< [kLedgerBanks][kLedgerSums]
};

} // namespace grouser::terrain
