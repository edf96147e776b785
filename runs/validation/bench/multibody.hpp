// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/solver.hpp"
#include "runs/validation/bench/bench.hpp"
#include "vehicle/assembly.hpp"

#include <string>
#include <vector>

/// `grouser bench multibody`: speed of the multibody solver on one core.
namespace grouser::bench {

struct MultibodyBench {
  std::string vehicle;     ///< spec file; empty: the light vehicle
  double speed = 3;        ///< sprocket speed [rad/s]
  double timeStep = 5e-5;  ///< [s]
  std::int64_t steps = 50; ///< steps per batch; small, so that some batches run without an interruption by the system
  int batches = 101;
  std::string json; ///< JSON file; empty: no file
  base::Comm comm;  ///< each rank does all the work; only the first rank writes
};

/// Results for the multibody model of the vehicle, which drives on level ground with tensioned tracks.
struct VehicleGraphFigures {
  int bodies = 0, joints = 0;
  int rows = 0;                              ///< hard constraint rows
  int loops = 0;                             ///< constraints outside the spanning tree
  int batches = 0;                           ///< SIMD batches of four bodies
  BatchTimes step;                           ///< complete steps
  double iterations = 0, mostIterations = 0; ///< iterations per step: mean and maximum
  double positionError = 0;                  ///< maximum joint error after a step [m, rad]
  double hullSpeed = 0;                      ///< final hull speed [m/s]
  // Parts of a step, called separately at the same state:
  BatchTimes linearise; ///< rows, inertias and the factorisation
  BatchTimes solve;     ///< one solve
  double iteration = 0; ///< solve, poses and joint errors; from steps with different numbers of iterations [us]
  double rest = 0;      ///< remainder of a step: loads, first joint errors, readings [us]
};
VehicleGraphFigures benchVehicleGraph(const MultibodyBench& bench);

/// Results for two spinning rings of shoes, and a hull with wheels, arms and idlers.
struct RingFigures {
  int shoes = 0, bodies = 0;
  long multiplications = 0; ///< number of multiplications in one factorisation and one solve
  double iterations = 0;
  BatchTimes step;
};
RingFigures benchRings(int shoes, const MultibodyBench& bench);
multibody::Model ringsAndHull(int shoes);

/// Prints the results of both models, with the growth over 46, 92 and 184 shoes per ring.
void benchMultibodyCommand(const MultibodyBench& bench);

/// Guiding forces on the shoes: circles represent the wheels, a plane at z = 0 represents the ground. Each acts through
/// a spring and a dashpot, with viscous friction. This applies realistic forces to every body without meshes.
class TrackGuide {
public:
  explicit TrackGuide(const vehicle::Assembly& vehicle);
  /// Sets the wrenches of the shoes in `loads`.
  void apply(const multibody::State& state, multibody::Loads& loads) const;

private:
  struct Circle {
    int body;
    double radius, height; ///< [m] radius of the circle, and height of the contact points on the shoe
    double drag;           ///< [N s/m]
  };
  void touch(int shoe, const base::Pose& X, const Circle& circle, const multibody::State& state,
             multibody::Loads& loads) const;

  const vehicle::Assembly& vehicle_;
  std::vector<std::vector<Circle>> circles_; ///< one list per track
};

} // namespace grouser::bench
