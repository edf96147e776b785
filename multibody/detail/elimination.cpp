// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/elimination.hpp"

#include "multibody/detail/constraint.hpp"
#include "multibody/detail/index.hpp"
#include "multibody/detail/vector6.hpp"

#include <algorithm>
#include <cstddef>

namespace grouser::multibody::detail {

namespace {

/// Extracts one lane.
double& in(Lanes& lanes, int lane) { return reinterpret_cast<double*>(&lanes)[lane]; }

void set(Vec3L& v, int lane, const base::Vec3<double>& value) {
  in(v.x, lane) = value.x, in(v.y, lane) = value.y, in(v.z, lane) = value.z;
}

GROUSER_SIMD Vec3L vector(const Lanes (&a)[6], int first) { return {a[first], a[first + 1], a[first + 2]}; }

GROUSER_SIMD Lanes dot6(const Lanes (&a)[6], const Lanes (&b)[6]) {
  return (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) + (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

/// Product of a symmetric matrix, stored as lower triangle by columns 00 10 20 11 21 22, and a vector.
GROUSER_SIMD Vec3L timesSymmetric(const Lanes (&m)[6], const Vec3L& v) {
  return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[1] * v.x + m[3] * v.y + m[4] * v.z,
          m[2] * v.x + m[4] * v.y + m[5] * v.z};
}
/// Products of a row-major matrix, and of its transpose, with a vector.
GROUSER_SIMD Vec3L times(const Lanes (&m)[9], const Vec3L& v) {
  return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
          m[6] * v.x + m[7] * v.y + m[8] * v.z};
}
GROUSER_SIMD Vec3L transposedTimes(const Lanes (&m)[9], const Vec3L& v) {
  return {m[0] * v.x + m[3] * v.y + m[6] * v.z, m[1] * v.x + m[4] * v.y + m[7] * v.z,
          m[2] * v.x + m[5] * v.y + m[8] * v.z};
}

GROUSER_SIMD void put(Lanes (&a)[6], const Vec3L& v, const Vec3L& w) {
  a[0] = v.x, a[1] = v.y, a[2] = v.z, a[3] = w.x, a[4] = w.y, a[5] = w.z;
}

/// Reads the vectors of four nodes, one per lane: six of their eight numbers.
GROUSER_SIMD void gatherNodes(const double* const (&row)[kLanes], Lanes (&out)[6]) {
  Lanes low[4], high[4];
  gatherRows(row, 0, low);
  gatherRows(row, 4, high);
  out[0] = low[0], out[1] = low[1], out[2] = low[2], out[3] = low[3], out[4] = high[0], out[5] = high[1];
}

} // namespace

void Elimination::setBody(int body, double mass, const double (&I)[3][3]) {
  const Place place = placeOfBody_[at(body)];
  Links& links = links_[at(place.batch)];
  in(links.mass, place.lane) = mass;
  const double lower[6] = {I[0][0], I[1][0], I[2][0], I[1][1], I[2][1], I[2][2]};
  for (int i = 0; i < 6; ++i) in(links.inertia[i], place.lane) = lower[i];
}

void Elimination::setJoint(int k, const RowDirectionsOf<double>& rows, const base::Vec3<double>& p_B,
                           const base::Vec3<double>& com_A, const base::Vec3<double>& com_B, const double* compliance,
                           unsigned active) {
  if (loopOf_[at(k)] >= 0) {
    Block jacobians[2]{};
    rowBlocks(rows, p_B, com_A, com_B, jacobians[0], jacobians[1]);
    setConstraint(k, jacobians, compliance, active);
    return;
  }
  const Place place = placeOfJoint_[at(k)];
  Links& links = links_[at(place.batch)];
  const int lane = place.lane;
  const double side = sideOf_[at(k)];
  const base::Vec3<double>&child = side > 0 ? com_B : com_A, &parent = side > 0 ? com_A : com_B;
  for (int i = 0; i < 3; ++i) {
    set(links.force[i], lane, side * rows.force[at(links.forceRow[at(i)])]);
    set(links.torque[i], lane, side * rows.torque[at(links.torqueRow[at(i)])]);
  }
  set(links.arm, lane, p_B - child);
  set(links.away, lane, child - parent);
  for (int i = 0; i < links.freedoms; ++i) {
    const int r = links.freeRow[at(i)];
    const bool holds = active >> r & 1u;
    in(links.inverseCompliance[i], lane) = holds && compliance[r] != 0 ? 1 / compliance[r] : 0;
    in(links.free[i], lane) = holds && compliance[r] == 0 ? 0 : 1;
  }
  kept_[at(k)] = active;
}

void Elimination::setConstraint(int k, const Block* jacobians, const double* compliance, unsigned active) {
  Loop& z = loops_[at(loopOf_[at(k)])];
  std::copy(jacobians, jacobians + z.bodies.size(), z.jacobians.begin());
  std::copy(compliance, compliance + 6, z.compliance.begin());
  z.active = active;
}

void Elimination::setSmallestPivots(int k, const double (&smallest)[6]) {
  if (loopOf_[at(k)] < 0) return;
  std::copy(smallest, smallest + 6, loops_[at(loopOf_[at(k)])].smallest.begin());
}

void Elimination::startLoops() {
  for (Column& column : columns_)
    for (Lanes& l : column.l) l = all(0);
  for (Block& block : w_) block.fill(0);
  for (std::size_t index = 0; index < loops_.size(); ++index) {
    Loop& z = loops_[index];
    z.atTop.fill(0);
    diagonal_[index].fill(0);
    for (std::size_t r = 0; r < 6; ++r) diagonal_[index][(kStride + 1) * r] = -z.compliance[r];
    for (std::size_t i = 0; i < z.bodies.size(); ++i)
      for (std::size_t r = 0; r < 6; ++r)
        if (const Onward& to = z.entries[i][r]; to.entry)
          for (int c = 0; c < 6; ++c) to.entry[to.stride * c] += z.jacobians[i][at(kStride * c) + r];
  }
}

/// Computes the directions dual to the rows, then eliminates the free directions as described in elimination.hpp.
/// `pairs`: destinations of the products of two columns.
GROUSER_SIMD void factorBatch(Elimination::Links& b, Elimination::Column* columns, double* const* pairs) {
  if (b.joint[0] >= 0) {
    const Lanes volume = dot(b.torque[0], cross(b.torque[1], b.torque[2]));
    const Lanes inverse = 1.0 / volume;
    b.dual[0] = cross(b.torque[1], b.torque[2]) * inverse;
    b.dual[1] = cross(b.torque[2], b.torque[0]) * inverse;
    b.dual[2] = cross(b.torque[0], b.torque[1]) * inverse;
    for (int i = 0; i < b.freedoms; ++i) {
      const int r = b.freeRow[at(i)];
      for (int j = 0; j < 3; ++j) {
        // Force rows are orthonormal, hence dual to themselves.
        if (b.forceRow[at(j)] == r) put(b.s[i], b.force[j], {});
        if (b.torqueRow[at(j)] == r) put(b.s[i], cross(b.arm, b.dual[j]), b.dual[j]);
      }
    }
  }

  for (int i = 0; i < b.freedoms; ++i) {
    const Vec3L v = vector(b.s[i], 0), w = vector(b.s[i], 3);
    put(b.u[i], timesSymmetric(b.vv, v) + times(b.vw, w), transposedTimes(b.vw, v) + timesSymmetric(b.ww, w));
    const Lanes(&u)[6] = b.u[i];
    const Lanes inverseD = b.free[i] / (dot6(b.s[i], u) + b.inverseCompliance[i]);
    b.inverseD[i] = inverseD;
    Lanes h[6];
#pragma GCC unroll 6
    for (int j = 0; j < 6; ++j) h[j] = u[j] * inverseD;
    b.vv[0] -= h[0] * u[0], b.vv[1] -= h[1] * u[0], b.vv[2] -= h[2] * u[0];
    b.vv[3] -= h[1] * u[1], b.vv[4] -= h[2] * u[1], b.vv[5] -= h[2] * u[2];
    b.ww[0] -= h[3] * u[3], b.ww[1] -= h[4] * u[3], b.ww[2] -= h[5] * u[3];
    b.ww[3] -= h[4] * u[4], b.ww[4] -= h[5] * u[4], b.ww[5] -= h[5] * u[5];
#pragma GCC unroll 3
    for (int j = 0; j < 3; ++j)
#pragma GCC unroll 3
      for (int k = 0; k < 3; ++k) b.vw[3 * j + k] -= h[j] * u[3 + k];
    for (int c = 0; c < b.columns; ++c) {
      Lanes(&l)[6] = columns[c].l;
      const Lanes product = dot6(b.s[i], l);
      columns[c].w[i] = product;
#pragma GCC unroll 6
      for (int j = 0; j < 6; ++j) l[j] -= h[j] * product;
    }
  }

  for (int c = 0; c < b.columns; ++c)
    for (int other = 0; other <= c; ++other, pairs += kLanes) {
      Lanes sum = all(0);
      for (int i = 0; i < b.freedoms; ++i) sum += columns[c].w[i] * columns[other].w[i] * b.inverseD[i];
      for (int lane = 0; lane < b.count; ++lane) *pairs[lane] -= sum[lane];
    }
}

/// Articulated inertia at the parent's centre of mass: with the twist shifted as v = v_parent + w x d, vw becomes
/// vw - vv [d], ww becomes ww + [d] vw' - vw^T [d]; [d] is the matrix of d x.
GROUSER_SIMD void shifted(const Elimination::Links& b, Lanes (&vw)[9], Lanes (&ww)[6]) {
  const Lanes &x = b.away.x, &y = b.away.y, &z = b.away.z;
  const Lanes m[9] = {b.vv[0], b.vv[1], b.vv[2], b.vv[1], b.vv[3], b.vv[4], b.vv[2], b.vv[4], b.vv[5]};
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    // The product of a row and [d] is the cross product of this row and d.
    const Lanes &a0 = m[3 * i], &a1 = m[3 * i + 1], &a2 = m[3 * i + 2];
    vw[3 * i] = b.vw[3 * i] - (a1 * z - a2 * y);
    vw[3 * i + 1] = b.vw[3 * i + 1] - (a2 * x - a0 * z);
    vw[3 * i + 2] = b.vw[3 * i + 2] - (a0 * y - a1 * x);
  }
  // [d] vw': each column is the cross product of d and this column. vw^T [d]: row i is (column i of vw) x d.
  const auto left = [&](int row, int column) {
    const Lanes &c0 = vw[column], &c1 = vw[3 + column], &c2 = vw[6 + column];
    return row == 0 ? y * c2 - z * c1 : row == 1 ? z * c0 - x * c2 : x * c1 - y * c0;
  };
  const auto right = [&](int row, int column) {
    const Lanes &c0 = b.vw[row], &c1 = b.vw[3 + row], &c2 = b.vw[6 + row];
    return column == 0 ? c1 * z - c2 * y : column == 1 ? c2 * x - c0 * z : c0 * y - c1 * x;
  };
  ww[0] = b.ww[0] + (left(0, 0) - right(0, 0));
  ww[1] = b.ww[1] + (left(1, 0) - right(1, 0));
  ww[2] = b.ww[2] + (left(2, 0) - right(2, 0));
  ww[3] = b.ww[3] + (left(1, 1) - right(1, 1));
  ww[4] = b.ww[4] + (left(2, 1) - right(2, 1));
  ww[5] = b.ww[5] + (left(2, 2) - right(2, 2));
}

/// Adds the remaining inertia and columns to the parents.
GROUSER_SIMD void passOn(Elimination::Links& b, Elimination::Column* columns, std::vector<Elimination::Links>& all) {
  Lanes vw[9], ww[6];
  shifted(b, vw, ww);
  if (b.aligned) {
    Elimination::Links& parent = all[at(b.parentBatch[0])];
    for (int i = 0; i < 6; ++i) parent.vv[i] += b.vv[i];
    for (int i = 0; i < 9; ++i) parent.vw[i] += vw[i];
    for (int i = 0; i < 6; ++i) parent.ww[i] += ww[i];
  } else {
    for (int lane = 0; lane < b.count; ++lane) {
      if (b.parentBatch[at(lane)] < 0) continue;
      Elimination::Links& parent = all[at(b.parentBatch[at(lane)])];
      const int to = b.parentLane[at(lane)];
      for (int i = 0; i < 6; ++i) in(parent.vv[i], to) += b.vv[i][lane];
      for (int i = 0; i < 9; ++i) in(parent.vw[i], to) += vw[i][lane];
      for (int i = 0; i < 6; ++i) in(parent.ww[i], to) += ww[i][lane];
    }
  }
  for (int c = 0; c < b.columns; ++c) {
    const Elimination::Column& column = columns[c];
    const Vec3L force = vector(column.l, 0), torque = vector(column.l, 3) + cross(b.away, force);
    const Lanes total[6] = {force.x, force.y, force.z, torque.x, torque.y, torque.z};
    if (b.aligned) {
      Lanes* const to = reinterpret_cast<Lanes*>(column.onward[0].entry);
      for (int i = 0; i < 6; ++i) to[i] += total[i];
    } else {
      for (int lane = 0; lane < b.count; ++lane)
        if (const auto to = column.onward[at(lane)]; to.entry)
          for (int i = 0; i < 6; ++i) to.entry[to.stride * i] += total[i][lane];
    }
  }
}

GROUSER_SIMD_CLONES int Elimination::sweep() {
  int omitted = 0;
  for (Links& b : links_) {
    const Lanes zero = all(0);
    b.vv[0] = b.vv[3] = b.vv[5] = b.mass;
    b.vv[1] = b.vv[2] = b.vv[4] = zero;
    for (Lanes& x : b.vw) x = zero;
    for (int i = 0; i < 6; ++i) b.ww[i] = b.inertia[i];
  }
  for (const Operation& operation : program_) {
    if (operation.closes) {
      omitted += factorLoop(loops_[at(operation.index)]);
      continue;
    }
    Links& b = links_[at(operation.index)];
    Column* const columns = columns_.data() + b.firstColumn;
    factorBatch(b, columns, pairs_.data() + b.firstPair);
    passOn(b, columns, links_);
  }
  return omitted;
}

int Elimination::factor() {
  startLoops();
  return sweep();
}

int Elimination::factorLoop(Loop& z) {
  const std::size_t index = static_cast<std::size_t>(&z - loops_.data());
  double* const L = diagonal_[index].data();
  const unsigned kept = factor6(L, z.dInverse.data(), z.smallest.data(), z.active);
  kept_[at(z.constraint)] = kept;
  for (const int slot : z.slots) solveRight6(w_[at(slot)].data(), v_[at(slot)].data(), L, z.dInverse.data());
  if (z.top >= 0) solveRight6(z.atTop.data(), z.vTop.data(), L, z.dInverse.data());

  for (std::size_t i = 0; i < z.slots.size(); ++i) {
    const double* const v = v_[at(z.slots[i])].data();
    subtractProduct6(diagonal_[at(z.neighbours[i])].data(), v, w_[at(z.slots[i])].data());
    for (std::size_t j = 0; j < i; ++j)
      subtractProduct6(w_[at(slotOf(z.neighbours[i], z.neighbours[j]))].data(), v, w_[at(z.slots[j])].data());
    if (z.top < 0) continue;
    // L of the neighbour at the top.
    Block product{};
    subtractProduct6(product.data(), z.vTop.data(), w_[at(z.slots[i])].data());
    for (std::size_t r = 0; r < 6; ++r)
      if (const Onward& to = z.onto[i][r]; to.entry)
        for (int c = 0; c < 6; ++c) to.entry[to.stride * c] += product[kStride * r + at(c)];
  }
  if (z.top >= 0) {
    Block product{};
    subtractProduct6(product.data(), z.vTop.data(), z.atTop.data());
    const Place place = placeOfBody_[at(z.top)];
    Links& b = links_[at(place.batch)];
    const auto entry = [&](int row, int column) { return product[at(kStride * column + row)]; };
    for (int j = 0, n = 0; j < 3; ++j)
      for (int i = j; i < 3; ++i, ++n) {
        in(b.vv[n], place.lane) += entry(i, j);
        in(b.ww[n], place.lane) += entry(3 + i, 3 + j);
      }
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) in(b.vw[3 * i + j], place.lane) += entry(i, 3 + j);
  }
  return __builtin_popcount(z.active & ~kept);
}

namespace {

GROUSER_SIMD void forwardBatch(const Elimination::Links& b, const Elimination::Column* columns, Vector6* x,
                               int bodies) {
  const double* row[kLanes];
  for (int l = 0; l < kLanes; ++l) row[l] = x[b.body[at(l)]].data();
  Lanes p[6], c[6] = {}, delta[6] = {};
  gatherNodes(row, p);
  if (b.joint[0] >= 0) {
    for (int l = 0; l < kLanes; ++l) row[l] = x[bodies + b.joint[at(l)]].data();
    gatherNodes(row, c);
    // A free or soft row imposes no motion.
    Lanes asked[6];
    for (int r = 0; r < 6; ++r) asked[r] = c[r];
    for (int i = 0; i < b.freedoms; ++i) asked[b.freeRow[at(i)]] *= 1.0 - b.free[i];
    const Vec3L v =
        b.force[0] * asked[b.forceRow[0]] + b.force[1] * asked[b.forceRow[1]] + b.force[2] * asked[b.forceRow[2]];
    const Vec3L w =
        b.dual[0] * asked[b.torqueRow[0]] + b.dual[1] * asked[b.torqueRow[1]] + b.dual[2] * asked[b.torqueRow[2]];
    put(delta, v + cross(b.arm, w), w);
  }
  for (int r = 0; r < 6; ++r) b.delta[r] = delta[r], b.residual[r] = c[r];
  for (int i = 0; i < b.freedoms; ++i) {
    const Lanes right = dot6(b.s[i], p) + b.inverseCompliance[i] * c[b.freeRow[at(i)]];
    b.right[i] = right;
    const Lanes q = right * b.inverseD[i];
#pragma GCC unroll 6
    for (int j = 0; j < 6; ++j) p[j] -= b.u[i][j] * q;
  }
  const Vec3L v = vector(delta, 0), w = vector(delta, 3);
  Vec3L force = vector(p, 0) - (timesSymmetric(b.vv, v) + times(b.vw, w));
  Vec3L torque = vector(p, 3) - (transposedTimes(b.vw, v) + timesSymmetric(b.ww, w));
  put(p, force, torque);
  for (int r = 0; r < 6; ++r) b.p[r] = p[r];

  for (int k = 0; k < b.columns; ++k) {
    const Elimination::Column& column = columns[k];
    Lanes sum = dot6(column.l, delta);
    for (int i = 0; i < b.freedoms; ++i) sum += column.w[i] * (b.right[i] * b.inverseD[i]);
    for (int l = 0; l < b.count; ++l) x[column.node[at(l)]][at(column.rowOf[at(l)])] -= sum[l];
  }

  torque += cross(b.away, force);
  Lanes low[4] = {force.x, force.y, force.z, torque.x}, high[4] = {torque.y, torque.z, all(0), all(0)};
  base::transpose(low);
  base::transpose(high);
  for (int l = 0; l < b.count; ++l) {
    if (b.parentNode[at(l)] < 0) continue;
    Lanes* const to = reinterpret_cast<Lanes*>(x[b.parentNode[at(l)]].data());
    to[0] += low[l];
    to[1] += high[l];
  }
}

GROUSER_SIMD void backwardBatch(const Elimination::Links& b, const Elimination::Column* columns, Vector6* x,
                                int bodies) {
  const double* row[kLanes];
  for (int l = 0; l < kLanes; ++l) row[l] = b.parentNode[at(l)] >= 0 ? x[b.parentNode[at(l)]].data() : kStill.data();
  Lanes y[6];
  gatherNodes(row, y);
  const Vec3L w = vector(y, 3), v = vector(y, 0) + cross(w, b.away);
  Vec3L force = timesSymmetric(b.vv, v) + times(b.vw, w) - vector(b.p, 0);
  Vec3L torque = transposedTimes(b.vw, v) + timesSymmetric(b.ww, w) - vector(b.p, 3);
  put(y, v + vector(b.delta, 0), w + vector(b.delta, 3));

  Lanes right[6];
  for (int i = 0; i < b.freedoms; ++i) right[i] = b.right[i];
  for (int k = 0; k < b.columns; ++k) {
    const Elimination::Column& column = columns[k];
    Lanes mu;
    for (int l = 0; l < kLanes; ++l) mu[l] = x[column.node[at(l)]][at(column.rowOf[at(l)])];
    force += vector(column.l, 0) * mu;
    torque += vector(column.l, 3) * mu;
    for (int i = 0; i < b.freedoms; ++i) right[i] -= column.w[i] * mu;
  }

  Lanes lambda[6];
  if (b.joint[0] >= 0) {
    const Vec3L torqueThere = torque - cross(b.arm, force);
    for (int j = 0; j < 3; ++j) {
      lambda[b.forceRow[at(j)]] = dot(b.force[j], force);
      lambda[b.torqueRow[at(j)]] = dot(b.dual[j], torqueThere);
    }
  }
  for (int i = b.freedoms - 1; i >= 0; --i) {
    const Lanes q = (right[i] - dot6(b.u[i], y)) * b.inverseD[i];
#pragma GCC unroll 6
    for (int j = 0; j < 6; ++j) y[j] += b.s[i][j] * q;
    if (b.joint[0] < 0) continue;
    const int r = b.freeRow[at(i)];
    lambda[r] = b.free[i] > 0.0 ? b.inverseCompliance[i] * (b.residual[r] - q) : lambda[r];
  }

  const auto write = [&](const Lanes(&z)[6], int first, const std::array<int, kLanes>& node) {
    Lanes low[4] = {z[0], z[1], z[2], z[3]}, high[4] = {z[4], z[5], all(0), all(0)};
    base::transpose(low);
    base::transpose(high);
    for (int l = 0; l < b.count; ++l) {
      Lanes* const to = reinterpret_cast<Lanes*>(x[first + node[at(l)]].data());
      to[0] = low[l];
      to[1] = high[l];
    }
  };
  write(y, 0, b.body);
  if (b.joint[0] >= 0) write(lambda, bodies, b.joint);
}

} // namespace

GROUSER_SIMD_CLONES void Elimination::sweepForward(Vector6* x) const {
  for (const Operation& operation : program_) {
    if (operation.closes) {
      forwardLoop(loops_[at(operation.index)], x);
    } else {
      const Links& b = links_[at(operation.index)];
      forwardBatch(b, columns_.data() + b.firstColumn, x, bodies_);
    }
  }
}

GROUSER_SIMD_CLONES void Elimination::sweepBackward(Vector6* x) const {
  for (std::size_t left = program_.size(); left > 0; --left) {
    const Operation& operation = program_[left - 1];
    if (operation.closes) {
      backwardLoop(loops_[at(operation.index)], x);
    } else {
      const Links& b = links_[at(operation.index)];
      backwardBatch(b, columns_.data() + b.firstColumn, x, bodies_);
    }
  }
}

void Elimination::forwardLoop(const Loop& z, Vector6* x) const {
  const std::size_t index = static_cast<std::size_t>(&z - loops_.data());
  double* const y = x[bodies_ + z.constraint].data();
  forward6(y, diagonal_[index].data());
  for (std::size_t i = 0; i < z.slots.size(); ++i)
    subtractTimes6(x[bodies_ + loops_[at(z.neighbours[i])].constraint].data(), v_[at(z.slots[i])].data(), y);
  if (z.top >= 0) subtractTimes6(x[z.top].data(), z.vTop.data(), y);
}

void Elimination::backwardLoop(const Loop& z, Vector6* x) const {
  const std::size_t index = static_cast<std::size_t>(&z - loops_.data());
  double* const y = x[bodies_ + z.constraint].data();
  for (std::size_t r = 0; r < 6; ++r) y[r] *= z.dInverse[r];
  for (std::size_t i = 0; i < z.slots.size(); ++i)
    subtractTransposedTimes6(y, v_[at(z.slots[i])].data(), x[bodies_ + loops_[at(z.neighbours[i])].constraint].data());
  if (z.top >= 0) subtractTransposedTimes6(y, z.vTop.data(), x[z.top].data());
  backward6(y, diagonal_[index].data());
}

void Elimination::solve(Vector6* x) const {
  sweepForward(x);
  sweepBackward(x);
  // The sweeps use the opposite sign for the loop multipliers.
  for (const Loop& z : loops_)
    for (double& lambda : x[bodies_ + z.constraint]) lambda *= -1;
}

} // namespace grouser::multibody::detail
