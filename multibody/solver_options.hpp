// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace grouser::multibody {

enum class Integrator {
  /// Constrained symplectic Euler scheme (detail/euler_step.cpp).
  /// Order 1; the cheapest scheme, intended for coupling with contacts.
  /// Twists are means over the steps.
  kSymplecticEuler,
  /// RATTLE on the rotation group (detail/rattle_step.cpp). Order 2, or 4, 6, 8 by composition (SolverOptions::order);
  /// symplectic and time-reversible; satisfies position and velocity constraints at the end of each step. An initial
  /// velocity that differs from an imposed rate jumps to it in the first step (StartVelocities::kAccept).
  kRattle,
};

/// Integration of axis springs, point springs and bushings by kRattle. Dampers and end stops are always implicit.
enum class Springs {
  /// Evaluated at the ends of a step. Lowest cost; requires omega dt < 2 (2.72, 2.53, 3.10 with order 4, 6, 8); the
  /// solver refuses longer steps and names the spring.
  kExplicit,
  /// Midpoint rule along the direction of the spring: order 2; stable at any step size if linear. The transverse
  /// stiffness T / l of a point spring of length l under tension T remains explicit: dt < 2 sqrt(m l / T).
  kImplicit,
};

/// Treatment of initial velocities that violate the constraints.
enum class StartVelocities {
  kRefuse, ///< InputError, with the joint and the rate at which it would open
  kAccept, ///< kept until the first step, or Solver::projectVelocities(), projects them
};

/// Defaults of SolverOptions::positionTolerance [m, rad]. RATTLE solves to round-off, as required for the order of its
/// energy error.
inline constexpr double kEulerTolerance = 1e-10, kRattleTolerance = 1e-15;

struct SolverOptions {
  /// Tolerance of every hard constraint after a step [m, rad]; 0: kEulerTolerance or kRattleTolerance. kRattle is
  /// limited to round-off, 5e-16 of the coordinates. A residual gap changes the constraint force of the next step by up
  /// to mass x gap / dt^2: 0.3 N for a shoe of 8.5 kg at 50 us and 1e-10 m.
  double positionTolerance = 0;
  int maxIterations =
      0; ///< maximum position iterations; 0: 12 for kSymplecticEuler, 40 for kRattle. Usually 1 to 5 suffice
  Integrator integrator = Integrator::kSymplecticEuler;
  /// Order of kRattle: 2, or 4, 6, 8 as symmetric compositions of 5, 9, 17 stages of order 2, some of them backward in
  /// time. Higher orders are for smooth motions, high accuracy and long times. The solver refuses dampers with c dt / m
  /// above about 0.3, which add energy in backward stages.
  int order = 2;
  Springs springs = Springs::kExplicit;
  StartVelocities startVelocities = StartVelocities::kRefuse;
  /// L of Solver::reactions() [m], >= 0: lever arm that relates moments to forces. 0: the spacing of the redundant
  /// joints, i.e. the root mean square of their mutual distances at the model's poses. With L well below this spacing,
  /// joints transmit moments only if forces are not sufficient, like short hinges.
  double momentLength = 0;
  /// kSymplecticEuler: true solves each body's gyroscopic equation to round-off, as kRattle does; false solves it to
  /// the position tolerance, which is cheaper for slow rotation. With false, the error of a spinning body may increase
  /// tenfold if smaller steps require one iteration less.
  bool exactGyroscopics = false;
  double velocityTolerance = 1e-6; ///< tolerance of the initial velocity check [m/s, rad/s]
};

/// Accuracy of the last step.
struct StepReport {
  int iterations = 0;
  double maxPositionError = 0; ///< max |C| over the hard rows at the new poses [m, rad]
  int singularRows = 0;        ///< rows without a pivot in this step, in which the mechanism passes a singular position
};

} // namespace grouser::multibody
