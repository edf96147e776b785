// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/bevameter/plan.hpp"
#include "runs/bevameter/shear_strength.hpp"
#include "runs/studies/pieces.hpp"
#include "runs/support/line_fit.hpp"

#include <map>
#include <optional>

/// A soil's constants with intervals, from the tests that are there.
namespace grouser::bevameter {

/// Means over the runs of a kind of test.
struct TestCosts {
  std::string name;
  int tests = 0;
  double grains = 0, steps = 0, seconds = 0; ///< beds and plates together; shear tests tell seconds alone
  double porosity = 0, porosityHalfWidth = 0;
};

struct SoilResults {
  std::map<Quantity, support::Estimate> measured; ///< in unitOf(); none where tests are missing
  support::Estimate peakAngle, peakCohesion;      ///< of the curves' peaks [deg], [kPa]
  support::Estimate hump, misfit;                 ///< peak over residual strength; see ShearFit [-]
  double sheared = 0, leastSheared = 0;           ///< share of the plates' way, of all shear tests, of the worst [-]
  support::Estimate sinkage;                      ///< under the track, by Bekker's form with what was measured [mm]
  std::array<support::Estimate, 2> k, ownN;       ///< of each breadth [kN/m^(n+2)], [-]; of one alone k with its ownN
  std::array<support::Estimate, 2> kAtGivenN;     ///< the same k with the n that is published
  std::array<support::Estimate, 2> goodness;      ///< Wong's [-]
  std::array<support::Estimate, 2> bedding;       ///< origin of the corrected curves below the mean surface [mm]
  std::array<support::Estimate, 2> lineBegins;    ///< of the greatest pressure: below it n is 1 by that correction [-]
  std::array<support::Estimate, 2> nFromContact;  ///< without it, sinkage counted from the first contact [-]
  std::optional<double> givenN;                   ///< the n that is published
  std::map<Quantity, support::Estimate> atGivenN; ///< k_c and k_phi with that n
  std::array<support::Estimate, 2> unloading, reloading; ///< k_u [kN/m3]; interval over the tests
  std::array<support::Estimate, 2> unloadedFrom;         ///< [kPa]
  std::array<support::Estimate, 2> addedByMotion;        ///< share of that, gone when the plate is held [-]
  std::optional<support::Estimate> wider; ///< mean pressure of the wide bin over that of the other, less 1 [-]
  support::Estimate stability;            ///< angle at which a tilted bed begins to flow [deg]
  int reposeTests = 0;
  std::array<int, 2> plates{}; ///< tests of each breadth
  int shearTests = 0;          ///< seeds under all loads
  std::vector<TestCosts> costs;
  bool hasPlates() const { return plates[0] > 0 && plates[1] > 0; }
  bool hasShear() const { return shearTests > 0; }
};

/// Runs of a kind that are there, by seed.
std::vector<studies::Table> runsOf(const TestPlan& plan, const studies::Pieces& pieces, TestKind kind);
/// Curves of the seeds that were sheared under all loads: [seed][load].
std::vector<std::vector<ShearCurve>> shearTests(const TestPlan& plan, const studies::Pieces& pieces);
/// The loading part of a plate's run, corrected for bedding within a grain's diameter.
BeddedCurve beddedCurve(const TestPlan& plan, const studies::Table& run);

SoilResults resultsOf(const TestPlan& plan, const studies::Pieces& pieces);

/// The span that a measured value is held against: of two sources or more, or of one that gives its own, from the
/// least to the greatest; else the only value +- what a table of soils is good for: n 15 %, k_phi and k_c 40 %, phi 2
/// deg, c 1 kPa, K 30 %, repose 2 deg.
struct PublishedSpan {
  double low = 0, high = 0;
  bool isTolerance = false; ///< of one source, widened
};
std::optional<PublishedSpan> publishedSpan(const TestedSoil& soil, Quantity quantity);
/// "inside": the whole interval; "inside, interval is wider"; "outside, interval reaches in"; "outside".
std::string verdictOf(const support::Estimate& measured, const PublishedSpan& span);

} // namespace grouser::bevameter
