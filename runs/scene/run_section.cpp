// SPDX-License-Identifier: BSD-3-Clause
// Keys and checks of [run].
#include "runs/scene/detail/section_lists.hpp"

#include "multibody/solver_options.hpp"

#include <fmt/format.h>

namespace grouser::scene::detail {

namespace {

constexpr double kShortestInterval = 1e-12, kLongestInterval = 1e5; ///< between outputs [s]

using base::Section;
using base::Table;

void addContactKeys(Table<RunSettings>& t) {
  using S = RunSettings;
  t.add("contact", &S::contact, "",
        "contact method of grains: penalty (springs and dashpots, explicit time steps), or complementarity (impulses "
        "with Coulomb friction, solved simultaneously with time steps of about a millisecond)");
  t.add("residual", &S::residual, "m/s",
        "tolerance of the complementarity solver, as a velocity; \"auto\": 0.01 times the speed that gravity adds per "
        "step")
      .above(0)
      .atMost(10)
      .orWord("auto");
}

void addIntervals(Table<RunSettings>& t) {
  using S = RunSettings;
  t.add("output_interval", &S::outputInterval, "s", "time between rows of the time series, at least one step")
      .plausible(1e-6, 10)
      .atLeast(kShortestInterval)
      .atMost(kLongestInterval);
  t.add("frame_interval", &S::frameInterval, "s", "time between frames for ParaView, at least one step")
      .plausible(1e-6, 100)
      .atLeast(kShortestInterval)
      .atMost(kLongestInterval);
  t.add("checkpoint_interval", &S::checkpointInterval, "s",
        "simulated time between checkpoints for --resume, at least one step; 0: only at the end of the run or when it "
        "is stopped")
      .plausible(1e-4, 1e4)
      .atLeast(0)
      .atMost(kLongestInterval);
}

Table<RunSettings> runTable() {
  using S = RunSettings;
  Table<S> t("run", "Time, gravity and hardware of a run");
  t.add("duration", &S::duration, "s", "simulated time, counted from the end of settling")
      .plausible(1e-6, 3600)
      .atLeast(1e-12)
      .atMost(1e5)
      .required();
  t.add("time_step", &S::timeStep, "s",
        "time step; \"auto\": duration of the shortest contact / steps_per_contact (1e-4 s without grains), at most "
        "half the largest step at which beds come to rest, 0.2 of the Rayleigh time of hertz grains, 0.1 s and the "
        "duration; for mechanisms, from their oscillation periods; given steps must not exceed the stability limit")
      .plausible(1e-9, 0.05)
      .atLeast(1e-12)
      .atMost(0.1)
      .orWord("auto");
  t.add("steps_per_contact", &S::stepsPerContact, "-",
        "for time_step = \"auto\": number of steps per shortest contact; with 20, 10, 6 steps, restitutions above 0.3 "
        "have errors of at most 0.035, 0.07, 0.12 (mean: -0.01, -0.02, -0.03); the other limits of \"auto\" scale in "
        "proportion, up to the largest step at which beds come to rest")
      .atLeast(kFewestStepsPerContact)
      .atMost(1000);
  t.add("tolerance", &S::tolerance, "m/s or rad/s",
        "tolerance for adaptive steps, instead of time_step: maximum error of body positions and orientations per "
        "second of simulated time; only for mechanisms with rattle, integrator_order = 2 and implicit springs")
      .atLeast(1e-12)
      .atMost(1);
  t.add("steps_per_period", &S::stepsPerPeriod, "-",
        "minimum number of steps per period, revolution or ramp of drives and moving surfaces, per table interval, per "
        "revolution of a body, per oscillation of vehicle springs, and per two bounces at an end stop; a larger time "
        "step is an error, and a body that rotates too fast during the run ends the run")
      .atLeast(2)
      .atMost(1e6);
  t.add("gravity", &S::gravity, "m/s2", "gravitational acceleration").plausible(1.2, 30).atLeast(-1000).atMost(1000);
  addIntervals(t);
  t.add("seed", &S::seed, "-", "seed of the random number generator").atLeast(0);
  t.add("device", &S::device, "", "device for the grains; \"auto\": a GPU if available");
  t.add("precision", &S::precision, "",
        "precision of the grain forces; with either precision, results are bitwise identical on all machines");
  addContactKeys(t);
  t.add("impact_speed", &S::impactSpeed, "m/s",
        "maximum expected impact speed, used to choose and check the time step of hertz materials; with "
        "complementarity, the \"auto\" step moves a grain of this speed by at most 0.08 of its diameter")
      .plausible(1e-3, 300)
      .above(0)
      .atMost(1e4);
  t.add("threads", &S::threads, "-", "number of CPU threads; 0: all available; no effect on results")
      .atLeast(0)
      .atMost(1024);
  t.add("integrator", &S::integrator, "",
        "integrator of mechanisms: symplectic Euler (order 1, implicit springs) or RATTLE (order 2 and higher)");
  t.add("integrator_order", &S::integratorOrder, "-", "order of rattle: 2, or 4, 6, 8 (5, 9, 17 stages per step)")
      .atLeast(1)
      .atMost(8);
  t.add("springs", &S::springs, "",
        "integration of springs with rattle: explicit (requires a step below 2 / omega) or implicit (stable at any "
        "step size)");
  t.add("constraint_tolerance", &S::constraintTolerance, "m or rad",
        fmt::format("position tolerance of the joints of a mechanism; \"auto\": {:g} for symplectic_euler, {:g} "
                    "(round-off) for rattle",
                    multibody::kEulerTolerance, multibody::kRattleTolerance))
      .atLeast(multibody::kRattleTolerance)
      .atMost(1e-3)
      .orWord("auto");
  t.add("skin", &S::skin, "-", "skin distance of the neighbour lists, in grain radii").above(0).atMost(2);
  t.add("max_overlap", &S::maxOverlap, "-",
        "overlap in grain radii above which the run ends; \"auto\": 0.5 between grains, 0.8 at planes, floor and "
        "surfaces, 0.2 for entering grains; at parts and meshes always 1 (grains with more overlap pass through)")
      .above(0)
      .atMost(1)
      .orWord("auto");
  t.add("periodic", &S::periodic, "",
        "whether the boundaries along x, y are periodic: grains that leave on one side enter on the opposite side");
  t.add("domain_x", &S::domainX, "m",
        "positions of the periodic boundaries along x; default: the borders of the terrain")
      .plausible(1e-4, 2000);
  t.add("domain_y", &S::domainY, "m", "positions of the periodic boundaries along y").plausible(1e-4, 2000);
  return t;
}

Table<Complementarity> complementarityTable() {
  using S = Complementarity;
  Table<S> t("complementarity", "Solver of grain contacts with run.contact = \"complementarity\"");
  t.add("friction", &S::friction, "",
        "friction law: coulomb, or associated (convex relaxation, in which sliding surfaces separate at friction times "
        "their sliding speed)");
  t.add("compliance", &S::compliance, "",
        "compliance of contacts: law (springs and dashpots of the materials, implicit in time) or rigid (no "
        "compliance; overlaps are reduced at most at the speed recovery)");
  t.add("iterations", &S::iterations, "-", "maximum number of iterations per step; steps that reach it are reported")
      .atLeast(1)
      .atMost(100'000);
  t.add("recovery", &S::recovery, "m/s", "maximum speed at which overlapping rigid contacts separate")
      .atLeast(0)
      .atMost(100);
  t.add("strict", &S::strict, "", "whether a step with a residual above run.residual ends the run with an error");
  return t;
}

void checkComplementarity(const Section& section, Complementarity&, const Scene& scene) {
  if (scene.run.contact != ContactMethod::complementarity)
    section.fail("", "has no effect without run.contact = \"complementarity\"; set it, or remove the section");
}

void checkContact(const Section& section, const RunSettings& run) {
  if (run.residual && run.contact != ContactMethod::complementarity)
    section.fail("residual", "[m/s] has no effect without contact = \"complementarity\"; set it, or remove the key");
}

void checkIntervals(const Section& section, const RunSettings& run) {
  const double shortest = run.timeStep.value_or(kShortestInterval);
  if (run.checkpointInterval > 0 && run.checkpointInterval < shortest)
    section.fail("checkpoint_interval",
                 fmt::format("[s] is below the {} of {} s; raise it, or set 0 for no checkpoints before the end",
                             run.timeStep ? "time step" : "shortest interval", shortest));
  if (!run.timeStep) return;
  if (*run.timeStep > run.duration)
    section.fail("time_step", fmt::format("[s] is above the duration of {} s; lower it", run.duration));
  if (run.outputInterval < *run.timeStep)
    section.fail("output_interval",
                 fmt::format("[s] is below the time step of {} s; raise it to at least this step", *run.timeStep));
  if (run.frameInterval < *run.timeStep)
    section.fail("frame_interval",
                 fmt::format("[s] is below the time step of {} s; raise it to at least this step", *run.timeStep));
}

void checkOrder(const Section& run, const RunSettings& settings) {
  const int order = settings.integratorOrder;
  if (settings.integrator == multibody::Integrator::kRattle && order != 2 && order != 4 && order != 6 && order != 8)
    run.fail("integrator_order", "[-] must be 2, 4, 6 or 8");
}

void checkTolerance(const Section& section, const RunSettings& run, const Scene& scene) {
  if (!run.tolerance) return;
  if (run.timeStep) section.fail("tolerance", "[m/s or rad/s] is mutually exclusive with time_step; remove one");
  if (!scene.document->root().has("body") || scene.document->root().has("vehicle"))
    section.fail("tolerance",
                 "[m/s or rad/s] applies to mechanisms only; grains and vehicles use fixed steps; remove it");
  if (run.integrator != multibody::Integrator::kRattle || run.integratorOrder != 2)
    section.fail("tolerance", "[m/s or rad/s] requires integrator = \"rattle\" with integrator_order = 2; set both");
  if (run.springs != multibody::Springs::kImplicit)
    section.fail("tolerance", "[m/s or rad/s] requires springs = \"implicit\", since steps may become long; set it");
}

void checkRun(const Section& section, RunSettings& run, const Scene& scene) {
  checkTolerance(section, run, scene);
  checkContact(section, run);
  checkIntervals(section, run);
  checkOrder(section, run);
}

} // namespace

SectionList runSections() {
  return {required("run", &Scene::run, runTable(), checkRun),
          optional("complementarity", &Scene::complementarity, complementarityTable(), checkComplementarity)};
}

} // namespace grouser::scene::detail
