// SPDX-License-Identifier: BSD-3-Clause
// Inputs of a vehicle: checks and routing.
#include "base/error.hpp"
#include "coupling/vehicle_rig.hpp"

#include <fmt/format.h>

namespace grouser::coupling {

namespace {

using vehicle::SprocketDrive;

/// Throws unless `right` is true; `drive` names the required kind of drive.
void requireDrive(bool right, const char* what, const char* drive) {
  if (!right)
    throw base::InputError(fmt::format("{} cannot be set with this driver; set driver.drive = {}", what, drive));
}

} // namespace

void VehicleRig::require(const Input& input) const {
  const SprocketDrive drive = driver_.options().drive;
  const bool ofTrack = input.kind == InputKind::sprocketSpeed || input.kind == InputKind::sprocketTorque ||
                       input.kind == InputKind::throttle;
  if (ofTrack && (input.target < 0 || input.target >= static_cast<std::int32_t>(assembly_.tracks.size())))
    throw base::InputError(fmt::format("the vehicle has no track {}; its tracks are 0 (left){}", input.target,
                                       assembly_.tracks.size() > 1 ? " and 1 (right)" : ""));
  switch (input.kind) {
  case InputKind::sprocketSpeed:
    return requireDrive(drive != SprocketDrive::torque, "sprocket speeds", "\"speed\" or \"engine\"");
  case InputKind::sprocketTorque:
    return requireDrive(drive == SprocketDrive::torque, "sprocket torques", "\"torque\"");
  case InputKind::throttle:
    return requireDrive(drive == SprocketDrive::engine, "throttles", "\"engine\"");
  case InputKind::hitchForce:
  case InputKind::hitchSpeed: {
    const bool force = input.kind == InputKind::hitchForce;
    const vehicle::HitchKind wanted = force ? vehicle::HitchKind::force : vehicle::HitchKind::speed;
    if (!towing_ || towing_->kind() != wanted)
      throw base::InputError(fmt::format("the scene has no hitch with an input {0}; add [hitch] kind = \"{0}\"",
                                         force ? "force" : "speed"));
    return;
  }
  case InputKind::bodyLoad:
    if (input.target < 0 || input.target >= static_cast<std::int32_t>(assembly_.model.bodies().size()))
      throw base::InputError(
          fmt::format("the vehicle has no body {}; it has {} bodies", input.target, assembly_.model.bodies().size()));
    return;
  case InputKind::gravity:
    return;
  }
}

void VehicleRig::command(const Inputs& inputs, const base::Vec3d& gravity) {
  const auto ofTracks = [&](InputKind kind, std::array<std::optional<double>, 2>& values) {
    for (std::int32_t side = 0; side < 2; ++side) {
      const auto value = inputs.now(kind, side);
      values[static_cast<std::size_t>(side)] = value ? std::optional(value->front()) : std::nullopt;
    }
  };
  ofTracks(InputKind::sprocketSpeed, commands_.sprocketSpeed);
  ofTracks(InputKind::sprocketTorque, commands_.torque);
  ofTracks(InputKind::throttle, commands_.throttle);
  applied_.set(inputs);
  gravity_ = gravity;
  observer_->setGravity(gravity);
  if (watch_) watch_->observer.setGravity(gravity);
  blows_.setWeight(assembly_.mass * norm(gravity));
  if (!towing_) return;
  const auto pull =
      inputs.now(towing_->kind() == vehicle::HitchKind::force ? InputKind::hitchForce : InputKind::hitchSpeed);
  towing_->command(pull ? std::optional(pull->front()) : std::nullopt);
}

} // namespace grouser::coupling
