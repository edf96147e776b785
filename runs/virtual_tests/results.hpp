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

/// Soil constants with 95 % intervals, from the finished tests.
namespace grouser::virtual_tests {

/// Means over the runs of a kind of test.
struct TestCosts {
  std::string name;
  int tests = 0;
  double grains = 0, steps = 0, seconds = 0; ///< plate tests, including the preparation of the bed; 0 for other tests
  double porosity = 0, porosityHalfWidth = 0;
};

/// Values of the small and the large plate; NaN if a plate was not measured.
using OfBreadths = std::array<support::Estimate, 2>;
inline constexpr support::Estimate kUnmeasured{std::numeric_limits<double>::quiet_NaN(),
                                               std::numeric_limits<double>::infinity()};
inline constexpr OfBreadths kUnmeasuredBoth{kUnmeasured, kUnmeasured};
inline constexpr std::array<TestKind, 2> kBreadths{TestKind::small, TestKind::large};

struct SoilResults {
  std::map<Quantity, support::Estimate> measured; ///< in unitOf(); absent if tests are missing
  support::Estimate peakAngle, peakCohesion;      ///< strength at the peaks of the curves [deg], [kPa]
  support::Estimate hump, misfit;                 ///< peak / residual strength, and misfit: see ShearFit [-]
  double sheared = 0, minSheared = 0; ///< sheared fraction of the plate displacement: mean, minimum of tests [-]
  support::Estimate sinkage;          ///< under the track, by Bekker's equation with the measured constants [mm]
  OfBreadths k = kUnmeasuredBoth;     ///< k with the common n; for a single plate, with its own n [kN/m^(n+2)]
  OfBreadths ownN = kUnmeasuredBoth;  ///< n fitted to each breadth separately [-]
  OfBreadths kAtPublishedN = kUnmeasuredBoth; ///< k with the published n
  OfBreadths goodness = kUnmeasuredBoth;      ///< Wong's goodness of fit [-]
  OfBreadths bedding = kUnmeasuredBoth;       ///< depth of the corrected curves' origin below the mean surface [mm]
  OfBreadths lineBegins = kUnmeasuredBoth; ///< pressure at the start of the line / greatest pressure: n is 1 below [-]
  OfBreadths nFromContact = kUnmeasuredBoth;          ///< n without bedding correction, sinkage from first contact [-]
  OfBreadths unloading = kUnmeasuredBoth;             ///< k_u with its interval over the tests [kN/m3]
  OfBreadths reloading = kUnmeasuredBoth;             ///< reloading stiffness [kN/m3]
  OfBreadths unloadedFrom = kUnmeasuredBoth;          ///< pressure at which unloading starts [kPa]
  OfBreadths addedByMotion = kUnmeasuredBoth;         ///< relative loss of pressure during the hold [-]
  std::optional<double> givenN;                       ///< published n
  std::map<Quantity, support::Estimate> atPublishedN; ///< k_c and k_phi with the published n
  std::optional<support::Estimate> wider;             ///< mean pressure in the wide bin / in the normal bin - 1 [-]
  support::Estimate stability;                        ///< tilt at which flow starts [deg]
  int reposeTests = 0;
  std::array<int, 2> plates{}; ///< tests of each breadth
  int shearTests = 0;          ///< number of seeds that were sheared under all loads
  std::vector<TestCosts> costs;
  bool hasPlates() const { return plates[0] > 0 && plates[1] > 0; }
  bool hasShear() const { return shearTests > 0; }
};

/// Finished runs of one kind, in the order of their seeds.
std::vector<jobs::Table> runsOf(const TestPlan& plan, const jobs::Pieces& pieces, TestKind kind);
/// Curves of the seeds that were sheared under all loads: [seed][load].
std::vector<std::vector<ShearCurve>> shearTests(const TestPlan& plan, const jobs::Pieces& pieces);
/// Loading phase of a plate's run, corrected for bedding with a room of one grain diameter.
BeddedCurve beddedCurve(const TestPlan& plan, const jobs::Table& run);

SoilResults resultsOf(const TestPlan& plan, const jobs::Pieces& pieces);

/// Span for comparison with a measured value: from the smallest to the greatest value of two or more sources, or the
/// span that a source states. Otherwise the span is the single published value +- a tolerance: 15 % for n, 40 % for
/// k_phi and k_c, 2 deg for phi, 1 kPa for c, 30 % for K, 2 deg for repose.
struct PublishedSpan {
  double low = 0, high = 0;
  bool isTolerance = false; ///< single value, widened by the tolerance
};
std::optional<PublishedSpan> publishedSpan(const TestedSoil& soil, Quantity quantity);

/// n, k_c and k_phi from a source that states all three.
struct PublishedBekker {
  BekkerFit fit;
  std::string source;
};
std::vector<PublishedBekker> publishedBekker(const TestedSoil& soil);
/// k_c / b + k_phi of the first published source for `breadth`, +- 40 % [kN/m^(n+2)]; for comparison with the k of a
/// plate at the n of the same source. Empty if the value is not positive.
std::optional<PublishedSpan> publishedModulus(const TestedSoil& soil, double breadth);
/// "inside" if the value and its whole interval are inside `span`; "inside, interval is wider" if only the value is;
/// "outside, interval reaches in" if only part of the interval is; else "outside".
std::string verdictOf(const support::Estimate& measured, const PublishedSpan& span);

} // namespace grouser::virtual_tests
