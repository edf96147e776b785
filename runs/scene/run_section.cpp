// SPDX-License-Identifier: BSD-3-Clause
// Keys and checks of [run].
#include "runs/scene/detail/section_lists.hpp"

#include "multibody/solver_options.hpp"

#include <fmt/format.h>

namespace grouser::scene::detail {

namespace {

using base::Section;
using base::Table;

void addContactKeys(Table<RunSettings>& t) {
  using S = RunSettings;
  t.add("contact", &S::contact, "",
        "contact method of grains: penalty (springs and dashpots, explicit steps), or complementarity (impulses with "
        "Coulomb friction, solved simultaneously in steps of about a millisecond)");
  t.add("residual", &S::residual, "m/s",
        "velocity tolerance of complementarity in each step; \"auto\": 0.01 of the speed that gravity adds in a step")
      .above(0)
      .atMost(10)
      .orWord("auto");
}

Table<RunSettings> runTable() {
  using S = RunSettings;
  Table<S> t("run", "Time, gravity, and the machine to run on");
  t.add("duration", &S::duration, "s", "simulated time after the bed has settled")
      .atLeast(1e-12)
      .atMost(1e5)
      .required();
  t.add("time_step", &S::timeStep, "s",
        "integration step; \"auto\": duration of the shortest contact / steps_per_contact (1e-4 s without grains), at "
        "most half the largest step at which beds come to rest, 0.2 of a hertz grain's Rayleigh time, 0.1 s and the "
        "duration; for mechanisms from their oscillation periods; a given step may reach the limit at which contacts "
        "create energy")
      .atLeast(1e-12)
      .atMost(0.1)
      .orWord("auto");
  t.add("steps_per_contact", &S::stepsPerContact, "-",
        "steps per shortest contact with the automatic time step: at 20, 10, 6 a restitution of 0.3 or more is "
        "accurate within 0.035, 0.07, 0.12, and on average 0.01, 0.02, 0.03 too low; the other limits of \"auto\" "
        "relax in proportion, at most to the largest step at which beds come to rest")
      .atLeast(kFewestStepsPerContact)
      .atMost(1000);
  t.add("tolerance", &S::tolerance, "m/s or rad/s",
        "error per second of position and orientation of any body, for adaptive steps instead of time_step; only for "
        "mechanisms with rattle of order 2 and implicit springs")
      .atLeast(1e-12)
      .atMost(1);
  t.add("steps_per_period", &S::stepsPerPeriod, "-",
        "minimum number of steps per period, turn or ramp of drives and moving surfaces, per interval of a table, per "
        "turn of a body, per oscillation of a vehicle's springs, and per two bounces off an end stop; larger steps are "
        "an error, and a body that turns too fast ends the run")
      .atLeast(2)
      .atMost(1e6);
  t.add("gravity", &S::gravity, "m/s2", "gravitational acceleration").atLeast(-1000).atMost(1000);
  t.add("output_interval", &S::outputInterval, "s", "interval between rows of the time series").above(0);
  t.add("frame_interval", &S::frameInterval, "s", "interval between frames for ParaView").above(0);
  t.add("checkpoint_interval", &S::checkpointInterval, "s",
        "simulated time between checkpoints for --resume; 0: only when the run ends or is stopped")
      .atLeast(0)
      .atMost(1e5);
  t.add("seed", &S::seed, "-", "seed of all random numbers").atLeast(0);
  t.add("device", &S::device, "", "device that computes the grains; \"auto\": a GPU if there is one");
  t.add("precision", &S::precision, "",
        "precision of the grains' forces; with either, results are bitwise identical on every machine");
  addContactKeys(t);
  t.add("impact_speed", &S::impactSpeed, "m/s",
        "maximum impact speed for which the time step of hertz materials is chosen and checked; with complementarity, "
        "\"auto\" moves a grain at this speed by 0.08 of its diameter in a step")
      .above(0)
      .atMost(1e4);
  t.add("threads", &S::threads, "-", "CPU threads; 0: all; results do not depend on the number")
      .atLeast(0)
      .atMost(1024);
  t.add("integrator", &S::integrator, "",
        "integrator of mechanisms: symplectic Euler (order 1, implicit springs) or RATTLE (order 2 and higher)");
  t.add("integrator_order", &S::integratorOrder, "-", "order of rattle: 2, or 4, 6, 8 with 5, 9, 17 stages per step")
      .atLeast(1)
      .atMost(8);
  t.add("springs", &S::springs, "",
        "springs with rattle: explicit requires a step below 2 / omega, implicit is stable at any step");
  t.add("constraint_tolerance", &S::constraintTolerance, "m or rad",
        fmt::format("position tolerance of the joints of a mechanism; \"auto\": {:g} for symplectic_euler, {:g} "
                    "(round-off) for rattle",
                    multibody::kEulerTolerance, multibody::kRattleTolerance))
      .atLeast(multibody::kRattleTolerance)
      .atMost(1e-3)
      .orWord("auto");
  t.add("skin", &S::skin, "-", "range added to the neighbour search, in grain radii").above(0).atMost(2);
  t.add("max_overlap", &S::maxOverlap, "-",
        "overlap in grain radii beyond which the run stops; \"auto\": 0.5 between grains, 0.8 at planes, floor and "
        "surfaces, 0.2 for grains that enter; at parts and meshes always 1, where a grain passes through")
      .above(0)
      .atMost(1)
      .orWord("auto");
  t.add("periodic", &S::periodic, "",
        "whether boundaries along x, y are periodic: grains that leave through one enter through the opposite one");
  t.add("domain_x", &S::domainX, "m",
        "positions of the periodic boundaries along x; default: the borders of the terrain");
  t.add("domain_y", &S::domainY, "m", "positions of the periodic boundaries along y");
  return t;
}

Table<Complementarity> complementarityTable() {
  using S = Complementarity;
  Table<S> t("complementarity", "Solver of grain contacts with run.contact = \"complementarity\"");
  t.add("friction", &S::friction, "",
        "coulomb: Coulomb's law; associated: its convex relaxation, which separates sliding surfaces at friction times "
        "their speed");
  t.add(
      "compliance", &S::compliance, "",
      "law: springs and dashpots of the materials, implicit in time; rigid: none, overlaps are corrected at recovery");
  t.add("iterations", &S::iterations, "-", "maximum iterations per step; steps that reach it are counted")
      .atLeast(1)
      .atMost(100'000);
  t.add("recovery", &S::recovery, "m/s", "maximum speed at which overlapping rigid contacts separate")
      .atLeast(0)
      .atMost(100);
  t.add("strict", &S::strict, "", "whether a step whose residual exceeds run.residual ends the run");
  return t;
}

void checkComplementarity(const Section& section, Complementarity&, const Scene& scene) {
  if (scene.run.contact != ContactMethod::complementarity)
    section.fail("", "has no effect without run.contact = \"complementarity\"; set that, or remove the section");
}

void checkContact(const Section& section, const RunSettings& run) {
  if (run.residual && run.contact != ContactMethod::complementarity)
    section.fail("residual", "[m/s] has no effect without contact = \"complementarity\"; set that, or remove it");
}

void checkIntervals(const Section& section, const RunSettings& run) {
  if (!run.timeStep) return;
  if (*run.timeStep > run.duration)
    section.fail("time_step", fmt::format("[s] is above the duration of {} s; lower it", run.duration));
  if (run.outputInterval < *run.timeStep)
    section.fail("output_interval",
                 fmt::format("[s] is below the time step of {} s; raise it to at least that", *run.timeStep));
  if (run.frameInterval < *run.timeStep)
    section.fail("frame_interval",
                 fmt::format("[s] is below the time step of {} s; raise it to at least that", *run.timeStep));
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
                 "[m/s or rad/s] applies to mechanisms only, since grains and vehicles use fixed steps; remove it");
  if (run.integrator != multibody::Integrator::kRattle || run.integratorOrder != 2)
    section.fail("tolerance", "[m/s or rad/s] requires integrator = \"rattle\" with integrator_order = 2; set both");
  if (run.springs != multibody::Springs::kImplicit)
    section.fail("tolerance", "[m/s or rad/s] requires springs = \"implicit\", since steps may grow; set that");
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
