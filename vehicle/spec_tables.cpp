// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/spec_tables.hpp"

#include "base/math.hpp"

namespace grouser::vehicle {
namespace {

using base::Table;

/// Mass and inertia keys, the same for every part. A pointer to a base's member serves the derived struct as well.
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
           "mesh file in mesh_folder: closed, outward, in metres, in the part's frame")
      .required();
}

} // namespace

Table<VehicleSpec> vehicleTable() {
  Table<VehicleSpec> t("vehicle", "The whole vehicle");
  t.add("name", &VehicleSpec::name, "", "name in outputs and messages").required();
  t.add("mesh_folder", &VehicleSpec::meshFolder, "", "folder of the meshes, from this file's folder").required();
  t.add("track_offset", &VehicleSpec::trackOffset, "m", "tracks lie at y = +-track_offset")
      .above(0)
      .atMost(5)
      .required();
  return t;
}

Table<ChassisSpec> chassisTable() {
  Table<ChassisSpec> t("chassis", "Hull with everything that rides in it");
  addSurface(t);
  t.add("centre", &ChassisSpec::centre, "m", "centre of mass from the middle of the sprockets' axle line")
      .atLeast(-20)
      .atMost(20)
      .required();
  return t;
}

Table<ShoeSpec> shoeTable() {
  Table<ShoeSpec> t("shoe", "One track shoe; heights from the line of its pins");
  t.add("count", &ShoeSpec::count, "-", "shoes a track").atLeast(12).atMost(400).required();
  t.add("pitch", &ShoeSpec::pitch, "m", "distance of the two pin axes").above(0).atMost(1).required();
  t.add("plate_top", &ShoeSpec::plateTop, "m", "face on which wheels roll").atLeast(0).atMost(0.2).required();
  t.add("pad_bottom", &ShoeSpec::padBottom, "m", "lower face of the pad").below(0).atLeast(-0.5).required();
  t.add("grouser_height", &ShoeSpec::grouserHeight, "m", "reach of the grousers below the pad")
      .atLeast(0)
      .atMost(0.2)
      .required();
  t.add("half_length", &ShoeSpec::halfLength, "m", "half length of plate and pad").above(0).atMost(0.5).required();
  t.add("pad_half_width", &ShoeSpec::padHalfWidth, "m", "pads reach to y = +- this").above(0).atMost(1).required();
  t.add("horn_height", &ShoeSpec::hornHeight, "m", "guide horn above the plate").above(0).atMost(0.3).required();
  t.add("maximum_fold", &ShoeSpec::maximumFold, "rad", "largest angle between neighbours that the plates clear")
      .above(0)
      .below(base::kPi / 2)
      .required();
  t.add("pin_damping", &ShoeSpec::pinDamping, "N m s/rad", "viscous moment in each pin joint")
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
  t.add("count", &RoadWheelSpec::count, "-", "wheels a track").atLeast(2).atMost(12).required();
  t.add("radius", &RoadWheelSpec::radius, "m", "rolling radius").above(0).atMost(2).required();
  t.add("first_x", &RoadWheelSpec::firstX, "m", "axle of the rearmost wheel").atLeast(-20).atMost(20).required();
  t.add("spacing", &RoadWheelSpec::spacing, "m", "from axle to axle").above(0).atMost(5).required();
  t.add("z", &RoadWheelSpec::z, "m", "axle height").atLeast(-20).atMost(20).required();
  addSurface(t);
  return t;
}

Table<ArmSpec> armTable() {
  Table<ArmSpec> t("arm", "Trailing arm of a road wheel with its torsion bar");
  t.add("suspension", &ArmSpec::suspension, "",
        "arms that turn against torsion bars, or that are part of the hull: stiffness, damping and preload then have "
        "no meaning");
  t.add("length", &ArmSpec::length, "m", "pivot to axle").above(0).atMost(2).required();
  t.add("pivot_angle", &ArmSpec::pivotAngle, "rad", "of the pivot over the horizontal through the axle")
      .atLeast(-1)
      .atMost(1)
      .required();
  t.add("stiffness", &ArmSpec::stiffness, "N m/rad", "torsion bar; required of sprung arms").atLeast(0).atMost(1e9);
  t.add("damping", &ArmSpec::damping, "N m s/rad", "damper about the pivot; required of sprung arms")
      .atLeast(0)
      .atMost(1e9);
  t.add("preload", &ArmSpec::preload, "N", "vertical wheel load in the drawn position; required of sprung arms")
      .atLeast(0)
      .atMost(1e7);
  addMass(t);
  return t;
}

Table<RollerSpec> rollerTable() {
  Table<RollerSpec> t("roller", "Support rollers of one track; without this section there are none");
  t.add("radius", &RollerSpec::radius, "m", "rolling radius").above(0).atMost(2).required();
  t.add("x", &RollerSpec::x, "m", "axles").atLeast(-20).atMost(20).required();
  t.add("z", &RollerSpec::z, "m", "axles").atLeast(-20).atMost(20).required();
  addSurface(t);
  return t;
}

Table<IdlerSpec> idlerTable() {
  Table<IdlerSpec> t("idler", "Idler, on a carrier that slides along x against the tensioner");
  t.add("radius", &IdlerSpec::radius, "m", "rolling radius").above(0).atMost(2).required();
  t.add("x", &IdlerSpec::x, "m",
        "drawn place of the axle; the wrap finds the exact one. Below 0: the sprocket is in front")
      .atLeast(-20)
      .atMost(20)
      .required();
  t.add("z", &IdlerSpec::z, "m", "axle height").atLeast(-20).atMost(20).required();
  t.add("slide_min", &IdlerSpec::slideMin, "m", "stop towards the sprocket").atMost(0).atLeast(-0.5).required();
  t.add("slide_max", &IdlerSpec::slideMax, "m", "stop away from the sprocket").atLeast(0).atMost(0.5).required();
  t.add("stiffness", &IdlerSpec::stiffness, "N/m", "tensioner spring").above(0).atMost(1e10).required();
  t.add("damping", &IdlerSpec::damping, "N s/m", "tensioner damper").atLeast(0).atMost(1e9).required();
  t.add("preload", &IdlerSpec::preload, "N", "spring force at the wrap's place").atLeast(0).atMost(1e7).required();
  t.add("stop_stiffness", &IdlerSpec::stopStiffness, "N/m", "of both stops").above(0).atMost(1e12).required();
  t.add("stop_damping", &IdlerSpec::stopDamping, "N s/m",
        "of both stops, which never pull: on the way out it takes at most what their springs give")
      .atLeast(0)
      .atMost(1e9)
      .required();
  t.add("carrier_mass", &IdlerSpec::carrierMass, "kg", "sliding carrier").atLeast(1e-3).atMost(1e6).required();
  t.add("carrier_inertia", &IdlerSpec::carrierInertia, "kg m2", "of the carrier").above(0).atMost(1e8).required();
  addSurface(t);
  return t;
}

Table<EngineSpec> engineTable() {
  Table<EngineSpec> t("engine", "An engine for each sprocket behind a gear, for driver.drive = \"engine\"; of one that "
                                "drives both, half of its torque. Without this section there is none");
  t.add("speed", &EngineSpec::speed, "rad/s", "of its shaft, the points of its torque curve, increasing")
      .atLeast(0)
      .atMost(1e5)
      .required();
  t.add("torque", &EngineSpec::torque, "N m", "full load at these speeds; linear between them")
      .atLeast(0)
      .atMost(1e6)
      .required();
  t.add("ratio", &EngineSpec::ratio, "-", "speed of the engine over that of the sprocket")
      .above(0)
      .atMost(1e4)
      .required();
  t.add("efficiency", &EngineSpec::efficiency, "-", "of the gear").above(0).atMost(1);
  t.add("governed_speed", &EngineSpec::governedSpeed, "rad/s", "of its shaft, which the governor lets it reach")
      .above(0)
      .atMost(1e5)
      .required();
  t.add("droop", &EngineSpec::droop, "rad/s", "of its shaft, over which the governor goes from no torque to all")
      .above(0)
      .atMost(1e4)
      .required();
  t.add("brake_torque", &EngineSpec::brakeTorque, "N m",
        "most that holds a sprocket back where it turns faster than asked")
      .atLeast(0)
      .atMost(1e7);
  t.add("inertia", &EngineSpec::inertia, "kg m2", "of engine and gear, reduced to the sprocket, with which it turns")
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
  t.add("grouser_x", &GearShapes::grouserX, "m", "shoe: position of the grousers, at +-x; 0: one in the middle")
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
  t.add("seat_half_angle", &GearShapes::seatHalfAngle, "rad", "sprocket: half angle of the seat, from its bottom")
      .above(0)
      .below(base::kPi / 2)
      .required();
  add("flank_radius", &GearShapes::flankRadius, "sprocket: radius of the convex tooth flanks, tangent to the seat");
  add("tip_radius", &GearShapes::tipRadius, "sprocket: radius of the tooth tips, from the axle");
  return t;
}

Table<ContactSpec> contactTable() {
  Table<ContactSpec> t("contact", "Part against part, and part against rigid ground");
  t.add("foundation_modulus", &ContactSpec::foundationModulus, "N/m3", "force = modulus x sum of area x overlap")
      .above(0)
      .atMost(1e14)
      .required();
  t.add("relaxation_time", &ContactSpec::relaxationTime, "s", "stress = modulus x (overlap + time x rate)")
      .atLeast(0)
      .atMost(0.1)
      .required();
  t.add("tangential_ratio", &ContactSpec::tangentialRatio, "-", "tangential over normal stiffness")
      .atLeast(0)
      .atMost(1)
      .required();
  t.add("friction_inside", &ContactSpec::frictionInside, "-", "shoes against wheels, sprocket, idler")
      .atLeast(0)
      .atMost(2)
      .required();
  t.add("friction_ground", &ContactSpec::frictionGround, "-", "shoes against ground").atLeast(0).atMost(5).required();
  return t;
}

} // namespace grouser::vehicle
