// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/result_fields.hpp"

#include "runs/output/channels.hpp"
#include "runs/output/fluid_output.hpp"
#include "runs/output/mechanism_output.hpp"
#include "runs/output/soil_result.hpp"
#include "vehicle/observation_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::output {

namespace {

using support::FileField;

/// A mechanism with all kinds of parts, so that its series include those of any mechanism.
multibody::Model modelOfAll() {
  using namespace multibody;
  Model model;
  const auto joint = [&](const std::string& name, JointType type) {
    Body body;
    body.name = "on " + name;
    return model.addJointAt(name, type, kWorld, model.addBody(body), {});
  };
  joint("both", JointType::kCylindrical);
  const int turning = joint("turning", JointType::kRevolute), sliding = joint("sliding", JointType::kPrismatic);
  for (const JointType type : {JointType::kRevolute, JointType::kPrismatic}) {
    AxisSpring spring;
    spring.joint = type == JointType::kRevolute ? turning : sliding;
    spring.name = fmt::format("spring {}", spring.joint), spring.stiffness = 1;
    model.addAxisSpring(spring);
    for (const DriveKind kind : {DriveKind::kSpeed, DriveKind::kPosition, DriveKind::kForce}) {
      Drive drive;
      drive.name = fmt::format("drive {} {}", static_cast<int>(kind), static_cast<int>(type));
      drive.joint = joint("of " + drive.name, type), drive.kind = kind;
      drive.law = TimeLaw::constant(0);
      model.addDrive(drive);
    }
  }
  for (const bool turns : {true, false}) {
    Coupling coupling;
    coupling.name = turns ? "to turning" : "to sliding";
    coupling.joint1 = turns ? sliding : turning, coupling.joint2 = turns ? turning : sliding;
    model.addCoupling(coupling);
  }
  PointSpring spring;
  spring.name = "point", spring.bodyB = turning, spring.point_A = {1, 0, 0};
  model.addPointSpring(spring);
  Bushing bushing;
  bushing.name = "bushing", bushing.bodyB = turning;
  model.addBushing(bushing);
  return model;
}

/// Converts "joints/both/force" to "joints/NAME/force".
std::string withoutName(const std::string& path) {
  constexpr const char* kKinds[] = {"bodies/", "joints/", "springs/", "bushings/", "drives/", "couplings/"};
  const bool hasName = std::any_of(std::begin(kKinds), std::end(kKinds), [&](auto k) { return path.starts_with(k); });
  if (!hasName) return path;
  const std::size_t from = path.find('/') + 1;
  return path.substr(0, from) + "NAME" + path.substr(path.find('/', from));
}

std::string shapeOf(const Channel& c) {
  if (c.width == 1) return "[rows]";
  if (c.path.ends_with("/arm_angle")) return "[rows, wheels]";
  return c.columns.empty() ? "[rows, shoes]" : fmt::format("[rows, {}]", c.width);
}

/// Adds `one` to `all`, unless `all` already contains it.
void addWords(std::string& all, const char* between, const std::string& one) {
  if ((between + all + between).find(between + one + between) == std::string::npos) all += between + one;
}

/// One line for all quantities with this path: "rad or m" if the units differ.
void add(std::vector<FileField>& fields, const Channel& c) {
  const std::string path = withoutName(c.path) + "/value";
  const auto same = std::find_if(fields.begin(), fields.end(), [&](const FileField& f) { return f.path == path; });
  if (same == fields.end()) {
    fields.push_back({path, "float64", shapeOf(c), c.unit, c.help});
    return;
  }
  addWords(same->unit, " or ", c.unit);
  addWords(same->help, "; or ", c.help);
}

FileField fieldOf(const ResultConstant& c, const char* shape) { return {c.path, "float64", shape, c.unit, c.help}; }

} // namespace

std::vector<FileField> resultFields() {
  std::vector<FileField> fields{
      {"/@creator", "text", "", "", "\"grouser\""},
      {"/@version", "text", "", "", "version of the program"},
      {"/@commit", "text", "", "", "commit of the program; \"-dirty\" is appended if the sources were changed"},
      {"/@machine", "text", "", "", "processor, cores, memory, system"},
      {"/@scene", "text", "", "", "the resolved scene, TOML"},
      {"/@state_hash", "text", "", "", "final state hash, 16 hexadecimal digits; empty without run --hash"},
      {"/@branched_from", "text", "", "", "branches only: checkpoint, step and state hash at the start of the branch"},
      {"/@soil_contact", "text", "", "", "parts of the vehicle with soil contact: \"all\" or \"shoes\""},
      {"/@parts", "texts", "", "", "part names; terrain/part_overlap_by is an index into this list, from 0"},
      {"/@deepest_in_a_part", "text", "", "", "maximum overlap of a grain with a part, and its part and time"},
      {"/@bed_warnings", "text", "", "", "warnings of the bed; absent without warnings"},
      {"/@energy_warning", "text", "", "", "warning of a large time-integration error; absent without it"},
      {"/@soil_warning", "text", "", "", "warning of a sinkage beyond scm.largest_sinkage; absent without it"},
      {"series/step", "int64", "[rows]", "-", "step number; each value has a link to this dataset"},
      {"series/time", "float64", "[rows]", "s", "time of the row; each value has a link to this dataset"},
      fieldOf(kPitchRadius, "[1]"),
      fieldOf(kVehicleMass, "[1]"),
      fieldOf(kSurfaceX, "[columns]"),
      fieldOf(kSurfaceY, "[lines]"),
      fieldOf(kSurfaceHeight, "[lines, columns]"),
      fieldOf(kSurfaceFinal, "[lines, columns]"),
      {std::string(kSurfaceHeight.path) + "@interpolation", "text", "", "",
       "interpolation between the nodes: \"bilinear\", \"Catmull-Rom\" or \"monotone\""}};
  fields.push_back(fieldOf(kInputs, "[settings, 10]"));
  fields.push_back(
      {std::string(kInputs.path) + "@kinds", "texts", "", "", "names of the input kinds, ordered by their numbers"});
  for (const BedConstant& c : kBedConstants) fields.push_back(fieldOf(c.constant, "[1]"));
  for (const SoilConstantField& c : kSoilConstants) fields.push_back(fieldOf(c.constant, "[1]"));
  for (const SoilLine& l : kSoilLines) fields.push_back(fieldOf(l.line, l.shape));
  for (const SoilMapField& m : kSoilMaps)
    fields.push_back({m.field.path, "float32", "[lines, columns]", m.field.unit, m.field.help});
  for (const BedCurve& c : kBedCurves) fields.push_back(fieldOf(c.curve, "[n]"));
  for (const vehicle::Quantity& q : vehicle::quantitiesOfHull()) add(fields, channelOf(q));
  for (const vehicle::Quantity& q : vehicle::quantitiesOfTrack("SIDE", 2, 0, true)) add(fields, channelOf(q));
  for (const auto& channels :
       {terrainColumns().channels(), surfaceColumns("NAME", true).channels(), obstacleColumns("NAME").channels(),
        hitchColumns().channels(), gearColumns().channels(), ledgerColumns().channels(),
        ledgerColumns({.deforms = true}).channels(), ledgerColumns({.wet = true}).channels(),
        ledgerColumns({.solved = true}).channels(), solverColumns().channels(),
        fluidColumns({{"NAME", false, {}}}, {"bodies/NAME", "vehicle/hull", "vehicle/SIDE_track"}).channels(),
        probeColumns({"NAME"}).channels(),
        mechanismColumns(modelOfAll(), std::vector<bool>(modelOfAll().bodies().size(), true), {}).channels()})
    for (const Channel& c : channels) add(fields, c);
  return fields;
}

} // namespace grouser::output
