// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.hpp"
#include "contact/contact_law.hpp"

#include <optional>

/// Contact laws from the properties of two materials.
namespace grouser::contact {

/// Force law of a material.
enum class LawKind {
  linear,     ///< linear springs and dashpots
  hertz,      ///< Hertz-Mindlin
  eepa,       ///< elastic-plastic with adhesion, on Hertz' law
  eepaLinear, ///< the same on linear springs
  luding      ///< Luding's, on linear springs
};

/// A material. complete() sets defaults for empty values that the law needs.
struct MaterialProperties {
  static constexpr double kStiffness = 1e6, kPoisson = 0.25, kRestitution = 0.5;
  static constexpr double kTangentialStiffnessRatio = 2.0 / 7;
  static constexpr double kLinearTangentialDampingRatio = 0.5, kHertzTangentialDampingRatio = 1;
  static constexpr double kPlasticity = 0.5, kPlasticDepth = 0.05;
  static constexpr double kFoundationModulus = 1e8;

  double density = 2500; ///< [kg/m3] of the solid
  LawKind law = LawKind::linear;
  std::optional<double> stiffness;      ///< [N/m] linear, > 0
  std::optional<double> young, poisson; ///< [Pa], [-] hertz; young has no default
  std::optional<double> restitution;    ///< [-] (0, 1]; with attraction 0 too
  std::optional<double> damping; ///< [1/s] linear, instead of restitution: gamma of F_n = k overlap + gamma m v_n
  bool attraction = false;       ///< whether the dashpot may pull
  double friction = 0.5;         ///< [-] Coulomb's
  std::optional<double> tangentialStiffnessRatio; ///< [-] linear: k_t over k
  std::optional<double> tangentialDampingRatio;   ///< [-] linear: over gamma; hertz: over 2 beta sqrt(k_t m)
  double rollingFriction = 0;                     ///< [-] largest rolling torque over R_eff F_n
  double rollingDampingRatio = 0.3;               ///< [-] of the rolling spring's critical damping
  double cohesion = 0;                            ///< [J/m2] energy of adhesion
  std::optional<double> adhesionRadius;    ///< [m] grain radius to which cohesion and surfaceEnergy refer; empty: any
  std::optional<double> plasticity;        ///< [-] eepa, eepaLinear, luding: 1 - k1/k2, the greatest
  std::optional<double> surfaceEnergy;     ///< [J/m2] eepa, eepaLinear: gamma of the pull-off force
  std::optional<double> adhesionExponent;  ///< [-] eepa, eepaLinear: chi of the adhesive branch, in halves
  std::optional<double> plasticDepth;      ///< [-] luding: of the smaller radius' overlap where k2 is greatest
  std::optional<double> adhesionStiffness; ///< [N/m] luding: k_c of the adhesive branch
  std::optional<double> crushingStrength;  ///< [Pa] of grains against parts; empty: no crushing
  double foundationModulus = kFoundationModulus; ///< [N/m3] elastic foundation of its bodies
  bool operator==(const MaterialProperties&) const = default;

  /// True for Hertz' elastic law, else linear springs.
  bool hertzian() const { return law == LawKind::hertz || law == LawKind::eepa; }
  bool yields() const { return law != LawKind::hertz && law != LawKind::linear; }
  /// Sets defaults for values that the law needs, except young: the defaults above; no adhesion; adhesion exponent 1.5
  /// for eepa and 1 for eepaLinear.
  void complete();
};

/// Properties of a pair of materials that override the mixing rules. Units as above.
struct PairProperties {
  std::optional<double> stiffness, restitution, damping, friction, rollingFriction, cohesion, plasticity, surfaceEnergy;
  bool operator==(const PairProperties&) const = default;
};

/// Two materials with incompatible properties.
struct MixingError : base::InputError {
  enum class Reason {
    lawsDiffer,               ///< law: linear against hertz, or eepaLinear against luding
    dampingBesideRestitution, ///< damping: one has it, the other restitution, among grains of many masses
    youngMissing              ///< young: not set in a hertz or eepa material
  };
  Reason reason;
  bool inSecond;   ///< true: the second material is at fault
  const char* key; ///< the property at fault, as scene files call it

  MixingError(Reason why, bool second, const char* property, const std::string& message)
      : InputError(message), reason(why), inSecond(second), key(property) {}
};

/// The law between two materials. Damping is derived from the restitution with the formula for the clamped or the free
/// law: for bodies of the given effective mass [kg], or, if none is given, for any mass (grains of many masses).
///
/// Values of `pair` apply; else
/// - linear: stiffness in series doubled, 2 k_a k_b / (k_a + k_b), so that equal materials keep theirs;
/// - hertz: 1 / E_eff = (1 - nu_a^2) / E_a + (1 - nu_b^2) / E_b and 1 / G_eff = (2 - nu_a) / G_a + (2 - nu_b) / G_b;
/// - the smaller friction, rolling friction and restitution, the smaller tangential and rolling ratios; the geometric
///   mean of the cohesions; attraction only if both allow it;
/// - elastic-plastic if both yield: the smaller plasticity and adhesion stiffness, the geometric mean of the surface
///   energies, the larger exponent and plastic depth.
/// Symmetric in both, to the last bit. One material with itself, the same object twice, keeps its values to the last
/// bit. Throws MixingError.
ContactLaw mixedLaw(const MaterialProperties& a, const MaterialProperties& b, const PairProperties& pair = {},
                    std::optional<double> effectiveMass = {});

/// Contact of two bodies, or of a body with a rigid surface: see PatchLaw.
struct Foundation {
  double modulus{};         ///< [N/m3] moduli in series doubled
  double friction{};        ///< [-] the smaller one
  double restitution{};     ///< [-] the smaller one
  double tangentialRatio{}; ///< [-] the smaller one; 2/7 of hertz materials
};
/// Friction and restitution given by `pair` replace the mixed values. A material with `damping` instead of
/// restitution counts as one of restitution kRestitution.
Foundation mixedFoundation(const MaterialProperties& a, const MaterialProperties& b, const PairProperties& pair = {});

/// Coefficients of a contact at its largest stiffness: constant for a linear one, at the deepest overlap of an impact
/// at `speed` [m/s] for a Hertz one.
Coefficients<double> stiffest(const ContactLaw& law, double effectiveMass, double effectiveRadius, double speed);

/// Duration of the undamped contact [s]; for a Hertz one at `speed` [m/s].
double contactTime(const ContactLaw& law, double effectiveMass, double effectiveRadius, double speed);

/// Restitution [-] of the law for bodies of effective mass `movedMass` [kg], if its damping was derived for
/// `effectiveMass`.
double restitutionOf(const ContactLaw& law, double effectiveMass, double movedMass);

/// Time of a Rayleigh wave along half a grain of a hertz material [s]; infinite for a linear one. `radius` [m]. Young's
/// modulus must be given.
double rayleighTimeOf(const MaterialProperties& material, double radius);

} // namespace grouser::contact
