// SPDX-License-Identifier: BSD-3-Clause
// Symbolic phase of the elimination: batches, columns, and the order of operations.
#include "multibody/detail/elimination.hpp"

#include "multibody/detail/index.hpp"

#include <algorithm>
#include <cstddef>
#include <tuple>

namespace grouser::multibody::detail {

namespace {

std::vector<int> bitsOf(unsigned mask) {
  std::vector<int> bits;
  for (int r = 0; r < 6; ++r)
    if (mask >> r & 1u) bits.push_back(r);
  return bits;
}

} // namespace

Elimination::Elimination(int bodies, const std::vector<ConstraintEdge>& edges)
    : bodies_(bodies), tree_(findSpanningTree(bodies, edges)), placeOfBody_(at(bodies)), placeOfJoint_(edges.size()),
      loopOf_(edges.size(), -1), sideOf_(edges.size(), 0), kept_(edges.size(), 0x3fu), columnsOf_(at(bodies)) {
  for (int z = 0; z < static_cast<int>(tree_.loops.size()); ++z) {
    const SpanningTree::Loop& loop = tree_.loops[at(z)];
    loopOf_[at(loop.constraint)] = z;
    for (const int b : loop.path)
      for (const int r : bitsOf(edges[at(loop.constraint)].rows)) columnsOf_[at(b)].emplace_back(z, r);
  }
  makeBatches(edges);
  makeColumns();
  makeLoops(edges);
  makeProgram();
}

/// Batches of up to four bodies with equal depth, joint kind and number of columns, sorted by parent, so that equal
/// branches use the same lanes.
void Elimination::makeBatches(const std::vector<ConstraintEdge>& edges) {
  int deepest = 0;
  for (const auto& link : tree_.links) deepest = std::max(deepest, link.depth);
  std::vector<std::vector<int>> level(at(deepest + 1));
  for (int b = 0; b < bodies_; ++b) level[at(tree_.links[at(b)].depth)].push_back(b);

  for (std::vector<int>& bodies : level) {
    const auto key = [&](int b) {
      const SpanningTree::Link& link = tree_.links[at(b)];
      const ConstraintEdge* edge = link.joint >= 0 ? &edges[at(link.joint)] : nullptr;
      const Place parent = link.parent >= 0 ? placeOfBody_[at(link.parent)] : Place{};
      return std::make_tuple(edge ? edge->hard : 0u, edge ? edge->forceRows : 0u, columnsOf_[at(b)].size(),
                             parent.batch, parent.lane, b);
    };
    const auto alike = [&](int a, int b) {
      const auto ka = key(a), kb = key(b);
      return std::get<0>(ka) == std::get<0>(kb) && std::get<1>(ka) == std::get<1>(kb) &&
             std::get<2>(ka) == std::get<2>(kb);
    };
    std::sort(bodies.begin(), bodies.end(), [&](int a, int b) { return key(a) < key(b); });
    for (std::size_t first = 0; first < bodies.size();) {
      std::size_t end = first + 1;
      while (end < bodies.size() && end - first < kLanes && alike(bodies[first], bodies[end])) ++end;
      addBatch({bodies.begin() + static_cast<std::ptrdiff_t>(first), bodies.begin() + static_cast<std::ptrdiff_t>(end)},
               edges);
      first = end;
    }
  }
  // A body without a joint moves along and about the world axes.
  for (Links& links : links_)
    for (int i = 0; i < 6; ++i) {
      links.free[i] = all(1), links.inverseCompliance[i] = all(0);
      for (int j = 0; j < 6; ++j) links.s[i][j] = all(links.joint[0] < 0 && i == j ? 1 : 0);
    }
}

/// Adds a batch of up to four similar bodies.
void Elimination::addBatch(const std::vector<int>& bodies, const std::vector<ConstraintEdge>& edges) {
  Links links;
  const int batch = static_cast<int>(links_.size());
  for (const int b : bodies) {
    const SpanningTree::Link& link = tree_.links[at(b)];
    const auto lane = at(links.count);
    links.body[lane] = b;
    links.joint[lane] = link.joint;
    links.parentNode[lane] = link.parent;
    const Place parent = link.parent >= 0 ? placeOfBody_[at(link.parent)] : Place{};
    links.parentBatch[lane] = parent.batch, links.parentLane[lane] = parent.lane;
    placeOfBody_[at(b)] = {batch, links.count};
    if (link.joint >= 0) {
      placeOfJoint_[at(link.joint)] = {batch, links.count};
      sideOf_[at(link.joint)] = edges[at(link.joint)].bodies[1] == b ? 1 : -1;
    }
    ++links.count;
  }
  // Idle lanes repeat the first lane; their results are not used.
  for (int lane = links.count; lane < kLanes; ++lane) {
    links.body[at(lane)] = links.body[0], links.joint[at(lane)] = links.joint[0];
    links.parentNode[at(lane)] = links.parentNode[0];
    links.parentBatch[at(lane)] = links.parentLane[at(lane)] = -1;
  }
  links.columns = static_cast<int>(columnsOf_[at(links.body[0])].size());
  std::vector<int> freeRows{0, 1, 2, 3, 4, 5};
  if (links.joint[0] >= 0) {
    const ConstraintEdge& edge = edges[at(links.joint[0])];
    const std::vector<int> forces = bitsOf(edge.forceRows), torques = bitsOf(0x3fu & ~edge.forceRows);
    std::copy(forces.begin(), forces.end(), links.forceRow.begin());
    std::copy(torques.begin(), torques.end(), links.torqueRow.begin());
    freeRows = bitsOf(0x3fu & ~edge.hard);
  }
  std::copy(freeRows.begin(), freeRows.end(), links.freeRow.begin());
  links.freedoms = static_cast<int>(freeRows.size());
  links_.push_back(links);
}

void Elimination::makeColumns() {
  for (Links& links : links_) {
    links.firstColumn = columns_.size();
    for (int c = 0; c < links.columns; ++c) {
      Column column;
      for (int lane = 0; lane < kLanes; ++lane) {
        const auto [z, r] = columnsOf_[at(links.body[at(lane)])][at(c)];
        column.node[at(lane)] = bodies_ + tree_.loops[at(z)].constraint;
        column.rowOf[at(lane)] = r;
      }
      columns_.push_back(column);
    }
  }
}

/// L of one row of a loop constraint at a body of its path, or at its top.
Elimination::Onward Elimination::columnAt(int body, int loop, int row) {
  if (body < 0) return {};
  if (body == loops_[at(loop)].top) return {&loops_[at(loop)].atTop[at(kStride * row)], 1};
  const auto& columns = columnsOf_[at(body)];
  const auto found = std::find(columns.begin(), columns.end(), std::make_pair(loop, row));
  const Place place = placeOfBody_[at(body)];
  Column& column = columns_[links_[at(place.batch)].firstColumn + static_cast<std::size_t>(found - columns.begin())];
  return {reinterpret_cast<double*>(column.l) + place.lane, kLanes};
}

int Elimination::slotOf(int later, int earlier) const {
  const Loop& z = loops_[at(earlier)];
  const auto found = std::find(z.neighbours.begin(), z.neighbours.end(), later);
  return z.slots[static_cast<std::size_t>(found - z.neighbours.begin())];
}

void Elimination::makeLoops(const std::vector<ConstraintEdge>& edges) {
  int slots = 0;
  for (const SpanningTree::Loop& loop : tree_.loops) {
    Loop z;
    z.constraint = loop.constraint;
    z.top = loop.top;
    z.bodies = edges[at(loop.constraint)].bodies;
    z.jacobians.resize(z.bodies.size());
    z.neighbours = loop.neighbours;
    for (std::size_t i = 0; i < z.neighbours.size(); ++i) z.slots.push_back(slots++);
    loops_.push_back(std::move(z));
  }
  diagonal_.assign(loops_.size(), Block{});
  w_.assign(at(slots), Block{});
  v_.assign(at(slots), Block{});

  // Addresses are set last, when the arrays are no longer reallocated.
  for (int index = 0; index < static_cast<int>(loops_.size()); ++index) {
    Loop& z = loops_[at(index)];
    for (const int b : z.bodies) {
      z.entries.emplace_back();
      for (const int r : bitsOf(edges[at(z.constraint)].rows)) z.entries.back()[at(r)] = columnAt(b, index, r);
    }
    for (const int later : z.neighbours) {
      z.onto.emplace_back();
      for (const int r : bitsOf(edges[at(loops_[at(later)].constraint)].rows))
        z.onto.back()[at(r)] = columnAt(z.top, later, r);
    }
  }
  for (Links& links : links_) {
    links.aligned = parentsAligned(links);
    linkColumns(links);
  }
}

/// True if the parents of a batch are the lanes of one batch, in order.
bool Elimination::parentsAligned(const Links& links) const {
  bool aligned = links.parentBatch[0] >= 0;
  for (int lane = 0; lane < links.count; ++lane)
    aligned = aligned && links.parentBatch[at(lane)] == links.parentBatch[0] && links.parentLane[at(lane)] == lane;
  return aligned && (links.count == kLanes || links.count == links_[at(links.parentBatch[0])].count);
}

/// Sets the targets of a batch's columns and of their products.
void Elimination::linkColumns(Links& links) {
  links.firstPair = pairs_.size();
  Column* const columns = columns_.data() + links.firstColumn;
  for (int c = 0; c < links.columns; ++c) {
    for (int lane = 0; lane < links.count; ++lane) {
      const auto [z, r] = columnsOf_[at(links.body[at(lane)])][at(c)];
      columns[c].onward[at(lane)] = columnAt(links.parentNode[at(lane)], z, r);
      if (!links.aligned) continue;
      const Links& parent = links_[at(links.parentBatch[0])];
      links.aligned =
          c < parent.columns &&
          columns[c].onward[at(lane)].entry == reinterpret_cast<double*>(columns_[parent.firstColumn + at(c)].l) + lane;
    }
    for (int other = 0; other <= c; ++other)
      for (int lane = 0; lane < kLanes; ++lane)
        pairs_.push_back(lane < links.count ? productOf(links.body[at(lane)], c, other) : nullptr);
  }
}

/// Entry of the loop matrix for the product of two columns of a body.
double* Elimination::productOf(int body, int column, int other) {
  const auto entry = [](Block& block, int row, int col) { return &block[at(kStride * col + row)]; };
  auto [z1, r1] = columnsOf_[at(body)][at(column)];
  auto [z2, r2] = columnsOf_[at(body)][at(other)];
  if (z1 < z2) std::swap(z1, z2), std::swap(r1, r2);
  return z1 == z2 ? entry(diagonal_[at(z1)], std::max(r1, r2), std::min(r1, r2))
                  : entry(w_[at(slotOf(z1, z2))], r1, r2);
}

/// Order of elimination: leaves first; a loop constraint after everything below its top, and before the top.
void Elimination::makeProgram() {
  std::size_t next = 0;
  const auto depthOfTop = [&](const Loop& z) { return z.top < 0 ? -1 : tree_.links[at(z.top)].depth; };
  for (int b = static_cast<int>(links_.size()) - 1; b >= 0; --b) {
    const int depth = tree_.links[at(links_[at(b)].body[0])].depth;
    while (next < loops_.size() && depthOfTop(loops_[next]) >= depth)
      program_.push_back({true, static_cast<int>(next++)});
    program_.push_back({false, b});
  }
  while (next < loops_.size()) program_.push_back({true, static_cast<int>(next++)});
}

long Elimination::multiplications() const {
  long sum = 0;
  for (const Links& links : links_) {
    const int f = links.freedoms, c = links.columns;
    // Factor: directions and shift, rank-one terms, columns. Solution: forward and backward.
    const int factor = 60 + f * (36 + 6 + 6 + 21) + c * (f * 12 + 6) + f * c * (c + 1) / 2;
    const int solution = 2 * (36 + 6 + 9) + f * 24 + c * (12 + 2 * f);
    sum += static_cast<long>(links.count) * (factor + solution);
  }
  for (const Loop& z : loops_) {
    const long n = static_cast<long>(z.neighbours.size()) + (z.top >= 0);
    sum += 56 + n * 126 + n * (n + 1) / 2 * 216 + 30 + n * 72;
  }
  return sum;
}

} // namespace grouser::multibody::detail
