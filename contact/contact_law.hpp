// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/number.hpp"
#include "contact/plastic_law.hpp"

#include <cmath>

namespace grouser::contact {

/// Features of a scene's contact laws. Force functions and kernels have a sum of these flags as template parameter;
/// absent features are not compiled. With kGeneral all features are compiled and each law's constants select them at
/// run time; the results are bitwise identical.
inline constexpr unsigned kHertz = 1; ///< Hertz normal and Mindlin tangential stiffness; otherwise constant stiffnesses
inline constexpr unsigned kFriction = 2;        ///< tangential spring with Coulomb limit
inline constexpr unsigned kRollingFriction = 4; ///< rolling resistance with history
inline constexpr unsigned kCohesion = 8;        ///< constant attraction during contact
/// Damping depends on the effective mass of each contact instead of one mass for the scene.
inline constexpr unsigned kManyMasses = 16;
inline constexpr unsigned kPlastic = 32; ///< elastic-plastic normal springs, with history
/// The kernel also sums a ContactMoment; never set in a time step.
inline constexpr unsigned kMeasured = 1u << 30;
inline constexpr unsigned kGeneral = 1u << 31; ///< all features, selected at run time

/// Index of the plastic state in a contact's history, after its springs.
GROUSER_HD constexpr int plasticPlace(unsigned features) {
  return features & kRollingFriction ? 6 : features & (kFriction | kPlastic) ? 3 : 0;
}
/// Size of the history of a contact with these features: tangential spring, rolling angle, plastic state.
GROUSER_HD constexpr int historyWidth(unsigned features) {
  return plasticPlace(features) + (features & kPlastic ? kPlasticNumbers : 0);
}

/// Contact law between two surfaces, in float or double. Every law has a normal spring and dashpot, and a tangential
/// spring (with history) and dashpot, with slip at the Coulomb limit (Cundall and Strack 1979, Geotechnique
/// 29:47):
///
///   F_n = elastic + c_n v_n                     v_n: approach speed;  never attractive unless `attraction`
///   F_t = -k_t shear - c_t v_t                  |F_t| <= friction F_n; on slip, a spring force above
///                                               the limit is reduced to the limit
///
/// Linear:  elastic = k overlap,  k_t constant,  c_n = gamma m_eff.  For grains of many masses with a given
/// restitution, c_n = 2 zeta sqrt(k m_eff), so that the restitution is the same for all masses.
///
/// Hertz-Mindlin, with the contact radius a = sqrt(R_eff overlap):
///   elastic = (4/3) E_eff a overlap,  k_t = 8 G_eff a (Mindlin 1949, no slip),  c_n = 2 beta sqrt(2 E_eff a m_eff), so
///   that the restitution does not depend on the speed (Tsuji et al. 1992, Powder Technol. 71:239).
///   During loading the tangential force is kept and the spring shortens as it stiffens; during unloading the
///   spring length is kept and the force decreases with k_t (Thornton, Cummins and Cleary 2013, Powder Technol.
///   233:30). So F_t^2 / (2 k_t) never increases as k_t changes: no closed path of loading and shear gains energy.
///
/// Cohesion (DMT, Derjaguin et al. 1975): a constant attraction of 2 pi w R_eff while the spheres overlap; w is the
/// energy of adhesion. It drops to zero at zero overlap. Its work on approach equals the work against it on
/// separation. Friction and rolling resistance are limited by the compressive part, F_n without the attraction.
///
/// Elastic-plastic contacts (plastic_law.hpp) use its force as `elastic`. In tension the dashpot adds no attraction,
/// and friction is limited by the force plus the maximum attraction of the contact (Thakur et al. 2014).
template <class T> struct BasicLaw {
  T stiffness{};             ///< linear: k [N/m], > 0;  Hertz: (4/3) E_eff [Pa]
  T damping{};               ///< linear: gamma [1/s], >= 0;  Hertz: 0
  T tangentialStiffness{};   ///< linear: k_t [N/m], >= 0;  Hertz: 8 G_eff [Pa]
  T tangentialDamping{};     ///< linear: gamma_t [1/s], >= 0;  Hertz: 0
  T friction{};              ///< Coulomb coefficient [-], >= 0; 0 disables the tangential force
  bool attraction{};         ///< true: the dashpot may cause a net attraction
  bool hertz{};              ///< true: Hertz; false: linear
  T rootDamping{};           ///< Hertz: 2 beta sqrt(2 E_eff) [sqrt(Pa)];  linear with many masses: 2 zeta sqrt(k)
  T tangentialRootDamping{}; ///< same for the tangential dashpot
  T rollingFriction{};       ///< [-], >= 0; 0 disables rolling resistance
  T rollingDamping{};        ///< [-], >= 0: share of the rolling spring's critical damping
  T pullPerRadius{};         ///< cohesion: 2 pi w [N/m], >= 0
  T pullPerArea{};           ///< cohesion that grows with the radius: 2 pi dw / dR_eff [Pa], >= 0
  BasicPlasticity<T> plastic{};
  /// Linear law, single mass: factor of both dashpots against a fixed grain [-], for the given restitution.
  T fixedShare{1};
  /// Power of two near 1 / (typical contact force) [1/N]. Forces and torques are scaled by it before squaring: a float
  /// cannot represent the squared force between micrometre grains or beyond 1e19 N. The scale does not change results;
  /// scaledFor() in strongest_force.hpp sets it.
  T squareScale{1};
  /// Coefficient of restitution [-]; complementarity contacts use it instead of the damping.
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
  /// Returns this law without plasticity.
  BasicLaw elastic() const {
    BasicLaw law = *this;
    law.plastic = {};
    return law;
  }
  /// Returns this law with adhesion and cohesion scaled by `share` [-]; features() is unchanged if `share` > 0.
  BasicLaw pulling(T share) const {
    BasicLaw law = *this;
    for (T* pull :
         {&law.pullPerRadius, &law.pullPerArea, &law.plastic.pull, &law.plastic.pullGrowth, &law.plastic.adhesion})
      *pull *= share;
    return law;
  }
  bool coheres() const { return pullPerRadius > 0 || pullPerArea > 0; }
  /// Constant attraction of cohesion [N] for an effective radius [m].
  template <class R> GROUSER_HD R pull(R effectiveRadius) const {
    return pullPerRadius * effectiveRadius + pullPerArea * effectiveRadius * effectiveRadius;
  }
  /// Features that a kernel requires for this law, except kManyMasses, which depends on the scene.
  unsigned features() const {
    return (hertz ? kHertz : 0u) | (friction > 0 ? kFriction : 0u) | (rollingFriction > 0 ? kRollingFriction : 0u) |
           (coheres() ? kCohesion : 0u) | (plastic.share > 0 ? kPlastic : 0u);
  }
};

/// Law in double precision; kernels convert it to their own precision.
using ContactLaw = BasicLaw<double>;

using base::ScalarOf;
using base::squareRoot;

/// Geometry of two surfaces in contact, seen from side i; with SIMD numbers, one pair per lane. The normal points from
/// i to j.
template <class T> struct BasicContactGeometry {
  base::Vec3<T> normal;                   ///< unit, from i to j
  T overlap;                              ///< [m], > 0
  base::Vec3<T> velocity;                 ///< velocity of i's material point relative to j's at the contact [m/s]
  T effectiveMass;                        ///< m_i m_j / (m_i + m_j) [kg]
  T effectiveRadius{};                    ///< R_i R_j / (R_i + R_j) [m]; for Hertz, cohesion and rolling
  T dampingShare = base::broadcast<T>(1); ///< multiplies both damping coefficients [-]: see BasicLaw::fixedShare
  T pullShare = base::broadcast<T>(1);    ///< scales the attraction of cohesion [-]
  bool crushes{false}; ///< the overlap stays constant during approach because the grain crushes (crushing.hpp)
};
using ContactGeometry = BasicContactGeometry<float>;

/// Change of a contact's spring stiffness since the last step. With Hertz's law the stiffness is proportional to the
/// contact radius, hence to the square root of the overlap.
template <class T> struct StiffnessChange {
  T kept = base::broadcast<T>(1); ///< ratio of spring lengths [-]: loading preserves the force, unloading the length
  T taken{};                      ///< dissipated energy / (stiffness x squared former length) [-], >= 0
};

/// Stiffness change for the approach `way` of the surfaces within the step [m].
template <class T> GROUSER_HD StiffnessChange<T> hertzChange(T overlap, T way) {
  using Scalar = ScalarOf<T>;
  const T one = base::broadcast<T>(1), share = way / overlap, within = share < one ? share : one;
  const T root = squareRoot(one - within), less = within / (one + root); // former stiffness / present; 1 - root
  const T kept = root < one ? root : one;
  return {kept, Scalar(0.5) * kept * (less < Scalar(0) ? -less : less)};
}

/// Force and energies of one contact in one step.
template <class T> struct BasicReaction {
  base::Vec3<T> force;         ///< force on i [N]; j receives exactly the opposite
  T damped;                    ///< dissipated by the dashpots within the step [J]
  T rubbed;                    ///< dissipated by sliding within the step [J]
  T pressing;                  ///< normal force without cohesion and adhesion [N]; limits friction
  T normalStiffness;           ///< dF_n / d overlap of the elastic spring [N/m]
  T yielded{};                 ///< plastic work within the step [J]
  T slipped{};                 ///< dissipated by the tangential spring as its stiffness changes within the step [J]
  StiffnessChange<T> change{}; ///< Hertz: also for the rolling spring
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

/// Returns the force of `law` on side i and updates the tangential spring `shear` [m] to the end of the step. T is
/// float, double, or a SIMD vector: this source serves the kernels of both devices and SIMD batches. Swapping
/// i and j (normal, velocity and shear change sign) only changes the sign of the force, bit for bit. `state`:
/// history of an elastic-plastic contact, also updated; null if all contacts are elastic.
///
/// Dashpot work uses the mid-step velocity, for which symplectic Euler changes the kinetic energy exactly by F . (v_old
/// + v_new) / 2 dt if this contact acts alone: second order in the step for a single collision. A sticking contact
/// dissipates only in its dashpots. A sliding contact dissipates all work except the energy gain of its spring, with
/// the slip of the step's start, since a grain kept at the Coulomb limit by other contacts must not appear to move.
/// Rotating the spring into the tangent plane loses energy; this is a time-integration error and not counted here. With
/// Hertz's law the tangential spring loses energy as k_t follows the contact radius, for any step size; this represents
/// the slip that begins at the rim of the contact and is reported as `slipped`.
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
  // Without attraction the dashpot may at most cancel a compressive spring force, and not add to a tensile one.
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

  // Rotate the spring into the current tangent plane, then stretch it by this step's slip.
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
    // Sliding: the force lies on the Coulomb cone.
    tangential = base::select(slides, tangential * base::shareOf(scaledLimit, squareRoot(size2)), tangential);
    // The spring is shortened only if its own force exceeds the cone: including the dashpot's force would stretch it
    // without work.
    const T scaledStiffness = c.tangentialStiffness * law.squareScale;
    const T spring2 = scaledStiffness * scaledStiffness * dot(shear, shear);
    if (const auto beyond = slides & (spring2 > limit2); base::any(beyond))
      shear = base::select(beyond, shear * base::shareOf(scaledLimit, squareRoot(spring2)), shear);
  }
  // A force at the rim of a sphere accelerates the slip 1 + 5/2 times as much as the centres. The mid-step slip is
  // slip + 7/2 F halfStepPerMass.
  const T along = dot(tangential, slip), square = dot(slip, slip) + along * (Scalar(3.5) * halfStepPerMass);
  const T gained = Scalar(0.5) * (c.tangentialStiffness * dot(shear, shear) - storedBefore);
  reaction.damped += slides ? zero : c.tangentialDamping * square * dt;
  reaction.rubbed -= slides ? along * dt + gained : zero;
  reaction.force += tangential;
  return reaction;
}

/// Stored energy of the springs of a contact [J] minus the work of cohesion; zero at zero overlap. `state`: history of
/// an elastic-plastic contact; null for a new contact.
template <class T> GROUSER_HD double storedEnergy(const BasicLaw<T>& law, double overlap, double effectiveRadius,
                                                  const base::Vec3<T>& shear,
                                                  const BasicPlasticState<double>* state = nullptr) {
  const double s2 = static_cast<double>(dot(shear, shear));
  const double k = static_cast<double>(law.stiffness), kt = static_cast<double>(law.tangentialStiffness);
  const double perRadius = static_cast<double>(law.pullPerRadius), perArea = static_cast<double>(law.pullPerArea);
  const double pull = (perRadius * effectiveRadius + perArea * effectiveRadius * effectiveRadius) * overlap;
  if (state && law.plastic.share > 0) {
    const BasicElasticSpring<double> spring{k, effectiveRadius, law.hertz};
    const double sticks = law.hertz ? sqrt(effectiveRadius * overlap) : 1; // factor of k_t
    return plasticEnergy(law.plastic.template as<double>(), spring, overlap, *state) + 0.5 * kt * sticks * s2 - pull;
  }
  if (!law.hertz) return 0.5 * k * overlap * overlap + 0.5 * kt * s2 - pull;
  const double a = sqrt(effectiveRadius * overlap);
  return 0.4 * k * a * overlap * overlap + 0.5 * kt * a * s2 - pull;
}

} // namespace grouser::contact
