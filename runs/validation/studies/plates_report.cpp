// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/plates_report.hpp"

#include "base/math.hpp"
#include "runs/jobs/study_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::studies {

namespace {

constexpr double kEqualBar = 0.05, kBearingBar = 0.25; // [-]

double radians(double degrees) { return degrees * base::kPi / 180; }

std::string sliceText(const Slice& s) { return fmt::format("{:.3f}-{:.3f}", s[0], s[1]); }

std::string sliceHeads(const std::vector<Slice>& slices) {
  std::string text;
  for (const Slice& s : slices) text += fmt::format(" {:>16}", sliceText(s));
  return text + "\n";
}

} // namespace

std::vector<double> CaseRuns::pressures(const Slice& slice) const {
  std::vector<double> all;
  for (const jobs::Table& run : runs)
    all.push_back(virtual_tests::meanPressure(run, area, slice[0] * breadth, slice[1] * breadth));
  return all;
}

double CaseRuns::mean(const std::string& column) const {
  double mean = 0;
  for (const jobs::Table& run : runs) mean += run.rows.front()[run.column(column)] / static_cast<double>(runs.size());
  return mean;
}

std::vector<CaseRuns> runsThatAreThere(const std::vector<PlateCase>& cases, const virtual_tests::Soil& soil, int seeds,
                                       const jobs::Pieces& pieces) {
  std::vector<CaseRuns> all;
  for (const PlateCase& c : cases) {
    CaseRuns runs{&c, c.test.area(soil), c.test.breadth * soil.grains.diameter(), {}};
    for (int seed = 1; seed <= seeds; ++seed)
      if (const std::string name = nameOf(c, seed); pieces.has(name)) runs.runs.push_back(pieces.read(name));
    if (!runs.runs.empty()) all.push_back(runs);
  }
  return all;
}

std::string pressureTable(const std::vector<CaseRuns>& all, const std::vector<Slice>& slices, std::string& csv) {
  std::string text =
      fmt::format("\npressure [kPa] over sinkage / plate width\n  {:<10} {:>5} {:>8}", "", "seeds", "porosity");
  text += sliceHeads(slices);
  csv = "case,seeds,porosity [-],from [breadths],to [breadths],pressure [Pa],half width\n";
  for (const CaseRuns& c : all) {
    const double porosity = c.mean("porosity [-]");
    text += fmt::format("  {:<10} {:>5} {:>8.4f}", c.plate->name, c.runs.size(), porosity);
    for (const Slice& s : slices) {
      if (!c.reaches(s)) {
        text += fmt::format(" {:>16}", "-");
        continue;
      }
      const support::Estimate p = jobs::interval95(c.pressures(s));
      text += fmt::format(" {:>16}", jobs::plusMinus({1e-3 * p.value, 1e-3 * p.halfWidth}, 2));
      csv += fmt::format("{},{},{:.4f},{:g},{:g},{:.5g},{:.3g}\n", c.plate->name, c.runs.size(), porosity, s[0], s[1],
                         p.value, p.halfWidth);
    }
    text += "  " + c.plate->title + "\n";
  }
  return text;
}

std::string differenceTable(const std::vector<CaseRuns>& all, const std::vector<Slice>& slices, std::string& csv) {
  csv = "case,compared with,from [breadths],to [breadths],difference [-],half width,verdict\n";
  std::string text;
  for (const CaseRuns& c : all) {
    const auto other =
        std::find_if(all.begin(), all.end(), [&](const CaseRuns& o) { return o.plate->name == c.plate->comparedWith; });
    if (other == all.end()) continue;
    if (text.empty())
      text = fmt::format("\npressure difference [%] over sinkage / plate width; tolerance {:g} %\n  {:<18}",
                         100 * kEqualBar, "") +
             sliceHeads(slices);
    text += fmt::format("  {:<18}", fmt::format("{} to {}", c.plate->name, other->plate->name));
    std::string verdict = "sinkage too small";
    for (const Slice& s : slices) {
      if (!c.reaches(s)) {
        text += fmt::format(" {:>16}", "-");
        continue;
      }
      const support::Estimate difference = jobs::relativeDifference(other->pressures(s), c.pressures(s));
      verdict = jobs::verdictText(jobs::judge(difference, kEqualBar));
      text += fmt::format(" {:>16}", jobs::plusMinus({100 * difference.value, 100 * difference.halfWidth}, 1));
      csv += fmt::format("{},{},{:g},{:g},{:.5f},{:.5f},{}\n", c.plate->name, other->plate->name, s[0], s[1],
                         difference.value, difference.halfWidth, verdict);
    }
    text += "  " + verdict + "\n";
  }
  return text;
}

std::string costTable(const std::vector<CaseRuns>& all, std::string& csv) {
  csv = "case,grains,steps of the bed,wall time of the bed [s],steps of the plate,wall time of the plate [s],times "
        "fewer grains,times faster\n";
  std::string text = fmt::format("\nmeans per run\n  {:<10} {:>9} {:>11} {:>8} {:>13} {:>8}\n", "", "grains",
                                 "bed steps", "[s]", "plate steps", "[s]");
  for (const CaseRuns& c : all) {
    std::array<double, 5> m{};
    for (std::size_t k = 0; k < m.size(); ++k) m[k] = c.mean(virtual_tests::kPlateColumns[3 + k]);
    text += fmt::format("  {:<10} {:>9.0f} {:>11.0f} {:>8.1f} {:>13.0f} {:>8.1f}", c.plate->name, m[0], m[1], m[2],
                        m[3], m[4]);
    csv += fmt::format("{},{:.0f},{:.0f},{:.2f},{:.0f},{:.2f},", c.plate->name, m[0], m[1], m[2], m[3], m[4]);
    const auto fine =
        std::find_if(all.begin(), all.end(), [&](const CaseRuns& o) { return o.plate->name == c.plate->comparedWith; });
    if (fine != all.end() && c.plate->test.coarsening > 0) {
      const double fewer = fine->mean("grains") / m[0];
      const double faster =
          (fine->mean(virtual_tests::kPlateColumns[5]) + fine->mean(virtual_tests::kPlateColumns[7])) / (m[2] + m[4]);
      text += fmt::format("  {:.2f} times fewer grains than {}, {:.2f} times faster", fewer, fine->plate->name, faster);
      csv += fmt::format("{:.3f},{:.3f}", fewer, faster);
    } else {
      csv += ",";
    }
    text += "\n", csv += "\n";
  }
  return text;
}

std::string bearingTable(const PlatesCommand& command, const virtual_tests::Soil& soil,
                         const std::vector<CaseRuns>& all, const std::vector<Slice>& slices, std::string& csv) {
  csv = "case,from [breadths],to [breadths],measured [Pa],half width,theory [Pa],at the angle's lower end [Pa],at its "
        "upper end [Pa],measured over theory - 1,half width,verdict,angle that theory would need [deg]\n";
  if (command.angle <= 0)
    return "\nno comparison with bearing theory: it requires --angle, from `grouser study shear-angle`\n";
  std::string text =
      fmt::format("\nbearing capacity at {:g} +- {:g} deg (Vesic's factors, density of the bed); tolerance {:g} %\n"
                  "  {:<10} {:>12} {:>18} {:>28} {:>20} {:>11} {:>14}\n",
                  command.angle, command.angleError, 100 * kBearingBar, "", "sinkage / B", "measured [kPa]",
                  "theory, angle interval [kPa]", "measured/theory - 1", "", "fitted angle");
  for (const CaseRuns& c : all) {
    if (!c.plate->bears) continue;
    const double weight = (1 - c.mean("porosity [-]")) * soil.grains.density * jobs::kGravity;
    for (const auto& s : slices) {
      const auto theory = [&](double degrees) {
        return virtual_tests::meanBearing(c.plate->test.shape, radians(degrees), weight, c.breadth, s[0] * c.breadth,
                                          s[1] * c.breadth);
      };
      const std::vector<double> measured = c.pressures(s);
      const support::Estimate p = jobs::interval95(measured);
      const double q = theory(command.angle), low = theory(command.angle - command.angleError),
                   high = theory(command.angle + command.angleError);
      // The interval includes the uncertainty of the angle and the scatter of the pressure.
      const support::Estimate ratio{p.value / q - 1, std::hypot(p.halfWidth / q, p.value / q * 0.5 * (high - low) / q)};
      const double fits = virtual_tests::bearingAngle(c.plate->test.shape, p.value, weight, c.breadth,
                                                      0.5 * (s[0] + s[1]) * c.breadth) *
                          180 / base::kPi;
      const std::string verdict = jobs::verdictText(jobs::judge(ratio, kBearingBar));
      text += fmt::format("  {:<10} {:>12} {:>18} {:>12.2f} ({:.2f} to {:.2f}) {:>20} {:>11} {:>12.1f} deg\n",
                          c.plate->name, sliceText(s), jobs::plusMinus({1e-3 * p.value, 1e-3 * p.halfWidth}, 2),
                          1e-3 * q, 1e-3 * low, 1e-3 * high, jobs::percent(ratio), verdict, fits);
      csv += fmt::format("{},{:g},{:g},{:.5g},{:.3g},{:.5g},{:.5g},{:.5g},{:.4f},{:.4f},{},{:.4g}\n", c.plate->name,
                         s[0], s[1], p.value, p.halfWidth, q, low, high, ratio.value, ratio.halfWidth, verdict, fits);
    }
  }
  return text;
}

} // namespace grouser::studies
