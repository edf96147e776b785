// SPDX-License-Identifier: BSD-3-Clause
// Planned distribution of a scene among ranks.
#include "runs/commands/plan.hpp"

#include "base/error.hpp"
#include "contact/partition.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/bed_options.hpp"
#include "runs/setup/grain_count.hpp"
#include "runs/setup/grain_memory.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/setup/lattice.hpp"
#include "runs/setup/placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::commands {

namespace {

constexpr double kBytesPerGhost = 48; // position, velocity and spin

} // namespace

std::string sharePlan(const scene::Scene& scene, int ranks) {
  const bool bed = scene.terrain && scene.terrain->granular();
  const double grains = static_cast<double>(setup::plannedGrains(scene));
  if (grains == 0) return "";
  if (ranks > grains)
    throw base::InputError(
        fmt::format("--ranks {}: the scene has only {:.0f} grains, too few for this many ranks; use at most {:.0f}",
                    ranks, grains, grains));
  const double radius = setup::grainKinds(scene).largest;
  std::array<double, 3> size{};
  if (bed) {
    const scene::Terrain& t = *scene.terrain;
    const double solid = t.lattice() ? *t.packing : 1 - t.porosity.value_or(scene::Terrain::kPoured);
    const double volume = grains * setup::bedOptions(scene).meanVolume() / solid;
    size = {scene.terrain->size[0], scene.terrain->size[1], volume / (scene.terrain->size[0] * scene.terrain->size[1])};
  } else {
    base::Vec3d low{1e300, 1e300, 1e300}, high = -low;
    const auto include = [&](const base::Vec3d& p) { low = base::min(low, p), high = base::max(high, p); };
    for (const scene::Grain& g : scene.grains) include(g.position);
    for (const scene::GrainFill& b : scene.fills) {
      for (const scene::Grain& g : b.fromFile) include(g.position);
      if (b.low) include(*b.low), include(*b.high);
    }
    for (const scene::Source& s : scene.sources) include(s.low), include(s.high);
    for (const scene::Plane& p : scene.planes) include(p.point);
    for (int a = 0; a < 3; ++a) size[static_cast<std::size_t>(a)] = high[a] - low[a] + 2 * radius;
  }
  setup::checkLattice(scene, ranks);
  const std::array<int, 3> shape = contact::latticeShape(ranks, size, setup::requestedSubdomains(scene));

  // Slaves are at most `range` outside the border; an inner subdomain has two borders along each divided axis.
  const double range = (2 + scene.run.skin) * radius;
  double grown = 1, all = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    const double width = size[a] / shape[a];
    grown *= 1 + (shape[a] > 2 ? 2 : shape[a] - 1) * std::min(range, size[a]) / width;
    all *= 1 + 2 * (shape[a] - 1) * range / size[a];
  }
  // A rank has at most as many ghosts as the other ranks have grains.
  const double each = grains / ranks, ghosts = std::min(each * (grown - 1), grains - each);
  std::string text = fmt::format("\n{} ranks\n", ranks);
  text += fmt::format("  {:<24} {} x {} x {}\n", "subdomains", shape[0], shape[1], shape[2]);
  text += fmt::format("  {:<24} {:.0f}, plus up to {:.0f} ghosts\n", "grains per rank", each, ghosts);
  text += fmt::format("  {:<24} {:.2f} % of the grains\n", "total ghosts", 100 * std::min(all - 1, ranks - 1.0));
  text += fmt::format("  {:<24} about {:.1f} MiB per rank\n", "memory for grains",
                      (each + ghosts) * setup::grainMemory(scene).most() / 1048576.0);
  text += fmt::format("  {:<24} {:.0f} KiB per rank and step\n", "messages", ghosts * kBytesPerGhost / 1024);
  return text;
}

} // namespace grouser::commands
