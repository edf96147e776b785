// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace grouser::multibody::detail {

/// A constraint as the graph sees it.
struct ConstraintEdge {
  std::vector<int> bodies; ///< that it acts on, movable ones by index; -1 is the world
  /// May be a joint of the tree: acts on two bodies, with three rows that are pure forces and three pure torques on B.
  bool joint = false;
  unsigned hard = 0;      ///< rows that always hold (bit mask)
  unsigned rows = 0x3fu;  ///< rows that may be in use at some time
  unsigned forceRows = 7; ///< of a joint: which three rows are forces
};

/// How a mechanism is taken apart: each body hangs on its parent by one joint of a spanning tree; the constraints that
/// are left close loops. A loop constraint's top is the nearest body that all its bodies hang on, itself included.
struct SpanningTree {
  struct Link {
    int parent = -1; ///< body; -1 is the world or, without a joint, nothing
    int joint = -1;  ///< constraint; -1: the body is free
    int depth = 0;
  };
  struct Loop {
    int constraint = 0;
    int top = -1;                ///< body; -1 is the world, and what holds free bodies of several trees together
    std::vector<int> path;       ///< bodies between its own and the top, its own included, the top not
    std::vector<int> neighbours; ///< loops of a later place in the order that it is coupled with
  };
  std::vector<Link> links; ///< one a body
  std::vector<Loop> loops; ///< in the order of elimination: those with the deepest tops first
  int independent = 0;     ///< parts of the mechanism that nothing joins
};

/// The tree is searched breadth first, from the world, then from the body with the most joints of what is left (among
/// equals the farthest from the joint with the fewest rows), so that paths are short and weak joints close the loops.
SpanningTree findSpanningTree(int bodies, const std::vector<ConstraintEdge>& edges);

} // namespace grouser::multibody::detail
