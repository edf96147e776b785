// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/impact_report.hpp"

#include "base/math.hpp"
#include "contact/restitution.hpp"

#include <fmt/format.h>

#include <cmath>

namespace grouser::studies {

namespace {

constexpr double kTolerances[] = {0.1, 0.01, 0.001};

std::string number(double x, const char* format) {
  return std::isfinite(x) ? fmt::format(fmt::runtime(format), x) : "-";
}

bool known(const ImpactSeries& s, int quantity) {
  return impactReference(s.study).value[static_cast<std::size_t>(quantity)].has_value();
}

const ImpactError& errorOf(const ImpactPoint& p, int quantity) { return p.error[static_cast<std::size_t>(quantity)]; }

} // namespace

std::string impactTable(const ImpactSeries& single, const ImpactSeries& double_) {
  std::string text = fmt::format("\n{}, {:g} m/s\n  {:>8} {:>10}  {:>21}  {:>21}  {:>21}  {:>9} {:>9} {:>9}\n  {:>8} "
                                 "{:>10}  {:>10} {:>10}  {:>10} "
                                 "{:>10}  {:>10} {:>10}  {:>9} {:>9} {:>9}\n",
                                 single.study.name(), single.study.speed, "", "", "restitution", "duration", "overlap",
                                 "double", "us single", "us double", "steps", "step [s]", "worst", "mean", "worst",
                                 "mean", "worst", "mean", "e worst", "", "");
  for (std::size_t i = 0; i < single.points.size(); ++i) {
    const ImpactPoint &p = single.points[i], &d = double_.points[i];
    text += fmt::format("  {:>8.4g} {:>10.3e}", p.steps, p.timeStep);
    if (!p.stable) {
      text += "  above the stable step\n";
      continue;
    }
    for (int q = 0; q < kImpactQuantities; ++q)
      text += known(single, q) ? fmt::format("  {:>10} {:>10}", number(errorOf(p, q).worst, "{:.2e}"),
                                             number(errorOf(p, q).mean, "{:+.2e}"))
                               : fmt::format("  {:>10} {:>10}", "", "");
    text += fmt::format("  {:>9} {:>9.3g} {:>9.3g}\n",
                        known(single, kRestitution) ? number(errorOf(d, kRestitution).worst, "{:.2e}") : "",
                        p.microseconds, d.microseconds);
  }
  return text;
}

std::string orderTable(const std::vector<ImpactSeries>& all) {
  std::string text = fmt::format(
      "\norder of the worst error in the step size with its 95 % interval, from points with at least {:g} steps "
      "per contact and errors above {:g}; in brackets: expected order\n  {:<36} {:<7}",
      kFitFrom, kRoundOffFloor, "", "");
  for (int q = 0; q < kImpactQuantities; ++q) text += fmt::format(" {:>19}", impactQuantityName(q));
  text += "\n";
  for (const ImpactSeries& s : all) {
    text += fmt::format("  {:<36} {:<7}", s.study.name(), precisionName(s.precision));
    for (int q = 0; q < kImpactQuantities; ++q) {
      const support::LineFit fit = measuredOrder(s, q);
      text += fmt::format(" {:>19}", known(s, q) && fit.hasError()
                                         ? fmt::format("{} ({})", fit.slopeText(), expectedOrder(s.study, q))
                                         : "-");
    }
    text += "\n";
  }
  return text;
}

std::string cheapestImpactTable(const std::vector<ImpactSeries>& all) {
  std::string text =
      fmt::format("\ncheapest step for an error (worst over the phases) of 10, 1 and 0.1 %: steps per contact / CPU "
                  "time per collision [us]\n  {:<36} {:<7}",
                  "", "");
  for (const char* what : {"restitution", "all quantities"})
    for (const double tolerance : kTolerances)
      text += fmt::format(" {:>16}",
                          fmt::format("{} {:g} %", what == std::string("restitution") ? "e" : "all", 100 * tolerance));
  text += "\n";
  for (const ImpactSeries& s : all) {
    text += fmt::format("  {:<36} {:<7}", s.study.name(), precisionName(s.precision));
    for (const int q : {int(kRestitution), int(kImpactQuantities)})
      for (const double tolerance : kTolerances) {
        const ImpactPoint* p = q == kRestitution && !known(s, q) ? nullptr : cheapestImpact(s, q, tolerance);
        text += fmt::format(" {:>16}", p ? fmt::format("{:.4g} / {:.3g}", p->steps, p->microseconds) : "-");
      }
    text += "\n";
  }
  return text;
}

std::string impactCsv(const std::vector<ImpactSeries>& all) {
  std::string text = "case,precision,speed [m/s],steps a contact,step [s],stable";
  for (int q = 0; q < kImpactQuantities; ++q)
    text += fmt::format(",{0} worst error [-],{0} mean error [-],{0} measured,{0} exact", impactQuantityName(q));
  text += ",CPU time of a collision [us],least [us]\n";
  for (const ImpactSeries& s : all) {
    const ImpactReference reference = impactReference(s.study);
    for (const ImpactPoint& p : s.points) {
      text += fmt::format("\"{}\",{},{},{},{},{}", s.study.name(), precisionName(s.precision), s.study.speed, p.steps,
                          p.timeStep, p.stable ? 1 : 0);
      for (int q = 0; q < kImpactQuantities; ++q) {
        const auto k = static_cast<std::size_t>(q);
        text += known(s, q) && p.stable
                    ? fmt::format(",{},{},{},{}", number(p.error[k].worst, "{}"), number(p.error[k].mean, "{}"),
                                  number(p.measured[k], "{}"), *reference.value[k])
                    : ",,,,";
      }
      text += fmt::format(",{},{}\n", p.microseconds, p.least);
    }
  }
  return text;
}

std::string orderCsv(const std::vector<ImpactSeries>& all) {
  std::string text = "case,precision,quantity,order,half width of 95 % confidence,points,expected\n";
  for (const ImpactSeries& s : all)
    for (int q = 0; q < kImpactQuantities; ++q)
      if (const support::LineFit fit = measuredOrder(s, q); known(s, q) && fit.hasError())
        text +=
            fmt::format("\"{}\",{},{},{},{},{},{}\n", s.study.name(), precisionName(s.precision), impactQuantityName(q),
                        fit.slope, fit.slopeEstimate().halfWidth, fit.points, expectedOrder(s.study, q));
  return text;
}

std::string cheapestImpactCsv(const std::vector<ImpactSeries>& all) {
  std::string text = "case,precision,quantity,tolerance [-],steps a contact,step [s],CPU time of a collision [us]\n";
  for (const ImpactSeries& s : all)
    for (int q = 0; q <= kImpactQuantities; ++q)
      for (const double tolerance : kTolerances) {
        if (q < kImpactQuantities && !known(s, q)) continue;
        const ImpactPoint* p = cheapestImpact(s, q, tolerance);
        text += fmt::format("\"{}\",{},{},{},{}\n", s.study.name(), precisionName(s.precision), impactQuantityName(q),
                            tolerance, p ? fmt::format("{},{},{}", p->steps, p->timeStep, p->microseconds) : ",,");
      }
  return text;
}

std::string closedFormTable(const std::vector<ImpactSeries>& all, std::size_t point) {
  std::string text = fmt::format(
      "\nclosed-form values (e: restitution, t_c: duration, maximum overlap) and simulation in single precision at "
      "{:.4g} steps per contact, mean over the phases\n  {:<30} {:>11} {:>11}  {:>11} {:>11}  {:>11} {:>11}\n",
      all.front().points[point].steps, "", "e", "measured", "t_c [s]", "measured", "overlap [m]", "measured");
  for (const ImpactSeries& s : all) {
    if (s.precision != terrain::Precision::single || s.study.binary || !s.points[point].stable) continue;
    const ImpactReference reference = impactReference(s.study);
    text += fmt::format("  {:<30}", s.study.name());
    for (int q = 0; q < kImpactQuantities; ++q) {
      const auto k = static_cast<std::size_t>(q);
      const char* const format = q == kRestitution ? "{:.8f}" : "{:.5e}";
      text += reference.value[k] ? fmt::format(" {:>11} {:>11} ", number(*reference.value[k], format),
                                               number(s.points[point].measured[k], format))
                                 : fmt::format(" {:>11} {:>11} ", "-", "-");
    }
    text += "\n";
  }
  return text;
}

std::vector<ConvergenceRow> convergenceRows(int phases) {
  std::vector<ConvergenceRow> rows = {{5, 0.113, {}, {}},    {10, 0.044, {}, {}},   {15, 0.027, {}, {}},
                                      {20, 0.020, {}, {}},   {30, 0.0126, {}, {}},  {50, 0.0074, {}, {}},
                                      {100, 0.0036, {}, {}}, {200, 0.0018, {}, {}}, {500, base::kNaN, {}, {}}};
  for (ConvergenceRow& row : rows) {
    ImpactCase c;
    c.damping = 0.2;
    // The numbers of steps per damped contact, which is longer, are integers.
    const ImpactReference reference = impactReference(c);
    const double shorter = reference.contactTime / *reference.value[kDuration];
    row.damped = measureImpact(c, terrain::Precision::double_, row.steps * shorter, {phases, 1}).error[kRestitution];
    c.damping = 0;
    row.elastic = measureImpact(c, terrain::Precision::double_, row.steps, {phases, 1}).error[kRestitution];
  }
  return rows;
}

std::string convergenceTable(const std::vector<ConvergenceRow>& rows) {
  std::string text = fmt::format(
      "\nlinear free law, grain on a plane, double precision: error of the restitution at an "
      "integer number of steps per contact\n  {:>6} {:>26} "
      "{:>12} {:>12}   {:>16}\n  {:>6} {:>26} {:>12} {:>12}   {:>16}\n",
      "", "zeta 0.2: worst, published", "worst here", "mean here", "elastic: worst", "steps", "", "", "", "");
  for (const ConvergenceRow& r : rows)
    text += fmt::format("  {:>6g} {:>26} {:>12.4f} {:>+12.4f}   {:>16.1e}\n", r.steps, number(r.published, "{:.4f}"),
                        r.damped.worst, r.damped.mean, r.elastic.worst);
  return text;
}

std::string convergenceCsv(const std::vector<ConvergenceRow>& rows) {
  std::string text = "steps a contact,published worst,zeta 0.2 worst,zeta 0.2 mean,elastic worst\n";
  for (const ConvergenceRow& r : rows)
    text += fmt::format("{},{},{},{},{}\n", r.steps, number(r.published, "{}"), r.damped.worst, r.damped.mean,
                        r.elastic.worst);
  return text;
}

std::vector<CoarseRow> coarseRows(int phases) {
  std::vector<CoarseRow> rows;
  for (const double restitution : {1.0, 0.9, 0.7, 0.5, 0.3, 0.2}) {
    CoarseRow row{restitution, contact::dampingRatioFor(restitution, false), {}};
    ImpactCase c;
    c.law = ImpactLaw::linearClamped, c.damping = row.zeta;
    for (std::size_t k = 0; k < kCoarseSteps.size(); ++k)
      row.error[k] = measureImpact(c, terrain::Precision::double_, kCoarseSteps[k], {phases, 1}).error[kRestitution];
    rows.push_back(row);
  }
  return rows;
}

std::string coarseTable(const std::vector<CoarseRow>& rows) {
  std::string text =
      "\nlinear clamped law, grain on a plane, double precision: error of the restitution, worst (mean), over the "
      "steps per contact\n  restitution";
  for (const double steps : kCoarseSteps) text += fmt::format(" {:>18g}", steps);
  for (const CoarseRow& row : rows) {
    text += fmt::format("\n  {:>11g}", row.restitution);
    for (const ImpactError& e : row.error) text += fmt::format(" {:>8.4f} ({:+.4f})", e.worst, e.mean);
  }
  return text + "\n";
}

std::string speedTable(const std::vector<ImpactSeries>& all) {
  std::string text =
      fmt::format("\nworst error over the approach speed at {:.4g} steps per contact\n  {:<36} {:<7} {:>12} "
                  "{:>12} {:>12} {:>12}\n",
                  all.front().points.front().steps, "", "", "speed [m/s]", "restitution", "duration", "overlap");
  for (const ImpactSeries& s : all)
    for (const ImpactPoint& p : s.points) {
      text += fmt::format("  {:<36} {:<7} {:>12g}", s.study.name(), precisionName(s.precision), s.study.speed);
      for (int q = 0; q < kImpactQuantities; ++q)
        text += fmt::format(" {:>12}", known(s, q) ? number(errorOf(p, q).worst, "{:.2e}") : "-");
      text += "\n";
    }
  return text;
}

} // namespace grouser::studies
