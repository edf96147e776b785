// SPDX-License-Identifier: BSD-3-Clause
// Which scene keys are part of the cache key of a settled bed: all keys of all sections against
// a manually checked list. A key without effect on settling must keep the bed;
// any other key must change it.
#include "runs/scene/scene.hpp"
#include "runs/setup/bed_alone.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/setup/step_limit.hpp"

#include "runs/scene/scene_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

namespace grouser::setup {
namespace {

/// A bed with a vehicle, and all objects that can be inside, beside or above it.
std::string sceneText(const std::string& more) {
  return R"(version = 1
[run]
duration = 0.1
time_step = 1e-4
[material.soil]
stiffness = 5e5
[material.steel]
stiffness = 1e6
[material.rubber]
stiffness = 1e6
[contact."soil|steel"]
friction = 0.4
[contact."soil|rubber"]
friction = 0.4
[terrain]
heightmap = "heightmaps/hills.png"
size = [4.2, 2.6]
height_range = [0.0, 0.05]
material = "soil"
grain_radius = 0.045
depth = 0.14
[[box]]
position = [2, 0.5, 0]
size = [0.2, 0.2, 0.1]
material = "steel"
[[cylinder]]
position = [2, -0.5, 0]
radius = 0.1
length = 0.2
material = "steel"
[[plane]]
point = [0, 0, -1]
material = "steel"
[[source]]
low = [1, 0, 1]
high = [2, 0.5, 1.2]
radius = 0.03
material = "soil"
every = 1
total = 3
[vehicle]
spec = "vehicles/light_tracked.toml"
material = "rubber"
[driver]
sprocket_speed = 2
)" + more;
}

/// Bed key of the scene with these keys; "-TEXT" removes the lines that start with TEXT.
std::string keyOf(const std::string& more, const std::vector<std::string>& changes) {
  std::string text;
  std::vector<std::string> overrides;
  std::copy_if(changes.begin(), changes.end(), std::back_inserter(overrides),
               [](const std::string& c) { return c[0] != '-'; });
  std::istringstream lines(sceneText(more));
  for (std::string line; std::getline(lines, line);)
    if (std::none_of(changes.begin(), changes.end(),
                     [&](const std::string& c) { return c[0] == '-' && line.rfind(c.substr(1), 0) == 0; }))
      text += line + "\n";
  const scene::Scene scene = scene::readSceneText(text, "bed.toml", overrides);
  return bedOrigin(isPutOnBed(scene) ? sceneOfBed(scene) : scene, 1e-4);
}

struct Change {
  std::string key;                    ///< "section.key", as in docs/keys.md
  bool moves;                         ///< whether the key changes the bed
  std::vector<std::string> overrides; ///< overrides that change it
  std::vector<std::string> before{};  ///< overrides of both scenes
  std::string more{};                 ///< additional sections of both scenes
};

const std::string
    kForce = "[hitch]\nkind = \"force\"\nforce = 100\n",
    kRamp = "[hitch]\nkind = \"ramp\"\nrate = 9\n", kSled = "[hitch]\nkind = \"sled\"\nmass = 800\nfriction = 0.4\n",
    kCarriage = "[hitch]\nkind = \"speed\"\nslip = 0.2\n",
    kMesh =
        "[[mesh]]\nfile = \"meshes/idler.obj\"\nposition = [2, 0, 3]\nmaterial = \"steel\"\nvelocity = [0, 0, -0.5]\n",
    kGrain = "[[grain]]\nposition = [2, 0.9, 0]\nabove_bed = 0.1\nradius = 0.06\nmaterial = \"steel\"\n",
    kFill = "[[grains]]\nlow = [1, 0, 0]\nhigh = [2, 1, 0.3]\nradius = 0.05\nmaterial = \"steel\"\n"
            "above_bed = 0.1\n",
    kTable = "[driver.table]\ntime = [0, 1]\nleft = [1, 2]\nright = [1, 2]\n",
    kTorques = "[driver.torques]\ntime = [0, 1]\nleft = [1, 2]\nright = [1, 2]\n",
    kCircle = "[driver.course]\nspeed = 1\nradius = 9\n",
    kPath = "[driver.course]\nspeed = 1\nx = [0, 5]\ny = [0, 1]\n";

std::vector<std::string> with(std::vector<std::string> changes, const std::string& one) {
  changes.push_back(one);
  return changes;
}
const std::vector<std::string> kNoVehicle{"-[vehicle]", "-spec", "-material = \"rubber\"", "-[driver]",
                                          "-sprocket_speed"};

const std::string kSolved = "run.contact=complementarity";

std::vector<Change> ofRun() {
  return {{"run.duration", false, {"run.duration=7"}},
          {"run.time_step", false, {"run.time_step=2e-4"}},               // the step itself is an input of bedOrigin()
          {"run.steps_per_contact", false, {"run.steps_per_contact=30"}}, // changes the step only
          {"run.steps_per_period", false, {"run.steps_per_period=30"}},
          {"run.gravity", true, {"run.gravity=[0,0,-9]"}},
          {"run.output_interval", false, {"run.output_interval=0.03"}},
          {"run.frame_interval", false, {"run.frame_interval=0.3"}},
          {"run.checkpoint_interval", false, {"run.checkpoint_interval=3"}},
          {"run.seed", true, {"run.seed=2"}},
          {"run.device", false, {"run.device=cpu"}},
          {"run.precision", true, {"run.precision=double"}},
          {"run.contact", false, {"run.contact=complementarity"}}, // beds settle with penalty contacts
          {"run.residual", false, {kSolved, "run.residual=1e-5"}, {kSolved}},
          {"complementarity.friction", false, {kSolved, "complementarity.friction=associated"}, {kSolved}},
          {"complementarity.compliance", false, {kSolved, "complementarity.compliance=rigid"}, {kSolved}},
          {"complementarity.iterations", false, {kSolved, "complementarity.iterations=9"}, {kSolved}},
          {"complementarity.recovery", false, {kSolved, "complementarity.recovery=0.2"}, {kSolved}},
          {"complementarity.strict", false, {kSolved, "complementarity.strict=true"}, {kSolved}},
          {"run.impact_speed", false, {"run.impact_speed=2"}}, // changes the step only
          {"run.threads", false, {"run.threads=2"}},
          {"run.integrator", false, {"run.integrator=symplectic_euler"}}, // mechanisms only, as are the next three
          {"run.integrator_order", false, {"run.integrator_order=4"}},
          {"run.springs", false, {"run.springs=explicit"}},
          {"run.constraint_tolerance", false, {"run.constraint_tolerance=1e-9"}},
          {"run.skin", false, {"run.skin=0.5"}},
          {"run.max_overlap", true, {"run.max_overlap=0.4"}}, // settling may fail
          {"run.periodic", true, with(kNoVehicle, "run.periodic=[true,false]"), kNoVehicle}};
}

std::vector<Change> ofMaterials() {
  const std::vector<std::string> hertz{"-stiffness",
                                       "material.soil.law=hertz",
                                       "material.soil.young=1e7",
                                       "material.steel.law=hertz",
                                       "material.steel.young=1e8",
                                       "material.rubber.law=hertz",
                                       "material.rubber.young=1e8"};
  const std::vector<std::string> plastic{"material.soil.law=eepa_linear", "material.steel.law=eepa_linear"};
  const auto lawful = [](const std::string& law, const std::string& key) {
    return std::vector<std::string>{"material.soil.law=" + law, key};
  };
  std::vector<Change> all{
      {"material.density", true, {"material.soil.density=2600"}},
      {"material.law", true, {"material.soil.law=luding"}},
      {"material.stiffness", true, {"material.soil.stiffness=6e5"}},
      {"material.restitution", true, {"material.soil.restitution=0.4"}},
      {"material.damping", true, {"material.soil.damping=300"}},
      {"material.attraction", true, {"material.soil.attraction=true"}},
      {"material.friction", true, {"material.soil.friction=0.6"}},
      {"material.tangential_stiffness_ratio", true, {"material.soil.tangential_stiffness_ratio=0.4"}},
      {"material.tangential_damping_ratio", true, {"material.soil.tangential_damping_ratio=0.4"}},
      {"material.rolling_friction", true, {"material.soil.rolling_friction=0.1"}},
      {"material.rolling_damping_ratio", true, {"material.soil.rolling_damping_ratio=0.2"}},
      {"material.cohesion", true, {"material.soil.cohesion=0.2"}},
      {"material.adhesion_radius", true, {"material.soil.adhesion_radius=0.03"}, {"material.soil.cohesion=0.2"}},
      {"material.plasticity", true, lawful("luding", "material.soil.plasticity=0.4"), {"material.soil.law=luding"}},
      {"material.plastic_depth",
       true,
       lawful("luding", "material.soil.plastic_depth=0.1"),
       {"material.soil.law=luding"}},
      {"material.adhesion_stiffness",
       true,
       lawful("luding", "material.soil.adhesion_stiffness=1e4"),
       {"material.soil.law=luding"}},
      {"material.surface_energy",
       true,
       lawful("eepa_linear", "material.soil.surface_energy=2"),
       {"material.soil.law=eepa_linear"}},
      {"material.adhesion_exponent",
       true,
       lawful("eepa_linear", "material.soil.adhesion_exponent=2"),
       {"material.soil.law=eepa_linear"}},
      {"material.crushing_strength",
       false,
       {"material.soil.crushing_strength=1e7"}}, // applies between grains and parts only
      {"contact.stiffness", true, {"contact.\"soil|steel\".stiffness=6e5"}},
      {"contact.restitution", true, {"contact.\"soil|steel\".restitution=0.4"}},
      {"contact.damping", true, {"contact.\"soil|steel\".damping=300"}},
      {"contact.friction", true, {"contact.\"soil|steel\".friction=0.3"}},
      {"contact.rolling_friction", true, {"contact.\"soil|steel\".rolling_friction=0.1"}},
      {"contact.cohesion", true, {"contact.\"soil|steel\".cohesion=0.1"}},
      {"contact.plasticity", true, with(plastic, "contact.\"soil|steel\".plasticity=0.3"), plastic},
      {"contact.surface_energy", true, with(plastic, "contact.\"soil|steel\".surface_energy=2"), plastic},
      // The vehicle's material.
      {"material.friction", false, {"material.rubber.friction=0.6"}},
      {"contact.friction", false, {"contact.\"soil|rubber\".friction=0.3"}}};
  for (const char* key : {"young=2e7", "poisson=0.3"}) {
    std::vector<std::string> changed = hertz;
    changed.push_back(std::string("material.soil.") + key);
    all.push_back(
        {std::string("material.") + std::string(key).substr(0, std::string(key).find('=')), true, changed, hertz});
  }
  return all;
}

std::vector<Change> ofTerrain() {
  const std::vector<std::string> lattice{"-depth", "terrain.arrangement=lattice", "terrain.layers=2"};
  const std::vector<std::string> sieve{"-grain_radius", "terrain.radius_distribution=sieve",
                                       "terrain.sieve_size=[0.05,0.07,0.1]", "terrain.sieve_passing=[0,0.5,1]"};
  const std::vector<std::string> graded{"terrain.fine_depth=0.05", "terrain.coarsening=0.2",
                                        "terrain.coarsest_radius=0.07"};
  const std::string deep = "terrain.depth=0.4";
  std::vector<Change> all{{"terrain.heightmap", true, {"terrain.heightmap=heightmaps/flat.png"}},
                          {"terrain.size", true, {"terrain.size=[4.2,2.7]"}},
                          {"terrain.interpolation", true, {"terrain.interpolation=smooth"}},
                          {"terrain.height_range", true, {"terrain.height_range=[0,0.06]"}},
                          {"terrain.material", true, {"terrain.material=steel"}},
                          {"terrain.ground_material", true, {"terrain.ground_material=steel"}},
                          {"terrain.grain_radius", true, {"terrain.grain_radius=0.04"}},
                          {"terrain.depth", true, {"terrain.depth=0.2"}},
                          {"terrain.radius_distribution", true, {"terrain.radius_distribution=single"}},
                          {"terrain.radius_spread", true, {"terrain.radius_spread=0.1"}},
                          {"terrain.porosity", true, {deep, "terrain.porosity=0.42"}, {deep}},
                          {"terrain.fine_depth", true, with(graded, "terrain.fine_depth=0.06"), graded},
                          {"terrain.coarsening", true, with(graded, "terrain.coarsening=0.3"), graded},
                          {"terrain.coarsest_radius", true, with(graded, "terrain.coarsest_radius=0.06"), graded},
                          {"terrain.tile", true, {"terrain.floor=flat", "terrain.tile=[1,1]"}, {"terrain.floor=flat"}},
                          {"terrain.floor", true, {"terrain.floor=flat"}},
                          {"terrain.floor_grains", true, {"terrain.floor_grains=false"}},
                          {"terrain.walls", true, {"terrain.walls=false"}},
                          {"terrain.wall_friction", true, {"terrain.wall_friction=0.3"}},
                          {"terrain.settle_time_limit", true, {"terrain.settle_time_limit=4"}}, // settling may fail
                          {"terrain.settle_kinetic_energy", true, {"terrain.settle_kinetic_energy=1e-3"}},
                          {"terrain.settle_force_ratio", true, {"terrain.settle_force_ratio=0.1"}},
                          {"terrain.cache", false, {"terrain.cache=false"}}};
  for (const char* key : {"spacing=2.3", "jitter=0.5", "packing=0.55", "layers=3"}) {
    const std::string name = key;
    // Not a random bed: its depth is no lattice depth.
    all.push_back({"terrain." + name.substr(0, name.find('=')), true, with(lattice, "terrain." + name), lattice});
  }
  all.push_back({"terrain.sieve_size", true, with(sieve, "terrain.sieve_size=[0.05,0.07,0.09]"), sieve});
  all.push_back({"terrain.sieve_passing", true, with(sieve, "terrain.sieve_passing=[0,0.6,1]"), sieve});
  return all;
}

/// A surface in the bed from the start counts with its position and material, not with its later motion.
std::vector<Change> ofSurfaces() {
  std::vector<Change> all;
  const auto moving = [&](const std::string& list, const std::string& first) {
    const std::string at = list + ".0.";
    const std::vector<std::string> before{at + "placed=before", at + first};
    const auto add = [&](const char* key, std::vector<std::string> changes, std::vector<std::string> more = {}) {
      std::vector<std::string> both = before;
      both.insert(both.end(), more.begin(), more.end());
      std::vector<std::string> changed = both;
      for (const std::string& c : changes) changed.push_back(at + c);
      all.push_back({list + "." + key, false, changed, both});
    };
    const std::vector<std::string> shaken{at + "amplitude=[0,0,0.01]", at + "frequency=10"};
    add("name", {"name=thing"}), add("velocity", {"velocity=[0.2,0,0]"}), add("spin", {"spin=[0,0,1]"});
    add("pivot", {"pivot=[1,1,0]"}, {at + "spin=[0,0,2]"});
    add("amplitude", {"amplitude=[0,0,0.02]"}, shaken), add("frequency", {"frequency=20"}, shaken);
    add("phase", {"phase=90"}, shaken), add("start", {"start=0.01"}), add("until", {"until=0.05"});
    const std::vector<std::string> free{at + "free=z", at + "mass=5", at + "load=-3"};
    add("free", {"free=z", "mass=5"}), add("mass", {"mass=6"}, free), add("load", {"load=-4"}, free);
    add("load_ramp", {"load_ramp=0.02"}, free);
    all.push_back({list + ".placed", true, {at + "placed=after_settling"}});
    const std::vector<std::string> lid{list == "plane" ? at + "normal=[0,0,-1]" : "run.duration=0.1"};
    all.push_back({list + ".above_bed", true, with(lid, at + "above_bed=0.1"), lid});
    all.push_back({list + ".material", true, {at + "material=soil"}});
  };
  moving("plane", "velocity=[0.1,0,0]"), moving("box", "velocity=[0.1,0,0]"), moving("cylinder", "velocity=[0.1,0,0]");
  const std::vector<Change> own{{"plane.point", true, {"plane.0.point=[0,0,-0.9]"}},
                                {"plane.normal", true, {"plane.0.normal=[0,0.1,1]"}},
                                {"plane.name", true, {"plane.0.name=belt"}}, // a surface, not a wall of the bed
                                {"box.position", true, {"box.0.position=[2,0.5,0.1]"}},
                                {"box.size", true, {"box.0.size=[0.2,0.2,0.2]"}},
                                {"box.axis", true, {"box.0.axis=[0,1,1]", "box.0.angle=10"}},
                                {"box.angle", true, {"box.0.axis=[0,0,1]", "box.0.angle=20"}},
                                {"box.orientation", true, {"box.0.orientation=[0.8,0.6,0,0]"}},
                                {"cylinder.position", true, {"cylinder.0.position=[2,-0.5,0.1]"}},
                                {"cylinder.axis", true, {"cylinder.0.axis=[0,1,1]"}},
                                {"cylinder.radius", true, {"cylinder.0.radius=0.12"}},
                                {"cylinder.length", true, {"cylinder.0.length=0.22"}},
                                {"cylinder.hollow", true, {"cylinder.0.hollow=true"}}};
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

/// Objects placed on the bed later have no effect.
std::vector<Change> ofWhatComesLater() {
  std::vector<Change> all{
      {"source.low", false, {"source.0.low=[1.1,0,1]"}},
      {"source.high", false, {"source.0.high=[2.1,0.5,1.2]"}},
      {"source.velocity", false, {"source.0.velocity=[0,0,-1]"}},
      {"source.spin", false, {"source.0.spin=[0,0,1]"}},
      {"source.radius", true, {"source.0.radius=0.06"}},       // the layout depends on all grains of the run
      {"source.material", true, {"source.0.material=rubber"}}, // see radii
      {"source.number", false, {"source.0.number=2"}},
      {"source.every", false, {"source.0.every=2"}},
      {"source.start", false, {"source.0.start=0.1"}},
      {"source.total", false, {"source.0.total=4"}}};
  const auto later = [&](const std::string& list, const std::string& more, const std::vector<const char*>& keys) {
    for (const std::string key : keys)
      all.push_back(
          {list + "." + key.substr(0, key.find('=')), false, with(kNoVehicle, list + ".0." + key), kNoVehicle, more});
  };
  later("mesh", kMesh,
        {"file=meshes/roller.obj", "scale=2", "position=[1,0,3]", "orientation=[0.8,0.6,0,0]", "sphere_radius=0.03",
         "sphere_refinement=2", "material=rubber", "name=rock", "velocity=[0,0,-1]", "spin=[0,0,1]", "start=0.01",
         "until=0.05", "above_bed=0.1", "placed=after_settling"});
  for (const char* key : {"mesh.axis", "mesh.angle"}) {
    const std::vector<std::string> turned = with(kNoVehicle, "mesh.0.axis=[0,0,1]");
    all.push_back({key, false, with(turned, "mesh.0.angle=20"), kNoVehicle, kMesh});
  }
  later("grain", kGrain,
        {"position=[1,0,0]", "velocity=[0,0,-1]", "spin=[0,0,1]", "radius=0.07", "material=rubber", "above_bed=0.2",
         "fixed=true"});
  later("grains", kFill,
        {"low=[0.9,0,0]", "high=[2,1,0.4]", "radius=0.06", "radius_to=0.07", "spacing=2.2", "jitter=0.5",
         "velocity=[0,0,-1]", "spin=[0,0,1]", "material=rubber", "above_bed=0.2"});
  all.push_back({"grains.form", false, {"grains.0.form=random", "grains.0.number=3"}, {}, kFill});
  all.push_back({"grains.number",
                 false,
                 {"grains.0.form=random", "grains.0.number=3"},
                 {"grains.0.form=random", "grains.0.number=2"},
                 kFill});
  return all;
}

std::vector<Change> ofVehicle() {
  std::vector<Change> all;
  const auto add = [&](const std::string& section, const std::string& more, const std::vector<const char*>& keys) {
    for (const std::string key : keys)
      all.push_back({section + "." + key.substr(0, key.find('=')), false, {section + "." + key}, {}, more});
  };
  add("vehicle", "",
      {"spec=vehicles/robot.toml", "position=[1,0]", "heading=20", "clearance=0.01", "sphere_radius=0.03",
       "sphere_refinement=2", "material=steel", "chassis=guided", "soil_contact=shoes", "hull_sphere_radius=0.05",
       "hull_touches=false", "gear_contact_model=samples"});
  all.push_back(
      {"vehicle.adhesion", false, {"vehicle.material=\"\"", "vehicle.adhesion=0.3"}, {"vehicle.material=\"\""}});
  all.push_back({"spec", false, {"spec.idler.preload=3000"}});
  all.push_back({"vehicle.tracks", false, {"vehicle.chassis=guided", "vehicle.tracks=single"}});
  add("driver", "",
      {"sprocket_speed=3", "tension_ramp=0.2", "weight_ramp=0.4", "drive_start=0.9", "drive_ramp=0.2",
       "rest_speed=0.02", "rest_load=0.06", "rest_time_limit=6"});
  add("hitch", kForce, {"force=200", "start=0.1", "ramp=0.1", "position=[-1,0,0.1]"});
  add("hitch", kRamp, {"rate=10", "kind=ramp"}), add("hitch", kSled, {"mass=900", "friction=0.3", "length=4"});
  add("hitch", kCarriage, {"slip=0.3", "stiffness=1e5", "damping_ratio=0.5"});
  for (const std::string& hitch : {kForce, kRamp, kSled, kCarriage})
    all.push_back({"hitch.kind", false, {"run.duration=0.2"}, {}, hitch});
  add("stop", "", {"distance=3", "edge=0.3", "immobile=2"});
  return all;
}

std::vector<Change> ofOutput() {
  std::vector<Change> all;
  for (const std::string key :
       {"output.folder=elsewhere", "output.frames=false", "output.contact_forces=false", "output.shoe_forces=true",
        "output.gear_contacts=true", "output.final_surface=false", "output.grains_csv=true", "output.picture=false",
        "output.picture_width=800", "output.plots=false", "parallel.subdomains=[1,1,1]", "parallel.cuts_x=[1]",
        "parallel.cuts_y=[0.1]", "parallel.cuts_z=[0.1]", "parallel.rebalance=false", "parallel.peer_memory=never"})
    all.push_back({key.substr(0, key.find('=')), false, {key}});
  return all;
}

std::vector<Change> reviewed() {
  std::vector<Change> all;
  for (const auto& some :
       {ofRun(), ofMaterials(), ofTerrain(), ofSurfaces(), ofWhatComesLater(), ofVehicle(), ofOutput()})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

TEST(BedKey, HasWhatMovesTheBedAndNothingElse) {
  std::map<std::string, std::string> known; // keys of unchanged scenes
  for (const Change& c : reviewed()) {
    SCOPED_TRACE(fmt::format("{} {} {}", c.key, fmt::join(c.overrides, " "), c.more));
    std::string& plain = known[c.more + fmt::format("{}", fmt::join(c.before, "\n"))];
    try {
      if (plain.empty()) plain = keyOf(c.more, c.before);
      EXPECT_EQ(keyOf(c.more, c.overrides) != plain, c.moves);
    } catch (const std::exception& e) {
      ADD_FAILURE() << e.what();
    }
  }
}

TEST(BedKey, WasDecidedForEveryKeyOfAScene) {
  // Exceptions: drivers' tables and courses, removed with the vehicle; soils, which count by value; contents of grain
  // files; records and steps of mechanisms; domains, which beds lack; the kind of a terrain (a rigid one has no bed),
  // and its packing.
  std::set<std::string> decided{"driver.drive", "driver.left", "driver.right", "driver.torque", "driver.left_torque",
                                "driver.right_torque", "material.soil", "material.soil_hash", "material.grain_radius",
                                "grains.file", "output.record", "run.tolerance", "run.domain_x", "run.domain_y",
                                "terrain.kind", "terrain.arrangement",
                                // Bodies are added after settling.
                                "material.foundation_modulus", "mechanism.above_bed",
                                // Output only.
                                "output.fields_cell", "output.fields_low", "output.fields_high"};
  // Meshes have the same motions as other surfaces.
  for (const char* key : {"pivot", "amplitude", "frequency", "phase", "free", "mass", "load", "load_ramp"})
    decided.insert(std::string("mesh.") + key);
  for (const Change& c : reviewed()) decided.insert(c.key);
  std::istringstream lines(scene::fieldHelp());
  std::string section, missing;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("### `", 0) == 0) {
      section = line.substr(line.find_first_not_of('[', 5));
      section = section.substr(0, section.find_first_of(".]"));
      for (const char* table : {"[driver.", "[output.plot"})
        if (line.find(table) != std::string::npos) section.clear();
    }
    const bool ofMechanism = section == "body" || section == "joint" || section == "spring" || section == "bushing" ||
                             section == "drive" || section == "coupling";
    const bool withoutBed = section == "scm" || section.rfind("fluid", 0) == 0;
    if (section.empty() || ofMechanism || withoutBed || line.rfind("| `", 0) != 0) continue;
    const std::string key = section + "." + line.substr(3, line.find('`', 3) - 3);
    if (!decided.contains(key)) missing += key + " ";
  }
  EXPECT_EQ(missing, "") << "add each to the list above, with its effect on settling";
}

TEST(BedKey, KnowsNoCourseAndNoTable) {
  const std::string plain = keyOf("", {});
  for (const std::string& drive : {kTable, kTorques, kCircle, kPath}) {
    std::string text = sceneText(drive);
    text.replace(text.find("sprocket_speed = 2\n"), 19,
                 &drive == &kTorques || drive == kTorques ? "drive = \"torque\"\n" : "");
    const scene::Scene scene = scene::readSceneText(text, "bed.toml");
    EXPECT_EQ(bedOrigin(scene, 1e-4), plain) << drive;
  }
}

TEST(PutBesideAVehicle, ThePieceOfTheBedHasNoHitchAndNoStop) {
  // On a bed with objects on it, of copied tiles, or prepared to a porosity, a scene without the vehicle is
  // created: all sections that require a vehicle go, too.
  const std::string tiled = "terrain.tile=[1,1]", flat = "terrain.floor=flat", porous = "terrain.porosity=0.42",
                    deep = "terrain.depth=0.4";
  for (const std::string& hitch : {kForce, kRamp, kSled, kCarriage})
    for (const std::string& put : {kGrain, kFill, std::string()})
      for (const bool prepared : {false, true}) {
        if (prepared ? hitch != kSled : put.empty()) continue;
        std::vector<std::string> overrides{"box.0.placed=after_settling", "cylinder.0.placed=after_settling"};
        if (prepared) overrides.insert(overrides.end(), {tiled, flat, porous, deep});
        const scene::Scene scene =
            scene::readSceneText(sceneText(hitch + "[stop]\ndistance = 2\n" + put), "bed.toml", overrides);
        coupling::GroundSetup ground;
        ASSERT_NO_THROW(ground = groundSetup(scene, chooseTimeStep(scene))) << hitch << put;
        ASSERT_TRUE(ground.grains->bed->alone);
        const scene::Scene without = scene::readSceneText(sceneText(put), "bed.toml", overrides);
        EXPECT_EQ(originOfBed(scene), originOfBed(without));
        EXPECT_EQ(ground.grains->bed->alone->grains->bed->origin, originOfBed(scene));
      }
}

} // namespace
} // namespace grouser::setup
