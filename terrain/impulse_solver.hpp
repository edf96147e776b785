// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "contact/body_response.hpp"
#include "contact/complementarity_options.hpp"
#include "contact/grain_part_contacts.hpp"
#include "terrain/grain_constants.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace grouser::terrain {

struct GrainKernelData;
struct GrainSystem;

/// Rigid bodies in contact with grains; they must outlive the step.
struct ImpulseParts {
  contact::GrainPartContacts* contacts{nullptr};           ///< pairs, history and laws; null: no parts
  const base::Array<contact::PartMotion>* motion{nullptr}; ///< at the start of the step
  contact::PartLoad* loads{nullptr};                       ///< [part] output, on the device
  contact::BodyResponse* bodies{nullptr};
};

/// Outcome of solving the complementarity problem of a step, identical on all ranks.
struct ImpulseReport {
  int iterations{};    ///< 0: the impulses of the last step already satisfied the tolerance
  double residual{};   ///< maximum over all rows [m/s]
  double rms{};        ///< root mean square over all rows [m/s]
  double rows{};       ///< number of contacts
  bool relaxed{false}; ///< Coulomb's law did not converge: the convex relaxation finished the step
  bool met{true};      ///< the residual is at most run.residual, or the rounding of the velocities
  bool raised{false};  ///< run.residual is below the rounding of the velocities, which is the tolerance of this step
};

/// Totals over all steps since the start of the run.
struct ImpulseTotals {
  std::int64_t steps{}, iterations{};
  std::int64_t missed{};  ///< steps that exceeded run.residual
  std::int64_t relaxed{}; ///< see ImpulseReport
  std::int64_t raised{};  ///< see ImpulseReport
  double worst{};         ///< largest residual [m/s]
  double tau{1};          ///< final value of the last step, used as initial value of the next; see ImpulseControl

  void add(const ImpulseReport& report);
  static constexpr std::size_t kWords = 7;
  std::vector<std::int64_t> words() const; ///< for checkpoints
  void setWords(const std::int64_t* words);
};

/// Cost of the iterations in this process; not part of the simulation state.
struct ImpulseCost {
  double seconds{};           ///< wall time
  std::int64_t evaluations{}; ///< evaluations, including repeated ones and initial impulses
  std::int64_t bytes{};       ///< sent to other ranks
};

/// Throws SimulationError if velocities are not finite, and in strict runs if a step exceeds run.residual or requires
/// the relaxation.
void checkReport(const ImpulseReport& report, const contact::ComplementarityOptions& options, std::int64_t step);

/// Solver of steps in which all contacts are solved simultaneously, as impulses on Coulomb cones
/// (contact/impulse_law.hpp): accelerated projected gradients in the metric of WeighRows, with restarts (Nesterov 1983;
/// Mazhar, Heyn, Negrut and Tasora 2015, ACM Trans. Graph. 34:32), warm-started from the last step. The error is
/// measured by the residual of the natural map. The order of contacts does not matter: results are bitwise identical on
/// every device and any number of ranks.
class ImpulseSolver {
public:
  /// Creates the solver; null if the model has penalty contacts.
  static std::unique_ptr<ImpulseSolver> make(const base::Exec& exec, const GrainConstants& constants);
  virtual ~ImpulseSolver() = default;

  /// Sets the rigid bodies for all following steps.
  void setParts(const ImpulseParts& parts) { parts_ = parts; }
  /// Computes one step: writes the grains' next state, springs, ledger sums and flags. Collective; requires up-to-date
  /// ghosts.
  virtual void step(GrainSystem& system, const GrainKernelData& d) = 0;
  const ImpulseReport& report() const { return report_; }
  const ImpulseTotals& totals() const { return totals_; }
  const ImpulseCost& cost() const { return cost_; }
  void setTotals(const std::int64_t* words) { totals_.setWords(words); }
  virtual std::size_t bytes() const = 0;

protected:
  ImpulseReport report_;
  ImpulseTotals totals_;
  ImpulseCost cost_;
  ImpulseParts parts_;
};

} // namespace grouser::terrain
