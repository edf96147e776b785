// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"
#include "runs/support/line_fit.hpp"
#include "terrain/grain_model.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

/// Error of one collision over run time: terrain::Grains against the closed forms of its contact laws.
namespace grouser::studies {

enum class ImpactLaw {
  linearFree,    ///< the dashpot may attract; the contact ends at zero overlap
  linearClamped, ///< never attractive; the contact ends at zero force
  hertzFree,
  hertzClamped
};

/// A collision with a closed form. Grain: radius 5 mm, 2600 kg/m3; linear 1e5 N/m, Hertz E_eff = 1 GPa.
struct ImpactCase {
  ImpactLaw law = ImpactLaw::linearFree;
  bool binary = false; ///< two grains head-on; else a grain on a plane
  double damping = 0;  ///< linear: zeta = gamma / (2 omega_0);  Hertz: beta [-]
  double speed = 1;    ///< approach speed [m/s]
  bool isLinear() const { return law == ImpactLaw::linearFree || law == ImpactLaw::linearClamped; }
  bool isClamped() const { return law == ImpactLaw::linearClamped || law == ImpactLaw::hertzClamped; }
  std::string name() const; ///< "plane, linear free, zeta 0.2"
};

enum ImpactQuantity { kRestitution, kDuration, kOverlap, kImpactQuantities };
const char* impactQuantityName(int quantity);

/// Exact results; empty without closed form or if the contact never ends.
struct ImpactReference {
  double contactTime = 0; ///< duration of the undamped collision [s], reference of steps per contact
  double stableStep = 0;  ///< longest stable step [s]; infinite for Hertz (zero initial stiffness)
  std::array<std::optional<double>, kImpactQuantities> value; ///< [-], [s], [m]
};
ImpactReference impactReference(const ImpactCase& c);

/// Order of the maximum error in the step.
int expectedOrder(const ImpactCase& c, int quantity);

/// Errors over the phase of first contact within a step: restitution absolute, duration and overlap relative.
struct ImpactError {
  double worst = 0, mean = 0; ///< maximum |error|, mean error
};

/// Numbers of phases per step size.
struct ImpactPhases {
  int touching = 20; ///< first contact (j + 1/2) / touching of a step after its start
  int leaving = 1;   ///< contact durations extended by k / leaving of a step, to vary the phase of separation
};

/// One step size.
struct ImpactPoint {
  double steps = 0;    ///< steps per contact: undamped contact time / step
  double timeStep = 0; ///< [s]
  bool stable = true;  ///< false: above the stable step, not measured
  std::array<ImpactError, kImpactQuantities> error;
  std::array<double, kImpactQuantities> measured{}; ///< mean over the phases [-], [s], [m]
  double microseconds = 0, least = 0;               ///< CPU time per collision, median and minimum; 0: not timed
};

/// Restitution: ratio of speeds. Duration: from zero overlap (linear interpolation within the step) to zero overlap
/// (free) or to zero force (clamped), extrapolated from the last accelerations by at most one step. Overlap: maximum at
/// the end of a step. All collisions run in one terrain::Grains.
ImpactPoint measureImpact(const ImpactCase& c, terrain::Precision precision, double stepsPerContact,
                          const ImpactPhases& phases);

/// Adds the CPU time of `collisions` simultaneous collisions, one thread, median and minimum of `repeats`.
void timeImpact(const ImpactCase& c, terrain::Precision precision, int collisions, int repeats, ImpactPoint& point);

struct ImpactSeries {
  ImpactCase study;
  terrain::Precision precision = terrain::Precision::single;
  std::vector<ImpactPoint> points; ///< by ascending steps per contact
};
const char* precisionName(terrain::Precision precision);

/// Order fitted over points with at least kFitFrom steps per contact and a maximum error above round-off.
support::LineFit measuredOrder(const ImpactSeries& series, int quantity);
inline constexpr double kFitFrom = 12, kRoundOffFloor = 5e-6;

/// The coarsest point from which on the error of `quantity` (kImpactQuantities: of all with a closed form) is below
/// `tolerance`; null if there is none.
const ImpactPoint* cheapestImpact(const ImpactSeries& series, int quantity, double tolerance);

/// `grouser study impact`.
struct ImpactCommand {
  jobs::StudyPlace place;
  ImpactPhases phases{20, 4};
  int collisions = 500; ///< simultaneous collisions in timings
  int repeats = 5;
};
void studyImpactCommand(const ImpactCommand& command);

} // namespace grouser::studies
