// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/assembly.hpp"

#include <deque>
#include <vector>

namespace grouser::vehicle {

/// Travel of one track and its sprocket: track pitches that passed the sprocket, and distance at every tooth. The
/// difference between teeth and pitches passed detects skipped teeth, which a count of engaged pins would miss.
class Travel {
public:
  /// `teeth`: number of whole tooth passages over which speed and slip are averaged.
  Travel(const Assembly& vehicle, int track, int teeth = 1);

  /// Updates the counts; call once after every step of length `dt` [s]. The first call sets the reference positions.
  void update(const multibody::State& state, double dt);

  /// Teeth passed according to the sprocket angle: integral of omega Z / (2 pi) [-].
  double teethPassed() const { return teethPassed_; }
  /// Track pitches that passed a gate on the top run next to the sprocket, forward positive [-].
  double pitchesPassed() const { return pitchesPassed_; }
  /// Teeth minus pitches passed [-]: within +-1/2 due to slack, near a whole number after a skip.
  double skipped() const { return teethPassed_ - pitchesPassed_; }
  /// Distance travelled by the hull point at the track, along the hull x axis [m].
  double distance() const { return distance_; }
  /// Mean speed over the last whole tooth passages [m/s]; NaN before enough teeth have passed.
  double toothSpeed() const;
  /// Slip over the last whole tooth passages, 1 - distance / (teeth x pitch) [-]; NaN before enough teeth have passed.
  double toothSlip() const;

  /// State variables, for a checkpoint.
  std::vector<double> save() const;
  /// Inverse of save(). Throws base::InputError if the length does not match.
  void restore(const std::vector<double>& flat);

private:
  /// Record of the passage of a tooth boundary.
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

/// Hull speed at the track's sprocket, along the hull x axis [m/s].
double trackSpeed(const Assembly& vehicle, int track, const multibody::State& state);

/// Pose of the vehicle frame, X_WV.
base::Pose vehiclePose(const Assembly& vehicle, const multibody::State& state);

} // namespace grouser::vehicle
