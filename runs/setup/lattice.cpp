// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/lattice.hpp"

#include "base/error.hpp"
#include "contact/partition.hpp"
#include "runs/scene/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace grouser::setup {

namespace {

constexpr const char* kRemedy = "change the key or the number of ranks (mpirun -np)";

bool fits(int ranks, const std::array<int, 3>& wanted) {
  try {
    contact::latticeShape(ranks, {1, 1, 1}, wanted);
    return true;
  } catch (const base::InputError&) {
    return false;
  }
}

} // namespace

std::array<int, 3> requestedSubdomains(const scene::Scene& scene) {
  const std::vector<double>* cuts[] = {&scene.parallel.cutsX, &scene.parallel.cutsY, &scene.parallel.cutsZ};
  std::array<int, 3> wanted{};
  for (int a = 0; a < 3; ++a) {
    if (scene.parallel.subdomains)
      wanted[static_cast<std::size_t>(a)] = static_cast<int>((*scene.parallel.subdomains)[a]);
    if (!cuts[a]->empty()) wanted[static_cast<std::size_t>(a)] = static_cast<int>(cuts[a]->size()) + 1;
  }
  return wanted;
}

contact::PartitionOptions partitionOptions(const scene::Scene& scene, const base::PositionScale& scale) {
  contact::PartitionOptions partition;
  partition.rebalance = scene.parallel.rebalance;
  partition.peers = scene.parallel.peerMemory;
  partition.cuts = {scene.parallel.cutsX, scene.parallel.cutsY, scene.parallel.cutsZ};
  // A plane beyond the range of positions is moved to its limit.
  for (std::vector<double>& planes : partition.cuts)
    for (double& place : planes) place = std::clamp(place, -scale.limit(), scale.limit());
  partition.subdomains = requestedSubdomains(scene);
  return partition;
}

void checkLattice(const scene::Scene& scene, int ranks) {
  const std::array<int, 3> wanted = requestedSubdomains(scene);
  if (ranks == 1 || fits(ranks, wanted)) return;
  const std::vector<double>* cuts[] = {&scene.parallel.cutsX, &scene.parallel.cutsY, &scene.parallel.cutsZ};
  for (std::size_t a = 0; a < 3; ++a)
    if (!cuts[a]->empty())
      scene.fail("parallel", std::string("cuts_") + "xyz"[a],
                 fmt::format("[m] results in {} subdomains along {}, but a lattice [{}, {}, {}] (0: any number up to "
                             "{}) cannot have one subdomain for each of {} ranks; {}",
                             wanted[a], "xyz"[a], wanted[0], wanted[1], wanted[2], contact::kMaxSubdomainsAnAxis, ranks,
                             kRemedy));
  if (scene.parallel.subdomains)
    scene.fail("parallel", "subdomains",
               fmt::format("does not result in {} subdomains, one per rank; {}", ranks, kRemedy));
  throw base::InputError(fmt::format("{}: {} ranks cannot be arranged in a lattice with at most {} subdomains along "
                                     "each axis; use a different number of ranks (mpirun -np)",
                                     scene.file.string(), ranks, contact::kMaxSubdomainsAnAxis));
}

} // namespace grouser::setup
