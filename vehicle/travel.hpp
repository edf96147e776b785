// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/assembly.hpp"

#include <deque>
#include <vector>

namespace grouser::vehicle {

/// Travel of one track and its sprocket: pitches past the sprocket, and distance covered at every tooth. A count of
/// engaged pins would miss a skip; pitches passed against teeth passed does not.
class Travel {
public:
  /// `teeth`: speed and slip are means over this many whole tooth passages.
  Travel(const Assembly& vehicle, int track, int teeth = 1);

  /// Call once after every step of length `dt` [s]; the first call sets the start.
  void update(const multibody::State& state, double dt);

  /// Teeth that have passed by the sprocket's angle, omega Z / (2 pi) integrated [-].
  double teethPassed() const { return teethPassed_; }
  /// Pitches of track that have passed a gate on the top run next to the sprocket, forward positive [-].
  double pitchesPassed() const { return pitchesPassed_; }
  /// Teeth minus pitches passed [-]: within +-1/2 is slack, near a whole number a skip.
  double skipped() const { return teethPassed_ - pitchesPassed_; }
  /// Distance covered by the track's position on the hull, along the hull's x axis [m].
  double distance() const { return distance_; }
  /// Mean speed over the last whole tooth passages [m/s]; NaN before the sprocket has passed so many.
  double toothSpeed() const;
  /// Slip over the last whole tooth passages, 1 - distance / (teeth x pitch) [-]; NaN before.
  double toothSlip() const;

  /// State variables, for a checkpoint.
  std::vector<double> save() const;
  /// Inverse of save(). Throws base::InputError if the length does not fit.
  void restore(const std::vector<double>& flat);

private:
  /// Passage of a tooth boundary.
  struct Passage {
    double tooth, time, distance;
  };
  double loopCoordinate(const multibody::State& state) const;
  void recordPassage(double teethBefore, double teethNow, double timeBefore, double timeNow, double distanceBefore);

  const Assembly* vehicle_;
  int track_;
  int teeth_;
  double gateX_;
  bool begun_ = false;
  double time_ = 0, firstTeeth_ = 0, lastCoordinate_ = 0;
  double teethPassed_ = 0, pitchesPassed_ = 0, distance_ = 0;
  std::deque<Passage> passages_;
};

/// Speed of the hull at the track's sprocket, along the hull's x axis [m/s].
double trackSpeed(const Assembly& vehicle, int track, const multibody::State& state);

/// Pose of the vehicle frame, X_WV.
base::Pose vehiclePose(const Assembly& vehicle, const multibody::State& state);

} // namespace grouser::vehicle
