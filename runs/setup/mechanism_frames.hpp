// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "runs/scene/mechanism_structs.hpp"

namespace grouser::setup {

/// Initial frames of a joint in the world, of its first and of its second body.
struct JointFrames {
  base::Pose A, B;
};

/// Frames from keys in the world, or from keys in the bodies, which must coincide. Throws SectionFault.
JointFrames placeJoint(const scene::JointSection& joint, const base::Pose& X_WA, const base::Pose& X_WB);

} // namespace grouser::setup
