// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"
#include "base/vec.hpp"

#include <optional>
#include <string>
#include <vector>

/// The fluid sections of a scene file as plain structs. fluid_section.cpp defines their keys, units and ranges.
namespace grouser::scene {

/// [[fluid.box]]: fluid at the start.
struct FluidBox {
  base::Vec3d low, high; ///< corners [m]
  base::Vec3d velocity;  ///< [m/s]
  bool operator==(const FluidBox&) const = default;
};

/// [[fluid.probe]]
enum class FluidProbeKind { pressure, level };

struct FluidProbe {
  std::string name;
  FluidProbeKind kind = FluidProbeKind::pressure;
  base::Vec3d position; ///< [m]; for a level: lower end of the wire
  bool operator==(const FluidProbe&) const = default;
};

/// [fluid]
struct Fluid {
  double spacing = 0; ///< [m]
  int dimensions = 3; ///< 2: plane y = 0, quantities per metre of width
  std::optional<base::Vec3d> tankLow,
      tankHigh;                         ///< [m] inner faces; empty: the terrain's borders, from its lowest point
  bool lid = false;                     ///< the tank is closed above
  std::optional<double> level;          ///< [m] z of the initial free surface; empty: boxes only
  double density = 1000, viscosity = 0; ///< [kg/m3], [Pa s]
  std::optional<double> soundSpeed;     ///< [m/s]
  std::optional<double> expectedSpeed;  ///< [m/s]; determines the sound speed; empty: see setup::fluidModel()
  double smoothing = 1.3;               ///< [-] smoothing length / spacing
  double artificialViscosity = 0.02, diffusion = 0.1; ///< [-]
  double shifting = 0;                                ///< [-]
  std::vector<FluidBox> boxes;
  std::vector<FluidProbe> probes;
  bool operator==(const Fluid&) const = default;
};

} // namespace grouser::scene

template <> struct grouser::base::EnumWords<grouser::scene::FluidProbeKind> {
  using E = scene::FluidProbeKind;
  static constexpr EnumWord<E> list[] = {{E::pressure, "pressure"}, {E::level, "level"}};
};
