// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/vehicle_surface.hpp"

#include "runs/scene/scene.hpp"
#include "vehicle/spec_file.hpp"

namespace grouser::setup {

contact::ContactLaw VehicleSurface::with(contact::ContactLaw law) const {
  law = law.pulling(adhesion);
  law.friction = friction;
  return law;
}

std::optional<VehicleSurface> vehicleSurface(const scene::Scene& scene) {
  if (!scene.vehicle || !scene.vehicle->material.empty()) return {};
  return VehicleSurface{vehicle::readVehicleSpec(scene.vehicle->source()).contact.frictionGround,
                        scene.vehicle->adhesion};
}

} // namespace grouser::setup
