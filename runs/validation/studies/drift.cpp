// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/drift.hpp"

#include "base/math.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::studies {

using terrain::Grains;
using terrain::Precision;

namespace {

constexpr double kDiameter = 2 * StudyBox::kRadius;
constexpr double kGasSpacing = 3.2; // [radii] lattice spacing of the gas
constexpr int kSampleEvery = 20;    // number of steps between samples
constexpr int kShaken = 8;          // [units of length] maximum initial displacement between runs
constexpr std::size_t kMacroTimes = 10;

StudyBox gasOf(const DriftStudy& study) {
  StudyBox box;
  box.grains = study.grains;
  box.layers = std::max(2, static_cast<int>(std::lround(std::cbrt(static_cast<double>(study.grains)))));
  box.spacing = kGasSpacing, box.speed = 1, box.gravity = 0, box.restitution = 1, box.friction = 0;
  return box;
}

StudyBox bedOf(const DriftStudy& study) {
  StudyBox box;
  box.grains = study.grains;
  return box;
}

void advanceBy(Grains& grains, std::int64_t steps) {
  for (std::int64_t i = 0; i < steps; ++i) {
    grains.refreshNeighbours();
    grains.step();
  }
}

/// Mean time between collisions in a gas of hard spheres (Enskog, contact value of Carnahan and Starling 1969):
/// 1 / (4 sqrt(pi) n D^2 chi sqrt(T / m)).
double collisionTimeOf(const StudyBox& box) {
  const double number = 1 / std::pow(box.spacing * StudyBox::kRadius, 3);
  const double fraction = number * base::kPi / 6 * std::pow(kDiameter, 3);
  const double chi = (1 - 0.5 * fraction) / std::pow(1 - fraction, 3);
  const double thermal = box.speed / std::sqrt(3.0); // rms of a velocity component that is uniform in [-speed, speed]
  return 1 / (4 * std::sqrt(base::kPi) * number * kDiameter * kDiameter * chi * thermal);
}

/// Exact positions, sorted by id.
std::vector<base::Position> placesById(const Grains& grains) {
  std::vector<base::Position> place(grains.view().count);
  for (std::size_t slot = 0; slot < place.size(); ++slot) place[grains.view().id[slot]] = grains.view().position[slot];
  return place;
}

DriftSample compare(const Grains& a, const Grains& b) {
  DriftSample sample;
  sample.time = static_cast<double>(a.steps()) * StudyBox::kTimeStep;
  const std::vector<base::Position> placeA = placesById(a), placeB = placesById(b);
  double sum = 0;
  for (std::size_t i = 0; i < placeA.size(); ++i) {
    const double d2 = static_cast<double>(base::squaredNorm(base::difference(placeA[i], placeB[i])));
    sum += d2, sample.max = std::max(sample.max, std::sqrt(d2));
  }
  sample.rms = std::sqrt(sum / static_cast<double>(placeA.size())) * a.scale().unit;
  sample.max *= a.scale().unit;
  return sample;
}

Drift runPair(const std::string& scene, const std::string& pair, const StudyBox& one, const StudyBox& other,
              double duration, int threads) {
  const base::Exec exec = base::cpuExec(threads);
  Grains a = fill(one, exec), b = fill(other, exec);
  Drift drift;
  drift.scene = scene, drift.pair = pair;
  const auto samples = static_cast<std::int64_t>(duration / StudyBox::kTimeStep) / kSampleEvery;
  // The growth rate is fitted where the distance is above rounding and below saturation.
  const double low = 10 * studyBoxScale().unit, high = 0.02 * kDiameter;
  std::vector<double> time, logRms;
  bool small = true;
  for (std::int64_t k = 0; k < samples; ++k) {
    advanceBy(a, kSampleEvery), advanceBy(b, kSampleEvery);
    const DriftSample s = compare(a, b);
    drift.samples.push_back(s);
    small = small && s.rms < high;
    if (small && s.rms > low) time.push_back(s.time), logRms.push_back(std::log(s.rms));
    if (drift.toDiameter < 0 && s.max >= kDiameter) drift.toDiameter = s.time;
    if (drift.rmsToDiameter < 0 && s.rms >= kDiameter) drift.rmsToDiameter = s.time;
    jobs::stopStudyOnRequest();
  }
  drift.growth = support::fitLine(time, logRms);
  return drift;
}

/// Macroscopic quantities of one run of the dropped bed at one time.
struct Macro {
  double kinetic, centre, top, coordination;
};
Macro macroOf(Grains& grains) {
  const terrain::GrainLedger ledger = grains.ledger();
  std::vector<double> height;
  double mean = 0;
  const double n = static_cast<double>(grains.view().count);
  for (const base::Position& p : placesById(grains)) {
    height.push_back(grains.scale().toMetres(p).z);
    mean += height.back() / n;
  }
  const auto at = height.begin() + static_cast<std::ptrdiff_t>(0.98 * n);
  std::nth_element(height.begin(), at, height.end());
  return {(ledger.kinetic + ledger.rotational) / n, mean, *at, 2 * static_cast<double>(ledger.contacts) / n};
}

} // namespace

double MacroRow::error() const { return std::sqrt(single.error * single.error + double_.error * double_.error); }

std::vector<Drift> studyDrift(const DriftStudy& study, const DriftProgress& progress) {
  std::vector<Drift> drifts;
  for (const bool gas : {true, false}) {
    const StudyBox box = gas ? gasOf(study) : bedOf(study);
    StudyBox exact = box, moved = box;
    exact.precision = moved.precision = Precision::double_, moved.shaken = 1, moved.seed = 1;
    const std::string scene = gas ? "gas" : "dropped bed";
    const double duration = gas ? study.gasTime : study.bedTime;
    progress(static_cast<double>(drifts.size()) / 4, scene);
    drifts.push_back(runPair(scene, "single - double", box, exact, duration, study.threads));
    progress(static_cast<double>(drifts.size()) / 4, scene);
    drifts.push_back(runPair(scene, "double - double moved by a unit", exact, moved, duration, study.threads));
    if (gas)
      for (Drift& d : drifts) d.collisionTime = collisionTimeOf(box);
  }
  return drifts;
}

std::vector<MacroRow> studyMacroscopic(const DriftStudy& study, const DriftProgress& progress) {
  const base::Exec exec = base::cpuExec(study.threads);
  const auto each = static_cast<std::int64_t>(study.bedTime / StudyBox::kTimeStep / kMacroTimes);
  std::vector<std::vector<Macro>> found[2]; // [precision][time][run]
  for (auto& f : found) f.resize(kMacroTimes);
  for (int run = 0; run < study.runs; ++run)
    for (int p = 0; p < 2; ++p) {
      StudyBox box = bedOf(study);
      box.precision = p == 0 ? Precision::single : Precision::double_;
      // All runs have different initial states, so that the two means are independent.
      box.shaken = kShaken, box.seed = 2 * static_cast<std::uint64_t>(run) + static_cast<std::uint64_t>(p) + 1;
      progress((run + 0.5 * p) / study.runs, "dropped bed");
      Grains grains = fill(box, exec);
      for (std::size_t k = 0; k < kMacroTimes; ++k) {
        advanceBy(grains, each);
        found[p][k].push_back(macroOf(grains));
        jobs::stopStudyOnRequest();
      }
    }
  const struct {
    const char *name, *unit;
    double Macro::*member;
  } quantities[] = {{"kinetic energy a grain", "J", &Macro::kinetic},
                    {"height of the centre of mass", "m", &Macro::centre},
                    {"height that 98 % lie below", "m", &Macro::top},
                    {"coordination", "-", &Macro::coordination}};
  std::vector<MacroRow> rows;
  for (const auto& q : quantities)
    for (std::size_t k = 0; k < kMacroTimes; ++k) {
      MacroRow row{
          q.name, q.unit, static_cast<double>(each) * static_cast<double>(k + 1) * StudyBox::kTimeStep, {}, {}};
      for (int p = 0; p < 2; ++p) {
        std::vector<double> values;
        for (const Macro& m : found[p][k]) values.push_back(m.*q.member);
        (p == 0 ? row.single : row.double_) = jobs::meanOf(values);
      }
      rows.push_back(row);
    }
  return rows;
}

std::string driftTable(const std::vector<Drift>& drifts) {
  std::string text =
      fmt::format("\ndrift of two runs from the same state: distance of each grain between the runs\n  {:<12} {:<32} "
                  "{:>17} {:>15} {:>14} {:>16} {:>14}\n",
                  "", "", "growth [1/s]", "a collision [-]", "farthest at D", "rms at D", "rms at end [m]");
  for (const Drift& d : drifts) {
    const auto moment = [](double t) { return t < 0 ? std::string("-") : fmt::format("{:.3f} s", t); };
    text += fmt::format(
        "  {:<12} {:<32} {:>17} {:>15} {:>14} {:>16} {:>14.2e}\n", d.scene, d.pair, d.growth.slopeText(),
        d.collisionTime > 0 && d.growth.hasError() ? fmt::format("x {:.2f}", std::exp(d.growth.slope * d.collisionTime))
                                                   : "-",
        moment(d.toDiameter), moment(d.rmsToDiameter), d.samples.back().rms);
  }
  if (!drifts.empty() && drifts.front().collisionTime > 0)
    text += fmt::format("  mean time between collisions in the gas: {:.4f} s; D: grain diameter, {:g} m; unit of "
                        "length: {:.2e} m\n",
                        drifts.front().collisionTime, kDiameter, studyBoxScale().unit);
  return text;
}

std::string driftCsv(const std::vector<Drift>& drifts) {
  std::string text = "scene,pair,time [s],farthest [m],rms [m]\n";
  for (const Drift& d : drifts)
    for (const DriftSample& s : d.samples)
      text += fmt::format("{},{},{},{},{}\n", d.scene, d.pair, s.time, s.max, s.rms);
  return text;
}

std::string macroTable(const std::vector<MacroRow>& rows, int runs) {
  std::string text = fmt::format(
      "\nmacroscopic quantities in single and double precision: means over {0} + {0} dropped beds with random initial "
      "displacements of up to {1} units of length\n  {2:<30} {3:>9} {4:>25} {5:>25} {6:>12} {7:>12} {8:>8}\n",
      runs, kShaken, "", "time [s]", "single", "double", "bias", "std. error", "ratio");
  int beyond = 0;
  for (const MacroRow& r : rows) {
    const double ratio = r.error() > 0 ? r.bias() / r.error() : 0;
    beyond += std::fabs(ratio) > 2;
    if ((&r - rows.data()) % 2 == 0) continue; // prints every second time; the file contains all times
    text += fmt::format("  {:<30} {:>9.3g} {:>25} {:>25} {:>12.2e} {:>12.2e} {:>+8.2f}\n",
                        fmt::format("{} [{}]", r.quantity, r.unit), r.time,
                        fmt::format("{:.6g} +- {:.1e}", r.single.mean, r.single.error),
                        fmt::format("{:.6g} +- {:.1e}", r.double_.mean, r.double_.error), r.bias(), r.error(), ratio);
  }
  return text + fmt::format("  {} of {} biases exceed two standard errors (expected by chance: about one in twenty)\n",
                            beyond, rows.size());
}

std::string macroCsv(const std::vector<MacroRow>& rows) {
  std::string text = "quantity,unit,time [s],single mean,single standard error,double mean,double standard error,bias,"
                     "standard error of the bias\n";
  for (const MacroRow& r : rows)
    text += fmt::format("{},{},{},{},{},{},{},{},{}\n", r.quantity, r.unit, r.time, r.single.mean, r.single.error,
                        r.double_.mean, r.double_.error, r.bias(), r.error());
  return text;
}

} // namespace grouser::studies
