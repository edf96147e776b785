// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/result_constant.hpp"
#include "runs/support/file_field.hpp"
#include "terrain/bed_structure.hpp"

#include <vector>

/// Contents of results.h5 besides the series: tables that are used to write and to describe the file.
namespace grouser::output {

inline constexpr ResultConstant kPitchRadius{"vehicle/pitch_radius", "m", "teeth x pitch / (2 pi)"};
inline constexpr ResultConstant kVehicleMass{"vehicle/mass", "kg", "mass of the vehicle"};

/// A number of the settled bed.
struct BedConstant {
  ResultConstant constant;
  double terrain::BedStructure::*member;
};
using terrain::BedStructure;
inline constexpr BedConstant kBedConstants[] = {
    {{"terrain/bed/porosity", "-", "fraction of sample points outside all grains"}, &BedStructure::porosity},
    {{"terrain/bed/porosity_error", "-", "standard error of the porosity"}, &BedStructure::porosityError},
    {{"terrain/bed/coordination", "-", "contacts per grain"}, &BedStructure::coordination},
    {{"terrain/bed/rattlers", "-", "fraction of grains with fewer than two contacts"}, &BedStructure::rattlers},
    {{"terrain/bed/order", "-", "fraction of grains in crystalline arrangement"}, &BedStructure::order},
    {{"terrain/bed/mean_diameter", "m", "mean grain diameter (by number)"}, &BedStructure::meanDiameter},
    {{"terrain/bed/settled_height", "m", "mean height of the undisturbed surface"}, &BedStructure::settledHeight},
    {{"terrain/bed/thickness", "m", "mean bed thickness: mean height of the surface above the floor"},
     &BedStructure::thickness},
};

/// Quantities of the bed as functions of distance or depth.
struct BedCurve {
  ResultConstant curve;
  std::vector<double> terrain::BedStructure::*member;
};
inline constexpr BedCurve kBedCurves[] = {
    {{"terrain/bed/distance", "mean diameters", "distance between the centres of two grains"}, &BedStructure::distance},
    {{"terrain/bed/radial_distribution", "-", "radial distribution function at each distance"},
     &BedStructure::radialDistribution},
    {{"terrain/bed/depth", "m", "depth below the undisturbed surface"}, &BedStructure::depth},
    {{"terrain/bed/porosity_at_depth", "-", "porosity at each depth"}, &BedStructure::porosityAtDepth},
};

/// Undisturbed surface [m].
inline constexpr ResultConstant kSurfaceX{"terrain/surface/x", "m", "x of the nodes"},
    kSurfaceY{"terrain/surface/y", "m", "y of the nodes"},
    kSurfaceHeight{"terrain/surface/height", "m",
                   "height of the undisturbed surface at the nodes, before the vehicle touched it; row j at y[j], "
                   "column i at x[i]"},
    kSurfaceFinal{"terrain/surface/final_height", "m",
                  "height of the bed surface at the same nodes at the end of the run; lower than `height` in ruts; "
                  "only with a vehicle and output.final_surface"};

/// Inputs set during the run, if any.
inline constexpr ResultConstant kInputs{
    "inputs/series", "-, various",
    "one row per input: step before which it was set, kind (index into the attribute kinds), target (track: 0 left, 1 "
    "right; body: its index), 1 if the input was released, six values in the unit of the kind"};

/// All fields of results.h5; of each series only the dataset `value`, which has `step` and `time` beside it.
std::vector<support::FileField> resultFields();

} // namespace grouser::output
