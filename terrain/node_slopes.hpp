// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/node_weights.hpp"

#include <vector>

namespace grouser::terrain {

/// Returns node slopes for a surface with continuous normals that stays, in each cell, between the minimum and
/// maximum of its four nodes. Along each axis: the harmonic mean of the slopes to both neighbours, 0 at extrema
/// (Fritsch and Butland 1984); the mixed derivative is that of Catmull-Rom. If a point of the Bezier net of one of the
/// four cells around a node would leave the range of that cell's nodes, the mixed derivative is moved, and if
/// necessary all slopes of the node are scaled down. Exact on planes. The mean order of convergence is 2.6 on smooth
/// ground and 1.7 at extrema, since the surface is flat at the highest or lowest node.
std::vector<NodeSlopes> monotoneSlopes(const std::vector<double>& heights, int columns, int rows);

/// True if all nodes are in one plane, to rounding.
bool isPlane(const std::vector<double>& heights, int columns, int rows);

} // namespace grouser::terrain
