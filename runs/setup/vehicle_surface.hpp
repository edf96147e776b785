// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_law.hpp"
#include "runs/scene/scene.hpp"

#include <optional>

namespace grouser::setup {

/// Contact parameters of vehicle parts without a material, which take the material of what they touch.
struct VehicleSurface {
  double friction{}; ///< [-] friction_ground of the vehicle file
  double adhesion{}; ///< [-] vehicle.adhesion: of the pull that a wall of the soil's own material has on its grains

  /// `law`: of the soil with itself.
  contact::ContactLaw with(contact::ContactLaw law) const;
};

/// Empty without a vehicle, and where vehicle.material is given.
std::optional<VehicleSurface> vehicleSurface(const scene::Scene& scene);

} // namespace grouser::setup
