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
  eepaLinear, ///< as eepa, on linear springs
  luding      ///< Luding's, on linear springs
};

/// Contact properties of a material. complete() sets defaults for empty values that the law requires.
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
  std::optional<double> restitution;    ///< [-] (0, 1]; with attraction also 0
  std::optional<double> damping; ///< [1/s] linear, instead of restitution: gamma of F_n = k overlap + gamma m v_n
  bool attraction = false;       ///< true: the dashpot may cause a net attraction
  double friction = 0.5;         ///< [-] Coulomb coefficient
  std::optional<double> tangentialStiffnessRatio; ///< [-] linear: k_t over k
  std::optional<double> tangentialDampingRatio;   ///< [-] linear: over gamma; hertz: over 2 beta sqrt(k_t m)
  double rollingFriction = 0;                     ///< [-] maximum rolling torque / (R_eff F_n)
  double rollingDampingRatio = 0.3;               ///< [-] fraction of the rolling spring's critical damping
  double cohesion = 0;                            ///< [J/m2] energy of adhesion
  std::optional<double> adhesionRadius;    ///< [m] grain radius to which cohesion and surfaceEnergy refer; empty: any
  std::optional<double> plasticity;        ///< [-] eepa, eepaLinear, luding: maximum 1 - k1/k2
  std::optional<double> surfaceEnergy;     ///< [J/m2] eepa, eepaLinear: gamma of the pull-off force
  std::optional<double> adhesionExponent;  ///< [-] eepa, eepaLinear: chi of the adhesive branch, in halves
  std::optional<double> plasticDepth;      ///< [-] luding: overlap of the maximum k2 / smaller radius
  std::optional<double> adhesionStiffness; ///< [N/m] luding: k_c of the adhesive branch
  std::optional<double> crushingStrength;  ///< [Pa] grains against parts; empty: no crushing
  double foundationModulus = kFoundationModulus; ///< [N/m3] elastic foundation of its bodies
  bool operator==(const MaterialProperties&) const = default;

  /// True for laws based on Hertz's elastic law; false for linear springs.
  bool hertzian() const { return law == LawKind::hertz || law == LawKind::eepa; }
  bool yields() const { return law != LawKind::hertz && law != LawKind::linear; }
  /// Sets defaults for values that the law requires, except young: the defaults above; no adhesion; adhesion exponent
  /// 1.5 for eepa and 1 for eepaLinear.
  void complete();
};

/// Properties of a material pair that override the mixing rules. Units as above.
struct PairProperties {
  std::optional<double> stiffness, restitution, damping, friction, rollingFriction, cohesion, plasticity, surfaceEnergy;
  bool operator==(const PairProperties&) const = default;
};

/// Error for two materials with incompatible properties.
struct MixingError : base::InputError {
  enum class Reason {
    lawsDiffer,               ///< law: linear with hertz, or eepaLinear with luding
    dampingBesideRestitution, ///< damping: one material sets it, the other restitution, for grains of many masses
    youngMissing              ///< young: not set in a hertz or eepa material
  };
  Reason reason;
  bool inSecond;   ///< true: error in the second material
  const char* key; ///< scene-file key of the property in error

  MixingError(Reason why, bool second, const char* property, const std::string& message)
      : InputError(message), reason(why), inSecond(second), key(property) {}
};

/// Returns the law between two materials. Damping is derived from the restitution by the formula for the clamped or
/// unclamped force: for bodies of the given effective mass [kg], or, without one, for any mass (grains of many masses).
///
/// Values set in `pair` override these rules:
/// - linear: stiffness in series doubled, 2 k_a k_b / (k_a + k_b), so that equal materials keep their stiffness;
/// - hertz: 1 / E_eff = (1 - nu_a^2) / E_a + (1 - nu_b^2) / E_b and 1 / G_eff = (2 - nu_a) / G_a + (2 - nu_b) / G_b;
/// - the smaller friction, rolling friction and restitution, the smaller tangential and rolling ratios; the geometric
///   mean of the cohesions; attraction only if both allow it;
/// - elastic-plastic if both yield: the smaller plasticity and adhesion stiffness, the geometric mean of the surface
///   energies, the larger exponent and plastic depth.
/// Bitwise symmetric in both materials. A material with itself (the same object twice) keeps its exact values. Throws
/// MixingError.
ContactLaw mixedLaw(const MaterialProperties& a, const MaterialProperties& b, const PairProperties& pair = {},
                    std::optional<double> effectiveMass = {});

/// Contact parameters of two bodies, or of a body and a rigid surface: see PatchLaw.
struct Foundation {
  double modulus{};         ///< [N/m3] moduli in series doubled
  double friction{};        ///< [-] minimum
  double restitution{};     ///< [-] minimum
  double tangentialRatio{}; ///< [-] minimum; 2/7 for hertz materials
};
/// Returns the mixed foundation; friction and restitution set in `pair` override the mixing rules. A material with
/// `damping` instead of restitution is treated as if its restitution were kRestitution.
Foundation mixedFoundation(const MaterialProperties& a, const MaterialProperties& b, const PairProperties& pair = {});

/// Coefficients of a contact at its maximum stiffness: constant for a linear law, at the maximum overlap of an impact
/// at `speed` [m/s] for a Hertz law.
Coefficients<double> stiffest(const ContactLaw& law, double effectiveMass, double effectiveRadius, double speed);

/// Duration of the undamped contact [s]; for a Hertz law in an impact at `speed` [m/s].
double contactTime(const ContactLaw& law, double effectiveMass, double effectiveRadius, double speed);

/// Coefficient of restitution [-] of the law for bodies of effective mass `movedMass` [kg], with damping derived for
/// the mass `effectiveMass` [kg].
double restitutionOf(const ContactLaw& law, double effectiveMass, double movedMass);

/// Time in which a Rayleigh wave travels half the circumference of a grain of a hertz material [s]; infinite for a
/// linear material. `radius` [m]. Requires Young's modulus.
double rayleighTimeOf(const MaterialProperties& material, double radius);

} // namespace grouser::contact
