// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/start_checks.hpp"

#include "multibody/detail/axis_laws.hpp"
#include "multibody/detail/index.hpp"
#include "multibody/detail/vector6.hpp"
#include "multibody/detail/velocity_projection.hpp"
#include "multibody/part_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <sstream>
#include <string>

namespace grouser::multibody::detail {

namespace {

/// Largest accepted gap of joints in a new model [m, rad].
constexpr double kStartGap = 1e-6;
/// A driven axis with less than this fraction of its free mobility counts as determined by other elements.
constexpr double kFixedAxis = 1e-9;

/// An axis with less than this fraction of its mobility counts as locked by couplings; gear reductions leave more.
constexpr double kLockedAxis = 1e-13;
/// Ratios that differ by less than this relative value count as equal, since input may be rounded.
constexpr double kSameRatio = 1e-6;

template <class... Words> [[noreturn]] void refuse(const PartName& part, const Words&... words) {
  std::ostringstream fault;
  (fault << ... << words);
  throw PartError(part, "", fault.str());
}

/// Returns laws with free axes: hard rows only.
std::vector<AxisLaw> hardOnly(const ConstraintSystem& system) { return std::vector<AxisLaw>(system.axes().size()); }

/// List, for a message, of elements other than joints that may lock an axis.
std::string others(const Model& model, const std::string& drive) {
  std::string text;
  for (const Drive& d : model.drives())
    if (d.name != drive && d.on && imposesMotion(d)) text += (text.empty() ? "drive '" : ", drive '") + d.name + "'";
  for (const Coupling& c : model.couplings()) text += (text.empty() ? "coupling '" : ", coupling '") + c.name + "'";
  return text.empty() ? "joints" : "joints, " + text;
}

/// Transmission between two axes through couplings.
struct Train {
  double ratio = 1;
  std::vector<int> couplings;
};

/// Transmission ratio of the couplings before `end` from one axis to another; empty if they do not connect the two.
std::optional<Train> trainBetween(const std::vector<CouplingRow>& couplings, int from, int to, int end) {
  std::map<int, Train> reached{{from, {}}};
  for (std::vector<int> next{from}; !next.empty();) {
    const int axis = next.back();
    next.pop_back();
    for (int c = 0; c < end; ++c) {
      const CouplingRow& row = couplings[at(c)];
      if (row.axis1 != axis && row.axis2 != axis) continue;
      const bool forwards = row.axis1 == axis;
      const int other = forwards ? row.axis2 : row.axis1;
      if (reached.contains(other)) continue;
      Train train = reached[axis];
      train.ratio *= forwards ? row.ratio : 1 / row.ratio;
      train.couplings.push_back(c);
      reached[other] = train;
      next.push_back(other);
    }
  }
  const auto found = reached.find(to);
  return found == reached.end() ? std::nullopt : std::optional(found->second);
}

std::string namesOf(const Model& model, const std::vector<int>& couplings) {
  std::string names;
  for (const int c : couplings) names += (names.empty() ? "'" : ", '") + model.couplings()[at(c)].name + "'";
  return names;
}

/// Throws if couplings of `part` lock an axis that could move without them. `canMove`: for both axes of each coupling,
/// true if the axis can move without couplings.
[[noreturn]] void refuseLock(const ConstraintSystem& system, const Model& model, const ConstraintSystem::Part& part,
                             const std::vector<std::pair<bool, bool>>& canMove) {
  // The ratio contradicts the previous couplings.
  for (const int c : part.couplings) {
    const CouplingRow& row = system.couplings()[at(c)];
    const std::optional<Train> train = trainBetween(system.couplings(), row.axis1, row.axis2, c);
    if (!train || std::fabs(train->ratio - row.ratio) <= kSameRatio * std::fabs(row.ratio)) continue;
    const Coupling& coupling = model.couplings()[at(c)];
    refuse({"coupling", coupling.name}, "joint '", model.joints()[at(coupling.joint2)].name, "' cannot move ",
           row.ratio, " times as far as joint '", model.joints()[at(coupling.joint1)].name, "': with ",
           namesOf(model, train->couplings), " it moves ", train->ratio,
           " times as far; remove one of them, or correct a ratio");
  }
  for (std::size_t i = 0; i < canMove.size(); ++i) {
    if (canMove[i].first && canMove[i].second) continue;
    const Coupling& coupling = model.couplings()[at(part.couplings[i])];
    refuse({"coupling", coupling.name}, "the axis of joint '",
           model.joints()[at(canMove[i].first ? coupling.joint2 : coupling.joint1)].name,
           "' is locked by other joints, and therefore also the axes coupled to it; remove this coupling, or free the "
           "axis");
  }
  const Coupling& first = model.couplings()[at(part.couplings.front())];
  refuse({"coupling", first.name}, "joints '", model.joints()[at(first.joint1)].name, "' and '",
         model.joints()[at(first.joint2)].name, "' cannot move: the couplings (", namesOf(model, part.couplings),
         ") contradict each other through the joints; remove one of them, or correct a ratio");
}

} // namespace

void checkClosed(const ConstraintSystem& system, const Model& model) {
  const std::vector<Frame> frames = system.framesOfModel();
  for (const Constraint& c : system.constraints()) {
    const JointFrames f = framesOf(c, frames[at(c.bodyA)], frames[at(c.bodyB)]);
    double error[6];
    positionError(c, f, error);
    for (int r = 0; r < 6; ++r)
      if (!(std::fabs(error[r]) <= kStartGap))
        refuse({"joint", model.joints()[at(c.source)].name}, rowName(c.kind, r), " has a gap of ", error[r],
               " [m or rad] at the start, above the limit of ", kStartGap, "; place the bodies so that it closes");
    const bool alongZ = c.kind == ConstraintKind::kRevolute || c.kind == ConstraintKind::kPrismatic ||
                        c.kind == ConstraintKind::kCylindrical || c.kind == ConstraintKind::kFixed;
    const bool alongX = c.kind == ConstraintKind::kPrismatic || c.kind == ConstraintKind::kFixed;
    if ((alongZ && dot(f.z_A, f.z_B) < 0) || (alongX && dot(f.x_A, f.x_B) < 0))
      refuse({"joint", model.joints()[at(c.source)].name},
             "the axes of its two frames point in opposite directions at the start; rotate one frame by 180 degrees");
  }
  for (std::size_t c = 0; c < system.couplings().size(); ++c) {
    const CouplingRow& row = system.couplings()[c];
    const double gap =
        system.positionOfAxis(row.axis2, frames) - row.ratio * system.positionOfAxis(row.axis1, frames) - row.offset;
    if (!(std::fabs(gap) <= kStartGap))
      refuse({"coupling", model.couplings()[c].name}, "has a gap of ", gap,
             " [m or rad] at the start, above the limit of ", kStartGap,
             "; place the bodies so that it closes, or remove its offset");
  }
}

/// Checks that no axis can move only without the couplings, i.e. that no two couplings impose different motions on it.
/// The mobility of an axis is row . y with y = K^-1 row.
void checkCouplings(ConstraintSystem& system, const Model& model) {
  const std::vector<Frame> frames = system.framesOfModel();
  const std::vector<AxisLaw> laws = hardOnly(system);
  for (const ConstraintSystem::Part& part : system.parts()) {
    if (part.couplings.empty()) continue;
    const auto mobilities = [&](bool coupled) {
      system.setCouplingsOn(coupled);
      system.linearise(part, frames, laws);
      std::vector<std::pair<double, double>> of; // both axes of each coupling
      for (const int c : part.couplings) {
        const auto mobility = [&](int axis) {
          const Axis& a = system.axes()[at(axis)];
          std::vector<Vector6> y(at(system.nodes()));
          system.addImpulse(a.constraint, a.row, 1, y);
          system.solve(part, y);
          return system.rowTimes(a.constraint, a.row, y);
        };
        of.emplace_back(mobility(system.couplings()[at(c)].axis1), mobility(system.couplings()[at(c)].axis2));
      }
      return of;
    };
    const auto alone = mobilities(false), together = mobilities(true);
    std::vector<std::pair<bool, bool>> canMove;
    for (std::size_t i = 0; i < alone.size(); ++i) {
      const CouplingRow& row = system.couplings()[at(part.couplings[i])];
      const auto moves = [&](int axis, double mobility) {
        const Axis& a = system.axes()[at(axis)];
        return mobility > kFixedAxis * system.rowSize(a.constraint, a.row);
      };
      canMove.emplace_back(moves(row.axis1, alone[i].first), moves(row.axis2, alone[i].second));
    }
    const auto locked = [](double before, double after) { return before > 0 && after <= kLockedAxis * before; };
    for (std::size_t i = 0; i < alone.size(); ++i)
      if (locked(alone[i].first, together[i].first) && locked(alone[i].second, together[i].second))
        refuseLock(system, model, part, canMove);
  }
}

namespace {

/// Drives of the part that impose a motion.
std::vector<int> imposingDrives(const ConstraintSystem& system, const Model& model,
                                const ConstraintSystem::Part& part) {
  std::vector<int> drives;
  for (int d = 0; d < static_cast<int>(model.drives().size()); ++d) {
    const Drive& drive = model.drives()[at(d)];
    const int axis = system.axisOf(drive.joint, drive.axis);
    const bool here = std::find(part.constraints.begin(), part.constraints.end(), system.axes()[at(axis)].constraint) !=
                      part.constraints.end();
    if (here && imposesMotion(drive) && drive.on) drives.push_back(d);
  }
  return drives;
}

/// J M^-1 J^T of an axis between free bodies. y: change of the bodies' momenta by a unit impulse along the axis.
double freeMobility(const ConstraintSystem& system, const Model& model, const ConstraintSystem::Part& part,
                    const std::vector<Vector6>& y) {
  double free = 0;
  for (const int node : part.bodies) {
    const Body& body = model.bodies()[at(system.bodyOf(node))];
    const Mat3d& I = system.inertia(node);
    free +=
        norm2(linear(y[at(node)])) / body.mass + norm2(angular(y[at(node)])) * 3 / (I.m[0][0] + I.m[1][1] + I.m[2][2]);
  }
  return free;
}

/// Checks the drives in order. With y_d = K^-1 (row d) under the constraints of joints and couplings, row d . y_d minus
/// the share of previous drives is the mobility of the axis of drive d (Cholesky pivot).
void checkMobility(const ConstraintSystem& system, const Model& model, const ConstraintSystem::Part& part,
                   const std::vector<int>& drives) {
  const auto axisOf = [&](int d) {
    const Drive& drive = model.drives()[at(d)];
    return system.axes()[at(system.axisOf(drive.joint, drive.axis))];
  };
  std::vector<std::vector<double>> L;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const Axis a = axisOf(drives[i]);
    std::vector<Vector6> y(at(system.nodes()));
    system.addImpulse(a.constraint, a.row, 1, y);
    const double free = freeMobility(system, model, part, y);
    system.solve(part, y);
    L.emplace_back(i + 1);
    for (std::size_t j = 0; j <= i; ++j) {
      const Axis b = axisOf(drives[j]);
      double s = system.rowTimes(b.constraint, b.row, y);
      for (std::size_t m = 0; m < j; ++m) s -= L[i][m] * L[j][m];
      if (j < i) {
        L[i][j] = s / L[j][j];
        continue;
      }
      const Drive& drive = model.drives()[at(drives[i])];
      if (!(s > kFixedAxis * free))
        refuse({"drive", drive.name}, "the axis of joint '", model.joints()[at(drive.joint)].name,
               "' cannot move on its own: it is already determined by ", others(model, drive.name),
               "; remove one of them, or start away from a dead centre");
      L[i][i] = std::sqrt(s);
    }
  }
}

/// Checks that position laws start at the axis positions.
void checkLawStarts(const ConstraintSystem& system, const Model& model) {
  const std::vector<double> start = driveStart(system, model);
  for (std::size_t d = 0; d < model.drives().size(); ++d) {
    const Drive& drive = model.drives()[d];
    if (drive.kind != DriveKind::kPosition) continue;
    const double wanted = drive.law.value(0);
    if (!(std::fabs(wanted - start[d]) <= kStartGap))
      refuse({"drive", drive.name}, "its law starts at ", wanted, " [rad or m], but the axis of joint '",
             model.joints()[at(drive.joint)].name, "' starts at ", start[d],
             "; start the law there, or place the bodies to match");
  }
}

} // namespace

void checkDrives(ConstraintSystem& system, const Model& model) {
  const std::vector<Frame> frames = system.framesOfModel();
  const std::vector<AxisLaw> laws = hardOnly(system);
  for (const ConstraintSystem::Part& part : system.parts()) {
    const std::vector<int> drives = imposingDrives(system, model, part);
    if (drives.empty()) continue;
    system.linearise(part, frames, laws);
    checkMobility(system, model, part, drives);
  }
  checkLawStarts(system, model);
}

void checkVelocities(ConstraintSystem& system, const Model& model, double tolerance, bool drives) {
  const std::vector<Frame> frames = system.framesOfModel();
  std::vector<Twist> twist;
  double fastest = 0;
  for (const Body& body : model.bodies()) {
    twist.push_back({body.v_WB, body.w_WB});
    fastest = std::max({fastest, norm(body.v_WB), norm(body.w_WB)});
  }
  // Add a tolerance for input of limited precision.
  const double allowed = tolerance * std::max(1.0, fastest);
  const std::string remedy =
      "; set velocities that satisfy the constraints, or project them (start velocities: accept)";
  std::vector<AxisLaw> laws(system.axes().size());
  imposedLaws(system, model, makeLoads(model), 0, laws);
  for (const ConstraintSystem::Part& part : system.parts()) {
    system.linearise(part, frames, laws);
    for (const int k : part.constraints) {
      const Constraint& c = system.constraints()[at(k)];
      for (int r = 0; r < 6; ++r) {
        if (!(hardRows(c.kind) >> r & 1u)) continue;
        const double rate = system.rate(k, r, twist);
        if (!(std::fabs(rate) <= allowed))
          refuse({"joint", model.joints()[at(c.source)].name}, rowName(c.kind, r), ": the start velocities of '",
                 model.bodyName(model.joints()[at(c.source)].bodyA), "' and '",
                 model.bodyName(model.joints()[at(c.source)].bodyB), "' open it at a rate of ", rate,
                 " [m/s or rad/s], above the limit of ", allowed, remedy);
      }
      for (int a = system.firstAxis(k); drives && a < system.firstAxis(k + 1); ++a) {
        if (!laws[at(a)].driven) continue;
        const double rate = system.rateOfAxis(a, twist);
        if (!(std::fabs(rate - laws[at(a)].speed) <= allowed))
          refuse({"joint", model.joints()[at(c.source)].name}, "its axis starts at a rate of ", rate,
                 " [m/s or rad/s], but its drive imposes ", laws[at(a)].speed, remedy);
      }
    }
    for (const int i : part.couplings) {
      const CouplingRow& row = system.couplings()[at(i)];
      const double rate = system.rateOfAxis(row.axis2, twist) - row.ratio * system.rateOfAxis(row.axis1, twist);
      if (!(std::fabs(rate) <= allowed))
        refuse({"coupling", model.couplings()[at(i)].name}, "the start velocities open it at a rate of ", rate,
               " [m/s or rad/s], above the limit of ", allowed, remedy);
    }
  }
}

} // namespace grouser::multibody::detail
