// SPDX-License-Identifier: BSD-3-Clause
#include "scm/soil_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::scm {

SoilContacts::SoilContacts(const SoilConstants& soil, double deepest, const Displacement& displacement, SoilMap& map,
                           std::vector<Pad> pads, std::vector<Solid> solids, double timeStep)
    : map_(map), timeStep_(timeStep),
      interval_(displacement.share > 0 ? std::max<std::int64_t>(1, std::llround(displacement.interval / timeStep)) : 0),
      loaded_(soil, deepest, displacement.share), pads_(map, loaded_, std::move(pads)),
      bodies_(map, loaded_, std::move(solids)), berms_(map, displacement.repose) {}

void SoilContacts::step(const contact::PartMotion* motion) {
  pads_.gather(motion), bodies_.gather(motion);
  loaded_.advance();
  energy_.elastic = energy_.elasticShear = 0;
  pads_.press(motion, timeStep_, energy_), bodies_.press(motion, timeStep_, energy_);
  ++steps_;
  if (interval_ > 0 && steps_ % interval_ == 0) {
    const auto deposit = [&](Node& node, double x, double y, double dx, double dy) {
      berms_.deposit(node, x, y, dx, dy);
    };
    pads_.pushAside(deposit), bodies_.pushAside(deposit);
    berms_.slide();
  }
  loaded_.finish();
}

namespace {

void stream(NumberStream& numbers, SoilEnergy& e) {
  numbers(e.elastic, e.elasticShear, e.compaction, e.shear, e.slipSinkage, e.damping, e.edges, e.coupling);
}
void stream(NumberStream& numbers, Node& node, bool underBodies) {
  for (Compaction* c : {&node.state, &node.loose}) numbers(c->sinkage, c->pressure, c->stiffness, c->modulus);
  numbers(node.slipSinkage, node.looseQuanta, node.displaced);
  if (underBodies) numbers(node.spared);
}

} // namespace

std::vector<double> SoilContacts::save() const {
  std::vector<double> saved;
  NumberStream numbers(saved);
  std::size_t pads = pads_.pads().size(), bodies = bodies_.solids().size(), nodes = 0;
  std::int64_t steps = steps_;
  SoilEnergy energy = energy_;
  map_.forEach([&](std::int32_t, std::int32_t, const Node& node) { nodes += node.isLoaded(); });
  numbers(pads, bodies, nodes, steps), stream(numbers, energy);
  map_.forEach([&](std::int32_t i, std::int32_t j, Node node) {
    if (node.isLoaded()) numbers(i, j), stream(numbers, node, bodies > 0);
  });
  pads_.save(numbers), bodies_.save(numbers), berms_.save(numbers);
  return saved;
}

bool SoilContacts::restore(const std::vector<double>& saved) {
  NumberStream numbers(saved);
  std::size_t pads = 0, bodies = 0, nodes = 0;
  numbers(pads, bodies, nodes, steps_), stream(numbers, energy_);
  if (pads != pads_.pads().size() || bodies != bodies_.solids().size()) return false;
  for (std::size_t n = 0; n < nodes && !numbers.isShort(); ++n) {
    std::int32_t i = 0, j = 0;
    numbers(i, j);
    stream(numbers, map_.at(i, j), bodies > 0);
    map_.addLoose(map_.at(i, j), 0);
  }
  pads_.restore(numbers), bodies_.restore(numbers), berms_.restore(numbers);
  return !numbers.isShort() && numbers.isAtEnd();
}

} // namespace grouser::scm
