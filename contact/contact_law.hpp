// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/number.hpp"
#include "contact/plastic_law.hpp"

#include <cmath>

namespace grouser::contact {

/// Features of a scene's contact laws. Force functions and kernels have a sum of these as template parameter: absent
/// features are not compiled in. With kGeneral all are compiled in, and each law's constants decide at run time; the
/// results are bitwise identical.
inline constexpr unsigned kHertz = 1; ///< Hertz' normal and Mindlin's tangential stiffness; else constant stiffnesses
inline constexpr unsigned kFriction = 2;        ///< tangential spring with Coulomb's limit
inline constexpr unsigned kRollingFriction = 4; ///< rolling resistance with history
inline constexpr unsigned kCohesion = 8;        ///< constant attraction during contact
/// Damping depends on the effective mass of each contact, not of the whole scene.
inline constexpr unsigned kManyMasses = 16;
inline constexpr unsigned kPlastic = 32; ///< elastic-plastic normal springs, with history
/// Kernel also sums a ContactMoment; never set in a time step.
inline constexpr unsigned kMeasured = 1u << 30;
inline constexpr unsigned kGeneral = 1u << 31; ///< all features, selected at run time

/// Index of the plastic state in a contact's history, behind its springs.
GROUSER_HD constexpr int plasticPlace(unsigned features) {
  return features & kRollingFriction ? 6 : features & (kFriction | kPlastic) ? 3 : 0;
}
/// Size of the history of a contact with these features: tangential spring, rolling angle, plastic state.
GROUSER_HD constexpr int historyWidth(unsigned features) {
  return plasticPlace(features) + (features & kPlastic ? kPlasticNumbers : 0);
}

/// A contact law between two surfaces, in float or double. All of them are a normal spring and dashpot, and a
/// tangential spring with history and dashpot that slips at Coulomb's limit (Cundall and Strack 1979,
/// Geotechnique 29:47):
///
///   F_n = elastic + c_n v_n                     v_n: approach speed;  never attractive unless `attraction`
///   F_t = -k_t shear - c_t v_t                  |F_t| <= friction F_n; when it slips the spring is shortened to fit:
///                                               linear, to all of the force; Hertz, to no more than the limit
///
/// Linear:  elastic = k overlap,  k_t constant,  c_n = gamma m_eff;  among grains of many masses, where a restitution
/// is given, c_n = 2 zeta sqrt(k m_eff), so that it is the same for all of them.
///
/// Hertz-Mindlin, with the contact radius a = sqrt(R_eff overlap):
///   elastic = (4/3) E_eff a overlap,  k_t = 8 G_eff a (Mindlin 1949, no slip),  c_n = 2 beta sqrt(2 E_eff a m_eff), so
///   that the restitution does not depend on the speed (Tsuji et al. 1992, Powder Technol. 71:239).
///   While the contact is loaded the tangential force stays and the spring is shortened as it stiffens; while it is
///   unloaded the spring's length stays and the force falls with k_t (Thornton, Cummins and Cleary 2013, Powder
///   Technol. 233:30). So F_t^2 / (2 k_t) only falls as k_t changes: no closed path of loads and shears gains energy.
///
/// Cohesion (DMT, Derjaguin et al. 1975): a constant pull of 2 pi w R_eff while the spheres overlap, w the energy of
/// adhesion. At overlap zero it ends at once: parting needs that force, and the work done against it is that gained on
/// approach. Friction and rolling friction are limited by the pressing part, F_n without the pull.
///
/// Elastic-plastic contacts (plastic_law.hpp) have its force for `elastic`. Where that pulls the dashpot does not add
/// to it, and friction is limited by the force and what the contact could be pulled with (Thakur et al. 2014).
template <class T> struct BasicLaw {
  T stiffness{};             ///< linear: k [N/m], > 0;  Hertz: (4/3) E_eff [Pa]
  T damping{};               ///< linear: gamma [1/s], >= 0;  Hertz: 0
  T tangentialStiffness{};   ///< linear: k_t [N/m], >= 0;  Hertz: 8 G_eff [Pa]
  T tangentialDamping{};     ///< linear: gamma_t [1/s], >= 0;  Hertz: 0
  T friction{};              ///< Coulomb coefficient [-], >= 0; 0 switches the tangential force off
  bool attraction{};         ///< whether the dashpot may pull
  bool hertz{};              ///< Hertz, else linear
  T rootDamping{};           ///< Hertz: 2 beta sqrt(2 E_eff) [sqrt(Pa)];  linear with many masses: 2 zeta sqrt(k)
  T tangentialRootDamping{}; ///< the same for the tangential dashpot
  T rollingFriction{};       ///< [-], >= 0; 0 switches rolling resistance off
  T rollingDamping{};        ///< [-], >= 0: of the rolling spring's critical damping
  T pullPerRadius{};         ///< cohesion: 2 pi w [N/m], >= 0
  T pullPerArea{};           ///< for cohesion that grows with the radius: 2 pi dw / dR_eff [Pa], >= 0
  BasicPlasticity<T> plastic{};
  /// Linear, of one mass: share of both dashpots against a grain that never moves [-], for the restitution asked for.
  T fixedShare{1};
  /// A power of two near one over the contact's typical force [1/N]. Forces and torques are multiplied by it before
  /// they are squared: a float holds neither the squares of those of micrometre grains nor of those beyond 1e19 N. It
  /// changes no other bits; scaledFor() in strongest_force.hpp sets it.
  T squareScale{1};
  /// Coefficient of restitution of the damping [-], which complementarity contacts use instead.
  T restitution{};

  template <class U> BasicLaw<U> as() const {
    const auto u = [](T value) { return static_cast<U>(value); };
    return {u(stiffness),
            u(damping),
            u(tangentialStiffness),
            u(tangentialDamping),
            u(friction),
            attraction,
            hertz,
            u(rootDamping),
            u(tangentialRootDamping),
            u(rollingFriction),
            u(rollingDamping),
            u(pullPerRadius),
            u(pullPerArea),
            plastic.template as<U>(),
            u(fixedShare),
            u(squareScale),
            u(restitution)};
  }
  /// The same law without plasticity.
  BasicLaw elastic() const {
    BasicLaw law = *this;
    law.plastic = {};
    return law;
  }
  /// The same law with adhesion and cohesion scaled by `share` [-]; same features if that is > 0.
  BasicLaw pulling(T share) const {
    BasicLaw law = *this;
    for (T* pull :
         {&law.pullPerRadius, &law.pullPerArea, &law.plastic.pull, &law.plastic.pullGrowth, &law.plastic.adhesion})
      *pull *= share;
    return law;
  }
  bool coheres() const { return pullPerRadius > 0 || pullPerArea > 0; }
  /// Constant pull of cohesion [N] at an effective radius [m].
  template <class R> GROUSER_HD R pull(R effectiveRadius) const {
    return pullPerRadius * effectiveRadius + pullPerArea * effectiveRadius * effectiveRadius;
  }
  /// Features that a kernel needs for this law, except kManyMasses, which depends on the scene.
  unsigned features() const {
    return (hertz ? kHertz : 0u) | (friction > 0 ? kFriction : 0u) | (rollingFriction > 0 ? kRollingFriction : 0u) |
           (coheres() ? kCohesion : 0u) | (plastic.share > 0 ? kPlastic : 0u);
  }
};

/// Law in double precision; kernels convert to their own.
using ContactLaw = BasicLaw<double>;

using base::ScalarOf;
using base::squareRoot;

/// Two surfaces in touch, seen from side i; with SIMD numbers, as many pairs as there are lanes. The normal points from
/// i to j.
template <class T> struct BasicContactGeometry {
  base::Vec3<T> normal;                   ///< unit, from i to j
  T overlap;                              ///< [m], > 0
  base::Vec3<T> velocity;                 ///< of i's material point relative to j's at the contact point [m/s]
  T effectiveMass;                        ///< m_i m_j / (m_i + m_j) [kg]
  T effectiveRadius{};                    ///< R_i R_j / (R_i + R_j) [m]; for Hertz, cohesion and rolling
  T dampingShare = base::broadcast<T>(1); ///< multiplies both damping coefficients [-]: see BasicLaw::fixedShare
  T pullShare = base::broadcast<T>(1);    ///< multiplies the pull of cohesion [-]
  bool crushes{false}; ///< the overlap stays as it is while the surfaces approach: the grain gives way (crushing.hpp)
};
using ContactGeometry = BasicContactGeometry<float>;

/// Change of a contact's spring stiffness since the last step. With Hertz' law it is proportional to the contact
/// radius, hence to the root of the overlap.
template <class T> struct StiffnessChange {
  T kept = base::broadcast<T>(1); ///< ratio of spring lengths [-]: loading keeps the force, unloading the length
  T taken{};                      ///< dissipated energy over stiffness times squared former length [-], >= 0
};

/// Stiffness change from the approach `way` of the surfaces within the step [m].
template <class T> GROUSER_HD StiffnessChange<T> hertzChange(T overlap, T way) {
  using Scalar = ScalarOf<T>;
  const T one = base::broadcast<T>(1), share = way / overlap, within = share < one ? share : one;
  const T root = squareRoot(one - within), less = within / (one + root); // former stiffness over present; 1 - that
  const T kept = root < one ? root : one;
  return {kept, Scalar(0.5) * kept * (less < Scalar(0) ? -less : less)};
}

/// Force and energies of one contact in one step.
template <class T> struct BasicReaction {
  base::Vec3<T> force;         ///< on i [N]; on j it is the exact opposite
  T damped;                    ///< dissipated by the dashpots within the step [J]
  T rubbed;                    ///< dissipated by sliding within the step [J]
  T pressing;                  ///< normal force without cohesion and adhesion [N], which limits friction
  T normalStiffness;           ///< dF_n / d overlap of the elastic spring [N/m]
  T yielded{};                 ///< plastic work within the step [J]
  T slipped{};                 ///< dissipated by the tangential spring as its stiffness changes within the step [J]
  StiffnessChange<T> change{}; ///< Hertz: for the rolling spring too
};
using Reaction = BasicReaction<float>;

/// Spring force and coefficients of a contact at one overlap.
template <class T> struct Coefficients {
  T elastic;             ///< [N]
  T normalStiffness;     ///< [N/m]
  T damping;             ///< c_n [N s/m]
  T tangentialStiffness; ///< k_t [N/m]
  T tangentialDamping;   ///< c_t [N s/m]
};

template <unsigned kFeatures, class T> GROUSER_HD Coefficients<T>
coefficientsOf(const BasicLaw<ScalarOf<T>>& law, T overlap, T effectiveMass, T effectiveRadius) {
  using Scalar = ScalarOf<T>;
  if (kFeatures & kGeneral ? law.hertz : kFeatures & kHertz) {
    const T a = squareRoot(effectiveRadius * overlap);
    const T root = squareRoot(a * effectiveMass);
    const T modulus = law.stiffness * a;
    return {modulus * overlap, Scalar(1.5) * modulus, law.rootDamping * root, law.tangentialStiffness * a,
            law.tangentialRootDamping * root};
  }
  Coefficients<T> c{law.stiffness * overlap, base::broadcast<T>(law.stiffness), law.damping * effectiveMass,
                    base::broadcast<T>(law.tangentialStiffness), law.tangentialDamping * effectiveMass};
  if (kFeatures & (kManyMasses | kGeneral)) {
    const T root = squareRoot(effectiveMass);
    c.damping += law.rootDamping * root;
    c.tangentialDamping += law.tangentialRootDamping * root;
  }
  return c;
}

/// Force of `law` on side i, and the tangential spring `shear` [m] carried to the end of the step. T is float, double,
/// or SIMD numbers of these: one source for the kernels of both devices and for many contacts at a time.
/// Swapping i and j (normal, velocity and shear change sign) changes only the force's sign, to the last bit. `state`:
/// of an elastic-plastic contact, carried to the end of the step; where it is null all contacts are elastic.
///
/// Dashpot work uses the velocity in the middle of the step, with which symplectic Euler changes the kinetic energy
/// exactly, F . (v_old + v_new) / 2 dt, as if this contact acted alone: second order in the step for a single
/// collision. A sticking contact dissipates by its dashpots only; a sliding one all work except its spring's gain, with
/// the slip at the start of the step: a grain held at Coulomb's limit by other contacts must not appear to move.
/// Rotating the spring into the tangent plane loses energy; that is a time-integration error and not counted here. With
/// Hertz' law the tangential spring loses energy as k_t follows the contact radius, however short the step: that stands
/// for the slip that begins at the rim of the contact, and is `slipped`.
template <unsigned kFeatures, class T>
GROUSER_HD BasicReaction<T> contactForce(const BasicLaw<ScalarOf<T>>& law, const BasicContactGeometry<T>& touch,
                                         ScalarOf<T> dt, base::Vec3<T>& shear, BasicPlasticState<T>* state = nullptr) {
  using Scalar = ScalarOf<T>;
  const T zero{};
  const base::Vec3<T>& n = touch.normal;
  const T approach = dot(touch.velocity, n);
  Coefficients<T> c = coefficientsOf<kFeatures>(law, touch.overlap, touch.effectiveMass, touch.effectiveRadius);
  c.damping *= touch.dampingShare, c.tangentialDamping *= touch.dampingShare;
  T elastic = c.elastic, least = zero, adhesion{}, yielded{};
  constexpr bool kMayYield = (kFeatures & (kPlastic | kGeneral)) != 0;
  if constexpr (kMayYield)
    if (state && law.plastic.share > 0) {
      const BasicElasticSpring<T> spring{law.stiffness, touch.effectiveRadius, law.hertz};
      const BasicPlasticForce<T> bent = plasticForce(law.plastic, spring, touch.overlap, *state);
      elastic = bent.force, adhesion = bent.adhesion, yielded = bent.yielded;
      least = elastic < zero ? elastic : zero;
    }
  T dashpot = c.damping * approach;
  // Without attraction the dashpot may at most cancel the spring, and not help it to pull.
  if (!law.attraction) dashpot = elastic + dashpot < least ? least - elastic : dashpot;
  T normalForce = elastic + dashpot;
  T pressing = normalForce;
  if constexpr (kMayYield) pressing += adhesion;
  if (kFeatures & (kCohesion | kGeneral)) normalForce -= law.pull(touch.effectiveRadius) * touch.pullShare;
  const T halfStepPerMass = Scalar(0.5) * dt / touch.effectiveMass;
  BasicReaction<T> reaction{
      n * -normalForce, dashpot * (approach - normalForce * halfStepPerMass) * dt, zero, pressing, c.normalStiffness,
      yielded};
  const bool hertz = kFeatures & kGeneral ? law.hertz : (kFeatures & kHertz) != 0;
  if (hertz) reaction.change = hertzChange(touch.overlap, touch.crushes ? zero : approach * dt);
  if (!(kFeatures & (kFriction | kGeneral)) || law.friction <= 0) return reaction;

  // Rotate the spring into the present tangent plane, then stretch it by this step's slip.
  const base::Vec3<T> slip = touch.velocity - n * approach;
  shear -= n * dot(shear, n);
  if (hertz) {
    reaction.slipped = c.tangentialStiffness * dot(shear, shear) * reaction.change.taken;
    shear *= reaction.change.kept;
  }
  const T storedBefore = c.tangentialStiffness * dot(shear, shear);
  shear += slip * base::broadcast<T>(dt);
  base::Vec3<T> tangential = shear * -c.tangentialStiffness - slip * c.tangentialDamping;
  const T limit = law.friction * (pressing > zero ? pressing : zero);
  const base::Vec3<T> scaled = tangential * base::broadcast<T>(law.squareScale);
  const T scaledLimit = limit * law.squareScale, size2 = dot(scaled, scaled), limit2 = scaledLimit * scaledLimit;
  const auto slides = size2 > limit2;
  if (base::any(slides)) {
    // Sliding: the force lies on Coulomb's cone.
    tangential = base::select(slides, tangential * base::shareOf(scaledLimit, squareRoot(size2)), tangential);
    // The spring is shortened only if it exceeds the cone by itself: taking over the dashpot's force would stretch it
    // without work.
    const T scaledStiffness = c.tangentialStiffness * law.squareScale;
    const T spring2 = scaledStiffness * scaledStiffness * dot(shear, shear);
    if (const auto beyond = slides & (spring2 > limit2); base::any(beyond))
      shear = base::select(beyond, shear * base::shareOf(scaledLimit, squareRoot(spring2)), shear);
  }
  // A force at the rim of a sphere speeds the slip up by 1 + 5/2 of what it does to the centres: slip + 7/2 F h is the
  // slip in the middle of the step.
  const T along = dot(tangential, slip), square = dot(slip, slip) + along * (Scalar(3.5) * halfStepPerMass);
  const T gained = Scalar(0.5) * (c.tangentialStiffness * dot(shear, shear) - storedBefore);
  reaction.damped += slides ? zero : c.tangentialDamping * square * dt;
  reaction.rubbed -= slides ? along * dt + gained : zero;
  reaction.force += tangential;
  return reaction;
}

/// Energy of the springs of a contact [J] minus the work of cohesion, zero at overlap 0. `state`: of an elastic-plastic
/// contact; null for a new one.
template <class T> GROUSER_HD double storedEnergy(const BasicLaw<T>& law, double overlap, double effectiveRadius,
                                                  const base::Vec3<T>& shear,
                                                  const BasicPlasticState<double>* state = nullptr) {
  const double s2 = static_cast<double>(dot(shear, shear));
  const double k = static_cast<double>(law.stiffness), kt = static_cast<double>(law.tangentialStiffness);
  const double perRadius = static_cast<double>(law.pullPerRadius), perArea = static_cast<double>(law.pullPerArea);
  const double pull = (perRadius * effectiveRadius + perArea * effectiveRadius * effectiveRadius) * overlap;
  if (state && law.plastic.share > 0) {
    const BasicElasticSpring<double> spring{k, effectiveRadius, law.hertz};
    const double sticks = law.hertz ? sqrt(effectiveRadius * overlap) : 1; // of k_t
    return plasticEnergy(law.plastic.template as<double>(), spring, overlap, *state) + 0.5 * kt * sticks * s2 - pull;
  }
  if (!law.hertz) return 0.5 * k * overlap * overlap + 0.5 * kt * s2 - pull;
  const double a = sqrt(effectiveRadius * overlap);
  return 0.4 * k * a * overlap * overlap + 0.5 * kt * a * s2 - pull;
}

} // namespace grouser::contact
