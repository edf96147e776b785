// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "multibody/readings.hpp"
#include "multibody/solver.hpp"

#include <string>

/// Mechanisms shared by several tests of this folder. All are in the x-z plane and rotate about y.
namespace grouser::multibody::test {

inline const Vec3d kY{0, 1, 0};

/// Orientation rotated by `angle` [rad] about y, from z towards x.
inline Quat aboutY(double angle) { return {base::cos(angle / 2), 0, base::sin(angle / 2), 0}; }

/// Inertia of a small, nearly point-like mass [kg m2].
inline Mat3d pointInertia(double i = 1e-9) { return Mat3d::diagonal({i, i, i}); }

/// Inertia of a body with three different moments [kg m2].
inline const Mat3d kWheelInertia = Mat3d::diagonal({0.3, 0.2, 0.25});

inline Body makeBody(const std::string& name, double mass, const Mat3d& inertia, const Pose& pose, const Vec3d& v = {},
                     const Vec3d& w = {}) {
  Body b;
  b.name = name;
  b.mass = mass;
  b.inertia_B = inertia;
  b.pose = pose;
  b.v_WB = v;
  b.w_WB = w;
  return b;
}

/// A mechanism with its state and loads.
struct Mechanism {
  Model model;
  State state;
  Loads loads;
  void start() {
    state = makeState(model);
    loads = makeLoads(model);
  }
};

enum class RingJoints { kAllRevolute, kOneSphericalOneUniversal };

struct RingSpec {
  int links = 46;
  double pitch = 0.1, mass = 1, spin = 0; ///< [m], [kg], [rad/s] about y
  double damping = 0;                     ///< [N m s/rad] in every revolute
  RingJoints joints = RingJoints::kAllRevolute;
  Mat3d inertia = Mat3d::diagonal({0.002, 0.001, 0.0025}); ///< inertia of a link: x along it, y along the pins [kg m2]
  Vec3d centre{};
  std::string name = "link";
};

/// Radius of the pins of a regular ring [m].
inline double pinRadius(const RingSpec& s) { return s.pitch / (2 * base::sin(base::kPi / s.links)); }

/// Adds a ring of equal links spinning about its centre; joint i joins link i to link i + 1.
inline void addRing(Model& model, const RingSpec& s) {
  const int first = static_cast<int>(model.bodies().size());
  const double R = pinRadius(s), apothem = R * base::cos(base::kPi / s.links);
  const auto onCircle = [&](double r, double angle) {
    return s.centre + Vec3d{r * base::sin(angle), 0, r * base::cos(angle)};
  };
  const double turn = 2 * base::kPi / s.links;
  for (int i = 0; i < s.links; ++i) {
    const Vec3d p = onCircle(apothem, turn * (i + 0.5));
    model.addBody(makeBody(s.name + " " + std::to_string(i), s.mass, s.inertia, {p, aboutY(turn * (i + 0.5))},
                           cross(s.spin * kY, p - s.centre), s.spin * kY));
  }
  for (int i = 0; i < s.links; ++i) {
    JointType type = JointType::kRevolute;
    if (s.joints == RingJoints::kOneSphericalOneUniversal && i == s.links / 3) type = JointType::kSpherical;
    if (s.joints == RingJoints::kOneSphericalOneUniversal && i == 2 * s.links / 3) type = JointType::kUniversal;
    const bool revolute = type == JointType::kRevolute;
    model.addJointAt(s.name + " pin " + std::to_string(i), type, first + i, first + (i + 1) % s.links,
                     frameWithZ(onCircle(R, turn * (i + 1)), kY), revolute ? s.damping : 0);
  }
}

inline double length(const Vec3d& v) { return base::norm(v); }

} // namespace grouser::multibody::test
