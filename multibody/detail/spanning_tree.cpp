// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/spanning_tree.hpp"

#include "multibody/detail/index.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <set>
#include <tuple>

namespace grouser::multibody::detail {

namespace {

class Builder {
public:
  Builder(int bodies, const std::vector<ConstraintEdge>& edges) : edges_(edges), jointsOf_(at(bodies)) {
    for (int k = 0; k < static_cast<int>(edges.size()); ++k) {
      const ConstraintEdge& edge = edges[at(k)];
      if (!edge.joint || edge.bodies[0] == edge.bodies[1]) continue;
      for (const int b : edge.bodies)
        if (b >= 0)
          jointsOf_[at(b)].push_back(k);
        else
          worldJoints_.push_back(k);
    }
    result_.links.resize(at(bodies));
    reached_.assign(at(bodies), 0);
  }

  SpanningTree build() {
    std::vector<int> level = reach({}, worldJoints_, 0);
    grow(level);
    for (int root = pickRoot(); root >= 0; root = pickRoot()) {
      reached_[at(root)] = 1;
      grow({root});
    }
    findLoops();
    orderLoops();
    countIndependent();
    return std::move(result_);
  }

private:
  int hardRows(int k) const { return __builtin_popcount(edges_[at(k)].hard); }
  int otherBody(int k, int body) const {
    const auto& b = edges_[at(k)].bodies;
    return b[0] == body ? b[1] : b[0];
  }

  /// Finds unreached bodies connected by `joints` to bodies of `level`, or to the world, each by its strongest joint.
  std::vector<int> reach(const std::vector<int>& level, const std::vector<int>& joints, int depth) {
    std::vector<int> next;
    const auto offer = [&](int k, int parent) {
      const int child = otherBody(k, parent);
      if (child < 0 || reached_[at(child)] == 1) return;
      SpanningTree::Link& link = result_.links[at(child)];
      if (reached_[at(child)] == 0) {
        reached_[at(child)] = 2;
        next.push_back(child);
      } else if (hardRows(k) <= hardRows(link.joint)) {
        return;
      }
      link = {parent, k, depth};
    };
    for (const int k : joints) offer(k, -1);
    for (const int body : level)
      for (const int k : jointsOf_[at(body)]) offer(k, body);
    for (const int child : next) reached_[at(child)] = 1;
    return next;
  }

  void grow(std::vector<int> level) {
    while (!level.empty()) level = reach(level, {}, result_.links[at(level.front())].depth + 1);
  }

  /// Selects an unreached body as root; -1 if there is none.
  int pickRoot() const {
    int most = -1;
    std::vector<int> candidates;
    for (int b = 0; b < static_cast<int>(reached_.size()); ++b) {
      if (reached_[at(b)]) continue;
      const int joints = static_cast<int>(jointsOf_[at(b)].size());
      if (joints > most) most = joints, candidates.clear();
      if (joints == most) candidates.push_back(b);
    }
    if (candidates.size() < 2 || most < 2) return candidates.empty() ? -1 : candidates.front();
    // Compute distances from the joint with the fewest rows in the component of the first candidate.
    std::vector<int> around = component(candidates.front());
    int weakest = jointsOf_[at(candidates.front())].front();
    for (const int b : around)
      for (const int k : jointsOf_[at(b)])
        if (hardRows(k) < hardRows(weakest)) weakest = k;
    const std::vector<int> distance = distancesFrom(edges_[at(weakest)].bodies);
    int best = candidates.front();
    for (const int b : candidates)
      if (distance[at(b)] > distance[at(best)]) best = b;
    return best;
  }

  std::vector<int> component(int body) const {
    const std::vector<int> distance = distancesFrom({body});
    std::vector<int> bodies;
    for (int b = 0; b < static_cast<int>(distance.size()); ++b)
      if (distance[at(b)] >= 0) bodies.push_back(b);
    return bodies;
  }

  /// Distance as a number of joints; -1 if not connected.
  std::vector<int> distancesFrom(const std::vector<int>& bodies) const {
    std::vector<int> distance(reached_.size(), -1), queue;
    for (const int b : bodies)
      if (b >= 0) distance[at(b)] = 0, queue.push_back(b);
    for (std::size_t next = 0; next < queue.size(); ++next)
      for (const int k : jointsOf_[at(queue[next])]) {
        const int b = otherBody(k, queue[next]);
        if (b >= 0 && distance[at(b)] < 0) distance[at(b)] = distance[at(queue[next])] + 1, queue.push_back(b);
      }
    return distance;
  }

  void findLoops() {
    const auto& links = result_.links;
    std::vector<char> inTree(edges_.size(), 0);
    for (const SpanningTree::Link& link : links)
      if (link.joint >= 0) inTree[at(link.joint)] = 1;
    std::vector<int> passes(links.size(), 0);
    for (int k = 0; k < static_cast<int>(edges_.size()); ++k) {
      if (inTree[at(k)]) continue;
      SpanningTree::Loop loop;
      loop.constraint = k;
      const std::set<int> own(edges_[at(k)].bodies.begin(), edges_[at(k)].bodies.end());
      // The top is the first body common to all paths towards the root; the world is common to all paths.
      std::vector<int> met;
      for (const int b : own)
        for (int i = b; i >= 0; i = links[at(i)].parent)
          if (++passes[at(i)] == 1) met.push_back(i);
      const int ends = static_cast<int>(own.size());
      for (const int i : met)
        if (passes[at(i)] == ends && (loop.top < 0 || links[at(i)].depth > links[at(loop.top)].depth)) loop.top = i;
      for (const int i : met)
        if (passes[at(i)] < ends) loop.path.push_back(i);
      for (const int i : met) passes[at(i)] = 0;
      result_.loops.push_back(std::move(loop));
    }
  }

  /// Orders the loops: deepest tops first; among equals, the loop coupled to the fewest others.
  void orderLoops() {
    std::vector<SpanningTree::Loop>& loops = result_.loops;
    std::vector<std::vector<int>> passing(result_.links.size());
    for (int z = 0; z < static_cast<int>(loops.size()); ++z)
      for (const int b : loops[at(z)].path) passing[at(b)].push_back(z);
    std::vector<std::set<int>> neighbours(loops.size());
    for (const auto& group : passing)
      for (const int z : group)
        for (const int other : group)
          if (other != z) neighbours[at(z)].insert(other);

    const auto depthOf = [&](int z) { return loops[at(z)].top < 0 ? -1 : result_.links[at(loops[at(z)].top)].depth; };
    std::set<int> left;
    for (int z = 0; z < static_cast<int>(loops.size()); ++z) left.insert(z);
    std::set<std::tuple<int, std::size_t, int>> queue;
    const auto key = [&](int z) { return std::make_tuple(-depthOf(z), neighbours[at(z)].size(), z); };
    for (const int z : left) queue.insert(key(z));
    std::vector<int> order, place(loops.size(), 0);
    while (!queue.empty()) {
      const int z = std::get<2>(*queue.begin());
      queue.erase(queue.begin());
      place[at(z)] = static_cast<int>(order.size());
      order.push_back(z);
      const std::vector<int> around(neighbours[at(z)].begin(), neighbours[at(z)].end());
      loops[at(z)].neighbours = around;
      for (const int i : around) {
        queue.erase(key(i));
        neighbours[at(i)].erase(z);
        for (const int j : around)
          if (j != i) neighbours[at(i)].insert(j);
        queue.insert(key(i));
      }
    }
    std::vector<SpanningTree::Loop> sorted;
    for (const int z : order) {
      for (int& n : loops[at(z)].neighbours) n = place[at(n)];
      std::sort(loops[at(z)].neighbours.begin(), loops[at(z)].neighbours.end());
      sorted.push_back(std::move(loops[at(z)]));
    }
    loops = std::move(sorted);
  }

  void countIndependent() {
    std::vector<int> group(result_.links.size());
    std::iota(group.begin(), group.end(), 0);
    const auto find = [&](int b) {
      while (group[at(b)] != b) b = group[at(b)] = group[at(group[at(b)])];
      return b;
    };
    result_.independent = static_cast<int>(group.size());
    for (const ConstraintEdge& edge : edges_) {
      int first = -1;
      for (const int b : edge.bodies) {
        if (b < 0) continue;
        if (first >= 0 && find(first) != find(b)) group[at(find(b))] = find(first), --result_.independent;
        first = b;
      }
    }
  }

  const std::vector<ConstraintEdge>& edges_;
  std::vector<std::vector<int>> jointsOf_;
  std::vector<int> worldJoints_;
  std::vector<char> reached_; ///< 2: reached in this round
  SpanningTree result_;
};

} // namespace

SpanningTree findSpanningTree(int bodies, const std::vector<ConstraintEdge>& edges) {
  return Builder(bodies, edges).build();
}

} // namespace grouser::multibody::detail
