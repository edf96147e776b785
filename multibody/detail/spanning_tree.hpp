// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace grouser::multibody::detail {

/// Constraint as an edge of the graph.
struct ConstraintEdge {
  std::vector<int> bodies; ///< bodies it acts on: indices of movable bodies; -1 is the world
  /// True if eligible as a tree joint: acts on two bodies, with three pure force rows and three pure torque rows on B.
  bool joint = false;
  unsigned hard = 0;      ///< bit mask of permanently active rows
  unsigned rows = 0x3fu;  ///< bit mask of rows that may be active at any time
  unsigned forceRows = 7; ///< for a joint, its three force rows (bit mask)
};

/// Spanning tree of a mechanism: each body has one joint to its parent; the other constraints close loops. The top of a
/// loop constraint is the nearest common ancestor of its bodies, and may be one of these bodies.
struct SpanningTree {
  struct Link {
    int parent = -1; ///< body; -1: the world, or no parent (free body)
    int joint = -1;  ///< constraint; -1: the body is free
    int depth = 0;
  };
  struct Loop {
    int constraint = 0;
    int top = -1;                ///< body; -1: the world, or common root of several trees
    std::vector<int> path;       ///< bodies from those of the constraint (included) up to the top (excluded)
    std::vector<int> neighbours; ///< coupled loops later in the order
  };
  std::vector<Link> links; ///< one per body
  std::vector<Loop> loops; ///< loops in elimination order: deepest tops first
  int independent = 0;     ///< number of unconnected parts of the mechanism
};

/// Finds the tree by breadth-first search from the world, then from the remaining body with the most joints (among
/// equals, the farthest from the joint with the fewest rows), so that paths are short and weak joints close the loops.
SpanningTree findSpanningTree(int bodies, const std::vector<ConstraintEdge>& edges);

} // namespace grouser::multibody::detail
