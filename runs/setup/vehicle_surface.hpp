// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_law.hpp"
#include "runs/scene/scene.hpp"

#include <optional>

namespace grouser::setup {

/// Contact parameters of vehicle parts without a material; they have the material of their contact partner.
struct VehicleSurface {
  double friction{}; ///< [-] friction_ground of the vehicle file
  double adhesion{}; ///< [-] vehicle.adhesion: adhesive force / that of a wall of the soil material

  /// `law`: law between grains of the soil.
  contact::ContactLaw with(contact::ContactLaw law) const;
};

/// Empty without a vehicle, or if vehicle.material is given.
std::optional<VehicleSurface> vehicleSurface(const scene::Scene& scene);

} // namespace grouser::setup
