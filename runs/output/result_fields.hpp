// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/result_constant.hpp"
#include "runs/support/file_field.hpp"
#include "terrain/bed_structure.hpp"

#include <vector>

/// What results.h5 holds beside its series: the tables that write it and that describe it.
namespace grouser::output {

inline constexpr ResultConstant kPitchRadius{"vehicle/pitch_radius", "m", "teeth x pitch / (2 pi)"};
inline constexpr ResultConstant kVehicleMass{"vehicle/mass", "kg", "of all its bodies"};

/// A number of the bed as it settled.
struct BedConstant {
  ResultConstant constant;
  double terrain::BedStructure::*member;
};
using terrain::BedStructure;
inline constexpr BedConstant kBedConstants[] = {
    {{"terrain/bed/porosity", "-", "share of points that lie in no grain"}, &BedStructure::porosity},
    {{"terrain/bed/porosity_error", "-", "standard error of that"}, &BedStructure::porosityError},
    {{"terrain/bed/coordination", "-", "contacts a grain"}, &BedStructure::coordination},
    {{"terrain/bed/rattlers", "-", "share of the grains with fewer than two contacts"}, &BedStructure::rattlers},
    {{"terrain/bed/order", "-", "share of the grains in crystalline surroundings"}, &BedStructure::order},
    {{"terrain/bed/mean_diameter", "m", "by number"}, &BedStructure::meanDiameter},
    {{"terrain/bed/settled_height", "m", "mean of the undisturbed surface"}, &BedStructure::settledHeight},
    {{"terrain/bed/thickness", "m", "mean of that surface above the floor"}, &BedStructure::thickness},
};

/// Numbers of the bed over a distance or a depth.
struct BedCurve {
  ResultConstant curve;
  std::vector<double> terrain::BedStructure::*member;
};
inline constexpr BedCurve kBedCurves[] = {
    {{"terrain/bed/distance", "mean diameters", "between the centres of two grains"}, &BedStructure::distance},
    {{"terrain/bed/radial_distribution", "-", "how many more grains lie at that distance than by chance"},
     &BedStructure::radialDistribution},
    {{"terrain/bed/depth", "m", "below the undisturbed surface"}, &BedStructure::depth},
    {{"terrain/bed/porosity_at_depth", "-", "at that depth"}, &BedStructure::porosityAtDepth},
};

/// The undisturbed surface, with what it is [m].
inline constexpr ResultConstant kSurfaceX{"terrain/surface/x", "m", "of the nodes"},
    kSurfaceY{"terrain/surface/y", "m", "of the nodes"},
    kSurfaceHeight{
        "terrain/surface/height", "m",
        "of the undisturbed surface at the nodes, before the vehicle touched it; row j at y[j], column i at x[i]"},
    kSurfaceFinal{
        "terrain/surface/final_height", "m",
        "of the bed's surface at the same nodes at the end of the run, found alike: what is below `height` are "
        "ruts; a bed under a vehicle alone, and where output.final_surface asks for it"};

/// What was set from outside while the run went, where anything was.
inline constexpr ResultConstant kInputs{
    "inputs/series", "-, various",
    "a row a setting: step before which it was made, kind (its place in the attribute kinds), target (track 0 left, 1 "
    "right; place of a body), 1 where it was released, six values in the unit of the kind"};

/// All that results.h5 may hold. Of each quantity of a series the dataset `value`; beside it lie `step` and `time`.
std::vector<support::FileField> resultFields();

} // namespace grouser::output
