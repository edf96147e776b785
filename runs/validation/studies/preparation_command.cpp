// SPDX-License-Identifier: BSD-3-Clause
// `grouser study preparation`: settles beds with a target porosity in [terrain], and measures their porosity.
#include "base/counted.hpp"
#include "base/error.hpp"
#include "coupling/simulation.hpp"
#include "runs/output/plots.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/text_file.hpp"
#include "runs/validation/studies/preparation.hpp"

#include <fmt/format.h>

#include <cmath>

namespace grouser::studies {

namespace {

constexpr double kPorosityBar = 0.01;                // [-] tolerance of the porosity
constexpr double kGrainRadius = 0.025;               // [m]
constexpr double kGrainStiffness = 4e5, kSoft = 1e5; // [N/m] for impacts at some m/s; kSoft with --quick

std::string sceneOf(const PreparationCommand& c, double porosity, int seed) {
  const double d = 2 * kGrainRadius;
  return fmt::format("version = 1\n[run]\nduration = 0.01\nperiodic = [true, true]\nseed = {}\n{}[material.grain]\n"
                     "stiffness = {:g}\nrestitution = 0.3\nfriction = {:.17g}\nrolling_friction = {:.17g}\n[terrain]\n"
                     "heightmap = \"heightmaps/flat.png\"\nsize = [{:.17g}, {:.17g}]\nheight_range = [0, 0]\n"
                     "material = \"grain\"\ngrain_radius = {:.17g}\ndepth = {:.17g}\nporosity = {:.17g}\n"
                     "settle_time_limit = 20\ncache = false\n{}",
                     seed, c.place.quick ? "time_step = 2e-4\n" : "", c.place.quick ? kSoft : kGrainStiffness,
                     c.friction, c.rollingFriction, c.width * d, c.width * d, kGrainRadius, c.depth * d, porosity,
                     c.place.quick ? "settle_kinetic_energy = 1e-3\n" : "");
}

std::string nameOf(double porosity, int seed) { return fmt::format("porosity{:g}_seed{}", porosity, seed); }

/// Table with one row; empty if the bed cannot reach the porosity.
jobs::Table prepare(const PreparationCommand& c, double porosity, int seed, const base::Exec& exec,
                    std::string& refused) {
  jobs::Table table;
  table.names = kPreparationColumns;
  try {
    const scene::Scene scene = setup::parseScene(sceneOf(c, porosity, seed), "preparation.toml");
    const coupling::Simulation simulation(setup::simulationSetup(scene), exec,
                                          [](double, double) { jobs::stopStudyOnRequest(); });
    const terrain::BedStructure& bed = *simulation.ground().structure;
    table.rows.push_back({porosity, bed.porosity, simulation.settled().friction, bed.coordination, bed.rattlers,
                          bed.order, static_cast<double>(bed.grains)});
  } catch (const base::InputError& error) {
    refused = error.what();
  }
  return table;
}

nlohmann::ordered_json recipeOf(const PreparationCommand& c) {
  return {{"study", "preparation"},        {"friction", c.friction}, {"rolling_friction", c.rollingFriction},
          {"radius_m", kGrainRadius},      {"width_d", c.width},     {"depth_d", c.depth},
          {"quick", c.place.quick ? 1 : 0}};
}

} // namespace

void studyPreparationCommand(const PreparationCommand& c) {
  jobs::Pieces pieces("preparation", c.place, c.pieces, recipeOf(c));
  const support::StopSignals signals;
  const auto begin = std::chrono::steady_clock::now();
  fmt::print(
      "          spheres of {:g} mm diameter (d) +- 25 %, friction {:g}, rolling friction {:g}; beds {:g} d wide "
      "between periodic boundaries, {:g} d deep; {} seeds, +-: 95 % interval\n",
      2e3 * kGrainRadius, c.friction, c.rollingFriction, c.width, c.depth, c.seeds);
  const base::Exec exec = support::chooseDevice(support::deviceChoice(c.pieces.device), c.pieces.threads, nullptr);
  support::Progress progress("preparing");
  const double all = static_cast<double>(c.porosities.size()) * c.seeds;
  int done = 0;
  for (const double porosity : c.porosities)
    for (int seed = 1; seed <= c.seeds; ++seed) {
      const std::string name = nameOf(porosity, seed);
      progress.update(done++ / all, name);
      if (!pieces.due(name)) continue;
      std::string refused;
      pieces.keep(name, prepare(c, porosity, seed, exec, refused));
      if (!refused.empty()) progress.note(fmt::format("{}: {}\n", name, refused));
    }
  progress.finish(fmt::format("{} of {} beds finished", all - pieces.left(), all));
  if (!pieces.whole()) return;

  std::string csv = "wanted [-],seeds,porosity [-],half width of porosity,preparation friction [-],coordination "
                    "[-],half width of coordination,"
                    "rattlers [-],order [-],verdict\n";
  fmt::print("\n  {:>7} {:>6} {:>18} {:>10} {:>16} {:>9} {:>8}  within {:g}\n", "target", "seeds", "porosity",
             "friction", "contacts", "rattlers", "order", kPorosityBar);
  for (const double porosity : c.porosities) {
    std::vector<double> reached, friction, contacts, rattlers, order;
    for (int seed = 1; seed <= c.seeds; ++seed) {
      const std::string name = nameOf(porosity, seed);
      if (!pieces.has(name)) continue;
      const jobs::Table run = pieces.read(name);
      if (run.rows.empty()) continue;
      reached.push_back(run.values("porosity [-]").front());
      friction.push_back(run.values("preparation friction [-]").front());
      contacts.push_back(run.values("coordination [-]").front());
      rattlers.push_back(run.values("rattlers [-]").front()), order.push_back(run.values("order [-]").front());
    }
    if (reached.empty()) {
      fmt::print("  {:>7.3f} {:>6}   unreachable\n", porosity, 0);
      csv += fmt::format("{:g},0,,,,,,,,unreachable\n", porosity);
      continue;
    }
    const support::Estimate n = jobs::interval95(reached), z = jobs::interval95(contacts);
    const std::string verdict = jobs::verdictText(jobs::judge({n.value - porosity, n.halfWidth}, kPorosityBar));
    fmt::print("  {:>7.3f} {:>6} {:>18} {:>10.4f} {:>16} {:>9.3f} {:>8.3f}  {}\n", porosity, reached.size(),
               jobs::plusMinus(n, 4), jobs::meanOf(friction).mean, jobs::plusMinus(z, 2), jobs::meanOf(rattlers).mean,
               jobs::meanOf(order).mean, verdict);
    csv += fmt::format("{:g},{},{:.5g},{:.3g},{:.4g},{:.4g},{:.3g},{:.3g},{:.3g},{}\n", porosity, reached.size(),
                       n.value, n.halfWidth, jobs::meanOf(friction).mean, z.value, z.halfWidth,
                       jobs::meanOf(rattlers).mean, jobs::meanOf(order).mean, verdict);
  }
  fmt::print("  friction: only during settling; then it is reset to the friction of the material\n");
  if (pieces.left() > 0)
    fmt::print("{} missing; repeat the command with --resume\n", base::counted(pieces.left(), "run is", "runs are"));
  support::writeTextFile(pieces.folder() / "preparation.csv", csv, "--out");
  nlohmann::ordered_json more = recipeOf(c);
  more["seeds"] = c.seeds;
  jobs::writeStudyOrigin(pieces.folder(), "preparation",
                         std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), more);
  output::drawPicture("study_preparation.py", {pieces.folder() / "preparation.csv"},
                      pieces.folder() / "preparation.png");
  fmt::print("tables    {}\n", pieces.folder().string());
}

} // namespace grouser::studies
