// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/multibody.hpp"

#include "base/error.hpp"
#include "runs/jobs/study_place.hpp"
#include "runs/output/plots.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/mechanism_setup.hpp"
#include "runs/support/locations.hpp"
#include "runs/support/private_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <limits>
#include <optional>

namespace grouser::studies {

namespace fs = std::filesystem;

namespace {

constexpr double kThreshold = 1e-3; ///< y_thr in the definition of the error
constexpr double kShortRun = 0.2;   ///< runs with less CPU time are repeated [s]
constexpr int kRepeats = 3;         ///< number of repetitions of a short run; the minimum time counts
constexpr double kHopeless = 1e3;   ///< runs with a larger error count as failed [-]

double cpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The scene of a case: a file in runs/mechanisms/, or a file that make_mechanisms.py in this folder writes.
scene::Scene loadCase(const std::string& scene, const IntegratorChoice& integrator) {
  const fs::path folder = support::shareFolder() / "runs" / "mechanisms";
  fs::path file = folder / scene;
  std::optional<support::PrivateFolder> scratch;
  if (!scene.ends_with(".toml")) {
    file = scratch.emplace("grouser_mechanism").path() / "mechanism.toml";
    std::vector<std::string> words;
    for (std::size_t at = 0; at < scene.size();) {
      const std::size_t space = std::min(scene.find(' ', at), scene.size());
      words.push_back(scene.substr(at, space - at)), at = space + 1;
    }
    words.push_back(file.string());
    std::string warning;
    if (!output::runScript(folder / "make_mechanisms.py", words, warning)) throw base::InputError(warning);
  }
  return setup::loadScene(file, {"run.integrator=" + integrator.word,
                                 fmt::format("run.integrator_order={}", std::max(2, integrator.order))});
}

struct Measured {
  double error = 0, position = 0, velocity = 0, energy = 0, seconds = 0;
};

/// Runs a case and compares it with the reference at the sample times; measures only the time of the steps.
Measured measure(const StudyCase& c, const scene::Scene& scene, double step, std::int64_t stepsPerSample,
                 std::int64_t samples) {
  coupling::Mechanism mechanism(setup::mechanismSetup(scene), step);
  const auto energy = [&] {
    const multibody::Balance b = mechanism.bodiesBalance();
    return b.now.kinetic + b.now.gravity + b.now.elastic + b.dissipated() - b.driveWork;
  };
  const double start = energy();
  Measured m;
  double sum = 0;
  for (std::int64_t i = 1; i <= samples; ++i) {
    const double begin = cpuSeconds();
    for (std::int64_t s = 0; s < stepsPerSample; ++s) mechanism.advance();
    m.seconds += cpuSeconds() - begin;
    const std::vector<double> is = readProbes(mechanism, c.probes);
    const std::vector<double> should = c.reference(static_cast<double>(i) * c.sample);
    for (std::size_t j = 0; j < is.size(); ++j) {
      const double e = std::fabs(is[j] - should[j]) / std::max(std::fabs(should[j]), kThreshold);
      sum += e * e / static_cast<double>(is.size());
    }
    const coupling::Mechanism::Drift drift = mechanism.drift();
    m.position = std::max(m.position, drift.position), m.velocity = std::max(m.velocity, drift.velocity);
    m.energy = std::max(m.energy, std::fabs(energy() - start));
    jobs::stopStudyOnRequest();
  }
  m.error = std::sqrt(sum / static_cast<double>(samples));
  return m;
}

} // namespace

std::vector<IntegratorChoice> studyIntegrators() {
  return {
      {"euler", "symplectic_euler", 1}, {"rattle2", "rattle", 2}, {"rattle4", "rattle", 4}, {"rattle8", "rattle", 8}};
}

std::vector<StudyPoint> studyOne(const StudyCase& c, const IntegratorChoice& integrator, int count, double budget) {
  const scene::Scene scene = loadCase(c.scene, integrator);
  const std::int64_t samples = std::llround(c.end / c.sample);
  std::vector<StudyPoint> points;
  std::int64_t perSample = c.coarsest;
  for (int k = 0; k < count; ++k, perSample *= 4) {
    StudyPoint p;
    p.integrator = integrator.name, p.step = c.sample / static_cast<double>(perSample), p.steps = samples * perSample;
    p.order = std::numeric_limits<double>::quiet_NaN();
    const StudyPoint* before = points.empty() ? nullptr : &points.back();
    if (before && before->seconds * 4 > budget) {
      p.failure = fmt::format("skipped: would take about {:.0f} s", before->seconds * 4);
      p.seconds = before->seconds * 4;
      points.push_back(p);
      continue;
    }
    try {
      Measured m = measure(c, scene, p.step, perSample, samples);
      for (int again = 1; again < kRepeats && m.seconds < kShortRun; ++again)
        m.seconds = std::min(m.seconds, measure(c, scene, p.step, perSample, samples).seconds);
      p.seconds = m.seconds, p.positionDrift = m.position, p.velocityDrift = m.velocity, p.energyDrift = m.energy;
      if (m.error < kHopeless)
        p.error = m.error;
      else
        p.failure = "failed: the error is too large";
      if (p.error && before && before->error && *p.error > 0) p.order = std::log2(*before->error / *p.error) / 2;
    } catch (const base::SimulationError& error) {
      p.failure = error.what();
    } catch (const base::InputError& error) {
      p.failure =
          error.what(); // an explicit spring above its stable step, or a case that the integrator does not support
    }
    points.push_back(p);
  }
  return points;
}

ReactionResult measureReaction(const ReactionCase& r, const IntegratorChoice& integrator) {
  ReactionResult result{r, integrator.name, {}, 0, ""};
  try {
    const scene::Scene scene = loadCase(r.scene, integrator);
    coupling::Mechanism mechanism(setup::mechanismSetup(scene), r.step);
    const std::int64_t steps = std::llround(r.end / r.step);
    double sum = 0;
    for (std::int64_t i = 0; i < steps; ++i) {
      mechanism.advance();
      const double f = r.measured(mechanism);
      sum += f;
      if (i > 0) result.worst = std::max(result.worst, std::fabs(f / r.exact - 1));
    }
    result.mean = sum / static_cast<double>(steps);
  } catch (const base::SimulationError& error) {
    result.failure = error.what();
  } catch (const base::InputError& error) {
    result.failure = error.what();
  }
  return result;
}

} // namespace grouser::studies
