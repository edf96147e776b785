// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/observation_table.hpp"

#include <array>

namespace grouser::vehicle {
namespace {

struct ScalarField {
  const char *name, *unit, *help;
  double TrackObservation::*member;
};
struct ShoeField {
  const char *name, *unit, *help;
  std::vector<double> TrackObservation::*member;
};
struct VehicleField {
  const char *name, *unit, *help;
  double Observation::*member;
};
struct VectorField {
  const char *name, *unit, *help;
  std::array<const char*, 3> columns;
  base::Vec3d Observation::*member;
};

constexpr VectorField kVectorFields[] = {
    {"position", "m", "middle of the sprockets' axle line", {"x", "y", "z"}, &Observation::position},
    {"velocity", "m/s", "velocity of the chassis' centre of mass", {"x", "y", "z"}, &Observation::velocity},
    {"ground_force", "N", "ground force on all bodies", {"forward", "left", "up"}, &Observation::groundForce},
};

constexpr VehicleField kVehicleFields[] = {
    {"heading", "rad", "heading of the hull, from world x towards y, continuous over turns", &Observation::heading},
    {"pitch_angle", "rad", "pitch of the hull, nose up positive, within +-pi/2", &Observation::pitchAngle},
    {"roll_angle", "rad", "roll of the hull, right side down positive, continuous over turns", &Observation::rollAngle},
    {"gross_traction", "N", "sum of the mean drive torques / pitch radius, in the direction of motion",
     &Observation::grossTraction},
    {"net_thrust", "N",
     "ground force on the vehicle along the ground, in the direction of motion, mean since the last row",
     &Observation::netThrust},
    {"drawbar_pull", "N",
     "force of the vehicle on its hitch in the direction of motion, mean since the last row; without a hitch: net "
     "thrust minus the weight component along the ground",
     &Observation::drawbarPull},
    {"motion_resistance", "N", "gross traction minus net thrust; NaN while the tracks run in opposite directions",
     &Observation::motionResistance},
};

constexpr ScalarField kTrackFields[] = {
    {"sprocket_speed", "rad/s", "sprocket speed, forward positive", &TrackObservation::sprocketSpeed},
    {"drive_torque", "N m", "drive torque of the hull on the sprocket, forward positive",
     &TrackObservation::driveTorque},
    {"mean_torque", "N m", "drive torque, mean since the last row", &TrackObservation::meanTorque},
    {"drive_power", "W", "power of the drive at the sprocket, mean since the last row", &TrackObservation::drivePower},
    {"idler_force", "N", "tensioner force on the idler, positive away from the sprocket",
     &TrackObservation::idlerForce},
    {"idler_slide", "m", "idler displacement from the design position, positive away from the sprocket",
     &TrackObservation::idlerSlide},
    {"speed", "m/s", "speed of the hull at this track", &TrackObservation::speed},
    {"slip", "-", "1 - speed / (sprocket speed x pitch radius)", &TrackObservation::slip},
    {"tooth_speed", "m/s", "speed, mean over whole tooth passages", &TrackObservation::toothSpeed},
    {"tooth_slip", "-", "slip, mean over whole tooth passages", &TrackObservation::toothSlip},
    {"teeth_passed", "-", "sprocket speed x teeth / (2 pi), integrated", &TrackObservation::teethPassed},
    {"pitches_passed", "-", "track pitches that passed the sprocket", &TrackObservation::pitchesPassed},
    {"skipped", "-", "teeth passed minus pitches passed", &TrackObservation::skipped},
    {"sideways", "m", "largest lateral distance of a shoe from its track's plane", &TrackObservation::sideways},
    {"wheel_lift", "m", "largest gap between a road wheel and the plates below it", &TrackObservation::wheelLift},
};

constexpr ShoeField kShoeFields[] = {
    {"pad_height", "m", "lowest point of each shoe's pad plate", &TrackObservation::padHeight},
    {"sinkage", "m", "depth of the pad centre below the undisturbed surface, along its normal, in ground contact",
     &TrackObservation::sinkage},
    {"tension", "N", "pull along the chain in the pin ahead of each shoe", &TrackObservation::tension},
    {"ground_pressure", "Pa", "ground force normal to the pad / pad area", &TrackObservation::groundPressure},
    {"on_ground", "-", "1 if the shoe is in ground contact and loaded, else 0", &TrackObservation::onGround},
};

/// Fields that are written only with per-shoe forces.
constexpr ShoeField kForceFields[] = {
    {"normal_force", "N", "ground force on each shoe normal to its pad, mean since the last row",
     &TrackObservation::normalForce},
    {"forward_force", "N", "ground force along the shoe (forward in ground contact), mean since the last row",
     &TrackObservation::forwardForce},
    {"left_force", "N", "ground force across the shoe, left positive, mean since the last row",
     &TrackObservation::leftForce},
    {"shear", "Pa", "resultant shear force on each pad / pad area", &TrackObservation::shear},
    {"pin_lateral_force", "N", "force along the pin ahead of each shoe, of the shoe on the next one, left positive",
     &TrackObservation::pinLateral},
    {"pin_moment", "N m", "moment across the pin ahead of each shoe, magnitude", &TrackObservation::pinMoment},
};

} // namespace

std::vector<Quantity> quantitiesOfHull() {
  std::vector<Quantity> list;
  for (const VectorField& f : kVectorFields)
    list.push_back({std::string("vehicle/") + f.name, f.unit, f.help, 3, {f.columns.begin(), f.columns.end()}});
  for (const VehicleField& f : kVehicleFields)
    list.push_back({std::string("vehicle/") + f.name, f.unit, f.help, 1, {}});
  return list;
}

std::vector<Quantity> quantitiesOfTrack(const std::string& side, int shoes, int wheels, bool shoeForces) {
  std::vector<Quantity> list;
  const std::string folder = "vehicle/" + side + "/";
  for (const ScalarField& f : kTrackFields) list.push_back({folder + f.name, f.unit, f.help, 1, {}});
  Quantity arms{folder + "arm_angle",
                "rad",
                "angle of each road wheel's arm from the design position, positive if the wheel moves up",
                wheels,
                {}};
  for (int i = 0; i < wheels; ++i) arms.columns.push_back(std::to_string(i));
  list.push_back(arms);
  for (const ShoeField& f : kShoeFields) list.push_back({folder + f.name, f.unit, f.help, shoes, {}});
  if (!shoeForces) return list;
  for (const ShoeField& f : kForceFields) list.push_back({folder + f.name, f.unit, f.help, shoes, {}});
  return list;
}

std::vector<Quantity> quantities(const Assembly& vehicle, bool shoeForces) {
  std::vector<Quantity> list = quantitiesOfHull();
  for (const Track& track : vehicle.tracks)
    for (Quantity& q : quantitiesOfTrack(sideName(track.side), static_cast<int>(track.shoes.size()),
                                         static_cast<int>(track.armJoints.size()), shoeForces))
      list.push_back(std::move(q));
  return list;
}

std::vector<double> flatten(const Observation& observation, bool shoeForces) {
  std::vector<double> values;
  const auto add = [&values](const std::vector<double>& more) {
    values.insert(values.end(), more.begin(), more.end());
  };
  for (const VectorField& f : kVectorFields) {
    const base::Vec3d& v = observation.*f.member;
    values.insert(values.end(), {v.x, v.y, v.z});
  }
  for (const VehicleField& f : kVehicleFields) values.push_back(observation.*f.member);
  for (const TrackObservation& track : observation.tracks) {
    for (const ScalarField& f : kTrackFields) values.push_back(track.*f.member);
    add(track.armAngle);
    for (const ShoeField& f : kShoeFields) add(track.*f.member);
    if (!shoeForces) continue;
    for (const ShoeField& f : kForceFields) add(track.*f.member);
  }
  return values;
}

} // namespace grouser::vehicle
