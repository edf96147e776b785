// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "scm/soil_energy.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace grouser::coupling {

/// Cumulative dissipation by mechanism [J].
struct Dissipated {
  double damping{};       ///< dashpots of grain contacts, with grains and surfaces
  double friction{};      ///< sliding of grains
  double microSlip{};     ///< tangential springs of Hertz contacts due to stiffness changes
  double rolling{};       ///< rolling resistance of grains
  double yielding{};      ///< plastic work in grain contacts
  double crushing{};      ///< crushing of grains against parts
  double parts{};         ///< contacts of rigid parts with each other and with rigid ground
  double joints{};        ///< dampers and end stops of joints and springs
  double soil{};          ///< deformable soil, by all causes of scm::SoilEnergy
  double fluid{};         ///< fluid: viscosity, density diffusion, walls
  double stabilisation{}; ///< energy added by complementarity contacts that separate overlaps, as a negative number

  double ofGrains() const { return damping + friction + microSlip + rolling + yielding + crushing; }
  double ofParts() const { return parts + soil; } ///< contacts of parts, except those with grains
  double total() const { return ofGrains() + parts + joints + soil + fluid + stabilisation; }
};

/// Dissipation mechanism: its word in result names, and its help text.
struct DissipationCause {
  const char *word, *help;
  double Dissipated::*heat;
};
inline constexpr DissipationCause kDissipationCauses[] = {
    {"damping", "by dashpots of grain contacts", &Dissipated::damping},
    {"friction", "by sliding of grains", &Dissipated::friction},
    {"micro_slip", "by tangential springs of Hertz contacts as their stiffness changes with the load",
     &Dissipated::microSlip},
    {"rolling", "by rolling resistance of grains", &Dissipated::rolling},
    {"yielding", "by plastic work in grain contacts", &Dissipated::yielding},
    {"crushing", "by crushing of grains against parts", &Dissipated::crushing},
    {"parts", "by contacts of rigid parts with each other, rigid ground and surfaces", &Dissipated::parts},
    {"joints", "by dampers and end stops of joints and springs", &Dissipated::joints},
};

/// Energy of deformable soil: its word in result names, and its help text.
struct SoilEnergyEntry {
  const char *word, *help;
  double scm::SoilEnergy::*energy;
};
inline constexpr SoilEnergyEntry kSoilEnergies[] = {
    {"elastic_pressure", "elastic energy of soil pressure under shoes and bodies, part of elastic",
     &scm::SoilEnergy::elastic},
    {"elastic_shear", "elastic energy of soil shear under shoes and bodies, part of elastic",
     &scm::SoilEnergy::elasticShear},
    {"compaction", "plastic sinkage", &scm::SoilEnergy::compaction},
    {"shear", "plastic shear", &scm::SoilEnergy::shear},
    {"slip_sinkage", "sinkage by shear", &scm::SoilEnergy::slipSinkage},
    {"damping", "damping of compression and shear", &scm::SoilEnergy::damping},
    {"edges", "elastic energy of soil that leaves a shoe or body or loses contact; negative where soil enters",
     &scm::SoilEnergy::edges},
    {"coupling", "change of the elastic shear energy with the pressure", &scm::SoilEnergy::coupling},
};
inline constexpr std::size_t kElasticSoilEnergies = 2; ///< number of elastic energies, listed first; others: dissipated

/// Energies [J] and momenta of a whole simulation, counted from its first step. For finite steps
///
///   kinetic + potential + elastic + dissipated + integrationError = driveWork + residual
///
/// Work uses the identity that symplectic Euler and RATTLE satisfy exactly: a step changes the kinetic energy by F .
/// (v_old + v_new) / 2 dt, for any force. Elastic and potential energy are functions of the state. The work of the
/// forces on the bodies and the decrease of these functions differ by the integration error, which decreases with the
/// step. The residual is the state's kinetic energy minus the accumulated work: rounding, or a program error.
struct Ledger {
  double driveWork{}, kinetic{}, potential{}, elastic{};
  double grainElastic{}; ///< part of elastic: contacts of grains with each other, floor and walls
  Dissipated dissipated;
  scm::SoilEnergy soil; ///< current elastic energies, and dissipation since the start; not affected by countFrom()
  double work{};        ///< work of all forces on all bodies
  double turnover{};    ///< sum of the absolute work per body and step, reference of the errors
  double integrationError{}, residual{};

  base::Vec3d momentum, angularMomentum;         ///< current values [N s], [N m s] about the world origin
  base::Vec3d momentumResidual, angularResidual; ///< momentum minus impulses of gravity, ground and surfaces: rounding
  base::Vec3d impulseResidual;                   ///< impulses on vehicle plus bed [N s]

  std::int64_t grainContacts{}, boundaryContacts{}, partContacts{}, patches{};
  /// Number of overlaps above a fifth of the grain radius: grain-grain; with planes, floor and surfaces; with parts.
  std::int64_t deepPairs{}, deepAtBoundaries{}, deepByParts{};
  std::int64_t cappedNow{};                ///< current number of contacts with parts at the crushing force of the grain
  double cutImpulse{};                     ///< cumulative impulse removed by the crushing force cap [N s]
  double deepestOverlap{}, fastestGrain{}; ///< [m], [m/s]

  /// Subtracts `start`, and computes integrationError and residual.
  void countFrom(const Ledger& start);
  /// Shifts the reference by the change between two ledgers without a step, e.g. when grains enter.
  void move(const Ledger& before, const Ledger& after);

  /// Accumulated values in a fixed order, for checkpoints.
  std::vector<double> counted() const;
  /// Throws base::InputError if the number of values differs.
  void setCounted(const std::vector<double>& numbers);
};

} // namespace grouser::coupling
