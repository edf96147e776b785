// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/contact_modes.hpp"

#include "base/math.hpp"
#include "base/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace grouser::studies {

using base::Vec3d;

namespace {

constexpr int kIterations = 4000;
constexpr double kSphereInertia = 0.4; ///< moment of inertia of a sphere / (m R^2)

/// Displacement of a sphere, and its rotation times radius.
struct Motion {
  Vec3d move, turn;
};

/// Negative forces, and negative moments / radius, that springs of unit stiffness exert at a displacement.
void stiffnessTimes(const ContactNetwork& network, const std::vector<Motion>& u, std::vector<Motion>& f) {
  std::fill(f.begin(), f.end(), Motion{});
  for (const ContactNetwork::Contact& c : network.contacts) {
    const Vec3d& n = c.normal;
    const auto i = static_cast<std::size_t>(c.i), j = static_cast<std::size_t>(c.j);
    Vec3d apart = u[i].move, turns = u[i].turn;
    if (c.j >= 0) apart -= u[j].move, turns += u[j].turn;
    const Vec3d along = n * dot(apart, n);
    Vec3d force = along;
    if (network.tangentialRatio > 0) force += network.tangentialRatio * (apart - along + cross(turns, n));
    const Vec3d moment = cross(n, force);
    f[i].move += force, f[i].turn += moment;
    if (c.j >= 0) f[j].move -= force, f[j].turn += moment;
  }
}

} // namespace

double highestFrequency(const ContactNetwork& network) {
  std::vector<Motion> u(network.spheres), f(network.spheres);
  constexpr std::uint64_t kPurpose = base::purpose("study.modes");
  for (std::size_t i = 0; i < u.size(); ++i) {
    const auto random = [&](std::uint64_t k) { return 2 * base::uniform(1, kPurpose, i, k) - 1; };
    u[i] = {{random(0), random(1), random(2)}, {random(3), random(4), random(5)}};
  }
  double value = 0;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    stiffnessTimes(network, u, f);
    double elastic = 0, inertia = 0, size = 0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      elastic += dot(u[i].move, f[i].move) + dot(u[i].turn, f[i].turn);
      inertia += dot(u[i].move, u[i].move) + kSphereInertia * dot(u[i].turn, u[i].turn);
      u[i] = {f[i].move, f[i].turn * (1 / kSphereInertia)};
      size = std::max({size, norm(u[i].move), norm(u[i].turn)});
    }
    if (size == 0) return 0;
    value = elastic / inertia;
    for (Motion& m : u) m.move *= 1 / size, m.turn *= 1 / size;
  }
  return std::sqrt(value);
}

double gershgorinFrequency(const ContactNetwork& network) {
  // K is summed by blocks of rows: for each sphere, a power iteration finds the largest eigenvalue of sum_c w_c n n^T.
  std::vector<std::array<Vec3d, 3>> rows(network.spheres);
  const auto add = [&](std::size_t i, const Vec3d& n, double weight) {
    rows[i][0] += weight * n.x * n, rows[i][1] += weight * n.y * n, rows[i][2] += weight * n.z * n;
  };
  for (const ContactNetwork::Contact& c : network.contacts) {
    add(c.i, c.normal, c.j >= 0 ? 2 : 1);
    if (c.j >= 0) add(static_cast<std::size_t>(c.j), c.normal, 2);
  }
  double largest = 0;
  for (const auto& m : rows) {
    Vec3d v{0.6, 0.64, 0.48};
    double value = 0;
    for (int k = 0; k < 200; ++k) {
      const Vec3d w{dot(m[0], v), dot(m[1], v), dot(m[2], v)};
      value = norm(w);
      if (value == 0) break;
      v = w * (1 / value);
    }
    largest = std::max(largest, value);
  }
  return std::sqrt(largest);
}

} // namespace grouser::studies
