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

/// A soil's constants with intervals, from the tests that are there.
namespace grouser::virtual_tests {

/// Means over the runs of a kind of test.
struct TestCosts {
  std::string name;
  int tests = 0;
  double grains = 0, steps = 0, seconds = 0; ///< beds and plates together; shear tests tell seconds alone
  double porosity = 0, porosityHalfWidth = 0;
};

/// Of the small plate and the large one; not a number where it has not been measured.
using OfBreadths = std::array<support::Estimate, 2>;
inline constexpr support::Estimate kUnmeasured{std::numeric_limits<double>::quiet_NaN(),
                                               std::numeric_limits<double>::infinity()};
inline constexpr OfBreadths kUnmeasuredBoth{kUnmeasured, kUnmeasured};
inline constexpr std::array<TestKind, 2> kBreadths{TestKind::small, TestKind::large};

struct SoilResults {
  std::map<Quantity, support::Estimate> measured; ///< in unitOf(); none where tests are missing
  support::Estimate peakAngle, peakCohesion;      ///< of the curves' peaks [deg], [kPa]
  support::Estimate hump, misfit;                 ///< peak over residual strength; see ShearFit [-]
  double sheared = 0, leastSheared = 0;           ///< share of the plates' way, of all shear tests, of the worst [-]
  support::Estimate sinkage;                      ///< under the track, by Bekker's form with what was measured [mm]
  OfBreadths k = kUnmeasuredBoth;                 ///< with the n of both; of a plate alone with its own [kN/m^(n+2)]
  OfBreadths ownN = kUnmeasuredBoth;              ///< that each breadth alone would give [-]
  OfBreadths kAtGivenN = kUnmeasuredBoth;         ///< k with the n that is published
  OfBreadths goodness = kUnmeasuredBoth;          ///< Wong's [-]
  OfBreadths bedding = kUnmeasuredBoth;           ///< origin of the corrected curves below the mean surface [mm]
  OfBreadths lineBegins = kUnmeasuredBoth;        ///< of the greatest pressure: below it n is 1 by that correction [-]
  OfBreadths nFromContact = kUnmeasuredBoth;      ///< without it, sinkage counted from the first contact [-]
  OfBreadths unloading = kUnmeasuredBoth;         ///< k_u; interval over the tests [kN/m3]
  OfBreadths reloading = kUnmeasuredBoth;         ///< [kN/m3]
  OfBreadths unloadedFrom = kUnmeasuredBoth;      ///< [kPa]
  OfBreadths addedByMotion = kUnmeasuredBoth;     ///< share of that, gone when the plate is held [-]
  std::optional<double> givenN;                   ///< the n that is published
  std::map<Quantity, support::Estimate> atGivenN; ///< k_c and k_phi with that n
  std::optional<support::Estimate> wider;         ///< mean pressure of the wide bin over that of the other, less 1 [-]
  support::Estimate stability;                    ///< angle at which a tilted bed begins to flow [deg]
  int reposeTests = 0;
  std::array<int, 2> plates{}; ///< tests of each breadth
  int shearTests = 0;          ///< seeds under all loads
  std::vector<TestCosts> costs;
  bool hasPlates() const { return plates[0] > 0 && plates[1] > 0; }
  bool hasShear() const { return shearTests > 0; }
};

/// Runs of a kind that are there, by seed.
std::vector<jobs::Table> runsOf(const TestPlan& plan, const jobs::Pieces& pieces, TestKind kind);
/// Curves of the seeds that were sheared under all loads: [seed][load].
std::vector<std::vector<ShearCurve>> shearTests(const TestPlan& plan, const jobs::Pieces& pieces);
/// The loading part of a plate's run, corrected for bedding within a grain's diameter.
BeddedCurve beddedCurve(const TestPlan& plan, const jobs::Table& run);

SoilResults resultsOf(const TestPlan& plan, const jobs::Pieces& pieces);

/// The span that a measured value is held against: of two sources or more, or of one that gives its own, from the
/// least to the greatest; else the only value +- what a table of soils is good for: n 15 %, k_phi and k_c 40 %, phi 2
/// deg, c 1 kPa, K 30 %, repose 2 deg.
struct PublishedSpan {
  double low = 0, high = 0;
  bool isTolerance = false; ///< of one source, widened
};
std::optional<PublishedSpan> publishedSpan(const TestedSoil& soil, Quantity quantity);

/// What one source has of n, k_c and k_phi, where it has all three.
struct PublishedBekker {
  BekkerFit fit;
  std::string source;
};
std::vector<PublishedBekker> publishedBekker(const TestedSoil& soil);
/// k_c / b + k_phi of the first of them for a plate of one breadth, +- 40 %, [kN/m^(n+2)]: what the k of a plate alone
/// is held against, with the n of that source. None where that form is not positive.
std::optional<PublishedSpan> publishedModulus(const TestedSoil& soil, double breadth);
/// "inside": the whole interval; "inside, interval is wider"; "outside, interval reaches in"; "outside".
std::string verdictOf(const support::Estimate& measured, const PublishedSpan& span);

} // namespace grouser::virtual_tests
