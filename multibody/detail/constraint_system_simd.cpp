// SPDX-License-Identifier: BSD-3-Clause
// SIMD part of ConstraintSystem, which processes four bodies and their joints at a time.
#include "multibody/detail/link_simd.hpp"

#include "multibody/detail/constraint_system.hpp"
#include "multibody/detail/index.hpp"
#include "multibody/detail/rotation_simd.hpp"

#include <cstddef>

namespace grouser::multibody::detail {

namespace {

/// Extracts one lane of a number or of a compound type.
double& lane(Lanes& x, std::size_t l) { return reinterpret_cast<double*>(&x)[l]; }
void set(Vec3L& v, std::size_t l, const Vec3d& value) {
  lane(v.x, l) = value.x, lane(v.y, l) = value.y, lane(v.z, l) = value.z;
}
Vec3d get(const Vec3L& v, int l) { return {v.x[l], v.y[l], v.z[l]}; }

} // namespace

void ConstraintSystem::makeLinks() {
  const int world = static_cast<int>(model().bodies().size());
  inTree_.assign(constraints().size(), 0);
  for (int index = 0; index < elimination_->batches(); ++index) {
    const Elimination::Links& batch = elimination_->links(index);
    LinkLanes links;
    links.count = batch.count;
    links.joint = batch.joint[0] >= 0;
    links.node = batch.body, links.constraint = batch.joint, links.parentNode = batch.parentNode;
    if (links.joint) {
      links.kind = constraints()[at(batch.joint[0])].kind;
      for (int r = 0; r < 6; ++r)
        if (axisRows(links.kind) >> r & 1u) links.axisRow[at(links.axes++)] = r;
    }
    for (int a = 0; a < links.axes; ++a)
      for (int i = 0; i < batch.freedoms; ++i)
        if (batch.freeRow[at(i)] == links.axisRow[at(a)]) links.freedom[at(a)] = i;
    for (std::size_t l = 0; l < kLanes; ++l) {
      links.body[l] = bodyOf(links.node[l]);
      const Body& body = model().bodies()[at(links.body[l])];
      lane(links.real, l) = static_cast<int>(l) < links.count ? 1 : 0;
      lane(links.mass, l) = body.mass;
      const double(&I)[3][3] = body.inertia_B.m;
      const double lower[6] = {I[0][0], I[1][0], I[2][0], I[1][1], I[2][1], I[2][2]};
      for (int i = 0; i < 6; ++i) lane(links.inertia_B[i], l) = lower[i];
      links.parent[l] = world;
      lane(links.side, l) = 1;
      if (!links.joint) continue;
      const int k = links.constraint[l];
      const Constraint& c = constraints()[at(k)];
      inTree_[at(k)] = 1;
      const bool childIsB = c.bodyB == links.body[l];
      lane(links.side, l) = childIsB ? 1 : -1;
      links.parent[l] = childIsB ? c.bodyA : c.bodyB;
      for (int a = 0; a < links.axes; ++a) links.axis[at(a)][l] = firstAxis(k) + a;
      const JointPlacesOf<double> places = placesOf(c);
      set(links.places.point_A, l, places.point_A), set(links.places.point_B, l, places.point_B);
      set(links.places.x_A, l, places.x_A), set(links.places.z_A, l, places.z_A);
      set(links.places.x_B, l, places.x_B), set(links.places.z_B, l, places.z_B);
    }
    Elimination::Links& target = elimination_->links(index);
    target.mass = links.mass;
    links_.push_back(links);
  }
  for (std::size_t k = 0; k < constraints().size(); ++k)
    if (!inTree_[k]) offTree_.push_back(static_cast<int>(k));
}

GROUSER_SIMD_CLONES void ConstraintSystem::lineariseLinks(const std::vector<Frame>& frames,
                                                          const std::vector<AxisLaw>& laws) {
  for (std::size_t index = 0; index < links_.size(); ++index) {
    LinkLanes& b = links_[index];
    Elimination::Links& to = elimination_->links(static_cast<int>(index));
    FrameL child, parent, A, B;
    gatherFrames(frames, b.body, child);
    rotatedInertia(child.R, b.inertia_B, to.inertia);
    b.com = child.p;
    if (!b.joint) continue;
    gatherFrames(frames, b.parent, parent);
    b.parentCom = parent.p;
    b.sort(child, parent, A, B);
    placeFrames(b.places, A, B, b.frames);
    jointRows(b.kind, b.frames, b.rows);
    for (std::size_t i = 0; i < 3; ++i) {
      to.force[i] = b.rows.force[at(to.forceRow[i])] * b.side;
      to.torque[i] = b.rows.torque[at(to.torqueRow[i])] * b.side;
    }
    to.arm = b.frames.p_B - child.p;
    to.away = child.p - parent.p;

    // A soft row has compliance; a driven row is hard; a free axis is not part of the system.
    for (int a = 0; a < b.axes; ++a)
      for (std::size_t l = 0; l < kLanes; ++l) {
        const AxisLaw& law = laws[at(b.axis[at(a)][l])];
        lane(to.inverseCompliance[b.freedom[at(a)]], l) = law.driven ? 0 : law.inverseCompliance;
        lane(to.free[b.freedom[at(a)]], l) = law.driven ? 0 : 1;
        const unsigned bit = 1u << b.axisRow[at(a)];
        unsigned& active = active_[at(b.constraint[l])];
        active = law.driven || law.inverseCompliance != 0 ? active | bit : active & ~bit;
      }
  }
}

/// Unpacks lane data into the arrays per constraint and body.
void ConstraintSystem::unpack() const {
  packed_ = false;
  for (std::size_t index = 0; index < links_.size(); ++index) {
    const LinkLanes& b = links_[index];
    const Elimination::Links& from = elimination_->links(static_cast<int>(index));
    for (int l = 0; l < b.count; ++l) {
      const Lanes(&I)[6] = from.inertia;
      inertia_[at(b.node[at(l)])] = {
          {{I[0][l], I[1][l], I[2][l]}, {I[1][l], I[3][l], I[4][l]}, {I[2][l], I[4][l], I[5][l]}}};
      if (!b.joint) continue;
      const int k = b.constraint[at(l)];
      const JointFramesL& f = b.frames;
      frames_[at(k)] = {get(f.p_A, l), get(f.p_B, l), get(f.x_A, l), get(f.y_A, l),
                        get(f.z_A, l), get(f.x_B, l), get(f.z_B, l)};
      for (std::size_t r = 0; r < 6; ++r) {
        rows_[at(k)].force[r] = get(b.rows.force[r], l);
        rows_[at(k)].torque[r] = get(b.rows.torque[r], l);
      }
      const bool childIsB = b.side[l] > 0;
      com_B_[at(k)] = get(childIsB ? b.com : b.parentCom, l);
      com_A_[at(k)] = get(childIsB ? b.parentCom : b.com, l);
    }
  }
}

} // namespace grouser::multibody::detail
