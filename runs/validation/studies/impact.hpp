// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"
#include "runs/support/line_fit.hpp"
#include "terrain/grain_model.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

/// Error of one collision against run time: the step of terrain::Grains against the closed forms of its contact laws.
namespace grouser::studies {

enum class ImpactLaw {
  linearFree,    ///< the dashpot may pull; the contact ends at overlap zero
  linearClamped, ///< never attractive; the contact ends when its force does
  hertzFree,
  hertzClamped
};

/// A collision whose outcome is known. The grain: radius 5 mm, 2600 kg/m3; linear 1e5 N/m, Hertz E_eff = 1 GPa.
struct ImpactCase {
  ImpactLaw law = ImpactLaw::linearFree;
  bool binary = false; ///< two grains head on; else one on a plane
  double damping = 0;  ///< linear: zeta = gamma / (2 omega_0);  Hertz: beta [-]
  double speed = 1;    ///< of approach [m/s]
  bool isLinear() const { return law == ImpactLaw::linearFree || law == ImpactLaw::linearClamped; }
  bool isClamped() const { return law == ImpactLaw::linearClamped || law == ImpactLaw::hertzClamped; }
  std::string name() const; ///< "plane, linear free, zeta 0.2"
};

enum ImpactQuantity { kRestitution, kDuration, kOverlap, kImpactQuantities };
const char* impactQuantityName(int quantity);

/// What the collision does exactly; empty where it has no closed form, or never ends.
struct ImpactReference {
  double contactTime = 0; ///< of the undamped collision [s]: steps a contact are counted in it
  double stableStep = 0;  ///< longest stable step [s]; infinite for Hertz, whose stiffness begins at zero
  std::array<std::optional<double>, kImpactQuantities> value; ///< [-], [s], [m]
};
ImpactReference impactReference(const ImpactCase& c);

/// Order in which the worst error falls with the step.
int expectedOrder(const ImpactCase& c, int quantity);

/// Errors over the phase of first touch within a step: of the restitution absolute, of duration and overlap relative.
struct ImpactError {
  double worst = 0, mean = 0; ///< largest |error|; mean of the signed error
};

/// Collisions that one step size is tried on.
struct ImpactPhases {
  int touching = 20; ///< first touch (j + 1/2) / touching of a step after its start
  int leaving = 1;   ///< contacts made longer by k / leaving of a step, so that they end anywhere in theirs
};

/// One step size.
struct ImpactPoint {
  double steps = 0;    ///< a contact: undamped contact time / step
  double timeStep = 0; ///< [s]
  bool stable = true;  ///< false: beyond the stable step, nothing measured
  std::array<ImpactError, kImpactQuantities> error;
  std::array<double, kImpactQuantities> measured{}; ///< mean over the phases [-], [s], [m]
  double microseconds = 0, least = 0;               ///< CPU time of one collision, median and least; 0: not timed
};

/// Restitution: speeds before and after. Duration: from the moment where the straight path of the step crosses first
/// touch, to that where it crosses overlap zero (free), or to the zero of the force that the last accelerations of the
/// grain point to, at most one step after the last (clamped). Overlap: the greatest at the end of a step.
/// Collisions run side by side in one terrain::Grains.
ImpactPoint measureImpact(const ImpactCase& c, terrain::Precision precision, double stepsPerContact,
                          const ImpactPhases& phases);

/// Adds the CPU time: `collisions` at once from first touch to the end, one thread, median and least of `repeats`.
void timeImpact(const ImpactCase& c, terrain::Precision precision, int collisions, int repeats, ImpactPoint& point);

struct ImpactSeries {
  ImpactCase study;
  terrain::Precision precision = terrain::Precision::single;
  std::vector<ImpactPoint> points; ///< steps a contact ascending
};
const char* precisionName(terrain::Precision precision);

/// Order measured over the points from kFitFrom steps a contact on whose worst error is above the round-off floor.
support::LineFit measuredOrder(const ImpactSeries& series, int quantity);
inline constexpr double kFitFrom = 12, kRoundOffFloor = 5e-6;

/// The coarsest point that keeps the error of `quantity` (or of all that are known: kImpactQuantities) below
/// `tolerance`, and so do all finer ones; null where there is none.
const ImpactPoint* cheapestImpact(const ImpactSeries& series, int quantity, double tolerance);

/// `grouser study impact`.
struct ImpactCommand {
  jobs::StudyPlace place;
  ImpactPhases phases{20, 4};
  int collisions = 500; ///< at once where time is taken
  int repeats = 5;
};
void studyImpactCommand(const ImpactCommand& command);

} // namespace grouser::studies
