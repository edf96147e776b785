// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/model.hpp"
#include "multibody/state.hpp"

#include <memory>
#include <string>
#include <vector>

namespace grouser::multibody {

enum class Integrator {
  /// Constrained symplectic Euler (detail/euler_step.cpp). Order 1; the cheapest, for coupling with contacts. Twists
  /// are
  /// means over the steps.
  kSymplecticEuler,
  /// RATTLE on the rotation group (detail/rattle_step.cpp). Order 2, or 4, 6, 8 by composition (SolverOptions::order);
  /// symplectic and time-reversible; position and velocity constraints both met at the end of each step. A start
  /// velocity that differs from an imposed rate is changed by a blow in the first step (StartVelocities::kAccept).
  kRattle,
};

/// How kRattle takes axis springs, point springs and bushings. Dampers and end stops are implicit in both.
enum class Springs {
  /// At the nodes: cheapest; needs omega dt < 2 (2.72, 2.53, 3.10 with order 4, 6, 8) and refuses a longer step, naming
  /// the spring.
  kExplicit,
  /// Midpoint along the spring's direction: order 2, stable at any step in the linear case. Across it a point spring
  /// under tension T and of length l has the stiffness T / l, which stays explicit: dt < 2 sqrt(m l / T).
  kImplicit,
};

/// What the solver does about start velocities that break the constraints.
enum class StartVelocities {
  kRefuse, ///< InputError naming the joint and the rate at which it would open
  kAccept, ///< leaves them: the first step, or Solver::projectVelocities(), makes them fit
};

/// What SolverOptions::positionTolerance is where it is not given [m, rad]. RATTLE closes to round-off: the order of
/// its energy error counts on it.
inline constexpr double kEulerTolerance = 1e-10, kRattleTolerance = 1e-15;

struct SolverOptions {
  /// On every hard constraint after a step [m, rad]; 0: kEulerTolerance or kRattleTolerance. kRattle goes no further
  /// than round-off, 5e-16 of the coordinates. What is left of
  /// a gap comes back in the next step's constraint force as up to mass x gap / dt^2: 0.3 N for a shoe of 8.5 kg at 50
  /// us and 1e-10 m.
  double positionTolerance = 0;
  int maxIterations =
      0; ///< of the position solve; 0: 12 for kSymplecticEuler, 40 for kRattle. Typically 1 to 5 are used
  Integrator integrator = Integrator::kSymplecticEuler;
  /// Of kRattle: 2, or 4, 6, 8 as symmetric compositions of 5, 9, 17 stages of order 2, some of them backwards in time:
  /// for smooth motions to high accuracy over long times. A damper with c dt / m > 0.3 or so is refused by name, since
  /// going back feeds it.
  int order = 2;
  Springs springs = Springs::kExplicit;
  StartVelocities startVelocities = StartVelocities::kRefuse;
  double velocityTolerance = 1e-6; ///< of the check of start velocities [m/s, rad/s]
};

/// How well the last step was solved.
struct StepReport {
  int iterations = 0;
  double maxPositionError = 0; ///< max |C| over the hard rows at the new poses [m, rad]
  int singularRows = 0;        ///< rows without a pivot in this step: a singular position is being passed
};

/// Advances a mechanism; the integrators' schemes are stated above their code. Deterministic, one thread, no allocation
/// in step().
///
/// With kSymplecticEuler a start velocity belongs to the start pose, half a step before the first mean velocity: the
/// first step gets a whole step of load where half would do (a shift in time of dt / 2, the scheme's only first-order
/// error for smooth motions), and needs half the centripetal constraint force.
class Solver {
public:
  /// Orders the elimination, finds redundant constraints, and checks the start. The model must outlive the solver and
  /// not change. Throws base::InputError if at the start joints are not closed (naming the joint and its gap),
  /// velocities break a constraint (naming joint and rate), a drive or coupling contradicts the others or a closed loop
  /// (naming it), a driven axis is not where its law begins, or an option is out of its range.
  explicit Solver(const Model& model, const SolverOptions& options = {});
  ~Solver();
  Solver(Solver&&) noexcept;
  Solver& operator=(Solver&&) noexcept;

  /// One step of size dt [s], > 0. Throws base::SimulationError (naming step time and joint or body) when the position
  /// solve fails or a state is not finite; base::InputError when dt is beyond the stability limit of explicit springs
  /// (naming spring, limit and remedy).
  void step(State& state, const Loads& loads, double dt);

  /// Makes the twists of a state fit the constraints and drives by the smallest change in the norm of kinetic energy
  /// (as a shock would). Returns the kinetic energy taken out [J].
  double projectVelocities(State& state, const Loads& loads);

  /// Largest step for which explicit springs are stable at a state's poses [s]: 2 / omega, omega the highest frequency
  /// of all springs against the constrained masses (the factor 2 is another for orders above 2, see kExplicit);
  /// infinite without springs. `spring`, if given, receives the name of the spring with the greatest part in it.
  double stableStep(const State& state, const Loads& loads, std::string* spring = nullptr);

  /// Fastest rate [rad/s] at which the pull of joints, springs, couplings and drives moves bodies at a state: a taut
  /// chain or spring lets them swing across it, a pressed one lets them fall to the side (detail/pull.hpp). All schemes
  /// need dt < stableTurn() / rate; beyond that a swing grows. 0 where nothing pulls. `part`, if given, receives the
  /// name of what has the greatest part in it.
  double geometricStiffnessRate(const State& state, const Loads& loads, std::string* part = nullptr);

  /// Largest omega dt [rad] of a swing that the scheme takes explicitly: 2 (2.72, 2.53, 3.10 with order 4, 6, 8).
  double stableTurn() const;

  const StepReport& lastStep() const;
  /// Rows without a pivot, by name, in the last matrix of the last step (kSymplecticEuler: of its start, kRattle: of
  /// its end); empty but in singular positions.
  std::vector<std::string> singularRowNames() const;
  /// max |J v| over the hard rows at a state's poses [m/s, rad/s]. With kRattle it is met to round-off. With
  /// kSymplecticEuler the twist is the mean over the step that led there and meets the constraints over that step to
  /// positionTolerance / dt; at its end it leaves them by O(dt |w|^2 size).
  double velocityError(const State& state) const;
  /// Size of the problem, independent parts, fill of the factor, and what was done about redundant rows.
  const std::string& report() const;
  /// Rows dropped because others imply them.
  int redundantRows() const;
  /// Their names: "joint 'pin 7': rotation about x".
  std::vector<std::string> redundantRowNames() const;
  /// Degrees of freedom that joints and couplings leave (drives not counted), redundancy taken into account.
  int degreesOfFreedom() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace grouser::multibody
