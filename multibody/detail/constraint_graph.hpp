// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint.hpp"
#include "multibody/detail/spanning_tree.hpp"
#include "multibody/model.hpp"

#include <string>
#include <vector>

namespace grouser::multibody::detail {

/// Axis row, on which springs, dampers, drives and couplings act.
struct Axis {
  int constraint;
  int row;
};

/// Couples axis 2 to axis 1: x_2 - ratio x_1 - offset = 0. The row acts on the bodies of both axes.
struct CouplingRow {
  int axis1, axis2;
  double ratio, offset;
};

/// Constant topology of a mechanism: movable bodies, constraints, axes, couplings, and their indices.
///
/// Nodes are numbered in the order movable bodies, constraints, couplings.
class ConstraintGraph {
public:
  explicit ConstraintGraph(const Model& model);

  const Model& model() const { return *model_; }
  const std::vector<Constraint>& constraints() const { return constraints_; }
  int movableBodies() const { return static_cast<int>(movable_.size()); }
  int bodyOf(int node) const { return movable_[static_cast<std::size_t>(node)]; } ///< model index of a movable body

  /// Independent part: bodies connected by constraints, springs or couplings.
  struct Part {
    int index = 0;
    std::vector<int> bodies; ///< movable bodies (nodes)
    std::vector<int> constraints;
    std::vector<int> couplings;
  };
  const std::vector<Part>& parts() const { return parts_; }

  /// Axis rows in the order of the constraints; constraint k has the rows firstAxis(k) to firstAxis(k + 1) - 1.
  const std::vector<Axis>& axes() const { return axes_; }
  int firstAxis(int constraint) const { return firstAxis_[static_cast<std::size_t>(constraint)]; }
  /// Index of an axis of a joint.
  int axisOf(int joint, JointAxis axis) const;
  const std::vector<CouplingRow>& couplings() const { return couplings_; }
  int couplingNode(int coupling) const { return movableBodies() + static_cast<int>(constraints_.size()) + coupling; }
  int nodes() const { return couplingNode(static_cast<int>(couplings_.size())); }

  /// Constraints as edges between the movable bodies.
  std::vector<ConstraintEdge> edges() const;

  /// Frames of all bodies at `poses`, the world last.
  void place(const std::vector<Pose>& poses, std::vector<Frame>& frames) const;
  void placeBody(int body, const Pose& pose, std::vector<Frame>& frames) const;
  /// Frames at the poses of the model.
  std::vector<Frame> framesOfModel() const;
  /// Position along an axis row [m, rad] for bodies at `frames`.
  double positionOfAxis(int axis, const std::vector<Frame>& frames) const;

  /// Name of a constraint row for messages: "joint 'pin 7': rotation about x".
  std::string describe(int constraint, int row) const;
  /// Name of a constraint for messages: "joint 'pin 7'".
  std::string describe(int constraint) const;

private:
  std::vector<int> nodesOfBodies();
  void addConstraints(const std::vector<int>& nodeOf);
  void setOffsets();

  const Model* model_;
  std::vector<int> movable_;
  std::vector<Constraint> constraints_;
  std::vector<Part> parts_;
  std::vector<Axis> axes_;
  std::vector<int> firstAxis_;
  std::vector<CouplingRow> couplings_;
};

} // namespace grouser::multibody::detail
