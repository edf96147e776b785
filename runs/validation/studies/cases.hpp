// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/mechanism.hpp"

#include <functional>
#include <string>
#include <vector>

/// Mechanisms with known motion, for `grouser study multibody`.
namespace grouser::studies {

/// One component of the position, velocity or direction of a point of a body.
struct Probe {
  enum Kind { kPosition, kVelocity, kDirection };
  std::string body;
  base::Vec3d point_B; ///< point in the body's frame [m]; for kDirection: unit vector in this frame
  int component = 0;   ///< 0: x, 1: y, 2: z
  Kind kind = kPosition;
};
std::vector<double> readProbes(const coupling::Mechanism& mechanism, const std::vector<Probe>& probes);

/// A mechanism with a known motion.
struct StudyCase {
  std::string name;
  std::string scene; ///< file in runs/mechanisms/, or arguments for make_mechanisms.py
  std::string title;
  std::string source; ///< source of the reference solution
  double end = 1;     ///< simulated time [s]
  double sample = 1;  ///< interval between the compared times [s]
  int coarsest = 1;   ///< the longest step is sample / coarsest; each other step is a quarter of the previous one
  std::vector<Probe> probes;
  std::function<std::vector<double>(double t)> reference; ///< exact values of the probes at time t [s]
  bool isLong = false;                                    ///< takes minutes; runs only without --quick, or if named
};
std::vector<StudyCase> studyCases();

/// A reaction force with a closed-form solution.
struct ReactionCase {
  std::string name, scene, title;
  double end = 1, step = 1e-3; ///< [s]
  std::function<double(const coupling::Mechanism&)> measured;
  double exact = 0;
};
std::vector<ReactionCase> reactionCases();

/// Positions over time from a file in runs/mechanisms/reference/; `t` must be the time of a row.
std::function<std::vector<double>(double t)> referenceFile(const std::string& name);

} // namespace grouser::studies
