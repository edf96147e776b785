// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "coupling/ground_fields.hpp"
#include "runs/output/result_constant.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace grouser::output {

/// Deformable soil at the end of a run: maps of the touched area, and a cross section of the rut.
struct SoilResult {
  scm::SoilConstants constants;
  std::vector<double> origin;  ///< x, y of the first node [m]
  std::vector<double> spacing; ///< node spacing of the maps [m]: that of the soil, or a multiple for large areas
  std::uint64_t columns{}, rows{};
  std::vector<float> sinkage, pressure, shear, maxPressure; ///< [rows, columns] [m], [Pa]
  std::vector<double> sectionOffset, sectionSinkage;        ///< [m]
};

/// A map of the soil.
struct SoilMapField {
  ResultConstant field;
  std::vector<float> SoilResult::*member;
};
inline constexpr SoilMapField kSoilMaps[] = {
    {{"terrain/soil/sinkage", "m",
      "sinkage of deformable soil below the undisturbed surface at the end of the run; row j at y = origin[1] + j "
      "spacing, "
      "column "
      "i at x = origin[0] + i spacing"},
     &SoilResult::sinkage},
    {{"terrain/soil/pressure", "Pa", "final pressure on the soil, at the nodes of terrain/soil/sinkage"},
     &SoilResult::pressure},
    {{"terrain/soil/shear", "Pa",
      "magnitude of the final shear stress on the soil, at the nodes of terrain/soil/sinkage"},
     &SoilResult::shear},
    {{"terrain/soil/max_pressure", "Pa", "maximum pressure since the start, at the nodes of terrain/soil/sinkage"},
     &SoilResult::maxPressure},
};

/// Numbers of the soil other than maps.
struct SoilLine {
  ResultConstant line;
  const char* shape; ///< shape of the dataset, for docs/files.md
  std::vector<double> SoilResult::*member;
};
inline constexpr SoilLine kSoilLines[] = {
    {{"terrain/soil/origin", "m", "x and y of the first node of the maps of deformable soil"},
     "[2]",
     &SoilResult::origin},
    {{"terrain/soil/spacing", "m", "node spacing of the maps of deformable soil"}, "[1]", &SoilResult::spacing},
    {{"terrain/soil/section_offset", "m",
      "lateral offset from the centreline of the vehicle in the rut profile, positive to the left"},
     "[n]",
     &SoilResult::sectionOffset},
    {{"terrain/soil/section_sinkage", "m",
      "final rut profile across the heading of the vehicle: sinkage, mean over the last 0.5 m of the rut behind the "
      "tracks; if there "
      "is no rut, under the tracks"},
     "[n]",
     &SoilResult::sectionSinkage},
};

/// A constant of the soil.
struct SoilConstantField {
  ResultConstant constant;
  double scm::SoilConstants::*member;
};
inline constexpr SoilConstantField kSoilConstants[] = {
    {{"terrain/soil/n", "-", "exponent of Bekker's relation"}, &scm::SoilConstants::exponent},
    {{"terrain/soil/k_c", "N/m^(n+1)", "cohesive modulus"}, &scm::SoilConstants::kc},
    {{"terrain/soil/k_phi", "N/m^(n+2)", "frictional modulus"}, &scm::SoilConstants::kphi},
    {{"terrain/soil/c", "Pa", "cohesion"}, &scm::SoilConstants::cohesion},
    {{"terrain/soil/tan_phi", "-", "tangent of the angle of internal friction"}, &scm::SoilConstants::friction},
    {{"terrain/soil/K", "m", "shear displacement modulus"}, &scm::SoilConstants::shearDisplacement},
    {{"terrain/soil/elastic_ratio", "-", "minimum ratio of the unloading slope to p / z at the end of virgin loading"},
     &scm::SoilConstants::elasticRatio},
    {{"terrain/soil/damping", "Pa s/m", "damping of compression and shear"}, &scm::SoilConstants::damping},
    {{"terrain/soil/slip_sinkage", "-", "sinkage per shear displacement at constant pressure"},
     &scm::SoilConstants::slipSinkage},
    {{"terrain/soil/maximum_slip_sinkage", "m", "maximum slip sinkage"}, &scm::SoilConstants::maximumSlipSinkage},
    {{"terrain/soil/unit_weight", "N/m3", "unit weight of the soil"}, &scm::SoilConstants::unitWeight},
};

/// Position of a vehicle [m], and unit vector along its heading.
struct Course {
  base::Vec3d position, heading;
};

/// Maps are empty if nothing touched the soil. The section requires the course of a vehicle.
SoilResult soilResult(const coupling::GroundFields& fields, const std::optional<Course>& course = {});

} // namespace grouser::output
