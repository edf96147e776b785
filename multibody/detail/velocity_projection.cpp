// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/velocity_projection.hpp"

#include "multibody/detail/axis_laws.hpp"
#include "multibody/detail/index.hpp"
#include "multibody/detail/vector6.hpp"

namespace grouser::multibody::detail {

void imposedLaws(const ConstraintSystem& system, const Model& model, const Loads& loads, double t,
                 std::vector<AxisLaw>& laws) {
  for (AxisLaw& law : laws) law = {};
  for (std::size_t d = 0; d < model.drives().size(); ++d) {
    const Drive& drive = model.drives()[d];
    if (!loads.drives[d].on || !imposesMotion(drive)) continue;
    AxisLaw& law = laws[at(system.axisOf(drive.joint, drive.axis))];
    law.driven = true;
    law.speed = drive.law.empty() ? loads.drives[d].speed : drivenRate(drive, t);
  }
}

void readRates(const ConstraintSystem& system, State& state) {
  for (int a = 0; a < static_cast<int>(system.axes().size()); ++a) {
    const Axis& axis = system.axes()[at(a)];
    const Constraint& c = system.constraints()[at(axis.constraint)];
    if (!isJoint(c.kind)) continue;
    const bool slide = c.kind == ConstraintKind::kCylindrical && axis.row == kSlideRow;
    (slide ? state.slide[at(c.source)].rate : state.joint[at(c.source)].rate) = system.rateOfAxis(a, state.twist);
  }
}

void projectTwists(const ConstraintSystem& system, const ConstraintSystem::Part& part, const std::vector<AxisLaw>& laws,
                   std::vector<Vector6>& x, std::vector<Twist>& twist) {
  for (const int node : part.bodies) x[at(node)] = {};
  for (const int k : part.constraints) {
    Vector6& residual = x[at(system.movableBodies() + k)];
    residual = {};
    for (int r = 0; r < 6; ++r)
      if (system.hardRowsOf(k) >> r & 1u) residual[at(r)] = -system.rate(k, r, twist);
    for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a)
      if (laws[at(a)].driven) residual[at(system.axes()[at(a)].row)] = laws[at(a)].speed - system.rateOfAxis(a, twist);
  }
  for (const int c : part.couplings) {
    const CouplingRow& row = system.couplings()[at(c)];
    x[at(system.couplingNode(c))] = {};
    x[at(system.couplingNode(c))][0] =
        row.ratio * system.rateOfAxis(row.axis1, twist) - system.rateOfAxis(row.axis2, twist);
  }
  system.solve(part, x);
  for (const int node : part.bodies) {
    Twist& V = twist[at(system.bodyOf(node))];
    V.v += linear(x[at(node)]);
    V.w += angular(x[at(node)]);
  }
}

} // namespace grouser::multibody::detail
