// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/random_stability.hpp"

#include "base/error.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/setup/step_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

namespace grouser::studies {

namespace {

constexpr double kFactor = 1.5, kFarthest = 40; // search above the limit: factor between steps, maximum step / limit
constexpr int kLooks = 40;                      // number of energy checks in a run

/// Runs of one scene; runs each step size only once.
class Trials {
public:
  Trials(const RandomScene& random, const scene::Scene& scene, double share)
      : random_(random), scene_(scene), share_(share) {}
  const StepTrial& at(double step) {
    const auto found = done_.find(step);
    if (found != done_.end()) return found->second;
    jobs::stopStudyOnRequest();
    return done_[step] = tryStep(random_, scene_, step, share_);
  }

  /// The longest step for which `unsound` is false; 0 if there is no such step.
  double longest(double limit, double accuracy, const std::function<bool(const StepTrial&)>& unsound) {
    double low = limit, high = limit;
    if (unsound(at(limit))) {
      while (unsound(at(low)) && low > limit / kFarthest) high = low, low /= kFactor;
      if (unsound(at(low))) return 0;
    } else {
      while (high < kFarthest * limit && !unsound(at(high))) low = high, high *= kFactor;
      if (high >= kFarthest * limit) return low;
    }
    while (high > (1 + accuracy) * low) {
      const double middle = std::sqrt(low * high);
      (unsound(at(middle)) ? high : low) = middle;
    }
    return low;
  }

private:
  const RandomScene& random_;
  const scene::Scene& scene_;
  double share_;
  std::map<double, StepTrial> done_;
};

} // namespace

StepTrial tryStep(const RandomScene& random, const scene::Scene& scene, double step, double share) {
  StepTrial trial;
  trial.step = step;
  const double duration = share * random.contacts * setup::shortestContact(scene);
  const auto alarm = [&trial](const std::string& why) {
    trial.alarmed = true;
    if (trial.why.empty()) trial.why = why;
  };
  const auto blowUp = [&](const std::string& why) {
    trial.blewUp = true;
    alarm(why);
  };
  try {
    coupling::SimulationSetup setup = setup::simulationSetup(scene);
    setup.timeStep = step, setup.ground = setup::groundSetup(scene, step);
    coupling::Simulation run(std::move(setup), base::cpuExec(1), [](double, double) {});
    const auto steps = static_cast<std::int64_t>(std::ceil(duration / step));
    const std::int64_t every = std::max<std::int64_t>(1, steps / kLooks);
    while (run.steps() < steps && !trial.blewUp) {
      const std::int64_t next = std::min(steps, run.steps() + every);
      while (run.steps() < next) try {
          run.advance(next - run.steps());
        } catch (const coupling::EnergyAlarm& error) {
          alarm(error.what()); // the simulation has completed the step and can continue
        }
      const coupling::Ledger ledger = run.ledger();
      trial.growth = std::max(trial.growth, (ledger.kinetic + ledger.potential + ledger.elastic) / random.energy);
      if (!(ledger.fastestGrain <= kRandomSpeed * random.speed))
        blowUp(fmt::format("step {}: a grain moves at {:.3g} m/s, above the physical maximum of {:.3g} m/s",
                           run.steps(), ledger.fastestGrain, random.speed));
      if (!(trial.growth <= kRandomGrowth))
        blowUp(
            fmt::format("step {}: the energy has increased by {:.3g} of its initial value", run.steps(), trial.growth));
    }
    if (!trial.alarmed) run.checkEnergy();
  } catch (const coupling::EnergyAlarm& error) {
    alarm(error.what());
  } catch (const base::SimulationError& error) {
    blowUp(error.what());
  } catch (const base::InputError& error) {
    blowUp(error.what()); // the grains are too fast for the neighbour lists at this step
  }
  return trial;
}

StepMargins stepMargins(const RandomScene& random, double accuracy, double share) {
  StepMargins m;
  m.scene = random;
  scene::Scene scene = setup::parseScene(random.toml, "random.toml");
  const setup::StepLimit limit = setup::stepLimit(scene);
  m.contact = setup::shortestContact(scene), m.limit = limit.step, m.limiting = limit.what;
  m.automatic = setup::chooseTimeStep(scene);
  const double given = scene.run.stepsPerContact;
  scene.run.stepsPerContact = scene::kFewestStepsPerContact;
  m.coarse = setup::chooseTimeStep(scene);
  scene.run.stepsPerContact = given;
  Trials trials(random, scene, share);
  m.atAutomatic = trials.at(m.automatic), m.atCoarse = trials.at(m.coarse), m.atLimit = trials.at(m.limit);
  m.bounded = trials.longest(m.limit, accuracy, [](const StepTrial& t) { return t.blewUp; });
  m.silent = trials.longest(m.limit, accuracy, [](const StepTrial& t) { return t.alarmed; });
  return m;
}

} // namespace grouser::studies
