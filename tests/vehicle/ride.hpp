// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "plane_contact.hpp"

#include "multibody/solver.hpp"
#include "vehicle/observers.hpp"
#include "vehicle/spec_file.hpp"

#include <string>

namespace grouser::test {

inline constexpr base::Vec3d kRideGravity{0, 0, -9.81};

inline vehicle::VehicleSpec readySpec(const std::string& name = "light_tracked") {
  return vehicle::readVehicleSpec(std::string(GROUSER_SOURCE_DIR "/assets/vehicles/") + name + ".toml");
}

/// Contact stiffness [N/m] and step [s]. Stiffer than the reference 1e7 N/m, so that overlaps at 5 kN are below the
/// tolerance of 1 mm; a thirtieth of the period of a shoe on its contact spring, 2 pi sqrt(m / k) = 3.3e-3 s.
struct RideNumbers {
  double stiffness = 3e7;
  double step = 1e-4;
};

/// A vehicle on level rigid ground, its driver, and everything required to step it.
class Ride {
public:
  Ride(const vehicle::VehicleSpec& spec, vehicle::AssemblyOptions options, const vehicle::DriverOptions& driver,
       double groundHeight, RideNumbers numbers = {})
      : step_(numbers.step), vehicle_(vehicle::assemble(spec, withDrive(options, driver))), solver_(vehicle_.model),
        driver_(driver), contact_(vehicle_, {.stiffness = numbers.stiffness, .groundHeight = groundHeight}),
        state(multibody::makeState(vehicle_.model)), loads(multibody::makeLoads(vehicle_.model)), observer(vehicle_) {}

  /// Steps until `time`, calling `each` after every step.
  template <class Each> void until(double time, Each each) {
    while (state.time < time - 0.5 * step_) {
      vehicle::Controls controls = driver_.step(state.time, step_, vehicle::hullMotion(vehicle_, state));
      if (driver_.options().drive == vehicle::SprocketDrive::engine)
        vehicle::addEngineTorques(vehicle_, state, controls);
      vehicle::applyControls(vehicle_, controls, kRideGravity, loads);
      contact_.apply(state, loads);
      solver_.step(state, loads, step_);
      observer.update(state, step_);
      each();
    }
  }
  void until(double time) {
    until(time, [] {});
  }
  vehicle::Observation observe() const {
    return observer.observe(state, contact_.ground(), [](double, double) { return 0.0; });
  }
  vehicle::HullMotion motion() const { return vehicle::hullMotion(vehicle_, state); }
  const vehicle::Assembly& vehicle() const { return vehicle_; }
  const vehicle::Driver& driver() const { return driver_; }
  const vehicle::GroundLoads& ground() const { return contact_.ground(); }

private:
  static vehicle::AssemblyOptions withDrive(vehicle::AssemblyOptions options, const vehicle::DriverOptions& driver) {
    options.drive = driver.drive;
    return options;
  }

  double step_;
  vehicle::Assembly vehicle_;
  multibody::Solver solver_;
  vehicle::Driver driver_;
  PlaneContact contact_;

public:
  multibody::State state;
  multibody::Loads loads;
  vehicle::Observer observer;
};

/// Placed at the origin, heading along x.
inline Ride rideOnGround(const vehicle::VehicleSpec& spec, const vehicle::DriverOptions& driver,
                         RideNumbers numbers = {}) {
  vehicle::AssemblyOptions options;
  options.pose_W = vehicle::placeOnGround(spec, 0, 0, 0, 0.002, 0);
  return Ride(spec, options, driver, 0.0, numbers);
}

} // namespace grouser::test
