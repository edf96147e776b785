// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/image.hpp"
#include "runs/output.hpp"

namespace grouser::runs {

/// A frame as one looks at it: grains coloured by height, parts by kind, the vehicle filling the picture, or where
/// there is none all grains but a few strays; seen from the front right above. Height of the picture: nine sixteenths
/// of its width.
Image drawFrame(const Frame& frame, const std::vector<FramePart>& parts, const base::TriangleMesh& ground, int width);

} // namespace grouser::runs
