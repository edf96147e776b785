// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/soil_report.hpp"

#include "base/counted.hpp"
#include "runs/jobs/estimate.hpp"
#include "runs/output/plots.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/csv_cell.hpp"
#include "runs/support/print_stderr.hpp"
#include "runs/support/text_file.hpp"
#include "runs/virtual_tests/constant_doubts.hpp"
#include "terrain/packing_limits.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

namespace grouser::virtual_tests {

namespace {

using support::Estimate;

std::string spanText(const PublishedSpan& span) {
  return fmt::format("{:.4g} to {:.4g}{}", span.low, span.high,
                     span.isTolerance ? " (single source, range widened)" : "");
}

/// JSON number; null if not finite.
nlohmann::ordered_json number(double x) {
  return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json publishedJson(const TestedSoil& soil, Quantity quantity) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const PublishedValue& p : soil.published) {
    if (p.quantity != quantity) continue;
    nlohmann::ordered_json one{{"value", p.value}, {"source", p.source}};
    if (p.low) one["low"] = *p.low;
    if (p.high) one["high"] = *p.high;
    all.push_back(one);
  }
  return all;
}

/// k of plate `i` with the published n, and the published span of k for the breadth of this plate.
std::string atGivenNText(const TestPlan& plan, const SoilResults& r, std::size_t i) {
  if (!r.givenN) return {};
  const std::optional<PublishedSpan> span = publishedModulus(plan.soil, plan.breadth(kBreadths[i]));
  return fmt::format("k {} with n = {:g}{}; ", jobs::valueText(r.kAtPublishedN[i]), *r.givenN,
                     span ? fmt::format(" ({}: {})", spanText(*span), verdictOf(r.kAtPublishedN[i], *span)) : "");
}

std::string row(const std::string& name, const Estimate& e, const std::string& unit, const std::string& rest) {
  return fmt::format("  {:<8} {:>20} {:<11} {}\n", name, jobs::valueText(e), unit, rest);
}

bool isPlate(TestKind kind) { return kind == TestKind::small || kind == TestKind::large || kind == TestKind::wide; }

/// Fraction of the displacement that shears the soil. If the soil slides along the teeth instead, the test measures the
/// friction of the teeth.
std::string slipText(const SoilResults& r) {
  constexpr double kSlides = 0.7;
  return fmt::format("  shear within the soil: {:.0f} % of the plate displacement (lowest test: {:.0f} %){}\n",
                     100 * r.sheared, 100 * r.minSheared,
                     r.minSheared < kSlides ? "; if the soil slides along the teeth, c and phi describe this sliding, "
                                              "not the soil: use larger grains or less cohesion"
                                            : "");
}

/// A large decrease of the pressure during the hold means that inertia contributed to it.
std::string motionText(const Estimate& added) {
  constexpr double kMuch = 0.1;
  return fmt::format("pressure decrease at constant sinkage: {} %{}\n",
                     jobs::valueText({100 * added.value, 100 * added.halfWidth}),
                     added.value > kMuch ? ": the plate motion increases the pressure; reduce --plate-waves" : "");
}

/// Warning about beds and samples that are looser than random packings of spheres; empty if there are none.
std::string looseText(const TestPlan& plan, const SoilResults& r) {
  const auto has = [&](const char* key) { return numberOf(plan.soil, key, 0) > 0; };
  const bool coheres = has("cohesion") || has("surface_energy") || has("adhesion_stiffness");
  const double loosest = terrain::loosestPacking(has("rolling_friction"), coheres);
  std::string text;
  for (const TestCosts& c : r.costs)
    if (c.porosity > loosest) text += fmt::format("{}{} {:.2f}", text.empty() ? "" : ", ", c.name, c.porosity);
  return text.empty() ? text
                      : fmt::format("porosity of {} exceeds {:.2f}, the porosity of the loosest random packing of such "
                                    "grains: these beds are too thin or have not settled; use deeper beds",
                                    text, loosest);
}

std::string pad() { return std::string(43, ' '); }

} // namespace

nlohmann::ordered_json estimateJson(const Estimate& e, const std::string& unit) {
  return {{"value", number(e.value)}, {"half_width", number(e.halfWidth)}, {"unit", unit}};
}

std::string constantsTable(const TestPlan& plan, const SoilResults& r) {
  const std::map<Quantity, std::string> doubts = doubtsOf(r);
  std::string text =
      fmt::format("\n{}soil {} (+-: half width of the 95 % interval)\n  {:<8} {:>20} {:<11} {}\n",
                  plan.options.coarse ? "coarse: " : "", plan.soil.name, "", "measured", "", "published");
  for (const Quantity q : kQuantities) {
    const auto measured = r.measured.find(q);
    if (measured == r.measured.end()) continue;
    const std::optional<PublishedSpan> span = publishedSpan(plan.soil, q);
    const auto given = r.atPublishedN.find(q);
    const bool isAtPublishedN = given != r.atPublishedN.end();
    if (isAtPublishedN) text += row(symbolOf(q), measured->second, unitOf(q), "with the n above");
    const Estimate& compared = isAtPublishedN ? given->second : measured->second;
    text += row(isAtPublishedN ? fmt::format("  n={:g}", *r.givenN) : symbolOf(q), compared, unitOf(q),
                (span ? spanText(*span) + ": " + verdictOf(compared, *span) : "-") +
                    (doubts.contains(q) ? "; inconclusive" : ""));
    for (const PublishedValue& p : plan.soil.published)
      if (p.quantity == q) text += pad() + fmt::format("{:g}  {}\n", p.value, p.source);
  }
  if (r.hasPlates()) {
    text += row(
        "z", r.sinkage, "mm",
        fmt::format("sinkage from Bekker's equation at {:g} kPa, width {:g} m", 1e-3 * kTrackPressure, kTrackBreadth));
    for (const PublishedBekker& p : publishedBekker(plan.soil))
      text += pad() + fmt::format("{:.3g}  {}\n", 1e3 * p.fit.sinkageAt(kTrackPressure, kTrackBreadth), p.source);
  }
  return text;
}

std::string detailsTable(const TestPlan& plan, const SoilResults& r) {
  std::string text;
  const double d = plan.grains.grains.diameter();
  text +=
      fmt::format("\n{}grain diameter {:g} mm; plate widths {:g} and {:g} grain diameters\n",
                  plan.options.coarse ? "coarse: " : "", 1e3 * d, plan.small.strip.breadth, plan.large.strip.breadth);
  for (std::size_t i = 0; i < 2; ++i) {
    if (r.plates[i] == 0) continue;
    const double b = plan.breadth(kBreadths[i]);
    text += fmt::format("  plate {:.3g} m, {}: ", b, base::counted(r.plates[i], "seed"));
    text += fmt::format("k {} kN/m^(n+2), n of this plate {}, goodness of fit {}; ", jobs::valueText(r.k[i]),
                        jobs::valueText(r.ownN[i]), jobs::valueText(r.goodness[i]));
    text += atGivenNText(plan, r, i);
    text += fmt::format("origin {} mm below the mean surface, steepest straight line starts at {:.0f} % of the maximum "
                        "pressure; n from first contact {}; ",
                        jobs::valueText(r.bedding[i]), 100 * r.lineBegins[i].value, jobs::valueText(r.nFromContact[i]));
    text += fmt::format("k_u {} kN/m3 for unloading from {} kPa, {} for reloading; ", jobs::valueText(r.unloading[i]),
                        jobs::valueText(r.unloadedFrom[i]), jobs::valueText(r.reloading[i])) +
            motionText(r.addedByMotion[i]);
  }
  if (r.wider)
    text += fmt::format("  bed of double width: pressure {:+.1f} +- {:.1f} %; within 5 %: {}\n", 100 * r.wider->value,
                        100 * r.wider->halfWidth, jobs::verdictText(jobs::judge(*r.wider, 0.05)));
  if (r.hasShear())
    text += fmt::format("  shear, {}, layer {:.3g} m thick: peak phi {} deg, peak c {} kPa; peak / residual strength "
                        "{}; misfit of 1 - exp(-j/K) {}\n",
                        base::counted(r.shearTests, "seed"), plan.cell.depth * d, jobs::valueText(r.peakAngle),
                        jobs::valueText(r.peakCohesion), jobs::valueText(r.hump), jobs::valueText(r.misfit)) +
            slipText(r);
  if (r.reposeTests > 0)
    text += fmt::format("  angle of repose, {}: flow starts at a tilt of {} deg\n",
                        base::counted(r.reposeTests, "seed"), jobs::valueText(r.stability));
  for (const TestCosts& c : r.costs) {
    text += fmt::format("  {:<6} {:>9}, porosity {}", c.name, base::counted(c.tests, "test"),
                        jobs::plusMinus({c.porosity, c.porosityHalfWidth}, 4));
    text += c.grains > 0 ? fmt::format(", {:.0f} grains, {:.0f} steps, {:.0f} s each\n", c.grains, c.steps, c.seconds)
                         : std::string("\n");
  }
  return text;
}

std::string constantsCsv(const TestPlan& plan, const SoilResults& r) {
  const std::map<Quantity, std::string> doubts = doubtsOf(r);
  std::string text = "care,quantity,measured,half width,unit,published low,published high,verdict,inconclusive\n";
  for (const auto& [q, e] : r.measured) {
    const std::optional<PublishedSpan> span = publishedSpan(plan.soil, q);
    const std::string doubt = doubts.contains(q) ? doubts.at(q) : "";
    text += fmt::format("{},{},{:.6g},{:.4g},{},", plan.care(), symbolOf(q), e.value, e.halfWidth, unitOf(q));
    if (const auto given = r.atPublishedN.find(q); given != r.atPublishedN.end()) {
      text += fmt::format(",,with the n above,{}\n", support::csvCell(doubt));
      text += fmt::format("{},{} at n {:g},{:.6g},{:.4g},{},", plan.care(), symbolOf(q), *r.givenN, given->second.value,
                          given->second.halfWidth, unitOf(q));
      text += (span ? fmt::format("{:.6g},{:.6g},{},", span->low, span->high,
                                  support::csvCell(verdictOf(given->second, *span)))
                    : std::string(",,,")) +
              support::csvCell(doubtOf(q, given->second)) + "\n";
      continue;
    }
    text += (span ? fmt::format("{:.6g},{:.6g},{},", span->low, span->high, support::csvCell(verdictOf(e, *span)))
                  : std::string(",,,")) +
            support::csvCell(doubt) + "\n";
  }
  return text;
}

std::string platesCsv(const TestPlan& plan, const jobs::Pieces& pieces) {
  std::string text = "care,plate,breadth [m],seed,phase,sinkage [m],pressure [Pa],origin [m]\n";
  for (const PlannedTest& test : plan.tests) {
    if (!isPlate(test.kind) || !pieces.has(test.name)) continue;
    const char* plate = test.kind == TestKind::small ? "small" : test.kind == TestKind::large ? "large" : "wide";
    const jobs::Table run = pieces.read(test.name);
    const double origin = beddedCurve(plan, run).origin;
    for (const std::vector<double>& row : run.rows)
      text += fmt::format("{},{},{:.6g},{},{:g},{:.6g},{:.6g},{:.6g}\n", plan.care(), plate, plan.breadth(test.kind),
                          test.seed, row[0], row[1], row[2], origin);
  }
  return text;
}

std::string shearCsv(const TestPlan& plan, const jobs::Pieces& pieces) {
  std::string text = "care,load [Pa],seed,displacement [m],shear stress [Pa],normal stress [Pa]\n";
  for (const PlannedTest& test : plan.tests) {
    if (test.kind != TestKind::shear || !pieces.has(test.name)) continue;
    const ShearCurve curve = shearCurve(pieces.read(test.name), plan.grains.grains.diameter());
    for (std::size_t i = 0; i < curve.shear.size(); ++i)
      text += fmt::format("{},{:g},{},{:.6g},{:.6g},{:.6g}\n", plan.care(), test.load, test.seed, curve.displacement[i],
                          curve.shear[i], curve.normal[i]);
  }
  return text;
}

nlohmann::ordered_json resultsJson(const TestPlan& plan, const SoilResults& r, int missing,
                                   const std::vector<NotedTest>& shorterSteps) {
  const support::BuildInfo build = support::buildInfo();
  nlohmann::ordered_json json{{"soil", plan.soil.name}, {"title", plan.soil.title}, {"care", plan.care()}};
  json["file"] = plan.soil.file.string();
  json["grain_radius_m"] = plan.soil.grainRadius;
  json["plate_over_grain"] = {plan.small.strip.breadth, plan.large.strip.breadth};
  json["breadth_m"] = {plan.breadth(TestKind::small), plan.breadth(TestKind::large)};
  json["seeds"] = {{"small", r.plates[0]}, {"large", r.plates[1]}, {"shear", r.shearTests}, {"repose", r.reposeTests}};
  json["missing_tests"] = missing;
  json["tests_with_shorter_steps"] = nlohmann::ordered_json::array();
  for (const NotedTest& test : shorterSteps) json["tests_with_shorter_steps"].push_back(test.name);
  json["constants"] = nlohmann::ordered_json::object();
  for (const auto& [q, e] : r.measured) {
    nlohmann::ordered_json one = estimateJson(e, unitOf(q));
    const std::string doubt = doubtOf(q, e);
    one["inconclusive"] = doubt.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(doubt);
    one["published"] = publishedJson(plan.soil, q);
    const auto given = r.atPublishedN.find(q);
    if (given != r.atPublishedN.end()) one["at_published_n"] = estimateJson(given->second, unitOf(q));
    if (const auto span = publishedSpan(plan.soil, q))
      one["span"] = {span->low, span->high},
      one["verdict"] = verdictOf(given != r.atPublishedN.end() ? given->second : e, *span);
    json["constants"][symbolOf(q)] = one;
  }
  if (r.hasPlates()) json["track_sinkage"] = estimateJson(r.sinkage, "mm");
  if (r.plates[0] + r.plates[1] > 0) {
    const auto ofK = [&](std::size_t i) { return r.hasPlates() ? r.measured.at(Quantity::exponent) : r.ownN[i]; };
    for (std::size_t i = 0; i < 2; ++i) {
      json["plates"].push_back({{"k", estimateJson(r.k[i], "kN/m^(n+2)")},
                                {"k_n", estimateJson(ofK(i), "-")},
                                {"k_at_published_n", estimateJson(r.kAtPublishedN[i], "kN/m^(n+2)")},
                                {"n_alone", estimateJson(r.ownN[i], "-")},
                                {"goodness", estimateJson(r.goodness[i], "-")},
                                {"origin", estimateJson(r.bedding[i], "mm")},
                                {"line_begins_at", estimateJson(r.lineBegins[i], "-")},
                                {"n_from_first_contact", estimateJson(r.nFromContact[i], "-")},
                                {"k_u", estimateJson(r.unloading[i], "kN/m3")},
                                {"k_reloading", estimateJson(r.reloading[i], "kN/m3")},
                                {"unloaded_from", estimateJson(r.unloadedFrom[i], "kPa")},
                                {"added_by_motion", estimateJson(r.addedByMotion[i], "-")}});
      if (const auto span = publishedModulus(plan.soil, plan.breadth(kBreadths[i])); span && r.plates[i] > 0)
        json["plates"].back()["k_at_published_n"]["span"] = {span->low, span->high},
        json["plates"].back()["k_at_published_n"]["verdict"] = verdictOf(r.kAtPublishedN[i], *span);
    }
  }
  if (r.wider) json["wide_over_small_less_one"] = estimateJson(*r.wider, "-");
  if (r.hasShear())
    json["shear"] = {{"layer_m", plan.cell.depth * plan.grains.grains.diameter()},
                     {"peak_phi", estimateJson(r.peakAngle, "deg")},
                     {"peak_c", estimateJson(r.peakCohesion, "kPa")},
                     {"peak_over_residual", estimateJson(r.hump, "-")},
                     {"janosi_misfit", estimateJson(r.misfit, "-")},
                     {"sheared_share", r.sheared},
                     {"least_sheared_share", r.minSheared}};
  if (r.reposeTests > 0) json["flow_begins_at"] = estimateJson(r.stability, "deg");
  for (const TestCosts& c : r.costs)
    json["tests"].push_back({{"name", c.name},
                             {"tests", c.tests},
                             {"porosity", estimateJson({c.porosity, c.porosityHalfWidth}, "-")},
                             {"grains", c.grains},
                             {"steps", c.steps},
                             {"seconds", c.seconds}});
  json["recipe"] = plan.recipe();
  json["machine"] = support::machineText();
  json["version"] = build.version, json["commit"] = build.commit;
  return json;
}

void reportSoil(const TestPlan& plan, const jobs::Pieces& pieces, int missing) {
  const SoilResults results = resultsOf(plan, pieces);
  std::string text = constantsTable(plan, results) + detailsTable(plan, results);
  const std::vector<NotedTest> noted = notedTests(plan, pieces, TestNote::shorterSteps);
  if (!noted.empty())
    text += fmt::format("  tests repeated with {:g} times as many steps per contact after a failure:{}\n",
                        kShorterSteps, textOf(noted));
  std::fflush(stdout);
  std::string warnings;
  for (const std::string& warning : {doubtsText(results, plan), looseText(plan, results)})
    if (!warning.empty()) warnings += fmt::format("WARNING: {}\n", warning);
  support::printStderr("{}", warnings);
  fmt::print("{}", text);
  text = warnings + text;
  if (missing > 0)
    fmt::print("{} missing; repeat the command with --resume\n", base::counted(missing, "test is", "tests are"));
  const auto& folder = pieces.folder();
  support::writeTextFile(folder / "soil.txt", text, "--out");
  support::writeTextFile(folder / "constants.csv", constantsCsv(plan, results), "--out");
  support::writeTextFile(folder / "plates.csv", platesCsv(plan, pieces), "--out");
  support::writeTextFile(folder / "shear.csv", shearCsv(plan, pieces), "--out");
  support::replaceTextFile(folder / "soil.json", resultsJson(plan, results, missing, noted).dump(2) + "\n");
  output::drawPicture("soil.py", {folder / "plates.csv", folder / "shear.csv", folder / "soil.json"},
                      folder / "soil.png");
  fmt::print("tables    {}\n", folder.string());
}

} // namespace grouser::virtual_tests
