// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/results.hpp"

#include "runs/jobs/estimate.hpp"
#include "runs/virtual_tests/resampling.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::virtual_tests {

namespace {

using jobs::Table;
using support::Estimate;

constexpr double kCompareFrom = 0.25; // sinkage at the start of the comparison of two bins / their common sinkage

/// Curves of one plate for the fits, corrected for bedding.
PlateTests plateTests(const TestPlan& plan, const std::vector<jobs::Table>& runs, TestKind kind) {
  PlateTests tests{plan.breadth(kind), {}};
  for (const jobs::Table& run : runs) tests.curves.push_back(beddedCurve(plan, run).curve);
  return tests;
}

std::vector<double> firstOf(const std::vector<jobs::Table>& runs, const std::string& column) {
  std::vector<double> values;
  for (const jobs::Table& run : runs) values.push_back(run.rows.front()[run.column(column)]);
  return values;
}

double meanValue(const std::vector<double>& values) { return jobs::meanOf(values).mean; }

TestCosts costsOf(const std::string& name, const std::vector<jobs::Table>& runs) {
  TestCosts c;
  c.name = name, c.tests = static_cast<int>(runs.size());
  const bool isPlate = !runs.empty() && runs.front().names == kSinkageColumns;
  const Estimate porosity = jobs::interval95(firstOf(runs, "porosity [-]"));
  c.porosity = porosity.value, c.porosityHalfWidth = porosity.halfWidth;
  if (!isPlate) return c;
  c.grains = meanValue(firstOf(runs, "grains"));
  c.steps = meanValue(firstOf(runs, "bed's steps")) + meanValue(firstOf(runs, "plate's steps"));
  c.seconds = meanValue(firstOf(runs, "bed's wall time [s]")) + meanValue(firstOf(runs, "plate's wall time [s]"));
  return c;
}

void addBedding(SoilResults& r, const TestPlan& plan, std::size_t i, const std::vector<jobs::Table>& runs) {
  std::vector<double> origins, begins;
  PlateTests asMeasured{plan.breadth(kBreadths[i]), {}};
  for (const jobs::Table& run : runs) {
    const BeddedCurve bedded = beddedCurve(plan, run);
    origins.push_back(1e3 * bedded.origin), begins.push_back(bedded.begins);
    asMeasured.curves.push_back(fromFirstContact(loadingCurve(run)));
  }
  r.bedding[i] = jobs::interval95(origins), r.lineBegins[i] = jobs::interval95(begins);
  const auto statistic = [&](const TestCounts& counts) {
    return std::vector<double>{fitOnePlate(asMeasured, counts[0]).n};
  };
  r.nFromContact[i] = intervalsOfTests({static_cast<int>(runs.size())}, statistic).front();
}

void addUnloading(SoilResults& r, std::size_t i, const std::vector<jobs::Table>& runs) {
  std::vector<double> stiffness, reloading, from, added;
  for (const jobs::Table& run : runs) {
    const Unloading u = unloadingOf(run);
    if (std::isfinite(u.stiffness)) stiffness.push_back(1e-3 * u.stiffness);
    if (std::isfinite(u.reloading)) reloading.push_back(1e-3 * u.reloading);
    from.push_back(1e-3 * u.from), added.push_back(addedByMotion(run));
  }
  const auto over = [](const std::vector<double>& values) {
    return values.empty() ? kUnmeasured : jobs::interval95(values);
  };
  r.unloading[i] = over(stiffness), r.reloading[i] = over(reloading), r.unloadedFrom[i] = over(from);
  r.addedByMotion[i] = over(added);
}

/// Relative difference of the small plate's pressure between the bin of double width and the normal bin, over the
/// common sinkage.
std::optional<Estimate> widerBin(const PlateTests& small, const PlateTests& wide) {
  if (small.curves.size() < 2 || wide.curves.size() < 2) return {};
  double common = INFINITY;
  for (const PlateTests* tests : {&small, &wide})
    for (const SinkageCurve& curve : tests->curves) common = std::min(common, curve.sinkage.back());
  std::vector<double> a, b;
  for (const SinkageCurve& c : small.curves) a.push_back(meanPressureBetween(c, kCompareFrom * common, common));
  for (const SinkageCurve& c : wide.curves) b.push_back(meanPressureBetween(c, kCompareFrom * common, common));
  return jobs::relativeDifference(a, b);
}

void addPlates(SoilResults& r, const TestPlan& plan, const std::array<std::vector<jobs::Table>, 2>& runs) {
  const std::array<PlateTests, 2> plates{plateTests(plan, runs[0], TestKind::small),
                                         plateTests(plan, runs[1], TestKind::large)};
  const auto statistic = [&](const TestCounts& counts) {
    const BekkerFit f = fitBekker(plates, counts), given = fitBekker(plates, counts, r.givenN);
    return std::vector<double>{f.n,
                               1e-3 * f.kc,
                               1e-3 * f.kphi,
                               1e-3 * f.k[0],
                               1e-3 * f.k[1],
                               f.ownN[0],
                               f.ownN[1],
                               1e3 * f.sinkageAt(kTrackPressure, kTrackBreadth),
                               f.goodness[0],
                               f.goodness[1],
                               1e-3 * given.kc,
                               1e-3 * given.kphi,
                               1e-3 * given.k[0],
                               1e-3 * given.k[1]};
  };
  const std::vector<Estimate> e =
      intervalsOfTests({static_cast<int>(runs[0].size()), static_cast<int>(runs[1].size())}, statistic);
  r.measured[Quantity::exponent] = e[0], r.measured[Quantity::cohesionModulus] = e[1];
  r.measured[Quantity::frictionModulus] = e[2];
  r.k = {e[3], e[4]}, r.ownN = {e[5], e[6]}, r.sinkage = e[7], r.goodness = {e[8], e[9]};
  if (!r.givenN) return;
  r.atPublishedN = {{Quantity::cohesionModulus, e[10]}, {Quantity::frictionModulus, e[11]}};
  r.kAtPublishedN = {e[12], e[13]};
}

/// Adds the results of one breadth if the other breadth has no finished tests.
void addOneBreadth(SoilResults& r, const TestPlan& plan, std::size_t i, const std::vector<jobs::Table>& runs) {
  const PlateTests tests = plateTests(plan, runs, kBreadths[i]);
  const auto statistic = [&](const TestCounts& counts) {
    const BekkerFit f = fitOnePlate(tests, counts[0]);
    return std::vector<double>{1e-3 * f.k[0], f.ownN[0], f.goodness[0],
                               1e-3 * fitOnePlate(tests, counts[0], r.givenN).k[0]};
  };
  const std::vector<Estimate> e = intervalsOfTests({static_cast<int>(runs.size())}, statistic);
  r.k[i] = e[0], r.ownN[i] = e[1], r.goodness[i] = e[2];
  if (r.givenN) r.kAtPublishedN[i] = e[3];
}

void addShear(SoilResults& r, const std::vector<std::vector<ShearCurve>>& tests) {
  const auto statistic = [&](const TestCounts& counts) {
    const ShearFit f = fitShear(tests, counts[0]);
    return std::vector<double>{
        1e-3 * f.cohesion, f.angle, 1e3 * f.shearModulus, 1e-3 * f.peakCohesion, f.peakAngle, f.hump, f.misfit};
  };
  const std::vector<Estimate> e = intervalsOfTests({static_cast<int>(tests.size())}, statistic);
  r.measured[Quantity::cohesion] = e[0], r.measured[Quantity::frictionAngle] = e[1];
  r.measured[Quantity::shearModulus] = e[2];
  r.peakCohesion = e[3], r.peakAngle = e[4], r.hump = e[5], r.misfit = e[6];
}

/// Fraction of the plate displacement that sheared the soil instead of sliding along the teeth.
void addSlip(SoilResults& r, const std::vector<jobs::Table>& runs) {
  r.sheared = 0, r.minSheared = INFINITY;
  for (const jobs::Table& run : runs) {
    const double share = shearStrength(run).sheared;
    r.sheared += share / static_cast<double>(runs.size()), r.minSheared = std::min(r.minSheared, share);
  }
}

void addRepose(SoilResults& r, const TestPlan& plan, const std::vector<jobs::Table>& runs) {
  std::vector<double> starts, repose;
  for (const jobs::Table& run : runs) {
    const ReposeAngles a = reposeAngles(run, plan.repose);
    if (std::isfinite(a.starts)) starts.push_back(a.starts);
    if (std::isfinite(a.repose)) repose.push_back(a.repose);
  }
  r.reposeTests = static_cast<int>(repose.size());
  if (starts.empty() || repose.empty()) return; // no bed flowed and came to rest again
  r.stability = jobs::interval95(starts), r.measured[Quantity::repose] = jobs::interval95(repose);
}

/// Tolerance of a published constant; relative for some quantities, absolute for others.
double toleranceOf(Quantity quantity, double value) {
  switch (quantity) {
  case Quantity::exponent:
    return 0.15 * std::fabs(value);
  case Quantity::cohesionModulus:
  case Quantity::frictionModulus:
    return 0.40 * std::fabs(value);
  case Quantity::cohesion:
    return 1;
  case Quantity::shearModulus:
    return 0.30 * std::fabs(value);
  default:
    return 2;
  }
}

} // namespace

BeddedCurve beddedCurve(const TestPlan& plan, const jobs::Table& run) {
  return correctedForBedding(loadingCurve(run), plan.grains.grains.diameter());
}

std::vector<jobs::Table> runsOf(const TestPlan& plan, const jobs::Pieces& pieces, TestKind kind) {
  std::vector<jobs::Table> runs;
  for (const PlannedTest& test : plan.tests)
    if (test.kind == kind && pieces.has(test.name)) runs.push_back(pieces.read(test.name));
  return runs;
}

std::vector<std::vector<ShearCurve>> shearTests(const TestPlan& plan, const jobs::Pieces& pieces) {
  std::map<int, std::vector<ShearCurve>> bySeed;
  for (const PlannedTest& test : plan.tests)
    if (test.kind == TestKind::shear && pieces.has(test.name))
      bySeed[test.seed].push_back(shearCurve(pieces.read(test.name), plan.grains.grains.diameter()));
  std::vector<std::vector<ShearCurve>> tests;
  for (auto& [seed, curves] : bySeed)
    if (curves.size() == plan.options.loads.size()) tests.push_back(std::move(curves));
  return tests;
}

SoilResults resultsOf(const TestPlan& plan, const jobs::Pieces& pieces) {
  SoilResults r;
  const std::array<std::vector<jobs::Table>, 2> plates{runsOf(plan, pieces, TestKind::small),
                                                       runsOf(plan, pieces, TestKind::large)};
  for (std::size_t i = 0; i < 2; ++i) {
    r.plates[i] = static_cast<int>(plates[i].size());
    if (plates[i].empty()) continue;
    addUnloading(r, i, plates[i]);
    addBedding(r, plan, i, plates[i]);
    r.costs.push_back(costsOf(i == 0 ? "small" : "large", plates[i]));
  }
  for (const PublishedValue& p : plan.soil.published)
    if (p.quantity == Quantity::exponent && !r.givenN) r.givenN = p.value;
  if (const auto whole = publishedBekker(plan.soil); !whole.empty()) r.givenN = whole.front().fit.n; // first source
  if (r.hasPlates()) addPlates(r, plan, plates);
  for (std::size_t i = 0; i < 2 && !r.hasPlates(); ++i)
    if (r.plates[i] > 0) addOneBreadth(r, plan, i, plates[i]);
  if (const std::vector<jobs::Table> wide = runsOf(plan, pieces, TestKind::wide); !wide.empty()) {
    r.wider = widerBin(plateTests(plan, plates[0], TestKind::small), plateTests(plan, wide, TestKind::wide));
    r.costs.push_back(costsOf("wide", wide));
  }
  if (const auto tests = shearTests(plan, pieces); !tests.empty()) {
    r.shearTests = static_cast<int>(tests.size());
    addShear(r, tests);
  }
  if (const std::vector<jobs::Table> tilted = runsOf(plan, pieces, TestKind::repose); !tilted.empty()) {
    r.costs.push_back(costsOf("repose", tilted));
    addRepose(r, plan, tilted);
  }
  if (const std::vector<jobs::Table> sheared = runsOf(plan, pieces, TestKind::shear); !sheared.empty()) {
    r.costs.push_back(costsOf("shear", sheared));
    addSlip(r, sheared);
  }
  return r;
}

std::optional<PublishedSpan> publishedSpan(const TestedSoil& soil, Quantity quantity) {
  std::optional<PublishedSpan> span;
  int values = 0;
  bool hasSpan = false;
  for (const PublishedValue& p : soil.published) {
    if (p.quantity != quantity) continue;
    const double low = p.low.value_or(p.value), high = p.high.value_or(p.value);
    hasSpan = hasSpan || p.low || p.high;
    span = span ? PublishedSpan{std::min(span->low, low), std::max(span->high, high)} : PublishedSpan{low, high};
    ++values;
  }
  if (span && !hasSpan && (values < 2 || span->low == span->high)) {
    const double tolerance = toleranceOf(quantity, span->low);
    span = PublishedSpan{span->low - tolerance, span->high + tolerance, true};
  }
  return span;
}

std::vector<PublishedBekker> publishedBekker(const TestedSoil& soil) {
  std::vector<PublishedBekker> found;
  for (const PublishedValue& n : soil.published) {
    if (n.quantity != Quantity::exponent) continue;
    BekkerFit fit;
    fit.n = n.value;
    int parts = 0;
    for (const PublishedValue& p : soil.published) {
      if (p.source != n.source) continue;
      if (p.quantity == Quantity::cohesionModulus) fit.kc = 1e3 * p.value, ++parts;
      if (p.quantity == Quantity::frictionModulus) fit.kphi = 1e3 * p.value, ++parts;
    }
    if (parts == 2) found.push_back({fit, n.source});
  }
  return found;
}

std::optional<PublishedSpan> publishedModulus(const TestedSoil& soil, double breadth) {
  const std::vector<PublishedBekker> all = publishedBekker(soil);
  if (all.empty() || !(all.front().fit.kAt(breadth) > 0)) return {};
  const double k = 1e-3 * all.front().fit.kAt(breadth), tolerance = toleranceOf(Quantity::frictionModulus, k);
  return PublishedSpan{k - tolerance, k + tolerance, true};
}

std::string verdictOf(const support::Estimate& measured, const PublishedSpan& span) {
  const double low = measured.value - measured.halfWidth, high = measured.value + measured.halfWidth;
  if (!std::isfinite(measured.value)) return "-";
  if (measured.value >= span.low && measured.value <= span.high)
    return low >= span.low && high <= span.high ? "inside" : "inside, interval is wider";
  return high >= span.low && low <= span.high ? "outside, interval reaches in" : "outside";
}

} // namespace grouser::virtual_tests
