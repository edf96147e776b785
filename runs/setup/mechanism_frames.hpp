// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "runs/scene/mechanism_structs.hpp"

namespace grouser::setup {

/// Initial frames of a joint on its first and second body, in the world frame.
struct JointFrames {
  base::Pose A, B;
};

/// Frames from keys in the world frame, or from keys in the body frames, which must coincide. Throws SectionFault.
JointFrames placeJoint(const scene::JointSection& joint, const base::Pose& X_WA, const base::Pose& X_WB);

} // namespace grouser::setup
