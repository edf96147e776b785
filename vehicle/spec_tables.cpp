// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/spec_tables.hpp"

#include "base/math.hpp"

namespace grouser::vehicle {
namespace {

using base::Table;

/// Adds the keys of mass and inertia, which are the same for every part.
template <class S> void addMass(Table<S>& table) {
  table.add("mass", static_cast<double S::*>(&MassSpec::mass), "kg", "mass").atLeast(1e-3).atMost(1e6).required();
  table.add("inertia", static_cast<Vec3d S::*>(&MassSpec::inertia), "kg m2", "principal moments about x, y, z")
      .above(0)
      .atMost(1e8)
      .required();
}
template <class S> void addSurface(Table<S>& table) {
  addMass(table);
  table
      .add("mesh", static_cast<std::string S::*>(&SurfaceSpec::mesh), "",
           "mesh file in mesh_folder: closed surface, faces outward, in metres, in the part's frame")
      .required();
}

} // namespace

Table<VehicleSpec> vehicleTable() {
  Table<VehicleSpec> t("vehicle", "Vehicle");
  t.add("name", &VehicleSpec::name, "", "name in outputs and messages").required();
  t.add("mesh_folder", &VehicleSpec::meshFolder, "", "mesh folder, relative to this file").required();
  t.add("track_offset", &VehicleSpec::trackOffset, "m",
        "distance of each track from the middle plane: tracks at y = +-track_offset")
      .plausible(0.02, 3)
      .above(0)
      .atMost(5)
      .required();
  return t;
}

Table<ChassisSpec> chassisTable() {
  Table<ChassisSpec> t("chassis", "Hull with its payload");
  addSurface(t);
  t.add("centre", &ChassisSpec::centre, "m", "centre of mass, relative to the middle of the sprockets' axle line")
      .plausible(0, 10)
      .atLeast(-20)
      .atMost(20)
      .required();
  return t;
}

Table<ShoeSpec> shoeTable() {
  Table<ShoeSpec> t("shoe", "Track shoe; heights are relative to the pin line");
  t.add("count", &ShoeSpec::count, "-", "shoes per track").atLeast(12).atMost(400).required();
  t.add("pitch", &ShoeSpec::pitch, "m", "distance between the two pin axes")
      .plausible(5e-3, 0.4)
      .above(0)
      .atMost(1)
      .required();
  t.add("plate_top", &ShoeSpec::plateTop, "m", "height of the rolling face").atLeast(0).atMost(0.2).required();
  t.add("pad_bottom", &ShoeSpec::padBottom, "m", "height of the pad bottom").below(0).atLeast(-0.5).required();
  t.add("grouser_height", &ShoeSpec::grouserHeight, "m", "height of the grousers below the pad")
      .atLeast(0)
      .atMost(0.2)
      .required();
  t.add("half_length", &ShoeSpec::halfLength, "m", "half length of plate and pad")
      .plausible(2e-3, 0.3)
      .above(0)
      .atMost(0.5)
      .required();
  t.add("pad_half_width", &ShoeSpec::padHalfWidth, "m", "half width of the pad")
      .plausible(2e-3, 0.6)
      .above(0)
      .atMost(1)
      .required();
  t.add("horn_height", &ShoeSpec::hornHeight, "m", "height of the guide horn").above(0).atMost(0.3).required();
  t.add("maximum_fold", &ShoeSpec::maximumFold, "rad", "maximum fold angle between neighbouring shoes, in radians")
      .plausible(0.1, 1.5)
      .above(0)
      .below(base::kPi / 2)
      .required();
  t.add("pin_damping", &ShoeSpec::pinDamping, "N m s/rad", "viscous damping of each pin joint")
      .plausible(0, 1000)
      .atLeast(0)
      .atMost(1e4)
      .required();
  addSurface(t);
  return t;
}

Table<SprocketSpec> sprocketTable() {
  Table<SprocketSpec> t("sprocket", "Drive sprocket, at the rear or in front; its axle is the origin");
  t.add("teeth", &SprocketSpec::teeth, "-", "number of teeth").atLeast(6).atMost(40).required();
  addSurface(t);
  return t;
}

Table<RoadWheelSpec> roadWheelTable() {
  Table<RoadWheelSpec> t("road_wheel", "Road wheels of one track");
  t.add("count", &RoadWheelSpec::count, "-", "road wheels per track").atLeast(2).atMost(12).required();
  t.add("radius", &RoadWheelSpec::radius, "m", "rolling radius").plausible(5e-3, 1).above(0).atMost(2).required();
  t.add("first_x", &RoadWheelSpec::firstX, "m", "x of the rearmost axle")
      .plausible(0, 10)
      .atLeast(-20)
      .atMost(20)
      .required();
  t.add("spacing", &RoadWheelSpec::spacing, "m", "distance between axles")
      .plausible(0.01, 3)
      .above(0)
      .atMost(5)
      .required();
  t.add("z", &RoadWheelSpec::z, "m", "axle height").plausible(0, 3).atLeast(-20).atMost(20).required();
  addSurface(t);
  return t;
}

Table<ArmSpec> armTable() {
  Table<ArmSpec> t("arm", "Trailing arm of a road wheel with its torsion bar");
  t.add("suspension", &ArmSpec::suspension, "",
        "sprung: arms on torsion bars; rigid: arms fixed to the hull, stiffness, damping and preload ignored");
  t.add("length", &ArmSpec::length, "m", "distance from pivot to axle")
      .plausible(5e-3, 1)
      .above(0)
      .atMost(2)
      .required();
  t.add("pivot_angle", &ArmSpec::pivotAngle, "rad",
        "angle of the pivot above the horizontal through the axle, in radians")
      .plausible(0, 0.9)
      .atLeast(-1)
      .atMost(1)
      .required();
  t.add("stiffness", &ArmSpec::stiffness, "N m/rad", "torsion bar stiffness; required for sprung arms")
      .plausible(1, 1e7)
      .atLeast(0)
      .atMost(1e9);
  t.add("damping", &ArmSpec::damping, "N m s/rad", "damping about the pivot; required for sprung arms")
      .plausible(0.01, 1e6)
      .atLeast(0)
      .atMost(1e9);
  t.add("preload", &ArmSpec::preload, "N", "vertical wheel load in the design position; required for sprung arms")
      .plausible(0.5, 5e5)
      .atLeast(0)
      .atMost(1e7);
  addMass(t);
  return t;
}

Table<RollerSpec> rollerTable() {
  Table<RollerSpec> t("roller", "Support rollers of one track (optional section)");
  t.add("radius", &RollerSpec::radius, "m", "rolling radius").plausible(5e-3, 0.5).above(0).atMost(2).required();
  t.add("x", &RollerSpec::x, "m", "axle positions along x").plausible(0, 10).atLeast(-20).atMost(20).required();
  t.add("z", &RollerSpec::z, "m", "axle heights").plausible(0, 3).atLeast(-20).atMost(20).required();
  addSurface(t);
  return t;
}

Table<IdlerSpec> idlerTable() {
  Table<IdlerSpec> t("idler", "Idler, on a carrier that slides along x against the tensioner");
  t.add("radius", &IdlerSpec::radius, "m", "rolling radius").plausible(5e-3, 1).above(0).atMost(2).required();
  t.add("x", &IdlerSpec::x, "m",
        "drawn axle position; adjusted so that the track closes. Below 0: the sprocket is in front")
      .plausible(0, 15)
      .atLeast(-20)
      .atMost(20)
      .required();
  t.add("z", &IdlerSpec::z, "m", "axle height").plausible(0, 3).atLeast(-20).atMost(20).required();
  t.add("slide_min", &IdlerSpec::slideMin, "m", "stop towards the sprocket").atMost(0).atLeast(-0.5).required();
  t.add("slide_max", &IdlerSpec::slideMax, "m", "stop away from the sprocket").atLeast(0).atMost(0.5).required();
  t.add("stiffness", &IdlerSpec::stiffness, "N/m", "tensioner spring stiffness")
      .plausible(100, 1e9)
      .above(0)
      .atMost(1e10)
      .required();
  t.add("damping", &IdlerSpec::damping, "N s/m", "tensioner damping")
      .plausible(0.1, 1e7)
      .atLeast(0)
      .atMost(1e9)
      .required();
  t.add("preload", &IdlerSpec::preload, "N", "spring force at the initial position")
      .plausible(0.5, 1e6)
      .atLeast(0)
      .atMost(1e7)
      .required();
  t.add("stop_stiffness", &IdlerSpec::stopStiffness, "N/m", "stiffness of both stops")
      .plausible(1e3, 1e10)
      .above(0)
      .atMost(1e12)
      .required();
  t.add("stop_damping", &IdlerSpec::stopDamping, "N s/m", "damping of both stops, limited so that they never pull")
      .plausible(0.1, 1e7)
      .atLeast(0)
      .atMost(1e9)
      .required();
  t.add("carrier_mass", &IdlerSpec::carrierMass, "kg", "carrier mass")
      .plausible(1e-3, 1000)
      .atLeast(1e-3)
      .atMost(1e6)
      .required();
  t.add("carrier_inertia", &IdlerSpec::carrierInertia, "kg m2", "carrier inertia")
      .plausible(1e-8, 1000)
      .above(0)
      .atMost(1e8)
      .required();
  addSurface(t);
  return t;
}

Table<EngineSpec> engineTable() {
  Table<EngineSpec> t("engine", "Engine and gear of each sprocket, for driver.drive = \"engine\"; if one engine drives "
                                "both, enter half of its torque (optional section)");
  t.add("speed", &EngineSpec::speed, "rad/s", "shaft speeds of the torque curve, increasing")
      .plausible(1, 1200)
      .atLeast(0)
      .atMost(1e5)
      .required();
  t.add("torque", &EngineSpec::torque, "N m", "full-load torque at these speeds; linear between them")
      .plausible(0.05, 2e4)
      .atLeast(0)
      .atMost(1e6)
      .required();
  t.add("ratio", &EngineSpec::ratio, "-", "gear ratio: engine speed over sprocket speed")
      .plausible(0.5, 500)
      .above(0)
      .atMost(1e4)
      .required();
  t.add("efficiency", &EngineSpec::efficiency, "-", "gear efficiency").above(0).atMost(1);
  t.add("governed_speed", &EngineSpec::governedSpeed, "rad/s", "maximum shaft speed under the governor")
      .plausible(1, 1200)
      .above(0)
      .atMost(1e5)
      .required();
  t.add("droop", &EngineSpec::droop, "rad/s", "shaft speed range between zero and full torque of the governed engine")
      .plausible(0.1, 150)
      .above(0)
      .atMost(1e4)
      .required();
  t.add("brake_torque", &EngineSpec::brakeTorque, "N m",
        "maximum braking torque on a sprocket that turns faster than commanded")
      .plausible(0.05, 1e6)
      .atLeast(0)
      .atMost(1e7);
  t.add("inertia", &EngineSpec::inertia, "kg m2", "moment of inertia of engine and gearing, reflected to the sprocket")
      .plausible(1e-6, 1000)
      .above(0)
      .atMost(1e6)
      .required();
  return t;
}

Table<GearShapes> shapesTable() {
  Table<GearShapes> t("shapes",
                      "Dimensions of the running gear for the shape contact model; without this section contacts use "
                      "samples of the meshes. All parts are symmetric about y = 0");
  const auto add = [&t](const char* key, double GearShapes::*length, const char* help) {
    t.add(key, length, "m", help).above(0).atMost(2).required();
  };
  add("plate_inner", &GearShapes::plateInner, "shoe: inner edges of the wheel plates, at +-y");
  add("plate_outer", &GearShapes::plateOuter, "shoe: outer edges of the wheel plates, at +-y");
  add("horn_length", &GearShapes::hornLength, "shoe: length of the guide horn (x) at plate height");
  add("horn_width", &GearShapes::hornWidth, "shoe: width of the guide horn (y) at plate height");
  add("horn_tip_length", &GearShapes::hornTipLength, "shoe: length of the guide horn (x) at its tip");
  add("horn_tip_width", &GearShapes::hornTipWidth, "shoe: width of the guide horn (y) at its tip");
  add("boss_radius", &GearShapes::bossRadius,
      "shoe: radius of the bosses about the pins (x = pitch / 2), which mesh with the sprocket");
  add("boss_inner", &GearShapes::bossInner, "shoe: inner faces of the bosses, at +-y");
  add("boss_outer", &GearShapes::bossOuter, "shoe: outer faces of the bosses, at +-y");
  t.add("pad_top", &GearShapes::padTop, "m", "shoe: height of the upper face of the pad, beside the plates")
      .atLeast(-0.5)
      .atMost(0.2)
      .required();
  t.add("grouser_x", &GearShapes::grouserX, "m",
        "shoe: position of the two grousers, at +-x; 0: a single grouser in the middle")
      .atLeast(0)
      .atMost(0.5)
      .required();
  add("grouser_width", &GearShapes::grouserWidth, "shoe: width of a grouser (x)");
  t.add("chamfer", &GearShapes::chamfer, "m", "shoe: chamfer of the lower edges of pad and grousers, at 45 degrees")
      .atLeast(0)
      .atMost(0.1)
      .required();
  add("disc_inner", &GearShapes::discInner, "wheels, rollers, idler: inner sides of the two discs, at +-y");
  add("disc_outer", &GearShapes::discOuter, "wheels, rollers, idler: outer sides of the two discs, at +-y");
  t.add("disc_chamfer", &GearShapes::discChamfer, "m",
        "wheels, rollers, idler: chamfer of the disc edges, at 45 degrees")
      .atLeast(0)
      .atMost(0.1)
      .required();
  add("ring_inner", &GearShapes::ringInner, "sprocket: inner sides of the two toothed rings, at +-y");
  add("ring_outer", &GearShapes::ringOuter, "sprocket: outer sides of the two toothed rings, at +-y");
  add("seat_radius", &GearShapes::seatRadius, "sprocket: radius of the seat, the arc that holds a boss");
  t.add("seat_half_angle", &GearShapes::seatHalfAngle, "rad",
        "sprocket: half angle of the seat, from its bottom, in radians")
      .plausible(0.1, 1.55)
      .above(0)
      .below(base::kPi / 2)
      .required();
  add("flank_radius", &GearShapes::flankRadius, "sprocket: radius of the convex tooth flanks, tangent to the seat");
  add("tip_radius", &GearShapes::tipRadius, "sprocket: radius of the tooth tips, from the axle");
  return t;
}

Table<ContactSpec> contactTable() {
  Table<ContactSpec> t("contact", "Contacts between parts, and of parts with rigid ground");
  t.add("foundation_modulus", &ContactSpec::foundationModulus, "N/m3",
        "elastic foundation modulus: force = modulus x sum of area x overlap")
      .plausible(1e6, 1e13)
      .above(0)
      .atMost(1e14)
      .required();
  t.add("pad_modulus", &ContactSpec::padModulus, "N/m3",
        "elastic foundation modulus of the shoes on rigid ground and obstacles, e.g. of rubber pads (modulus of "
        "elasticity / thickness); default: foundation_modulus")
      .plausible(1e6, 1e13)
      .above(0)
      .atMost(1e14);
  t.add("relaxation_time", &ContactSpec::relaxationTime, "s",
        "foundation damping: stress = modulus x (overlap + relaxation_time x rate)")
      .plausible(1e-7, 0.02)
      .atLeast(0)
      .atMost(0.1)
      .required();
  t.add("tangential_ratio", &ContactSpec::tangentialRatio, "-", "ratio of tangential to normal stiffness")
      .atLeast(0)
      .atMost(1)
      .required();
  t.add("friction_inside", &ContactSpec::frictionInside, "-", "friction of shoes on wheels, sprocket and idler")
      .plausible(0.01, 1.5, "tan of the friction angle, not the angle")
      .atLeast(0)
      .atMost(2)
      .required();
  t.add("friction_ground", &ContactSpec::frictionGround, "-", "shoe-ground friction")
      .plausible(0.05, 2, "tan of the friction angle, not the angle")
      .atLeast(0)
      .atMost(5)
      .required();
  return t;
}

} // namespace grouser::vehicle
