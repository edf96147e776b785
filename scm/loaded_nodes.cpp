// SPDX-License-Identifier: BSD-3-Clause
#include "scm/loaded_nodes.hpp"

namespace grouser::scm {

namespace {

/// Pressure of a layer at a sinkage, before the step [Pa].
double trialPressure(const Compaction& state, const PressureCurve& curve, double modulus, double sinkage) {
  if (!(sinkage > 0)) return 0;
  return sinkage <= state.sinkage ? state.pressureAt(sinkage) : std::max(modulus, state.modulus) * curve.at(sinkage);
}

} // namespace

void LoadedNodes::advance() {
  for (LoadedNode& t : nodes_) {
    Node& node = *t.node;
    t.offset = node.slipSinkage;
    if (node.looseQuanta > 0) {
      const double offset = node.firmDepth() - node.looseThickness() * node.cosine;
      const double firm = trialPressure(node.state, curve_, t.modulus, t.deepest - node.slipSinkage);
      if (firm > trialPressure(node.loose, curve_, t.modulus, t.deepest - offset))
        node.looseQuanta = 0, node.loose = {};
      else
        t.onLoose = true, t.offset = offset;
    }
    Compaction& layer = t.onLoose ? node.loose : node.state;
    t.before = layer;
    const double sinkage = t.deepest - t.offset;
    t.yields = sinkage > layer.sinkage;
    const double rebound = layer.rebound();
    if (t.yields) compress(layer, soil_, curve_, t.modulus, rebound, sinkage);
    if (!t.onLoose && sinkage > rebound)
      node.displaced += displaced_ * sunkShare(node, t.share, layer.rebound() - rebound) / node.cosine;
  }
}

double LoadedNodes::sunkShare(Node& node, double share, double more) {
  const double before = node.spared;
  node.spared = std::min(before + (1 - share) * more, (1 - share) * node.firmDepth());
  return more + (before - node.spared);
}

void LoadedNodes::finish() {
  for (const LoadedNode& t : nodes_) {
    Node& node = *t.node;
    node.touched = -1;
    if (t.onLoose || !(t.slip > 0)) continue;
    const double more =
        std::min(soil_.slipSinkage * t.slip, std::max(0.0, soil_.maximumSlipSinkage - node.slipSinkage));
    node.slipSinkage += more;
    node.displaced += displaced_ * sunkShare(node, t.share, more) / node.cosine;
  }
  nodes_.clear();
}

} // namespace grouser::scm
