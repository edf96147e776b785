// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scm/soil_map.hpp"

#include <vector>

namespace grouser::scm {

/// Node in contact in this step. Loose soil carries the load until the pressure of the firm soil below is higher; then
/// the loose soil counts as compacted into the firm soil. `offset` is the depth at which the layer's sinkage begins.
struct LoadedNode {
  Node* node{};
  double deepest{};  ///< maximum depth of the bodies below the undisturbed surface, along its normal [m]
  double modulus{};  ///< maximum k of the bodies [N/m^(n+2)]
  Compaction before; ///< state of the loaded layer before the step
  double offset{};   ///< depth minus sinkage of the layer [m]
  bool onLoose{};    ///< the loaded layer is the loose soil
  bool yields{};     ///< true: virgin loading of the layer
  double slip{};     ///< maximum shear displacement in the step [m]
  double share{};    ///< share of the node's square under bodies [-]

  const Compaction& state() const { return onLoose ? node->loose : node->state; }
};

/// Nodes in contact in a step. Bodies add their nodes; then advance() updates the soil once for all bodies.
class LoadedNodes {
public:
  /// `displaced`: fraction of the sunk volume that is displaced sideways [-].
  LoadedNodes(const SoilConstants& soil, double deepest, double displaced)
      : soil_(soil), curve_(soil.exponent, deepest), displaced_(displaced) {}

  const SoilConstants& soil() const { return soil_; }
  const PressureCurve& curve() const { return curve_; }
  const LoadedNode& operator[](int index) const { return nodes_[static_cast<std::size_t>(index)]; }

  /// Adds a node, or another body to it, and returns its index. `depth`: as LoadedNode::deepest [m]. `share`: share of
  /// the node's square that sinks; tracks sink whole squares.
  int add(Node& node, double depth, double modulus, double share = 1) {
    if (node.touched < 0) {
      node.touched = static_cast<int>(nodes_.size());
      nodes_.push_back({&node, depth, modulus, {}, 0, false, false, 0, share});
    } else {
      LoadedNode& t = nodes_[static_cast<std::size_t>(node.touched)];
      t.deepest = std::max(t.deepest, depth), t.modulus = std::max(t.modulus, modulus);
      t.share = std::min(1.0, t.share + share);
    }
    return node.touched;
  }
  /// Selects the loaded layer of each node and compresses it.
  void advance();
  /// Records a shear displacement under a body [m].
  void slip(int index, double displacement) {
    LoadedNode& t = nodes_[static_cast<std::size_t>(index)];
    t.slip = std::max(t.slip, displacement);
  }
  /// Lowers the firm soil by the slip sinkage due to the shear displacements at constant pressure, and ends the step.
  void finish();

private:
  /// Updates Node::spared after a node sank by `more`; returns the mean sinkage of its square [m], along the normal.
  static double sunkShare(Node& node, double share, double more);

  SoilConstants soil_;
  PressureCurve curve_;
  double displaced_;
  std::vector<LoadedNode> nodes_;
};

} // namespace grouser::scm
