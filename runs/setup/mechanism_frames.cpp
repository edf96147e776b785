// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/mechanism_frames.hpp"

#include "multibody/model.hpp"
#include "runs/support/section_fault.hpp"

#include <fmt/format.h>

#include <cmath>

namespace grouser::setup {

using base::Pose;
using base::Vec3d;
using multibody::JointType;

namespace {

/// Tolerance of the initial difference between joint frames given in both bodies [m, rad].
constexpr double kStartGap = 1e-6;
std::string text(const Vec3d& v) { return fmt::format("({:.7g}, {:.7g}, {:.7g})", v.x, v.y, v.z); }

/// Returns the direction given for a key. Throws SectionFault if it is missing or zero.
Vec3d direction(const char* key, const std::optional<Vec3d>& v) {
  if (!v)
    throw support::SectionFault(key, "[-] is missing, but this type of joint requires it; add it, e.g. [0, 0, 1]");
  if (norm2(*v) == 0) throw support::SectionFault(key, "[-] has zero length; set a direction, e.g. [0, 0, 1]");
  return normalized(*v);
}

bool hasAxis(JointType type) {
  return type != JointType::kSpherical && type != JointType::kFixed && type != JointType::kDistance;
}

/// Both frames, from point and axis in the world frame.
JointFrames placedInWorld(const scene::JointSection& j) {
  for (const auto& [key, given] : {std::pair{"point_a", j.pointA.has_value()},
                                   {"point_b", j.pointB.has_value()},
                                   {"axis_a", j.axisA.has_value()},
                                   {"axis_b", j.axisB.has_value()}})
    if (given)
      throw support::SectionFault(key, "is mutually exclusive with point; set either point and axis in the world "
                                       "frame, or point_a, point_b, axis_a and axis_b in the body frames");
  if (!hasAxis(j.type)) return {{*j.point, {}}, {*j.point, {}}};
  const Vec3d z = direction("axis", j.axis);
  Pose X = multibody::frameWithZ(*j.point, z);
  if (j.type == JointType::kUniversal) {
    const Vec3d x = direction("second_axis", j.secondAxis);
    if (std::fabs(dot(x, z)) > kStartGap)
      throw support::SectionFault(
          "second_axis",
          fmt::format("[-] must be perpendicular to axis at the start, but deviates by {:.6g} rad; correct it",
                      std::fabs(dot(x, z))));
    X = multibody::frameWithZX(*j.point, z, x);
  }
  return {X, X};
}

/// Both frames, from points and axes in the body frames, which must coincide at the start.
JointFrames placedInBodies(const scene::JointSection& j, const Pose& X_WA, const Pose& X_WB) {
  if (!j.pointA)
    throw support::SectionFault("point_a",
                                "[m] is missing, but point_b requires it; set both, or point in the world frame");
  if (!j.pointB)
    throw support::SectionFault("point_b",
                                "[m] is missing, but point_a requires it; set both, or point in the world frame");
  const Vec3d p_A = X_WA.toWorld(*j.pointA), p_B = X_WB.toWorld(*j.pointB);
  const auto apart = [&](const Vec3d& gap, const char* where) {
    if (!(norm(gap) <= kStartGap))
      throw support::SectionFault("point_b",
                                  fmt::format("[m] is initially at {} in the world, {:.4g} m{} from point_a at {} "
                                              "(tolerance {:g} m); correct the points or the positions of the bodies",
                                              text(p_B), norm(gap), where, text(p_A), kStartGap));
  };
  if (!hasAxis(j.type)) {
    apart(p_B - p_A, "");
    return {{p_A, X_WA.orientation}, {p_A, X_WA.orientation}};
  }
  const Vec3d z = rotate(X_WA.orientation, direction("axis_a", j.axisA));
  const Vec3d b = rotate(X_WB.orientation, direction("axis_b", j.axisB));
  if (j.type == JointType::kUniversal) {
    apart(p_B - p_A, "");
    if (std::fabs(dot(z, b)) > kStartGap)
      throw support::SectionFault(
          "axis_b",
          fmt::format("[-] must be perpendicular to axis_a at the start, but deviates by {:.6g} rad; correct it",
                      std::fabs(dot(z, b))));
    const Pose X = multibody::frameWithZX(p_A, z, b);
    return {X, X};
  }
  if (!(norm(cross(z, b)) <= kStartGap && dot(z, b) > 0))
    throw support::SectionFault("axis_b",
                                fmt::format("[-] initially points along {} in the world, but axis_a along {} "
                                            "(difference {:.4g}); rotate a body or an axis to make them parallel",
                                            text(b), text(z), norm(b - z)));
  const bool slides = j.type == JointType::kPrismatic || j.type == JointType::kCylindrical;
  const double slide = slides ? dot(p_B - p_A, z) : 0;
  apart(p_B - p_A - slide * z, slides ? " perpendicular to the axis" : "");
  const Pose X = multibody::frameWithZ(p_A, z);
  return {X, {p_A + slide * z, X.orientation}};
}

/// Frames of a distance joint: two points, with the orientations of the bodies.
JointFrames placedAtEnds(const scene::JointSection& j, const Pose& X_WA, const Pose& X_WB) {
  if (j.point)
    throw support::SectionFault("point",
                                "[m] does not apply to a distance joint; set point_a and point_b in the body frames");
  const JointFrames ends{{X_WA.toWorld(j.pointA.value_or(Vec3d{})), X_WA.orientation},
                         {X_WB.toWorld(j.pointB.value_or(Vec3d{})), X_WB.orientation}};
  if (!(norm(ends.B.position - ends.A.position) > 0))
    throw support::SectionFault(
        "point_b",
        "[m] coincides with point_a at the start, so the joint has no length; move one, or use a spherical joint");
  return ends;
}

} // namespace

JointFrames placeJoint(const scene::JointSection& j, const Pose& X_WA, const Pose& X_WB) {
  if (j.secondAxis && j.type != JointType::kUniversal)
    throw support::SectionFault("second_axis", "applies to universal joints only; remove it");
  if (j.type == JointType::kDistance) return placedAtEnds(j, X_WA, X_WB);
  if (!j.point && !j.pointA && !j.pointB)
    throw support::SectionFault("point",
                                "[m] is missing; add the initial position of the joint, or point_a and point_b");
  return j.point ? placedInWorld(j) : placedInBodies(j, X_WA, X_WB);
}

} // namespace grouser::setup
