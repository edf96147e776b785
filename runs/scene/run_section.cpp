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
        "of grains: penalty (springs and dashpots, explicit steps), or complementarity (impulses on Coulomb's cones, "
        "solved for together in steps of a millisecond)");
  t.add(
       "residual", &S::residual, "m/s",
       "of complementarity: velocity error to which each step is solved; \"auto\": a hundredth of what gravity adds in "
       "a step")
      .above(0)
      .atMost(10)
      .orWord("auto");
}

Table<RunSettings> runTable() {
  using S = RunSettings;
  Table<S> t("run", "Time, gravity, and the machine to run on");
  t.add("duration", &S::duration, "s", "simulated time, after the bed has settled")
      .atLeast(1e-12)
      .atMost(1e5)
      .required();
  t.add("time_step", &S::timeStep, "s",
        "\"auto\": the shortest contact over steps_per_contact (1e-4 s without grains), but at most half the step at "
        "which beds still come to rest, 0.2 of a hertz grain's Rayleigh time, 0.1 s and the duration; of a mechanism "
        "from its swings; a step that is given may be as long as no contact gives energy")
      .atLeast(1e-12)
      .atMost(0.1)
      .orWord("auto");
  t.add(
       "steps_per_contact", &S::stepsPerContact, "-",
       "steps that the automatic time step gives the shortest contact: at 20, 10, 6 a restitution of 0.3 or more is "
       "right within 0.035, 0.07, 0.12, and 0.01, 0.02, 0.03 too low in the mean; other bounds of \"auto\" give way in "
       "proportion, to all of that at which beds come to rest")
      .atLeast(kFewestStepsPerContact)
      .atMost(1000);
  t.add("tolerance", &S::tolerance, "m/s or rad/s",
        "instead of time_step, of mechanisms with rattle of order 2 and implicit springs: steps are as long as the "
        "error "
        "allows that they add to the place and turn of any body, this much a second")
      .atLeast(1e-12)
      .atMost(1);
  t.add("steps_per_period", &S::stepsPerPeriod, "-",
        "fewest steps in a period, turn or ramp of drives and moving surfaces, between two times of a table, in a turn "
        "of a body, a swing of a vehicle's springs, and in twice a bounce off an end stop: fewer are refused, and a "
        "turn that becomes too quick ends the run")
      .atLeast(2)
      .atMost(1e6);
  t.add("gravity", &S::gravity, "m/s2", "acceleration of free fall").atLeast(-1000).atMost(1000);
  t.add("output_interval", &S::outputInterval, "s", "between rows of the time series").above(0);
  t.add("frame_interval", &S::frameInterval, "s", "between frames for ParaView").above(0);
  t.add("checkpoint_interval", &S::checkpointInterval, "s",
        "between checkpoints for --resume, simulated; 0: only where the run ends or is stopped")
      .atLeast(0)
      .atMost(1e5);
  t.add("seed", &S::seed, "-", "of every random number").atLeast(0);
  t.add("device", &S::device, "", "where grains are computed; \"auto\" is the GPU where there is one");
  t.add("precision", &S::precision, "", "of the grains' forces; each gives the same bits everywhere");
  addContactKeys(t);
  t.add("impact_speed", &S::impactSpeed, "m/s",
        "fastest impact that the time step of hertz materials is chosen and checked for; with complementarity \"auto\" "
        "moves a grain of that speed by 0.08 of its diameter in a step")
      .above(0)
      .atMost(1e4);
  t.add("threads", &S::threads, "-", "CPU threads; 0 takes all; the answer is the same for any number")
      .atLeast(0)
      .atMost(1024);
  t.add("integrator", &S::integrator, "",
        "of mechanisms: symplectic Euler (order 1, springs implicit) or RATTLE (order 2 and higher)");
  t.add("integrator_order", &S::integratorOrder, "-", "of rattle: 2, or 4, 6, 8 by 5, 9, 17 stages a step")
      .atLeast(1)
      .atMost(8);
  t.add("springs", &S::springs, "", "of rattle: explicit needs a step below 2 / omega, implicit takes any");
  t.add("constraint_tolerance", &S::constraintTolerance, "m or rad",
        fmt::format(
            "to which joints of a mechanism are closed; \"auto\": {:g} for symplectic_euler, {:g} (round-off) for "
            "rattle",
            multibody::kEulerTolerance, multibody::kRattleTolerance))
      .atLeast(multibody::kRattleTolerance)
      .atMost(1e-3)
      .orWord("auto");
  t.add("skin", &S::skin, "-", "range added to the neighbour search, in grain radii").above(0).atMost(2);
  t.add("max_overlap", &S::maxOverlap, "-",
        "overlap in grain radii beyond which the run stops as unsound; \"auto\": 0.5 between grains, 0.8 at planes, "
        "floor and surfaces, 0.2 where grains enter; at parts and meshes always 1, where a grain passes through")
      .above(0)
      .atMost(1)
      .orWord("auto");
  t.add("periodic", &S::periodic, "",
        "whether boundaries along x, y are periodic: grains that leave through one enter through the opposite one");
  t.add("domain_x", &S::domainX, "m",
        "where periodic boundaries stand along x; without it at the borders of the terrain");
  t.add("domain_y", &S::domainY, "m", "the same along y");
  return t;
}

Table<Complementarity> complementarityTable() {
  using S = Complementarity;
  Table<S> t("complementarity", "How grains' contacts are solved for where run.contact = \"complementarity\"");
  t.add("friction", &S::friction, "",
        "Coulomb's own law, or associated: its convex relaxation, which parts sliding surfaces at friction times their "
        "speed");
  t.add("compliance", &S::compliance, "",
        "law: springs and dashpots of the materials, implicit in time; rigid: none, overlaps are pushed apart");
  t.add("iterations", &S::iterations, "-", "maximum per step; steps that reach it are counted")
      .atLeast(1)
      .atMost(100'000);
  t.add("recovery", &S::recovery, "m/s", "greatest speed at which rigid contacts that overlap part")
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
                 fmt::format("[s] is below the time step of {} s; raise it to that at least", *run.timeStep));
  if (run.frameInterval < *run.timeStep)
    section.fail("frame_interval",
                 fmt::format("[s] is below the time step of {} s; raise it to that at least", *run.timeStep));
}

void checkOrder(const Section& run, const RunSettings& settings) {
  const int order = settings.integratorOrder;
  if (settings.integrator == multibody::Integrator::kRattle && order != 2 && order != 4 && order != 6 && order != 8)
    run.fail("integrator_order", "[-] is none of 2, 4, 6, 8; choose one of these");
}

void checkTolerance(const Section& section, const RunSettings& run, const Scene& scene) {
  if (!run.tolerance) return;
  if (run.timeStep) section.fail("tolerance", "[m/s or rad/s] stands beside time_step; keep one of the two");
  if (!scene.document->root().has("body") || scene.document->root().has("vehicle"))
    section.fail("tolerance", "[m/s or rad/s] is of mechanisms alone: grains and vehicles take fixed steps; remove it");
  if (run.integrator != multibody::Integrator::kRattle || run.integratorOrder != 2)
    section.fail("tolerance", "[m/s or rad/s] needs integrator = \"rattle\" with integrator_order = 2; choose these");
  if (run.springs != multibody::Springs::kImplicit)
    section.fail("tolerance", "[m/s or rad/s] needs springs = \"implicit\", since steps may grow; choose that");
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
