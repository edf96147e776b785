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

/// The books of a scene's grains since the start, or none where the model asks for none. Each rank has a share.
class GrainBookkeeping {
public:
  GrainBookkeeping(const base::Exec& exec, const GrainConstants& constants);

  void describe(GrainKernelData& d);
  bool kept() const { return !books_.empty(); }

  /// What the books say, of all ranks, which all call it.
  struct Totals {
    double work{}, turnover{}, damped{}, rubbed{}, rolled{}, slipped{}, yielded{}, stabilised{}; ///< [J]
    double mass{};                     ///< sum over steps and grains [kg]
    base::Vec3d moment;                ///< sum over steps and grains of mass times place [kg m]
    base::Vec3d wallForce, wallTorque; ///< sums over steps [N], [N m about the origin]
  };
  Totals totals(const base::Comm& comm) const;

  /// Number of words that a checkpoint has of them: two a sum.
  std::size_t words() const { return kept() ? 2 * std::size_t{kBooks} : 0; }
  /// The sums as two words each, low and high, of all ranks; for checkpoints. Empty where no books are kept.
  std::vector<std::int64_t> save(const base::Comm& comm) const;
  /// Throws InputError where there are books in one and none in the other.
  void restore(const std::vector<std::int64_t>& saved, const base::Comm& comm);

private:
  using Sums = std::vector<base::WideSum>;
  Sums sums(const base::Comm& comm) const;

  BookScale scale_;
  double massQuantum_;               ///< [kg]
  base::Array<base::WideSum> books_; ///< [kBookBanks][kBooks]
};

} // namespace grouser::terrain
