// SPDX-License-Identifier: BSD-3-Clause
#include "contact/cell_grid.hpp"

#include <algorithm>

namespace grouser::contact {

void CellGrid::setEdge(std::int64_t least) {
  for (int a = 0; a < 3; ++a) {
    edge[a] = least;
    if (!period.along(a)) continue;
    const std::int64_t ring = std::max<std::int64_t>(3, period.length[a] / least);
    edge[a] = period.length[a] / ring, cells[a] = static_cast<std::uint32_t>(ring), low[a] = 0;
  }
}

} // namespace grouser::contact
