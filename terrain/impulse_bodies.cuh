// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/comm.hpp"
#include "contact/grain_part_contacts.hpp"
#include "terrain/impulse_rows.cuh"

#include <algorithm>
#include <array>
#include <vector>

namespace grouser::terrain {

/// Sums counts over the ranks; collective.
inline void sumCounts(base::Array<std::uint32_t>& counts, const base::Comm& comm) {
  if (comm.alone()) return;
  const std::vector<std::uint32_t> mine = counts.toHost();
  std::vector<std::int64_t> all(mine.begin(), mine.end());
  comm.sum(all.data(), all.size());
  counts.assign(std::vector<std::uint32_t>(all.begin(), all.end()));
}

/// Velocities of the rigid bodies in the iterations of a step. The host computes them from integer sums of the
/// impulses, so all ranks have identical bits.
template <class Real> class ImpulseBodies {
public:
  explicit ImpulseBodies(const base::Exec& exec)
      : exec_(exec), laws_(exec), bodyOfPart_(exec), inverses_(exec), rows_(exec), pushes_(exec), motion_(exec) {}

  /// Starts a step with the body velocities without grain contacts.
  void begin(contact::BodyResponse& bodies, const contact::GrainPartContacts& contacts, double timeStep) {
    bodies_ = &bodies;
    const std::size_t count = bodies.inverses().size();
    if (&contacts != contacts_) {
      contacts_ = &contacts;
      std::vector<contact::BasicLaw<Real>> laws;
      for (const contact::ContactLaw& law : contacts.laws()) laws.push_back(law.as<Real>());
      laws_.assign(laws), bodyOfPart_.assign(bodies.bodyOfPart());
      // Same resolution as the forces of penalty contacts.
      const contact::GrainPartModel& model = contacts.model();
      push_ = base::fixedPointFor(model.force.quantum * timeStep * 0x1p40, 40);
      turn_ = base::fixedPointFor(model.torque.quantum * timeStep * 0x1p40, 40);
    }
    inverses_.assign(bodies.inverses());
    anyMovable_ =
        std::any_of(bodies.inverses().begin(), bodies.inverses().end(), [](const auto& b) { return b.mass > 0; });
    rows_.assign(std::vector<std::uint32_t>(count));
    pushes_.resize(6 * count);
    for (State& state : states_) state.impulses.assign(count, {});
    motion_.resize(kBuffers * count);
    respond(0);
  }

  void into(ImpulseData<Real>& data) {
    data.partLaws = laws_.data(), data.bodyOfPart = bodyOfPart_.data(), data.body = inverses_.data();
    data.bodyRows = rows_.data(), data.bodyPushes = anyMovable_ ? pushes_.data() : nullptr;
    for (int k = 0; k < kBuffers; ++k) data.bodyMotion[k] = motionOf(anyMovable_ ? k : 0);
    data.bodyPush = push_, data.bodyTurn = turn_;
  }

  /// Sums the row counts over the ranks. Collective.
  void sumRows(const base::Comm& comm) { sumCounts(rows_, comm); }

  /// True if any body can move.
  bool anyMovable() const { return anyMovable_; }
  void clearPushes() { pushes_.zero(); }
  /// Computes the body velocities in buffer `generation` from the impulses of all ranks. Collective.
  void move(int generation, const base::Comm& comm) {
    std::vector<std::int64_t> pushes = pushes_.toHost();
    comm.sum(pushes.data(), pushes.size());
    std::vector<contact::BodyImpulse>& impulses = states_[generation].impulses;
    for (std::size_t b = 0; b < impulses.size(); ++b) {
      const std::int64_t* const q = pushes.data() + 6 * b;
      impulses[b] = {push_.checked({q[0], q[1], q[2]}, "impulses on a body"),
                     turn_.checked({q[3], q[4], q[5]}, "impulses on a body")};
    }
    respond(generation);
  }
  /// Share of the bodies in the curvature of the step from the extrapolated impulses to the trial [J].
  double curvature(const ImpulseControl<Real>& c) const {
    double sum = 0;
    for (std::size_t b = 0; b < rows_.size(); ++b)
      sum += dot(c.stepOf([&](int k) { return states_[k].impulses[b].linear; }),
                 c.stepOf([&](int k) { return states_[k].velocities[b].linear; })) +
             dot(c.stepOf([&](int k) { return states_[k].impulses[b].angular; }),
                 c.stepOf([&](int k) { return states_[k].velocities[b].angular; }));
    return sum;
  }

private:
  static constexpr int kBuffers = 3;

  /// Impulses on the bodies, and the resulting velocities.
  struct State {
    std::vector<contact::BodyImpulse> impulses;
    std::vector<contact::BodyVelocity> velocities;
  };

  BodyMotion<Real>* motionOf(int generation) {
    return motion_.data() + static_cast<std::size_t>(generation) * rows_.size();
  }

  void respond(int generation) {
    bodies_->respond(states_[generation].impulses, states_[generation].velocities);
    std::vector<BodyMotion<Real>> motion;
    for (const contact::BodyVelocity& v : states_[generation].velocities)
      motion.push_back({v.linear.template as<Real>(), v.angular.template as<Real>()});
    base::copyToDevice(exec_, motionOf(generation), motion.data(), motion.size() * sizeof(motion[0]));
  }

  base::Exec exec_;
  contact::BodyResponse* bodies_{nullptr};
  const contact::GrainPartContacts* contacts_{nullptr}; ///< source of laws and quanta
  bool anyMovable_{false};
  base::Array<contact::BasicLaw<Real>> laws_;
  base::Array<std::uint32_t> bodyOfPart_;
  base::Array<contact::BodyResponse::Inverse> inverses_;
  base::Array<std::uint32_t> rows_;
  base::Array<std::int64_t> pushes_;
  base::Array<BodyMotion<Real>> motion_; ///< [buffer][body]
  base::FixedPoint push_, turn_;
  std::array<State, kBuffers> states_; ///< by buffer
};

} // namespace grouser::terrain
