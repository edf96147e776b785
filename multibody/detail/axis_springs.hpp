// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/detail/constraint_system.hpp"
#include "multibody/state.hpp"

#include <cstddef>

namespace grouser::multibody::detail {

/// A spring with a damper along an axis at position x: F = load - stiffness (x - rest) - damping x'.
struct LinearSpring {
  double load = 0, stiffness = 0, rest = 0, damping = 0;
};

/// Returns the model's spring at a joint axis, without its end stops.
inline LinearSpring linearSpring(const AxisSpring& spring, const SpringControl& control) {
  return {control.loadFactor * spring.preload, control.stiffnessFactor * spring.stiffness, spring.freePosition,
          spring.damping};
}

/// Damping of the element that owns an axis row: joint, point spring or bushing component.
inline double ownDamping(const ConstraintSystem& system, const Model& model, const Axis& axis) {
  const Constraint& c = system.constraints()[static_cast<std::size_t>(axis.constraint)];
  const auto source = static_cast<std::size_t>(c.source);
  if (c.kind == ConstraintKind::kPointSpring) return model.pointSprings()[source].damping;
  if (c.kind == ConstraintKind::kBushing) {
    const Bushing& bushing = model.bushings()[source];
    return (axis.row < 3 ? bushing.damping : bushing.rotationDamping)[axis.row % 3];
  }
  const Joint& joint = model.joints()[source];
  return c.kind == ConstraintKind::kCylindrical && axis.row == kSlideRow ? joint.slideDamping : joint.damping;
}

/// Spring of the element that owns an axis row; for a joint, only its damper.
inline LinearSpring ownSpring(const ConstraintSystem& system, const Model& model, const Loads& loads,
                              const Axis& axis) {
  const Constraint& c = system.constraints()[static_cast<std::size_t>(axis.constraint)];
  const auto source = static_cast<std::size_t>(c.source);
  LinearSpring own;
  own.damping = ownDamping(system, model, axis);
  if (c.kind == ConstraintKind::kPointSpring) {
    const PointSpring& spring = model.pointSprings()[source];
    const SpringControl& control = loads.pointSprings[source];
    own.load = control.loadFactor * spring.preload, own.rest = spring.restLength;
    own.stiffness = control.stiffnessFactor * spring.stiffness;
  } else if (c.kind == ConstraintKind::kBushing) {
    const Bushing& bushing = model.bushings()[source];
    own.stiffness = loads.bushings[source].stiffnessFactor *
                    (axis.row < 3 ? bushing.stiffness : bushing.rotationStiffness)[axis.row % 3];
  }
  return own;
}

} // namespace grouser::multibody::detail
