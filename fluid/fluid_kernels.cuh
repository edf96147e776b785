// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/bits.hpp"
#include "base/for_each.cuh"
#include "fluid/fluid_view.hpp"

#include <cmath>

/// Kernel bodies of a fluid step. Every pair term is an exact function of the pair, opposite to its partner's term,
/// and rounded once to an integer, so sums are identical in any order, on every device.
namespace grouser::fluid {

/// Rounds to the nearest integer. A pair term is within its range (FluidConstants) until a fault ends the run.
GROUSER_HD std::int64_t rounded(float quanta) {
#if defined(__CUDA_ARCH__)
  return __float2int_rn(quanta);
#else
  return fabsf(quanta) < 0x1p31f ? static_cast<std::int32_t>(rintf(quanta)) : 0;
#endif
}

GROUSER_HD base::Vec3l roundedVector(const base::Vec3f& v) { return {rounded(v.x), rounded(v.y), rounded(v.z)}; }

/// Same for terms beyond 32 bits.
GROUSER_HD std::int64_t roundedLong(float quanta) {
#if defined(__CUDA_ARCH__)
  return __float2ll_rn(quanta);
#else
  return std::llrintf(quanta);
#endif
}
GROUSER_HD base::Vec3l roundedLong(const base::Vec3f& v) {
  return {roundedLong(v.x), roundedLong(v.y), roundedLong(v.z)};
}

/// Pair of points within the kernel support.
struct Pair {
  base::Vec3f d; ///< from the neighbour to this point [m]
  float r2;      ///< [m2]
  float q;       ///< distance over smoothing length [-]
  float taper;   ///< 1 - q/2 [-]

  /// V0 F [1/m2], <= 0.
  GROUSER_HD float slope(const FluidConstants& k) const { return k.slope * (taper * taper * taper); }
  /// W/W(0) [-].
  GROUSER_HD float weight() const { return taper * taper * (taper * taper) * (1 + 2 * q); }
};

/// Returns the pair at a given distance from neighbour to point [units]; inside the support if q < 2.
GROUSER_HD Pair pairAt(const FluidConstants& k, const base::Vec3f& units) {
  Pair pair;
  pair.d = units * k.metresPerUnit;
  pair.r2 = dot(pair.d, pair.d);
  pair.q = sqrtf(pair.r2) * k.perLength;
  pair.taper = 1 - 0.5f * pair.q;
  return pair;
}

/// Calls visit(pair, j) for the neighbours within the support among the places [first, last) of row i.
template <class Visit>
GROUSER_HD void eachNeighbour(const FluidView& f, int i, std::uint32_t first, std::uint32_t last, const Visit& visit) {
  const FluidConstants& k = f.constants;
  const base::Position here = f.position[i];
  const bool periodic = k.period.any();
  for (std::uint32_t n = first; n < last; ++n) {
    const std::uint32_t j = f.rows.slot[f.rows.at(i, n)];
    const base::Vec3i apart =
        periodic ? k.period.apart(f.position[j], here).as<std::int32_t>() : base::difference(f.position[j], here);
    const Pair pair = pairAt(k, apart.as<float>());
    if (pair.q < 2) visit(pair, j);
  }
}
/// Visits the fluid neighbours of the particle or marker in slot i.
template <class Visit> GROUSER_HD void eachFluidNeighbour(const FluidView& f, int i, const Visit& visit) {
  eachNeighbour(f, i, 0, f.rows.fluidCount[i], visit);
}
/// Visits the markers near particle i.
template <class Visit> GROUSER_HD void eachMarkerNeighbour(const FluidView& f, int i, const Visit& visit) {
  eachNeighbour(f, i, f.rows.fluidCount[i], f.rows.count[i], visit);
}

/// p/rho^2 in units of c^2/rho0: s/(1 + s)^2 [-].
template <class T> GROUSER_HD T stress(T compression) { return compression / ((1 + compression) * (1 + compression)); }

GROUSER_HD void raiseFault(FluidFlags* flags, FluidFault fault, std::uint32_t id) {
  base::atomicMin64(&flags->fault, static_cast<std::uint64_t>(fault) << 32 | id);
}

/// Acceleration of particle i [m/s2]: pair terms, gravity and central attraction.
GROUSER_HD base::Vec3d accelerationOf(const FluidView& f, int i) {
  base::Vec3d a = f.constants.acceleration.value(f.force[i]) + f.gravity;
  if (f.attraction != 0) a -= f.attraction * f.constants.scale.toMetres(f.position[i]);
  return a;
}

/// Displacement of particle i since the lists were built [m].
GROUSER_HD double movedSinceListed(const FluidView& f, int i) {
  const base::Vec3l d = f.constants.period.apart(f.reference[i], f.position[i]);
  return norm(d.as<double>()) * f.constants.scale.unit;
}

/// v += a dt/2. At the end of a step (`greatestMove` > 0) it requests new lists if the next step, drifting at v + a
/// dt/2, would move a particle more than `greatestMove` [m] from its listed position.
struct Kick {
  static constexpr double kNanoseconds = 15;
  FluidView f;
  double greatestMove = 0;
  GROUSER_HD void operator()(int i) const {
    if (f.isGhost(i)) return;
    PreciseMotion& m = f.precise[i];
    const base::Vec3d half = 0.5 * f.timeStep * accelerationOf(f, i);
    m.velocity += half;
    const base::Vec3f v = m.velocity.as<float>();
    f.motion[i] = {v.x, v.y, v.z, static_cast<float>(m.compression)};
    const float speed2 = dot(v, v);
    if (!(speed2 < f.constants.greatestSpeed * f.constants.greatestSpeed))
      raiseFault(f.flags, FluidFault::speed, f.id[i]);
    else if (f.shift)
      base::atomicMax32(&f.flags->fastest, base::bitsAs<std::uint32_t>(speed2));
    if (greatestMove > 0 && movedSinceListed(f, i) + norm(m.velocity + half) * f.timeStep > greatestMove)
      base::raise(&f.flags->listEnded);
  }
};

/// r += move [m].
GROUSER_HD void moveBy(const FluidView& f, int i, const base::Vec3d& move) {
  constexpr double kRange = 0x1p41; // units, range of positions
  const base::PositionScale& scale = f.constants.scale;
  const auto units = [&scale](double metres) {
    return static_cast<std::int64_t>(floor(metres * scale.perMetre + 0.5));
  };
  const auto inRange = [](std::int64_t u) { return fabs(static_cast<double>(u)) < kRange; };
  if (norm(move) * scale.perMetre < kRange) { // false for NaN
    const base::Vec3l to = base::toUnits(f.position[i]) + base::Vec3l{units(move.x), units(move.y), units(move.z)};
    if (inRange(to.x) && inRange(to.y) && inRange(to.z) &&
        scale.unit * static_cast<double>(to.z) > f.constants.lowest) {
      f.position[i] = base::fromUnits(f.constants.period.wrapped(to));
      return;
    }
  }
  raiseFault(f.flags, FluidFault::range, f.id[i]);
}

/// Vector from the origin of its body to marker n of the bodies [m], world components.
GROUSER_HD base::Vec3d armOf(const FluidView& f, std::uint32_t n) {
  return rotate(f.body[f.bodyOf[n]].pose.orientation, f.bodyPoint[n]);
}

/// Sets the position of slot i to a place [m] within the range of positions.
GROUSER_HD void setPosition(const FluidView& f, std::uint32_t i, const base::Vec3d& place) {
  f.position[i] = base::fromUnits(f.constants.period.wrapped(base::toUnits(f.constants.scale.fromMetres(place))));
}

/// r += v dt/2.
struct Drift {
  static constexpr double kNanoseconds = 20;
  FluidView f;
  GROUSER_HD void operator()(int i) const {
    if (!f.isGhost(i)) moveBy(f, i, 0.5 * f.timeStep * f.precise[i].velocity);
  }
};

/// Adds the compression change, then r += v dt/2 and shifting.
struct CompressAndDrift {
  static constexpr double kNanoseconds = 30;
  FluidView f;
  double skin;          ///< [m]
  double shiftFactor;   ///< shifting x h x dt [m s]
  double greatestShift; ///< [m]
  double minDivergence; ///< no shifting below this value [-]

  GROUSER_HD void operator()(int i) const {
    if (f.isGhost(i)) return;
    addCompression(i);
    base::Vec3d move = 0.5 * f.timeStep * f.precise[i].velocity;
    if (f.shift && f.divergence[i] > minDivergence) move += shiftOf(i);
    moveBy(f, i, move);
    if (movedSinceListed(f, i) > 0.5 * skin) raiseFault(f.flags, FluidFault::displacement, f.id[i]);
  }

private:
  GROUSER_HD void addCompression(int i) const {
    double& compression = f.precise[i].compression;
    const CompressionChange change = f.change[i];
    const double mean = compression + 0.5 * (change.flow + change.diffusion);
    compression += change.flow + change.diffusion;
    if (change.limit < kMaxCompression) limitCompression(i, change.limit);
    // Internal energy change due to diffusion: p/rho^2 drho.
    f.losses[i].diffusion -= static_cast<double>(f.constants.sound2) * stress(mean) * change.diffusion;
    f.motion[i].w = static_cast<float>(compression);
    if (!(fabs(compression) < kMaxCompression)) raiseFault(f.flags, FluidFault::compression, f.id[i]);
  }
  GROUSER_HD void limitCompression(int i, double limit) const {
    double& compression = f.precise[i].compression;
    const double within = compression > limit ? limit : compression < -limit ? -limit : compression;
    f.losses[i].wall += static_cast<double>(f.constants.sound2) * stress(within) * (compression - within);
    compression = within;
  }
  GROUSER_HD base::Vec3d shiftOf(int i) const {
    const double speed = sqrt(static_cast<double>(base::bitsAs<float>(f.flags->fastest)));
    const base::Vec3d shift = f.shift[i] * (-shiftFactor * speed);
    const double length = norm(shift);
    return length > greatestShift ? shift * (greatestShift / length) : shift;
  }
};

/// ds/dt = V0 sum_j (v_i - v_j).grad W, and diffusion 2 delta h c V0 sum_j |F| e_ij between fluid particles, with
/// e_ij = s_j - s_i - g.(r_j - r_i)/c^2 (Fourtakas et al. 2019, linear equation of state).
template <bool kShifts> struct Continuity {
  static constexpr double kNanoseconds = 800;
  FluidView f;

  GROUSER_HD void operator()(int i) const {
    if (f.isGhost(i)) return;
    const FluidConstants& k = f.constants;
    const base::Vec4f own = f.motion[i];
    const auto perRate = static_cast<float>(k.rate.perUnit);
    std::int64_t flow = 0, diffusion = 0, divergence = 0;
    base::Vec3l gradient{};
    const auto both = [&](const Pair& pair, const base::Vec4f& other, float slope) {
      flow += rounded(slope * dot(own.xyz() - other.xyz(), pair.d) * perRate);
      if constexpr (kShifts) addConcentration(pair, slope, divergence, gradient);
    };
    eachFluidNeighbour(f, i, [&](const Pair& pair, std::uint32_t j) {
      const base::Vec4f other = f.motion[j];
      const float slope = pair.slope(k), excess = other.w - own.w + dot(k.gravityOverSound2, pair.d);
      both(pair, other, slope);
      diffusion += rounded(k.diffusion * slope * excess * perRate);
    });
    const float beside = 1.5f * k.contact * k.perLength;
    bool pinched = false;
    eachMarkerNeighbour(f, i, [&](const Pair& pair, std::uint32_t j) {
      both(pair, f.motion[j], pair.slope(k));
      if (pair.q < beside) pinched |= f.contactOf(j - f.particles) < k.contact;
    });
    f.change[i] = {f.timeStep * k.rate.value(flow), f.timeStep * k.rate.value(diffusion),
                   pinched ? kPinchedCompression : kMaxCompression};
    if constexpr (kShifts) {
      f.divergence[i] = static_cast<float>(k.divergence.value(divergence));
      f.shift[i] = k.gradient.value(gradient);
    }
  }

private:
  /// div r = -V0 sum r.grad W, and V0 sum (1 + 0.2 (W/W(spacing))^4) grad W.
  GROUSER_HD void addConcentration(const Pair& pair, float slope, std::int64_t& divergence,
                                   base::Vec3l& gradient) const {
    const FluidConstants& k = f.constants;
    const float w2 = pair.weight() * pair.weight();
    gradient +=
        roundedVector(pair.d * (slope * (1 + k.shiftSeed * (w2 * w2)) * static_cast<float>(k.gradient.perUnit)));
    divergence += rounded(-slope * pair.r2 * static_cast<float>(k.divergence.perUnit));
  }
};

/// Marker pressure, extrapolated from the fluid (Adami et al. 2012, eq. 27), and ghost velocity for no slip at the
/// wall: 2 u_w minus the mean fluid velocity.
struct Extrapolate {
  static constexpr double kNanoseconds = 500;
  FluidView f;
  const std::uint32_t* list; ///< markers near fluid

  GROUSER_HD void operator()(int n) const {
    const FluidConstants& k = f.constants;
    const std::uint32_t m = list[n];
    const auto slot = static_cast<int>(f.particles + m);
    std::int64_t weight = 0, compression = 0;
    base::Vec3l moment{}, velocity{};
    eachFluidNeighbour(f, slot, [&](const Pair& pair, std::uint32_t j) {
      const base::Vec4f other = f.motion[j];
      const float w = pair.weight();
      weight += rounded(w * static_cast<float>(k.weight.perUnit));
      compression += rounded(w * other.w * static_cast<float>(k.compression.perUnit));
      moment += roundedVector(pair.d * (w * (1 + other.w) * static_cast<float>(k.moment.perUnit)));
      if (f.ghostVelocity) velocity += roundedVector(other.xyz() * (w * static_cast<float>(k.speed.perUnit)));
    });
    base::Vec4f& own = f.motion[slot];
    if (weight <= 0) {
      own.w = 0;
      if (f.ghostVelocity) f.ghostVelocity[m] = own.xyz();
      return;
    }
    const double sum = k.weight.value(weight);
    const double c2 = static_cast<double>(k.sound2);
    const base::Vec3d pull = (f.gravity - markerAcceleration(m)) * (1 / c2);
    const double s = (k.compression.value(compression) + dot(pull, k.moment.value(moment))) / sum;
    constexpr double kMax = kMaxCompression;
    own.w = static_cast<float>(stress(s > kMax ? kMax : s < -kMax ? -kMax : s));
    if (f.ghostVelocity)
      f.ghostVelocity[m] = (2.0 * own.xyz().as<double>() - k.speed.value(velocity) * (1 / sum)).as<float>();
  }

private:
  GROUSER_HD base::Vec3d markerAcceleration(std::uint32_t m) const {
    if (m < f.fixedMarkers || f.contactOf(m) == 0) return {};
    const std::uint32_t n = m - f.fixedMarkers;
    const BodyMotion& body = f.body[f.bodyOf[n]];
    const base::Vec3d arm = armOf(f, n);
    return body.acceleration + cross(body.angularAcceleration, arm) + cross(body.spin, cross(body.spin, arm));
  }
};

/// Moves markers with their bodies, to positions and velocities `before` [s] earlier than the end of the step.
struct PlaceMarkers {
  static constexpr double kNanoseconds = 40;
  FluidView f;
  double before;
  GROUSER_HD void operator()(int n) const {
    const BodyMotion& body = f.body[f.bodyOf[n]];
    const base::Vec3d arm = armOf(f, static_cast<std::uint32_t>(n));
    const base::Vec3d v = body.velocity + cross(body.spin, arm);
    const std::uint32_t slot = f.particles + f.fixedMarkers + static_cast<std::uint32_t>(n);
    setPosition(f, slot, body.pose.position + arm - v * before);
    const base::Vec3f speed = v.as<float>();
    f.motion[slot] = {speed.x, speed.y, speed.z, f.motion[slot].w};
  }
};

/// Stores stress in place of compression for the force sums.
struct StoreStress {
  static constexpr double kNanoseconds = 4;
  FluidView f;
  GROUSER_HD void operator()(int i) const { f.motion[i].w = stress(f.motion[i].w); }
};

/// Acceleration of particle i due to a pair [m/s2]: pressure -m (p_i/rho_i^2 + p_j/rho_j^2) grad W, artificial
/// viscosity (Monaghan 1992) and laminar viscosity (FluidModel). `slip`: relative velocity for the laminar term.
struct PairForce {
  base::Vec3f pressure, viscous;
};
GROUSER_HD PairForce pairForce(const FluidConstants& k, const Pair& pair, const base::Vec4f& own,
                               const base::Vec4f& other, const base::Vec3f& slip, bool artificial) {
  const float slope = pair.slope(k), stresses = own.w + other.w;
  PairForce force{pair.d * (-k.sound2 * stresses * slope), {}};
  const float approach = dot(own.xyz() - other.xyz(), pair.d);
  if (artificial && approach < 0) // 1/rho of the pair, first order
    force.viscous = pair.d * (k.artificial * approach / (pair.r2 + k.eta2) * (1 - 0.5f * stresses) * slope);
  if (k.laminar > 0) {
    const float viscosity = k.laminar * (1 - stresses) * slope;
    force.viscous +=
        k.central > 0 ? pair.d * (k.central * dot(slip, pair.d) / (pair.r2 + k.eta2) * viscosity) : slip * viscosity;
  }
  return force;
}

/// Acceleration of a particle due to a marker within its contact range [m/s2], from the potential 3 c^2 (1 -
/// r/range)^2. It prevents leaks through walls where the fluid pressure is small, as in thin jets. The barrier between
/// markers is 0.34 c^2 in three dimensions, 0.49 c^2 in two, above the 0.3 c^2 of fluid at the maximum compression.
///
/// `apart`: relative velocity times pair.d, > 0 if they separate [m2/s]. Time steps do not resolve the impact of a
/// jet on markers at an edge: the force on particles that separate faster than 0.15 c is reduced, to a tenth above
/// 0.25 c.
GROUSER_HD base::Vec3f contactForce(const FluidView& f, const Pair& pair, std::uint32_t marker, float apart) {
  const FluidConstants& k = f.constants;
  const float r = pair.q / k.perLength;
  if (r >= k.contact || r == 0) return {};
  const float range = f.contactOf(marker);
  if (r >= range) return {};
  const float share = 1 - 9 * (apart / (r * sqrtf(k.sound2)) - 0.15f);
  return pair.d * (6 * k.sound2 * (range - r) / (range * range * r) * fmaxf(0.1f, fminf(1.0f, share)));
}

/// Sums the accelerations of a particle: all pairs, viscous forces, and marker pressure.
struct Force {
  static constexpr double kNanoseconds = 900;
  FluidView f;

  GROUSER_HD void operator()(int i) const {
    if (f.isGhost(i)) return;
    const FluidConstants& k = f.constants;
    const base::Vec4f own = f.motion[i];
    const auto perAcceleration = static_cast<float>(k.acceleration.perUnit);
    const auto perPower = static_cast<float>(k.power.perUnit);
    base::Vec3l sum{}, viscous{}, wall{};
    std::int64_t dragPower = 0, wallPower = 0; // marker force times marker velocity
    const auto add = [&](const PairForce& force) {
      sum += roundedVector((force.pressure + force.viscous) * perAcceleration);
      viscous += roundedVector(force.viscous * perAcceleration);
    };
    eachFluidNeighbour(f, i, [&](const Pair& pair, std::uint32_t j) {
      const base::Vec4f other = f.motion[j];
      add(pairForce(k, pair, own, other, own.xyz() - other.xyz(), true));
    });
    eachMarkerNeighbour(f, i, [&](const Pair& pair, std::uint32_t j) {
      const base::Vec4f other = f.motion[j];
      const base::Vec3f slip = f.ghostVelocity ? own.xyz() - f.ghostVelocity[j - f.particles] : base::Vec3f{};
      const PairForce force = pairForce(k, pair, own, other, slip, false);
      add(force);
      const base::Vec3f push = pair.d * (-k.sound2 * other.w * pair.slope(k)),
                        contact = contactForce(f, pair, j - f.particles, dot(own.xyz() - other.xyz(), pair.d));
      const base::Vec3l repelled = roundedLong(contact * perAcceleration);
      sum += repelled;
      wall += roundedVector(push * perAcceleration) + repelled;
      wallPower += rounded(dot(push, other.xyz()) * perPower) + roundedLong(dot(contact, other.xyz()) * perPower);
      dragPower += rounded(dot(force.viscous, other.xyz()) * perPower);
    });
    f.force[i] = sum;
    // Work in both half kicks at their mean velocity, which is the end-of-step velocity.
    const base::Vec3d end = f.precise[i].velocity + 0.5 * f.timeStep * accelerationOf(f, i);
    const auto loss = [&](const base::Vec3l& force, std::int64_t power) {
      return f.timeStep * (k.power.value(power) - dot(k.acceleration.value(force), end));
    };
    f.losses[i].viscous += loss(viscous, dragPower);
    f.losses[i].wall += loss(wall, wallPower);
  }
};

/// Fluid force on a marker: the integers of Force with opposite sign. Markers of bodies add it to the body load.
/// Torques are rounded per pair, so that ranks may share the pairs of a marker.
struct WallForce {
  static constexpr double kNanoseconds = 500;
  FluidView f;
  const std::uint32_t* list;
  double perSpacing; ///< [1/m]

  GROUSER_HD void operator()(int n) const {
    const FluidConstants& k = f.constants;
    const std::uint32_t m = list[n];
    const auto slot = static_cast<int>(f.particles + m);
    const auto perAcceleration = static_cast<float>(k.acceleration.perUnit);
    const base::Vec4f own = f.motion[slot];
    const bool ofBody = m >= f.fixedMarkers;
    const base::Vec3d arm = ofBody ? armOf(f, m - f.fixedMarkers) * perSpacing : base::Vec3d{};
    BodyLoadQuanta sum{};
    eachFluidNeighbour(f, slot, [&](const Pair& pair, std::uint32_t j) {
      if (f.isGhost(j)) return; // added by another rank
      const base::Vec4f other = f.motion[j];
      const base::Vec3f slip = f.ghostVelocity ? f.ghostVelocity[m] - other.xyz() : base::Vec3f{};
      const PairForce force = pairForce(k, pair, own, other, slip, false);
      const base::Vec3l quanta =
          roundedVector((force.pressure + force.viscous) * perAcceleration) +
          roundedLong(contactForce(f, pair, m, dot(own.xyz() - other.xyz(), pair.d)) * perAcceleration);
      sum.force += quanta;
      if (ofBody) sum.torque += wholeVector(cross(arm, quanta.as<double>()));
    });
    f.markerForce[m] = sum.force;
    if (!ofBody) return;
    BodyLoadQuanta& load = f.bodyLoad[f.bodyOf[m - f.fixedMarkers]];
    for (int a = 0; a < 3; ++a)
      base::atomicAdd64(&load.force[a], sum.force[a]), base::atomicAdd64(&load.torque[a], sum.torque[a]);
  }

private:
  GROUSER_HD static base::Vec3l wholeVector(const base::Vec3d& v) {
    const auto whole = [](double x) { return static_cast<std::int64_t>(floor(x + 0.5)); };
    return {whole(v.x), whole(v.y), whole(v.z)};
  }
};

} // namespace grouser::fluid
