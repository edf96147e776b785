// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/pieces.hpp"
#include "runs/virtual_tests/soil_bed.hpp"

/// Simple shear cell: soil between two toothed plates, periodic along both sides, without gravity. The lower plate is
/// fixed, the upper one has constant load and shear velocity and moves freely in z.
namespace grouser::virtual_tests {

struct ShearCell {
  double length = 16, width = 8, depth = 10; ///< [d]
  double inertialNumber = 8e-4;              ///< [-] shear rate times d sqrt(density / stress)
  double strain = 0.4;                       ///< [-] displacement of the upper plate over the height of the sample
  int rows = 200;                            ///< rows of the table
  /// Measure the stress of the core, which requires linear springs without cohesion; else its columns are 0.
  bool core = true;
  double tooth = 0.7;     ///< [d] height of the teeth, 2 d apart
  double tip = 0;         ///< [d] breadth of the tooth tips
  bool pressesIn = false; ///< press the upper plate in before grains are cohesive
};

/// Columns of a run's table; compression is positive, as is shear by the displacement of the upper plate. `sheared`:
/// velocity difference of grains at both tips over that of the plates; the rest slides along the teeth.
inline const std::vector<std::string> kShearColumns = {"strain [-]",       "shear stress [Pa]",   "normal stress [Pa]",
                                                       "height [d]",       "core xx [Pa]",        "core zz [Pa]",
                                                       "core xz [Pa]",     "core zx [Pa]",        "porosity [-]",
                                                       "coordination [-]", "inertial number [-]", "sheared [-]"};

/// Prepares a sample and shears it under `stress` [Pa]. Writes the plate meshes into `folder`. `kept`: folder with
/// poured samples, reused for other stresses with the same seed; empty: none.
jobs::Table shearCell(const Soil& soil, const ShearCell& cell, double stress, std::int64_t seed,
                      const std::filesystem::path& folder, const base::Exec& exec,
                      const std::filesystem::path& kept = {});

/// Strength of one run from stress ratios: maximum of means over 5 % of the strain (peak) and mean over the second half
/// (residual).
struct ShearStrength {
  double normal = 0, shear = 0;  ///< residual stresses on the plates [Pa]
  double peak = 0, residual = 0; ///< shear over normal stress on the plates [-]
  double mohrCoulomb = 0;        ///< residual angle of the core, sin = (s1 - s3) / (s1 + s3) in the plane [rad]
  double porosityBefore = 0, porosityAfter = 0;
  double inertialNumber = 0;
  double sheared = 0; ///< share of the plate displacement [-], mean over the second half
};
ShearStrength shearStrength(const jobs::Table& run);

/// Angle [rad] whose sine is the radius of Mohr's circle over its centre stress.
double mohrCoulombAngle(double xx, double zz, double xz);

/// Mean stress of a region [Pa] from its contacts, force times branch vector (Love 1927, Weber 1966), compression
/// positive, and contacts per grain.
struct CoreStress {
  double xx = 0, zz = 0, xz = 0, zx = 0, coordination = 0;
};
/// Includes contacts with their middle between the heights. Linear springs of one material without dashpots.
CoreStress coreStress(const terrain::Grains& grains, const BedSize& size, double low, double high);

} // namespace grouser::virtual_tests
