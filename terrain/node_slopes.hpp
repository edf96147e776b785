// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/node_weights.hpp"

#include <vector>

namespace grouser::terrain {

/// Slopes of the nodes for a surface with continuous normals that stays, in each cell, between the lowest and the
/// highest of its four nodes. Along each axis the harmonic mean of the slopes to both neighbours, 0 at extrema (Fritsch
/// and Butland 1984); the mixed derivative is that of Catmull-Rom. Where a point of the Bezier net of one of the four
/// cells around a node would leave the range of that cell's nodes, the mixed derivative is moved, and if that is not
/// enough all slopes of the node are scaled down. Exact on planes. On smooth ground of order 2.6 in the mean; at
/// extrema, which come out flat at the highest or lowest node, of order 1.7.
std::vector<NodeSlopes> monotoneSlopes(const std::vector<double>& heights, int columns, int rows);

/// Whether all nodes lie in one plane, to rounding.
bool isPlane(const std::vector<double>& heights, int columns, int rows);

} // namespace grouser::terrain
