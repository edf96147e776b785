// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/pieces.hpp"
#include "runs/support/line_fit.hpp"
#include "runs/virtual_tests/plan.hpp"
#include "runs/virtual_tests/shear_strength.hpp"

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// Soil constants with intervals, from the finished tests.
namespace grouser::virtual_tests {

/// Means over the runs of a kind of test.
struct TestCosts {
  std::string name;
  int tests = 0;
  double grains = 0, steps = 0, seconds = 0; ///< beds and plates together; 0 for shear tests
  double porosity = 0, porosityHalfWidth = 0;
};

/// Values of the small and the large plate; NaN if not measured.
using OfBreadths = std::array<support::Estimate, 2>;
inline constexpr support::Estimate kUnmeasured{std::numeric_limits<double>::quiet_NaN(),
                                               std::numeric_limits<double>::infinity()};
inline constexpr OfBreadths kUnmeasuredBoth{kUnmeasured, kUnmeasured};
inline constexpr std::array<TestKind, 2> kBreadths{TestKind::small, TestKind::large};

struct SoilResults {
  std::map<Quantity, support::Estimate> measured; ///< in unitOf(); absent if tests are missing
  support::Estimate peakAngle, peakCohesion;      ///< strength at the curves' peaks [deg], [kPa]
  support::Estimate hump, misfit;                 ///< peak over residual strength; see ShearFit [-]
  double sheared = 0, leastSheared = 0;    ///< sheared share of the plate displacement: mean, minimum of all tests [-]
  support::Estimate sinkage;               ///< below the track, by Bekker's equation with the measured constants [mm]
  OfBreadths k = kUnmeasuredBoth;          ///< k with the common n; single plate: with its own n [kN/m^(n+2)]
  OfBreadths ownN = kUnmeasuredBoth;       ///< n of each breadth alone [-]
  OfBreadths kAtGivenN = kUnmeasuredBoth;  ///< k with the published n
  OfBreadths goodness = kUnmeasuredBoth;   ///< Wong's goodness of fit [-]
  OfBreadths bedding = kUnmeasuredBoth;    ///< origin of the corrected curves below the mean surface [mm]
  OfBreadths lineBegins = kUnmeasuredBoth; ///< start of the line over the greatest pressure: below it n is 1 [-]
  OfBreadths nFromContact = kUnmeasuredBoth;      ///< without correction, sinkage from first contact [-]
  OfBreadths unloading = kUnmeasuredBoth;         ///< k_u; interval over the tests [kN/m3]
  OfBreadths reloading = kUnmeasuredBoth;         ///< [kN/m3]
  OfBreadths unloadedFrom = kUnmeasuredBoth;      ///< [kPa]
  OfBreadths addedByMotion = kUnmeasuredBoth;     ///< relative loss of pressure during the hold [-]
  std::optional<double> givenN;                   ///< published n
  std::map<Quantity, support::Estimate> atGivenN; ///< k_c and k_phi with that n
  std::optional<support::Estimate> wider;         ///< mean pressure of the wide bin over that of the other, less 1 [-]
  support::Estimate stability;                    ///< tilt at which flow starts [deg]
  int reposeTests = 0;
  std::array<int, 2> plates{}; ///< tests of each breadth
  int shearTests = 0;          ///< seeds under all loads
  std::vector<TestCosts> costs;
  bool hasPlates() const { return plates[0] > 0 && plates[1] > 0; }
  bool hasShear() const { return shearTests > 0; }
};

/// Finished runs of a kind, by seed.
std::vector<jobs::Table> runsOf(const TestPlan& plan, const jobs::Pieces& pieces, TestKind kind);
/// Curves of the seeds that were sheared under all loads: [seed][load].
std::vector<std::vector<ShearCurve>> shearTests(const TestPlan& plan, const jobs::Pieces& pieces);
/// Loading part of a plate's run, corrected for bedding within a grain diameter.
BeddedCurve beddedCurve(const TestPlan& plan, const jobs::Table& run);

SoilResults resultsOf(const TestPlan& plan, const jobs::Pieces& pieces);

/// Span for comparison with a measured value: from the least to the greatest of two or more sources, or of one with its
/// own span; else the single value +- n 15 %, k_phi and k_c 40 %, phi 2 deg, c 1 kPa, K 30 %, repose 2 deg.
struct PublishedSpan {
  double low = 0, high = 0;
  bool isTolerance = false; ///< one source, widened
};
std::optional<PublishedSpan> publishedSpan(const TestedSoil& soil, Quantity quantity);

/// n, k_c and k_phi of a source that has all three.
struct PublishedBekker {
  BekkerFit fit;
  std::string source;
};
std::vector<PublishedBekker> publishedBekker(const TestedSoil& soil);
/// k_c / b + k_phi of the first published source for a breadth, +- 40 % [kN/m^(n+2)], to compare with the k of a single
/// plate at the n of that source. Empty if not positive.
std::optional<PublishedSpan> publishedModulus(const TestedSoil& soil, double breadth);
/// "inside": the whole interval; "inside, interval is wider"; "outside, interval reaches in"; "outside".
std::string verdictOf(const support::Estimate& measured, const PublishedSpan& span);

} // namespace grouser::virtual_tests
