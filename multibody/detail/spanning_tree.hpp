// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace grouser::multibody::detail {

/// A constraint as an edge of the graph.
struct ConstraintEdge {
  std::vector<int> bodies; ///< that it acts on, movable ones by index; -1 is the world
  /// May be a joint of the tree: acts on two bodies, with three rows that are pure forces and three pure torques on B.
  bool joint = false;
  unsigned hard = 0;      ///< rows that always hold (bit mask)
  unsigned rows = 0x3fu;  ///< rows that may be in use at some time
  unsigned forceRows = 7; ///< of a joint: which three rows are forces
};

/// Spanning tree of a mechanism: each body has one joint to its parent; the other constraints close loops. The top of a
/// loop constraint is the nearest common ancestor of its bodies, which may be one of them.
struct SpanningTree {
  struct Link {
    int parent = -1; ///< body; -1 is the world or, without a joint, nothing
    int joint = -1;  ///< constraint; -1: the body is free
    int depth = 0;
  };
  struct Loop {
    int constraint = 0;
    int top = -1;                ///< body; -1: the world, or common root of several trees
    std::vector<int> path;       ///< bodies between its own and the top, its own included, the top not
    std::vector<int> neighbours; ///< coupled loops later in the order
  };
  std::vector<Link> links; ///< one per body
  std::vector<Loop> loops; ///< in the order of elimination: those with the deepest tops first
  int independent = 0;     ///< unconnected parts of the mechanism
};

/// The tree is searched breadth first, from the world, then from the body with the most joints of what is left (among
/// equals the farthest from the joint with the fewest rows), so that paths are short and weak joints close the loops.
SpanningTree findSpanningTree(int bodies, const std::vector<ConstraintEdge>& edges);

} // namespace grouser::multibody::detail
