// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/pieces.hpp"
#include "runs/virtual_tests/soil_bed.hpp"

/// Simple shear cell: soil between two toothed plates, with periodic boundaries in x and y, without gravity. The lower
/// plate is fixed; the upper plate has a constant load and a constant shear velocity, and can move in z.
namespace grouser::virtual_tests {

struct ShearCell {
  double length = 16, width = 8, depth = 10; ///< [d]
  double inertialNumber = 8e-4;              ///< [-] shear rate x d sqrt(density / stress)
  double strain = 0.4;                       ///< [-] displacement of the upper plate / height of the sample
  int rows = 200;                            ///< rows of the table
  /// True: measure the stress in the core of the sample, which requires linear springs without cohesion. False: the
  /// columns of the core stress are 0.
  bool core = true;
  double tooth = 0.7;     ///< [d] height of the teeth, 2 d apart
  double tip = 0;         ///< [d] breadth of the tooth tips
  bool pressesIn = false; ///< press the upper plate into the layer before the grains become cohesive
};

/// Columns of a run's table. Compression is positive; so is the shear caused by the displacement of the upper plate.
/// `sheared`: velocity difference of the grains between the tips of both plates / velocity of the upper plate; the
/// remainder is sliding along the teeth.
inline const std::vector<std::string> kShearColumns = {"strain [-]",       "shear stress [Pa]",   "normal stress [Pa]",
                                                       "height [d]",       "core xx [Pa]",        "core zz [Pa]",
                                                       "core xz [Pa]",     "core zx [Pa]",        "porosity [-]",
                                                       "coordination [-]", "inertial number [-]", "sheared [-]"};

/// Prepares a sample and shears it under `stress` [Pa]. Writes the plate meshes to `folder`. `kept`: folder of poured
/// samples, which tests under other stresses with the same seed reuse; empty: samples are not kept.
jobs::Table shearCell(const Soil& soil, const ShearCell& cell, double stress, std::int64_t seed,
                      const std::filesystem::path& folder, const base::Exec& exec,
                      const std::filesystem::path& kept = {});

/// Strength of one run from its stress ratio: the peak is the maximum of means over 5 % of the strain, the residual
/// value is the mean over the second half.
struct ShearStrength {
  double normal = 0, shear = 0;  ///< residual stresses on the plates [Pa]
  double peak = 0, residual = 0; ///< shear stress / normal stress on the plates [-]
  double mohrCoulomb = 0;        ///< residual angle of the core [rad]: sin = (s1 - s3) / (s1 + s3) in the plane x-z
  double porosityBefore = 0, porosityAfter = 0;
  double inertialNumber = 0;
  double sheared = 0; ///< mean of the column `sheared` over the second half [-]
};
ShearStrength shearStrength(const jobs::Table& run);

/// Angle [rad] with sine = radius of Mohr's circle / stress at its centre.
double mohrCoulombAngle(double xx, double zz, double xz);

/// Mean stress of a region [Pa] from force x branch vector of its contacts (Love 1927, Weber 1966), with compression
/// positive; and number of contacts per grain.
struct CoreStress {
  double xx = 0, zz = 0, xz = 0, zx = 0, coordination = 0;
};
/// Includes contacts with midpoints between the heights `low` and `high` [m]. Requires linear springs of a single
/// material; neglects the dashpots.
CoreStress coreStress(const terrain::Grains& grains, const BedSize& size, double low, double high);

} // namespace grouser::virtual_tests
