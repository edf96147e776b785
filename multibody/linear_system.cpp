// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/linear_system.hpp"

#include "multibody/detail/constraint_system.hpp"
#include "multibody/detail/index.hpp"

#include <vector>

namespace grouser::multibody {

using namespace detail;

struct LinearSystem::Impl {
  explicit Impl(const Model& model) : system(model), laws(system.axes().size()), x(at(system.nodes())) {
    frames = system.framesOfModel();
  }
  ConstraintSystem system;
  std::vector<AxisLaw> laws; ///< one per axis: free
  std::vector<Vector6> x;    ///< one per node
  std::vector<Frame> frames; ///< one per body, the world last
};

LinearSystem::LinearSystem(const Model& model) : impl_(std::make_unique<Impl>(model)) {}
LinearSystem::~LinearSystem() = default;
LinearSystem::LinearSystem(LinearSystem&&) noexcept = default;
LinearSystem& LinearSystem::operator=(LinearSystem&&) noexcept = default;

int LinearSystem::hardRows() const {
  int rows = 0;
  for (const Constraint& c : impl_->system.constraints()) rows += __builtin_popcount(detail::hardRows(c.kind));
  return rows;
}
int LinearSystem::loops() const { return static_cast<int>(impl_->system.elimination().tree().loops.size()); }
int LinearSystem::batches() const { return impl_->system.elimination().batches(); }
long LinearSystem::multiplications() const { return impl_->system.elimination().multiplications(); }

void LinearSystem::place(const State& state) { impl_->system.place(state.pose, impl_->frames); }
void LinearSystem::factor() {
  for (const ConstraintSystem::Part& part : impl_->system.parts())
    impl_->system.linearise(part, impl_->frames, impl_->laws);
}
void LinearSystem::solve() {
  for (const ConstraintSystem::Part& part : impl_->system.parts()) impl_->system.solve(part, impl_->x);
}

} // namespace grouser::multibody
