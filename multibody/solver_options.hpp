// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace grouser::multibody {

enum class Integrator {
  /// Constrained symplectic Euler (detail/euler_step.cpp). Order 1; the cheapest, for coupling with contacts. Twists
  /// are
  /// means over the steps.
  kSymplecticEuler,
  /// RATTLE on the rotation group (detail/rattle_step.cpp). Order 2, or 4, 6, 8 by composition (SolverOptions::order);
  /// symplectic and time-reversible; position and velocity constraints both met at the end of each step. A start
  /// velocity that differs from an imposed rate is changed by an impact in the first step (StartVelocities::kAccept).
  kRattle,
};

/// Treatment of axis springs, point springs and bushings by kRattle. Dampers and end stops are implicit in both.
enum class Springs {
  /// At the nodes: cheapest; needs omega dt < 2 (2.72, 2.53, 3.10 with order 4, 6, 8) and rejects longer steps, naming
  /// the spring.
  kExplicit,
  /// Midpoint along the spring's direction: order 2, stable at any step in the linear case. Across it a point spring
  /// under tension T and of length l has the stiffness T / l, which stays explicit: dt < 2 sqrt(m l / T).
  kImplicit,
};

/// Treatment of start velocities that violate the constraints.
enum class StartVelocities {
  kRefuse, ///< InputError naming the joint and the rate at which it would open
  kAccept, ///< leaves them: the first step, or Solver::projectVelocities(), makes them fit
};

/// Defaults of SolverOptions::positionTolerance [m, rad]. RATTLE solves to round-off, as the order of its energy error
/// requires.
inline constexpr double kEulerTolerance = 1e-10, kRattleTolerance = 1e-15;

struct SolverOptions {
  /// Tolerance of every hard constraint after a step [m, rad]; 0: kEulerTolerance or kRattleTolerance. kRattle is
  /// limited to round-off, 5e-16 of the coordinates. A remaining gap changes the next step's constraint force by up to
  /// mass x gap / dt^2: 0.3 N for a shoe of 8.5 kg at 50 us and 1e-10 m.
  double positionTolerance = 0;
  int maxIterations =
      0; ///< of the position solve; 0: 12 for kSymplecticEuler, 40 for kRattle. Typically 1 to 5 are used
  Integrator integrator = Integrator::kSymplecticEuler;
  /// Order of kRattle: 2, or 4, 6, 8 as symmetric compositions of 5, 9, 17 stages of order 2, some of them backwards in
  /// time: for smooth motions to high accuracy over long times. Dampers with c dt / m above about 0.3 are rejected by
  /// name, since backward stages add their energy.
  int order = 2;
  Springs springs = Springs::kExplicit;
  StartVelocities startVelocities = StartVelocities::kRefuse;
  /// L of Solver::reactions() [m], >= 0: lever arm that relates moments to forces. 0: the spacing of the joints that
  /// share, the root mean square of the distances between any two of them as the model places them. Well below it
  /// joints carry moments only if forces alone cannot, like short hinges.
  double momentLength = 0;
  /// kSymplecticEuler: solve each body's gyroscopic equation to round-off, as kRattle does. If false, which is cheaper
  /// for slow rotation, it is solved to the position tolerance: if smaller steps then need one iteration less, the
  /// error of a spinning body becomes ten times as large.
  bool exactGyroscopics = false;
  double velocityTolerance = 1e-6; ///< of the check of start velocities [m/s, rad/s]
};

/// Accuracy of the last step.
struct StepReport {
  int iterations = 0;
  double maxPositionError = 0; ///< max |C| over the hard rows at the new poses [m, rad]
  int singularRows = 0;        ///< rows without a pivot in this step: a singular position is being passed
};

} // namespace grouser::multibody
