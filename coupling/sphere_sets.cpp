// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/sphere_sets.hpp"

namespace grouser::coupling {

namespace {

/// Broadcasts the set of rank `root` to all ranks.
base::SphereSet shared(const base::Comm& comm, base::SphereSet set, int root) {
  if (comm.alone()) return set;
  const base::Bytes mine = base::Comm::bytesOf(std::vector{base::figuresOf(set)});
  setFigures(set, base::Comm::valuesOf<base::SphereSetFigures>(comm.broadcast(mine, root)).front());
  set.spheres = base::Comm::valuesOf<base::SetSphere>(comm.broadcast(base::Comm::bytesOf(set.spheres), root));
  set.name = comm.broadcast(set.name, root);
  return set;
}

} // namespace

base::SphereSet cutPart(const PartCut& part, spheredecomp::Protrusion& protrusion) {
  if (!part.limit) return spheredecomp::decompose(*part.mesh, part.name, part.options);
  base::SphereSet set = spheredecomp::decomposeWithin(*part.mesh, part.place.empty() ? part.name : part.place,
                                                      part.options, *part.limit, protrusion);
  set.name = part.name;
  return set;
}

std::vector<base::SphereSet> cutParts(const std::vector<PartCut>& parts, SphereSets* kept, const base::Comm& comm,
                                      std::vector<spheredecomp::CutReport>* reports) {
  const auto cutterOf = [&](std::size_t i) { return static_cast<int>(i % static_cast<std::size_t>(comm.size())); };
  std::vector<base::SphereSet> sets(parts.size());
  std::vector<spheredecomp::Protrusion> protrusions(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const PartCut& p = parts[i];
    if (cutterOf(i) == comm.rank()) sets[i] = kept ? kept->cut(p, &protrusions[i]) : cutPart(p, protrusions[i]);
  }
  for (std::size_t i = 0; i < sets.size(); ++i) sets[i] = shared(comm, std::move(sets[i]), cutterOf(i));
  if (!reports) return sets;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    if (!parts[i].limit) continue;
    const base::Bytes mine = base::Comm::bytesOf(std::vector{protrusions[i]});
    const auto protrusion =
        comm.alone() ? protrusions[i]
                     : base::Comm::valuesOf<spheredecomp::Protrusion>(comm.broadcast(mine, cutterOf(i))).front();
    reports->push_back(
        {parts[i].name, parts[i].key, sets[i].radius, sets[i].spheres.size(), protrusion, *parts[i].limit});
  }
  return sets;
}

} // namespace grouser::coupling
