// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "scm/soil_energy.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace grouser::coupling {

/// What has become heat since the start, by its cause [J].
struct Dissipated {
  double damping{};       ///< dashpots of grains' contacts, with whatever they touch
  double friction{};      ///< sliding of grains
  double microSlip{};     ///< tangential springs of Hertz' law as they stiffen and soften
  double rolling{};       ///< rolling resistance of grains
  double yielding{};      ///< plastic work of grains' contacts
  double crushing{};      ///< grains that crush against parts
  double parts{};         ///< contacts of rigid parts with each other and with rigid ground
  double joints{};        ///< dampers and end stops of joints and springs
  double soil{};          ///< deformable soil, by all causes of scm::SoilEnergy
  double fluid{};         ///< fluid: viscosity, density diffusion, walls
  double stabilisation{}; ///< complementarity contacts that push overlaps apart: put in, so at most 0

  double ofGrains() const { return damping + friction + microSlip + rolling + yielding + crushing; }
  double ofParts() const { return parts + soil; } ///< contacts of parts with all but grains
  double total() const { return ofGrains() + parts + joints + soil + fluid + stabilisation; }
};

/// A cause by its word in the names of results, with what the results say of it.
struct DissipationCause {
  const char *word, *help;
  double Dissipated::*heat;
};
inline constexpr DissipationCause kDissipationCauses[] = {
    {"damping", "by dashpots of grains' contacts", &Dissipated::damping},
    {"friction", "by sliding of grains", &Dissipated::friction},
    {"micro_slip", "by tangential springs of Hertz' law as their stiffness follows the load", &Dissipated::microSlip},
    {"rolling", "by rolling resistance of grains", &Dissipated::rolling},
    {"yielding", "by plastic work of grains' contacts", &Dissipated::yielding},
    {"crushing", "by grains that crush against parts", &Dissipated::crushing},
    {"parts", "by contacts of rigid parts with each other, with rigid ground and surfaces", &Dissipated::parts},
    {"joints", "by dampers and end stops of joints and springs", &Dissipated::joints},
};

/// An energy of deformable soil, likewise.
struct SoilEnergyEntry {
  const char *word, *help;
  double scm::SoilEnergy::*energy;
};
inline constexpr SoilEnergyEntry kSoilEnergies[] = {
    {"elastic_pressure", "elastic energy of the soil's pressure under shoes and bodies, part of elastic",
     &scm::SoilEnergy::elastic},
    {"elastic_shear", "elastic energy of the soil's shear under shoes and bodies, part of elastic",
     &scm::SoilEnergy::elasticShear},
    {"compaction", "plastic sinkage", &scm::SoilEnergy::compaction},
    {"shear", "plastic shear", &scm::SoilEnergy::shear},
    {"slip_sinkage", "sinkage by shear", &scm::SoilEnergy::slipSinkage},
    {"damping", "damping of compression and shear", &scm::SoilEnergy::damping},
    {"edges", "elastic energy of soil that leaves a shoe or body, or loses contact; negative where soil enters",
     &scm::SoilEnergy::edges},
    {"coupling", "change of the elastic shear energy with the pressure", &scm::SoilEnergy::coupling},
};
inline constexpr std::size_t kElasticSoilEnergies = 2; ///< the first of them; the others are dissipated

/// Energies [J] and momenta of a whole simulation, counted from its first step. With steps of finite length
///
///   kinetic + potential + elastic + dissipated + integrationError = driveWork + residual
///
/// Work is booked by the identity that symplectic Euler and RATTLE obey exactly: a step changes the kinetic energy by
/// F . (v_old + v_new) / 2 dt, whatever the force. Elastic and potential energy are functions of the state. What the
/// forces' work on the bodies and what these functions have lost differ by the integration error: it falls with the
/// step. The residual is what the state's kinetic energy has more than the work booked: rounding, or else a mistake.
struct Ledger {
  double driveWork{}, kinetic{}, potential{}, elastic{};
  double grainElastic{}; ///< of elastic: contacts of grains with each other, floor and walls
  Dissipated dissipated;
  scm::SoilEnergy soil; ///< elastic energies now, and dissipation since the start; not counted from another start
  double work{};        ///< of all forces on all bodies
  double turnover{};    ///< the same without signs, a body and a step each: what the errors are to be held against
  double integrationError{}, residual{};

  base::Vec3d momentum, angularMomentum;         ///< now [N s], [N m s] about the origin of the world
  base::Vec3d momentumResidual, angularResidual; ///< these less what gravity, ground and surfaces have given: rounding
  base::Vec3d impulseResidual;                   ///< on vehicle plus on bed [N s]

  std::int64_t grainContacts{}, boundaryContacts{}, partContacts{}, patches{};
  /// Contacts deeper than a fifth of the grain's radius: of two grains; with planes, floor and surfaces; with parts.
  std::int64_t squeezedPairs{}, squeezedAtBoundaries{}, squeezedByParts{};
  std::int64_t cappedNow{};                ///< contacts with parts at the force at which their grain crushes
  double cutImpulse{};                     ///< that springs of these would have given without it, since the start [N s]
  double deepestOverlap{}, fastestGrain{}; ///< [m], [m/s]

  /// Makes it count from `start`, and closes it: integrationError and residual follow from the others.
  void countFrom(const Ledger& start);
  /// Moves a start by what has come between two ledgers without a step: grains that enter.
  void move(const Ledger& before, const Ledger& after);

  /// What is counted, in a fixed order, for checkpoints.
  std::vector<double> counted() const;
  /// Throws base::InputError where these are not as many.
  void setCounted(const std::vector<double>& numbers);
};

} // namespace grouser::coupling
