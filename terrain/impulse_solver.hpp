// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "contact/impulse_law.hpp"
#include "terrain/grain_constants.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace grouser::terrain {

struct GrainKernelData;
struct GrainSystem;

/// How well the complementarity problem of a step was solved, the same on all ranks.
struct ImpulseReport {
  int iterations{};    ///< 0 where the impulses of the last step were good enough
  int products{};      ///< evaluations of velocities from impulses: iterations, and steps that were too long
  double residual{};   ///< largest of all rows [m/s]
  double rms{};        ///< root of their mean square [m/s]
  double rows{};       ///< contacts
  bool relaxed{false}; ///< Coulomb's law did not converge and the step was ended with the convex relaxation
  bool met{true};      ///< whether the residual is within what was asked for
};

/// All steps since the start of the run.
struct ImpulseTotals {
  std::int64_t steps{}, iterations{};
  std::int64_t missed{};  ///< steps whose residual exceeded what was asked for
  std::int64_t relaxed{}; ///< see ImpulseReport
  double worst{};         ///< largest residual [m/s]

  void add(const ImpulseReport& report);
  static constexpr std::size_t kWords = 5;
  std::vector<std::int64_t> words() const; ///< for checkpoints
  void setWords(const std::int64_t* words);
};

/// Throws SimulationError where a step has no numbers any more, or where it misses what a strict run asks for.
void checkReport(const ImpulseReport& report, const contact::ComplementarityOptions& options, std::int64_t step);

/// Takes steps whose contacts are solved for together, as impulses on Coulomb's cones (contact/impulse_law.hpp):
/// accelerated projected gradients in the metric of WeighRows, with restarts (Nesterov 1983; Mazhar, Heyn, Negrut and
/// Tasora 2015, ACM Trans. Graph. 34:32), from the impulses of the last step. The residual of the natural map tells how
/// good the answer is. No order of contacts enters: the bits are the same on every device and any number of ranks.
class ImpulseSolver {
public:
  /// Null where the model has penalty contacts.
  static std::unique_ptr<ImpulseSolver> make(const base::Exec& exec, const GrainConstants& constants);
  virtual ~ImpulseSolver() = default;

  /// One step: writes the grains' next state, springs, books and flags. All ranks call it; ghosts must be up to date.
  virtual void step(GrainSystem& system, const GrainKernelData& d) = 0;
  const ImpulseReport& report() const { return report_; }
  const ImpulseTotals& totals() const { return totals_; }
  void setTotals(const std::int64_t* words) { totals_.setWords(words); }
  virtual std::size_t bytes() const = 0;

protected:
  ImpulseReport report_;
  ImpulseTotals totals_;
};

} // namespace grouser::terrain
