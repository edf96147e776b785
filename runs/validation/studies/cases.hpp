// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/mechanism.hpp"

#include <functional>
#include <string>
#include <vector>

/// Mechanisms with known motion: the references of `grouser study multibody`.
namespace grouser::studies {

/// One component of position or velocity of a point of a body.
struct Probe {
  enum Kind { kPosition, kVelocity, kDirection };
  std::string body;
  base::Vec3d point_B; ///< point in the body's frame [m]; kDirection: unit vector
  int component = 0;   ///< x, y, z
  Kind kind = kPosition;
};
std::vector<double> readProbes(const coupling::Mechanism& mechanism, const std::vector<Probe>& probes);

/// A mechanism with its known motion.
struct StudyCase {
  std::string name;
  std::string scene; ///< file in runs/mechanisms/, or words for make_mechanisms.py
  std::string title;
  std::string source; ///< source of the reference
  double end = 1;     ///< simulated time [s]
  double sample = 1;  ///< interval between compared times [s]
  int coarsest = 1;   ///< longest step: sample / coarsest; then a quarter of the previous one each
  std::vector<Probe> probes;
  std::function<std::vector<double>(double t)> reference; ///< the probes' values at time t
  bool isLong = false;                                    ///< takes minutes: only in the full study or if named
};
std::vector<StudyCase> studyCases();

/// A reaction with a closed form.
struct ReactionCase {
  std::string name, scene, title;
  double end = 1, step = 1e-3; ///< [s]
  std::function<double(const coupling::Mechanism&)> measured;
  double exact = 0;
};
std::vector<ReactionCase> reactionCases();

/// Positions over time from runs/mechanisms/reference/; t must be the time of a row.
std::function<std::vector<double>(double t)> referenceFile(const std::string& name);

} // namespace grouser::studies
