// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "runs/scene.hpp"

namespace grouser::runs {

/// Throws base::InputError, naming the rank and what differs, where the ranks run other programs or other scenes than
/// the first one: the promise of one answer holds for one program and one scene.
void requireAlike(const Scene& scene, const base::Comm& comm);

} // namespace grouser::runs
