// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/collapse.hpp"

#include "base/math.hpp"
#include "runs/output/plots.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace grouser::studies {

namespace {

constexpr double kSpacing = 2.6;    // lattice spacing of the initial column [radii]; large enough for disorder
constexpr double kSolid = 0.59;     // expected solid fraction of the column; determines the initial height
constexpr double kCalm = 1e-4;      // kinetic energy per grain / (m g d) below which grains are at rest [-]
constexpr double kLongest = 4;      // maximum duration / expected duration [-]
constexpr double kLookEvery = 0.02; // sampling interval [sqrt(h0 / g)]

/// Scene of the column, with (`closed`) or without the gate at the distance `gate` [m] from the back wall.
std::string columnScene(const virtual_tests::SampleGrains& material, double gate, double width, double height,
                        std::int64_t seed, scene::ContactMethod contact, bool closed) {
  std::string text = fmt::format(
      "version = 1\n[run]\nduration = 1\nseed = {0}\ncontact = \"{7}\"\nperiodic = [false, true]\ndomain_y = [0, "
      "{1:.17g}]\n{2}"
      "[[grains]]\nform = \"lattice\"\nlow = [0, 0, 0]\nhigh = [{3:.17g}, {1:.17g}, {4:.17g}]\nradius = {5:.17g}\n"
      "spacing = {6}\njitter = 1.0\nmaterial = \"grain\"\n"
      "[[plane]]\nmaterial = \"grain\"\n[[plane]]\nmaterial = \"grain\"\nnormal = [1, 0, 0]\n",
      seed, width, material.toml("grain"), gate, height, material.radius, kSpacing, base::wordOf(contact));
  if (closed)
    text += fmt::format("[[plane]]\nmaterial = \"grain\"\npoint = [{:.17g}, 0, 0]\nnormal = [-1, 0, 0]\n", gate);
  return text;
}

/// The state without the last boundary (the gate) and its springs.
terrain::GrainState withoutGate(terrain::GrainState s) {
  const auto before = static_cast<std::size_t>(s.layout.boundaries), after = before - 1;
  const auto dropLast = [&]<class T>(std::vector<T>& springs) {
    if (springs.empty()) return;
    std::vector<T> kept;
    for (std::size_t g = 0; g < s.rows(); ++g)
      kept.insert(kept.end(), springs.begin() + static_cast<std::ptrdiff_t>(g * before),
                  springs.begin() + static_cast<std::ptrdiff_t>(g * before + after));
    springs = std::move(kept);
  };
  dropLast(s.wallShear), dropLast(s.wallRolling), dropLast(s.wallDeepest), dropLast(s.wallOrigin);
  for (std::uint32_t& bits : s.wallBits) bits &= (1u << after) - 1;
  s.layout.boundaries = static_cast<std::int64_t>(after);
  return s;
}

/// Depth of the deposit [m] in bins of one diameter along x, assuming the solid fraction kSolid.
std::vector<double> profile(const std::vector<base::Vec3d>& centres, double d, double width) {
  std::vector<double> depth;
  for (const base::Vec3d& x : centres) {
    const auto bin = static_cast<std::size_t>(std::max(0.0, x.x / d));
    if (bin >= depth.size()) depth.resize(bin + 1);
    depth[bin] += base::kPi / 6 * d * d * d / (kSolid * d * width);
  }
  return depth;
}

/// Distance from the back wall to the first position where the deposit is less than half a diameter deep [m].
double frontOf(const std::vector<double>& depth, double d) {
  const auto end = std::find_if(depth.begin(), depth.end(), [d](double h) { return h < 0.5 * d; });
  return static_cast<double>(end - depth.begin()) * d;
}

} // namespace

double channelRunOut(double aspect) { return aspect < 2.3 ? 1.2 * aspect : 1.9 * std::pow(aspect, 2.0 / 3); }
double channelHeight(double aspect) { return aspect < 1.15 ? aspect : 0.65 * std::pow(aspect, 0.4); }

Collapse collapseColumn(const virtual_tests::SampleGrains& material, double length, double width, double aspect,
                        std::int64_t seed, scene::ContactMethod contact) {
  const double d = material.diameter(), gate = length * d, deep = width * d;
  const double spread = kSpacing / 2;
  const double fill = aspect * gate * kSolid / (base::kPi / 6) * spread * spread * spread;
  virtual_tests::Sample column = virtual_tests::buildSample(
      columnScene(material, gate, deep, fill, seed, scene::ContactMethod::penalty, true), base::cpuExec(1));
  virtual_tests::bringToRest(column, kCalm, 2.0); // a single grain may still roll on top

  double mean = 0;
  for (const base::Vec3d& x : column.grains().snapshot().position)
    mean += x.z / static_cast<double>(column.grains().count());
  Collapse result;
  result.grains = column.grains().count();
  result.aspect = 2 * mean / gate;

  virtual_tests::Sample open =
      virtual_tests::buildSample(columnScene(material, gate, deep, fill, seed, contact, false), base::cpuExec(1));
  open.grains().restore(withoutGate(column.grains().state()));
  const double g = norm(open.grains().model().gravity), unit = std::sqrt(2 * mean / g);
  const auto every = std::max<std::int64_t>(1, static_cast<std::int64_t>(kLookEvery * unit / open.timeStep));
  const double look = static_cast<double>(every) * open.timeStep;
  const double restful = kCalm * material.mass() * g * d * static_cast<double>(result.grains);
  std::vector<double> fronts, depth;
  result.rests = false;
  for (double t = 0; t < kLongest * kChannelTime * unit && !result.rests; t += look) {
    jobs::stopStudyOnRequest();
    virtual_tests::advanceSample(open.grains(), every);
    depth = profile(open.grains().snapshot().position, d, deep);
    fronts.push_back(frontOf(depth, d));
    const terrain::GrainLedger ledger = open.grains().ledger();
    result.rests = t > unit && ledger.kinetic + ledger.rotational < restful;
  }
  result.runOut = (fronts.back() - gate) / gate;
  result.height =
      *std::max_element(depth.begin(), depth.begin() + std::min<std::ptrdiff_t>(3, std::ssize(depth))) / gate;
  const auto arrived = std::find_if(fronts.begin(), fronts.end(), [&](double f) { return f >= fronts.back() - d; });
  result.time = static_cast<double>(arrived - fronts.begin() + 1) * look / unit;
  return result;
}

void studyCollapseCommand(const CollapseCommand& command) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const auto folder = jobs::beginStudy("collapse", command.place);
  const support::StopSignals signals;
  const int seeds = command.seeds;
  const double length = command.length;
  const std::vector<double>& aspects = command.aspects;
  virtual_tests::SampleGrains material;
  material.stiffness = 3e4, material.rollingFriction = 0.1;
  fmt::print("          spheres of 10 mm diameter (d), 3e4 N/m, restitution 0.5, friction 0.5, rolling friction 0.1; "
             "column {} d "
             "long\n          between a wall and a gate, {} d between periodic boundaries; smooth floor with the same "
             "friction; "
             "{} contacts;\n          {} seeds, +- standard error; one thread\n",
             length, command.width, base::wordOf(command.contact), seeds);
  support::Progress progress("collapsing");
  std::string csv = "aspect [-],seed,grains,run-out [-],deposit height [-],time [-],rests\n";
  std::string table = fmt::format("\n  {:>13} {:>7} {:>17} {:>8} {:>17} {:>8} {:>17} {:>8}\n", "h0/d0", "grains",
                                  "run-out/d0", "channel", "height/d0", "channel", "time/sqrt(h0/g)", "channel");
  double weight = 0, done = 0;
  for (const double a : aspects) weight += a * std::sqrt(a) * seeds;
  for (const double wanted : aspects) {
    std::vector<double> aspect, runOut, height, time;
    std::size_t grains = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
      progress.update(done / weight, fmt::format("aspect {:g}, seed {}", wanted, seed));
      const Collapse c = collapseColumn(material, length, command.width, wanted, seed, command.contact);
      done += wanted * std::sqrt(wanted), grains = c.grains;
      aspect.push_back(c.aspect), runOut.push_back(c.runOut), height.push_back(c.height), time.push_back(c.time);
      csv += fmt::format("{:.5f},{},{},{:.5f},{:.5f},{:.4f},{}\n", c.aspect, seed, c.grains, c.runOut, c.height, c.time,
                         c.rests ? 1 : 0);
    }
    const auto both = [](const std::vector<double>& values) {
      const jobs::MeanError m = jobs::meanOf(values);
      return fmt::format("{:.3f} +- {:.3f}", m.mean, m.error);
    };
    const double a = jobs::meanOf(aspect).mean;
    table += fmt::format("  {:>13.3f} {:>7} {:>17} {:>8.3f} {:>17} {:>8.3f} {:>17} {:>8.1f}\n", a, grains, both(runOut),
                         channelRunOut(a), both(height), channelHeight(a), both(time), kChannelTime);
  }
  progress.finish(fmt::format("{} columns", aspects.size() * static_cast<std::size_t>(seeds)));
  fmt::print("{}\n  channel: fits to channel experiments (scatter 10 to 15 %); columns of few grains deviate from the "
             "fits\n",
             table);
  support::writeTextFile(folder / "collapse.csv", csv, "--out");
  jobs::writeStudyOrigin(folder, "collapse", std::chrono::duration<double>(Clock::now() - begin).count(),
                         {{"length_in_diameters", length},
                          {"width_in_diameters", command.width},
                          {"seeds", seeds},
                          {"contact", base::wordOf(command.contact)},
                          {"threads", 1}});
  output::drawPicture("study_collapse.py", {folder / "collapse.csv"}, folder / "collapse.png");
  fmt::print("tables    {}\n", folder.string());
}

} // namespace grouser::studies
