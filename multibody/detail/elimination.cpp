// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/elimination.hpp"

#include <algorithm>
#include <cstddef>
#include <set>
#include <tuple>
#include <utility>

namespace grouser::multibody::detail {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// For each constraint the bodies that must be eliminated before it, and how many of them.
struct Waiting {
  std::vector<std::vector<int>> constraintsOf; ///< one a body: those that wait for it
  std::vector<int> count;                      ///< one a constraint
};

Waiting findWaiting(int bodies, const std::vector<Elimination::Edge>& edges) {
  std::vector<std::vector<int>> jointsOf(at(bodies));
  std::vector<int> worldJoints;
  for (int c = 0; c < static_cast<int>(edges.size()); ++c) {
    if (edges[at(c)].soft) continue;
    for (const int b : {edges[at(c)].bodyA, edges[at(c)].bodyB})
      if (b >= 0)
        jointsOf[at(b)].push_back(c);
      else
        worldJoints.push_back(c);
  }

  // Spanning forest, breadth first: from the world, then from the body with the most joints of what is left.
  std::vector<int> treeOf(at(bodies), -1), child(edges.size(), -1);
  std::vector<int> queue;
  const auto take = [&](int body, int constraint, int tree) {
    if (body < 0 || treeOf[at(body)] >= 0) return;
    treeOf[at(body)] = tree;
    if (constraint >= 0) child[at(constraint)] = body;
    queue.push_back(body);
  };
  const auto spread = [&](int tree) {
    for (std::size_t next = 0; next < queue.size(); ++next)
      for (const int c : jointsOf[at(queue[next])]) {
        take(edges[at(c)].bodyA, c, tree);
        take(edges[at(c)].bodyB, c, tree);
      }
    queue.clear();
  };
  for (const int c : worldJoints) take(edges[at(c)].bodyA, c, 0), take(edges[at(c)].bodyB, c, 0);
  spread(0);
  for (int tree = 1;; ++tree) {
    int root = -1;
    for (int b = 0; b < bodies; ++b)
      if (treeOf[at(b)] < 0 && (root < 0 || jointsOf[at(b)].size() > jointsOf[at(root)].size())) root = b;
    if (root < 0) break;
    take(root, -1, tree);
    spread(tree);
  }

  Waiting waiting{std::vector<std::vector<int>>(at(bodies)), std::vector<int>(edges.size(), 0)};
  const auto wait = [&](int constraint, int body) {
    waiting.constraintsOf[at(body)].push_back(constraint);
    ++waiting.count[at(constraint)];
  };
  for (int c = 0; c < static_cast<int>(edges.size()); ++c) {
    const auto [a, b, soft] = edges[at(c)];
    if (soft) {
      wait(c, a >= 0 ? a : b);
    } else if (child[at(c)] >= 0) {
      wait(c, child[at(c)]);
    } else {
      const int tree = treeOf[at(a >= 0 ? a : b)];
      for (int body = 0; body < bodies; ++body)
        if (treeOf[at(body)] == tree) wait(c, body);
    }
  }
  return waiting;
}

} // namespace

Elimination::Elimination(int bodies, const std::vector<Edge>& edges)
    : bodies_(bodies), nodes_(bodies + static_cast<int>(edges.size())) {
  findOrder(edges);
  findProgram(edges);
  diagonal_.assign(at(nodes_), Block{});
  dInverse_.assign(at(nodes_), {});
  smallest_.assign(at(nodes_), {});
  active_.assign(at(nodes_), 0x3fu);
  kept_.assign(at(nodes_), 0x3fu);
  w_.assign(slots_.size(), Block{});
  v_.assign(slots_.size(), Block{});
}

void Elimination::findOrder(const std::vector<Edge>& edges) {
  std::vector<std::set<int>> neighbours(at(nodes_));
  for (std::size_t c = 0; c < edges.size(); ++c)
    for (const int b : {edges[c].bodyA, edges[c].bodyB})
      if (b >= 0) {
        neighbours[at(b)].insert(bodies_ + static_cast<int>(c));
        neighbours[at(bodies_) + c].insert(b);
      }

  // Minimum degree; among equals bodies first, then by index.
  Waiting waiting = findWaiting(bodies_, edges);
  std::set<std::tuple<std::size_t, bool, int>> queue;
  const auto key = [&](int n) { return std::make_tuple(neighbours[at(n)].size(), n >= bodies_, n); };
  const auto eligible = [&](int n) { return n < bodies_ || waiting.count[at(n - bodies_)] == 0; };
  for (int n = 0; n < bodies_; ++n) queue.insert(key(n));
  std::vector<int> rough;
  laterNeighbours_.assign(at(nodes_), {});
  while (!queue.empty()) {
    const int p = std::get<2>(*queue.begin());
    queue.erase(queue.begin());
    rough.push_back(p);
    const std::vector<int> around(neighbours[at(p)].begin(), neighbours[at(p)].end());
    laterNeighbours_[at(p)] = around;
    for (const int i : around) {
      if (eligible(i)) queue.erase(key(i));
      neighbours[at(i)].erase(p);
      for (const int j : around)
        if (j != i) neighbours[at(i)].insert(j);
    }
    for (const int i : around)
      if (eligible(i)) queue.insert(key(i));
    if (p < bodies_)
      for (const int c : waiting.constraintsOf[at(p)])
        if (--waiting.count[at(c)] == 0) queue.insert(key(bodies_ + c));
  }
  postorder(rough);
}

/// Postorder of the elimination tree: the same factor, walked along each branch; one root for each independent part.
void Elimination::postorder(const std::vector<int>& rough) {
  std::vector<int> rank(at(nodes_), 0);
  for (std::size_t k = 0; k < rough.size(); ++k) rank[at(rough[k])] = static_cast<int>(k);
  std::vector<std::vector<int>> children(at(nodes_));
  std::vector<int> roots;
  for (const int p : rough) {
    const auto& later = laterNeighbours_[at(p)];
    if (later.empty())
      roots.push_back(p);
    else
      children[at(*std::min_element(later.begin(), later.end(), [&](int a, int b) {
        return rank[at(a)] < rank[at(b)];
      }))].push_back(p);
  }
  for (const int root : roots) {
    Part part;
    part.firstStep = static_cast<int>(order_.size());
    std::vector<std::pair<int, std::size_t>> stack{{root, 0}};
    while (!stack.empty()) {
      auto& [node, next] = stack.back();
      if (next < children[at(node)].size()) {
        const int child = children[at(node)][next++];
        stack.emplace_back(child, 0);
      } else {
        order_.push_back(node);
        stack.pop_back();
      }
    }
    part.endStep = static_cast<int>(order_.size());
    parts_.push_back(part);
  }
}

void Elimination::findProgram(const std::vector<Edge>& edges) {
  std::vector<int> position(at(nodes_), 0);
  for (int k = 0; k < nodes_; ++k) position[at(order_[at(k)])] = k;
  std::vector<std::vector<int>> slotOfColumn(at(nodes_)); // parallel to laterNeighbours_
  for (const int p : order_) {
    auto& later = laterNeighbours_[at(p)];
    std::sort(later.begin(), later.end(), [&](int a, int b) { return position[at(a)] < position[at(b)]; });
    for (const int i : later) {
      slotOfColumn[at(p)].push_back(static_cast<int>(slots_.size()));
      slots_.push_back({i, p});
    }
  }
  const auto findSlot = [&](int row, int column) {
    const auto& later = laterNeighbours_[at(column)];
    const auto it = std::find(later.begin(), later.end(), row);
    return slotOfColumn[at(column)][at(static_cast<int>(it - later.begin()))];
  };

  alone_.assign(at(bodies_), 0);
  std::vector<char> touched(at(nodes_), 0);
  for (const int p : order_) {
    Step step;
    step.node = p;
    const auto& later = laterNeighbours_[at(p)];
    step.firstSlot = later.empty() ? 0 : slotOfColumn[at(p)].front();
    step.endSlot = step.firstSlot + static_cast<int>(later.size());
    step.bodyAlone = p < bodies_ && !touched[at(p)];
    if (step.bodyAlone) alone_[at(p)] = 1;
    step.firstUpdate = static_cast<int>(updates_.size());
    for (std::size_t i = 0; i < later.size(); ++i) {
      updates_.push_back({slotOfColumn[at(p)][i], slotOfColumn[at(p)][i], ~later[i]});
      touched[at(later[i])] = 1;
      for (std::size_t j = 0; j < i; ++j)
        updates_.push_back({slotOfColumn[at(p)][i], slotOfColumn[at(p)][j], findSlot(later[i], later[j])});
    }
    step.endUpdate = static_cast<int>(updates_.size());
    steps_.push_back(step);
  }

  isFill_.assign(slots_.size(), 1);
  ends_.resize(edges.size());
  for (std::size_t c = 0; c < edges.size(); ++c) {
    const int node = bodies_ + static_cast<int>(c);
    const auto place = [&](int body, int& slot, bool& transpose) {
      if (body < 0) return;
      transpose = position[at(node)] < position[at(body)];
      slot = transpose ? findSlot(body, node) : findSlot(node, body);
      isFill_[at(slot)] = 0;
    };
    place(edges[c].bodyA, ends_[c].slotA, ends_[c].transposeA);
    place(edges[c].bodyB, ends_[c].slotB, ends_[c].transposeB);
  }
}

void Elimination::setBody(int body, double mass, const double (&inertia)[3][3]) {
  Block& D = diagonal_[at(body)];
  D.fill(0);
  for (int i = 0; i < 3; ++i) {
    D[at((kStride + 1) * i)] = mass;
    for (int j = 0; j < 3; ++j) D[at(kStride * (3 + j) + 3 + i)] = inertia[i][j];
  }
}

void Elimination::setConstraint(int constraint, const Block& jacobianA, const Block& jacobianB,
                                const double* compliance, unsigned active) {
  const std::size_t node = at(bodies_ + constraint);
  Block& D = diagonal_[node];
  D.fill(0);
  for (std::size_t i = 0; i < 6; ++i) D[(kStride + 1) * i] = -compliance[i];
  active_[node] = active;
  const auto put = [&](int slot, bool transpose, const Block& J) {
    if (slot < 0) return;
    Block& K = w_[at(slot)];
    if (transpose)
      for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j) K[kStride * i + j] = J[kStride * j + i];
    else
      K = J;
  };
  const Ends& e = ends_[at(constraint)];
  put(e.slotA, e.transposeA, jacobianA);
  put(e.slotB, e.transposeB, jacobianB);
}

void Elimination::setBodyInverse(int body, double inverseMass, const double (&inverseInertia)[3][3]) {
  setBody(body, inverseMass, inverseInertia);
}

void Elimination::setSmallestPivots(int constraint, const double (&smallest)[6]) {
  std::copy(smallest, smallest + 6, smallest_[at(bodies_ + constraint)].begin());
}

int Elimination::factor(const Part& part) { return factorPart(part); }

// Wide registers where the processor has them, chosen at load time. No fused multiply-add in any: the bits are equal.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__SANITIZE_ADDRESS__)
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
int Elimination::factorPart(const Part& part) {
  int leftOut = 0;
  for (int s = part.firstStep; s < part.endStep; ++s) {
    const Step& step = steps_[at(s)];
    for (int k = step.firstSlot; k < step.endSlot; ++k)
      if (isFill_[at(k)]) clear6(w_[at(k)].data());
  }
  for (int s = part.firstStep; s < part.endStep; ++s) {
    const Step& step = steps_[at(s)];
    const std::size_t p = at(step.node);
    double* const L = diagonal_[p].data();
    double* const d = dInverse_[p].data();
    if (step.bodyAlone) {
      for (int k = step.firstSlot; k < step.endSlot; ++k) timesBodyInverse6(v_[at(k)].data(), w_[at(k)].data(), L);
    } else {
      kept_[p] = factor6(L, d, smallest_[p].data(), active_[p]);
      leftOut += __builtin_popcount(active_[p] & ~kept_[p]);
      for (int k = step.firstSlot; k < step.endSlot; ++k) solveRight6(w_[at(k)].data(), v_[at(k)].data(), L, d);
    }
    for (int k = step.firstUpdate; k < step.endUpdate; ++k) {
      const Update& u = updates_[at(k)];
      if (u.target < 0)
        subtractProduct6(diagonal_[at(~u.target)].data(), v_[at(u.left)].data(), w_[at(u.right)].data());
      else
        subtractProduct6(w_[at(u.target)].data(), v_[at(u.left)].data(), w_[at(u.right)].data());
    }
  }
  return leftOut;
}

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__SANITIZE_ADDRESS__)
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
void Elimination::solvePart(const Part& part, Vector6* x) const {
  for (int s = part.firstStep; s < part.endStep; ++s) {
    const Step& step = steps_[at(s)];
    double* const y = x[step.node].data();
    if (!step.bodyAlone) forward6(y, diagonal_[at(step.node)].data());
    for (int k = step.firstSlot; k < step.endSlot; ++k)
      subtractTimes6(x[slots_[at(k)].row].data(), v_[at(k)].data(), y);
  }
  for (int s = part.endStep - 1; s >= part.firstStep; --s) {
    const Step& step = steps_[at(s)];
    double* const y = x[step.node].data();
    const double* const L = diagonal_[at(step.node)].data();
    if (step.bodyAlone)
      applyBodyInverse6(y, L);
    else
      for (int i = 0; i < 6; ++i) y[i] *= dInverse_[at(step.node)][at(i)];
    for (int k = step.firstSlot; k < step.endSlot; ++k)
      subtractTransposedTimes6(y, v_[at(k)].data(), x[slots_[at(k)].row].data());
    if (!step.bodyAlone) backward6(y, L);
  }
}

void Elimination::solve(const Part& part, Vector6* x) const { solvePart(part, x); }

} // namespace grouser::multibody::detail
