// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/solver.hpp"
#include "runs/validation/bench/bench.hpp"
#include "vehicle/assembly.hpp"

#include <string>
#include <vector>

/// `grouser bench multibody`: the speed of the multibody solver alone, on one core.
namespace grouser::bench {

struct MultibodyBench {
  std::string vehicle;     ///< spec file; empty: the light vehicle
  double speed = 3;        ///< of the sprockets [rad/s]
  double timeStep = 5e-5;  ///< [s]
  std::int64_t steps = 50; ///< of one batch: short, so that some are not interrupted
  int batches = 101;
  std::string json; ///< file; empty: none
  base::Comm comm;  ///< the ranks that were started: each does it all, the first one writes
};

/// The vehicle's graph, driven on level ground with its tracks under tension.
struct VehicleGraphFigures {
  int bodies = 0, joints = 0;
  int rows = 0;                              ///< hard constraint rows
  int loops = 0;                             ///< closed by a constraint outside the spanning tree
  int batches = 0;                           ///< of four bodies
  BatchTimes step;                           ///< as driven
  double iterations = 0, mostIterations = 0; ///< a step: mean and largest
  double positionError = 0;                  ///< largest after a step [m, rad]
  double hullSpeed = 0;                      ///< at the end [m/s]
  // Parts of a step, called by themselves at one state.
  BatchTimes linearise; ///< rows, inertias and the factorisation
  BatchTimes solve;     ///< one solution
  double iteration = 0; ///< solution, new poses and new gaps, from steps with more and with fewer iterations [us]
  double rest = 0;      ///< loads, first gaps, readings: a step's remainder [us]
};
VehicleGraphFigures benchVehicleGraph(const MultibodyBench& bench);

/// Two rings of so many shoes that spin, and a hull with wheels, arms and idlers.
struct RingFigures {
  int shoes = 0, bodies = 0;
  long multiplications = 0; ///< of one factorisation and one solution
  double iterations = 0;
  BatchTimes step;
};
RingFigures benchRings(int shoes, const MultibodyBench& bench);
multibody::Model ringsAndHull(int shoes);

/// Prints both, with the growth over 46, 92 and 184 shoes a ring.
void benchMultibodyCommand(const MultibodyBench& bench);

/// What guides the shoes while the solver is timed: circles for the wheels, a plane at z = 0 for the ground, each a
/// spring and dashpot with viscous friction. Forces of the right size on every body, without meshes and sphere sets.
class TrackGuide {
public:
  explicit TrackGuide(const vehicle::Assembly& vehicle);
  /// Sets the wrenches in `loads`.
  void apply(const multibody::State& state, multibody::Loads& loads) const;

private:
  struct Circle {
    int body;
    double radius, height; ///< [m]; of the points on the shoe that it touches
    double drag;           ///< [N s/m]
  };
  void touch(int shoe, const base::Pose& X, const Circle& circle, const multibody::State& state,
             multibody::Loads& loads) const;

  const vehicle::Assembly& vehicle_;
  std::vector<std::vector<Circle>> circles_; ///< one list a track
};

} // namespace grouser::bench
