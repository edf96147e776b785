// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"
#include "runs/support/line_fit.hpp"
#include "terrain/grain_model.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

/// Error of one collision over run time: compares terrain::Grains with the closed-form solutions of its contact laws.
namespace grouser::studies {

enum class ImpactLaw {
  linearFree,    ///< the force may be attractive; the contact ends at zero overlap
  linearClamped, ///< the force is never attractive; the contact ends at zero force
  hertzFree,
  hertzClamped
};

/// A collision with a closed-form solution. Grain: radius 5 mm, 2600 kg/m3; linear 1e5 N/m, Hertz E_eff = 1 GPa.
struct ImpactCase {
  ImpactLaw law = ImpactLaw::linearFree;
  bool binary = false; ///< head-on collision of two grains; else a grain hits a plane
  double damping = 0;  ///< linear: zeta = gamma / (2 omega_0);  Hertz: beta [-]
  double speed = 1;    ///< approach speed [m/s]
  bool isLinear() const { return law == ImpactLaw::linearFree || law == ImpactLaw::linearClamped; }
  bool isClamped() const { return law == ImpactLaw::linearClamped || law == ImpactLaw::hertzClamped; }
  std::string name() const; ///< "plane, linear free, zeta 0.2"
};

enum ImpactQuantity { kRestitution, kDuration, kOverlap, kImpactQuantities };
const char* impactQuantityName(int quantity);

/// Exact results; empty if there is no closed form or the contact never ends.
struct ImpactReference {
  double contactTime = 0; ///< duration of the undamped collision [s]; `steps per contact` refers to it
  double stableStep = 0;  ///< longest stable step [s]; infinite for Hertz contacts (zero initial stiffness)
  std::array<std::optional<double>, kImpactQuantities> value; ///< [-], [s], [m]
};
ImpactReference impactReference(const ImpactCase& c);

/// Expected order of the maximum error in the step size.
int expectedOrder(const ImpactCase& c, int quantity);

/// Errors over all phases of the first contact within a step: absolute error of the restitution, relative error of
/// duration and overlap.
struct ImpactError {
  double worst = 0, mean = 0; ///< maximum |error|, mean error
};

/// Numbers of collisions with different phases at each step size.
struct ImpactPhases {
  int touching = 20; ///< the first contacts occur (j + 1/2) / touching of a step after the start of a step
  int leaving = 1;   ///< the contact durations increase by k / leaving of a step, to vary the phase of separation
};

/// Results at one step size.
struct ImpactPoint {
  double steps = 0;    ///< steps per contact: undamped contact time / step
  double timeStep = 0; ///< [s]
  bool stable = true;  ///< false: the step exceeds the stable step and was not measured
  std::array<ImpactError, kImpactQuantities> error;
  std::array<double, kImpactQuantities> measured{}; ///< means over the phases [-], [s], [m]
  double microseconds = 0, least = 0;               ///< CPU time per collision [us], median and minimum; 0: not timed
};

/// Restitution: ratio of speeds. Duration: from zero overlap (by linear interpolation within the step) to zero overlap
/// (free law) or to zero force (clamped law; extrapolated from the last accelerations by at most one step). Overlap:
/// maximum over the ends of the steps. All collisions run in one terrain::Grains.
ImpactPoint measureImpact(const ImpactCase& c, terrain::Precision precision, double stepsPerContact,
                          const ImpactPhases& phases);

/// Adds the CPU time of `collisions` simultaneous collisions in one thread: median and minimum of `repeats` runs.
void timeImpact(const ImpactCase& c, terrain::Precision precision, int collisions, int repeats, ImpactPoint& point);

struct ImpactSeries {
  ImpactCase study;
  terrain::Precision precision = terrain::Precision::single;
  std::vector<ImpactPoint> points; ///< sorted by ascending steps per contact
};
const char* precisionName(terrain::Precision precision);

/// Order fitted over the points with at least kFitFrom steps per contact and a maximum error above kRoundOffFloor.
support::LineFit measuredOrder(const ImpactSeries& series, int quantity);
inline constexpr double kFitFrom = 12, kRoundOffFloor = 5e-6;

/// The coarsest point at which, and at all finer points, the error of `quantity` is below `tolerance`; null if there is
/// none. `quantity` = kImpactQuantities: the errors of all quantities with a closed form.
const ImpactPoint* cheapestImpact(const ImpactSeries& series, int quantity, double tolerance);

/// `grouser study impact`.
struct ImpactCommand {
  jobs::StudyPlace place;
  ImpactPhases phases{20, 4};
  int collisions = 500; ///< number of simultaneous collisions in timings
  int repeats = 5;
};
void studyImpactCommand(const ImpactCommand& command);

} // namespace grouser::studies
