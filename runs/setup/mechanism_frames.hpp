// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "runs/scene/mechanism_structs.hpp"

namespace grouser::setup {

/// Where the two frames of a joint stand in the world at the start: that of its first and that of its second body.
struct JointFrames {
  base::Pose A, B;
};

/// From what a section says in the world, or in the bodies; then the two must meet. Throws SectionFault.
JointFrames placeJoint(const scene::JointSection& joint, const base::Pose& X_WA, const base::Pose& X_WB);

} // namespace grouser::setup
