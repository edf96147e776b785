// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/pieces.hpp"
#include "runs/virtual_tests/soil_bed.hpp"

/// A cell of simple shear: soil between two toothed plates, periodic along both sides, without gravity. The lower plate
/// rests, the upper one is pressed down with a constant load, free to rise and sink, and drawn.
namespace grouser::virtual_tests {

struct ShearCell {
  double length = 16, width = 8, depth = 10; ///< [d]
  double inertialNumber = 8e-4;              ///< [-] rate of shear times d sqrt(density / stress)
  double strain = 0.4;                       ///< [-] way of the upper plate over the height of the sample
  int rows = 200;                            ///< of a table
  /// Whether the stress of the core is measured, which takes linear springs without cohesion; else its columns are 0.
  bool core = true;
  double tooth = 0.7;     ///< [d] height of the plates' teeth, which stand 2 d apart
  double tip = 0;         ///< [d] breadth of their tips
  bool pressesIn = false; ///< the upper plate before grains stick: for soils that do
};

/// Columns of a run's table; compression is positive, and shear that the upper plate's way makes. `sheared`: how much
/// of its speed the grains at its tips have over those at the lower one's; what is missing slides along the teeth.
inline const std::vector<std::string> kShearColumns = {"strain [-]",       "shear stress [Pa]",   "normal stress [Pa]",
                                                       "height [d]",       "core xx [Pa]",        "core zz [Pa]",
                                                       "core xz [Pa]",     "core zx [Pa]",        "porosity [-]",
                                                       "coordination [-]", "inertial number [-]", "sheared [-]"};

/// Prepares a sample and shears it under `stress` [Pa]. Meshes of the plates are written into `folder`. `kept`: a
/// folder where the sample that is poured stays for the same seed under another stress; empty: none does.
jobs::Table shearCell(const Soil& soil, const ShearCell& cell, double stress, std::int64_t seed,
                      const std::filesystem::path& folder, const base::Exec& exec,
                      const std::filesystem::path& kept = {});

/// What one run says: of the ratios of stresses, the greatest as mean over a twentieth of the strain (peak) and the
/// mean over the second half (residual).
struct ShearStrength {
  double normal = 0, shear = 0;  ///< residual stresses on the plates [Pa]
  double peak = 0, residual = 0; ///< shear over normal stress on the plates [-]
  double mohrCoulomb = 0;        ///< residual angle of the core, sin = (s1 - s3) / (s1 + s3) in the plane [rad]
  double porosityBefore = 0, porosityAfter = 0;
  double inertialNumber = 0;
  double sheared = 0; ///< of the plates' way [-], mean over the second half
};
ShearStrength shearStrength(const jobs::Table& run);

/// Angle [rad] whose sine is the radius of Mohr's circle over the distance of its centre.
double mohrCoulombAngle(double xx, double zz, double xz);

/// Mean stress of a region [Pa] from its contacts, force times branch vector (Love 1927, Weber 1966), compression
/// positive, and contacts a grain.
struct CoreStress {
  double xx = 0, zz = 0, xz = 0, zx = 0, coordination = 0;
};
/// Contacts count whose middle lies between the two heights. Linear springs of one material without dashpots.
CoreStress coreStress(const terrain::Grains& grains, const BedSize& size, double low, double high);

} // namespace grouser::virtual_tests
