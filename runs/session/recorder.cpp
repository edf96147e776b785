// SPDX-License-Identifier: BSD-3-Clause
#include "runs/session/recorder.hpp"

#include "base/error.hpp"
#include "coupling/fluid_domain.hpp"
#include "runs/output/fluid_datasets.hpp"
#include "runs/output/former_output.hpp"
#include "runs/output/manifest.hpp"
#include "runs/output/mechanism_output.hpp"
#include "runs/output/plane_mesh.hpp"
#include "runs/output/soil_surface.hpp"
#include "runs/output/surface_mesh.hpp"
#include "runs/render/image.hpp"
#include "runs/render/picture.hpp"
#include "runs/session/field_grid.hpp"
#include "runs/session/frame_of.hpp"
#include "runs/support/print_stderr.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

namespace grouser::session {

namespace {

output::PartKind pictured(vehicle::PartKind kind) {
  using From = vehicle::PartKind;
  using To = output::PartKind;
  constexpr std::pair<From, To> kKinds[] = {{From::kChassis, To::chassis},   {From::kShoe, To::shoe},
                                            {From::kSprocket, To::sprocket}, {From::kRoadWheel, To::roadWheel},
                                            {From::kRoller, To::roller},     {From::kIdler, To::idler}};
  for (const auto& [from, to] : kKinds)
    if (from == kind) return to;
  return To::other;
}

std::vector<output::FramePart> frameParts(const coupling::VehicleRig& rig) {
  std::vector<output::FramePart> parts;
  for (std::size_t p = 0; p < rig.assembly().parts.size(); ++p) {
    const vehicle::Part& part = rig.assembly().parts[p];
    parts.push_back({part.name, pictured(part.kind), rig.parts().meshes()[rig.parts().meshOfPart(p)]});
  }
  return parts;
}

/// Reference surface of sinkage; empty without terrain.
std::optional<output::UndisturbedSurface> undisturbedSurface(const coupling::LaidGround& ground) {
  output::UndisturbedSurface s;
  const auto lay = [&s](const terrain::Rectangle& area, int columns, int rows, const std::vector<double>& heights) {
    for (int i = 0; i < columns; ++i) s.x.push_back(area.xMin + area.width() * i / (columns - 1));
    for (int j = 0; j < rows; ++j) s.y.push_back(area.yMin + area.length() * j / (rows - 1));
    s.height = heights;
  };
  if (const auto& bed = ground.undisturbed) {
    lay(bed->area(), bed->columns(), bed->rows(), bed->heights());
    s.interpolation = "bilinear";
  } else if (const auto& field = ground.surface) {
    lay(field->area(), field->columns(), field->rows(), field->heights());
    using terrain::Interpolation;
    const Interpolation how = field->interpolation();
    s.interpolation = how == Interpolation::smooth     ? "Catmull-Rom"
                      : how == Interpolation::monotone ? "monotone"
                                                       : "bilinear";
  } else {
    return {};
  }
  return s;
}

output::RunWriter::Options writerOptions(bool frames, const RunRequest& options, const base::Exec& exec,
                                         const std::vector<output::Channel>& channels,
                                         const storage::Checkpoint* former, std::int64_t total) {
  output::RunWriter::Options w;
  w.force = options.force, w.names = options.names;
  w.frames = frames;
  w.comm = options.comm();
  w.metadata = {
      {"command_line", options.commandLine}, {"device", base::describe(exec)}, {"switches", options.switches}};
  if (!w.comm.alone()) w.metadata["ranks"] = std::to_string(w.comm.size());
  if (!former) return w;
  const std::int64_t step = former->state.steps;
  w.metadata["resumed_from_step"] = std::to_string(step);
  w.former = output::FormerOutput{};
  // One rank reads and rewrites the files, and broadcasts the numbers of kept rows and frames.
  if (w.comm.first()) {
    if (!options.force)
      output::manifestText(options.folder, "restore it from a copy, or replace it by resuming with --force");
    try {
      output::FormerOutput kept{output::readRows(options.folder, channels, step, former->rows), former->frames};
      // If no step is left, the last frame is kept, since its contact forces cannot be recomputed.
      if (w.frames) kept.frames = output::keptFrames(options.folder, step, former->frames, step == total);
      w.former = std::move(kept);
    } catch (const base::InputError& error) {
      if (!options.force) throw;
      support::printStderr("WARNING: {}\n", error.what());
    }
  }
  w.former->frames = w.comm.gatherValue(w.former->frames).front();
  return w;
}

/// Frame with all grains, on the first rank.
output::Frame gathered(const output::Frame& mine, const base::Comm& comm) {
  if (comm.alone()) return mine;
  output::Frame whole = mine;
  const auto collect = [&comm](auto& values) {
    using T = typename std::decay_t<decltype(values)>::value_type;
    std::vector<base::Bytes> to(static_cast<std::size_t>(comm.size()));
    to.front() = base::Comm::bytesOf(values);
    values.clear();
    for (const base::Bytes& part : comm.allToAll(to)) {
      const std::vector<T> more = base::Comm::valuesOf<T>(part);
      values.insert(values.end(), more.begin(), more.end());
    }
  };
  collect(whole.positions), collect(whole.radii), collect(whole.velocities), collect(whole.ids);
  return whole;
}

} // namespace

Recorder::Recorder(coupling::Simulation& simulation, const setup::RecordSetup& record, const RunRequest& options,
                   const base::Exec& exec, const storage::Checkpoint* former, std::int64_t total)
    : simulation_(simulation), record_(record), begunAt_(simulation.steps()), columns_(simulation, record.output),
      writer_(options.folder, record.provenance, columns_.channels(),
              writerOptions(record.output.frames, options, exec, columns_.channels(), former, total)) {
  try {
    begin(options, former);
    if (former && writer_.frames() > former->frames) framedAt_ = begunAt_;
  } catch (const std::exception& error) {
    writer_.abandon(error.what());
    throw;
  }
}

void Recorder::begin(const RunRequest& options, const storage::Checkpoint* former) {
  const coupling::SimulationSetup& setup = simulation_.setup();
  if (const auto& grains = simulation_.ground().grains)
    fieldGrid_ = fieldGridOf(record_.output, *grains, setup.ground.grains->boundaries.periodic,
                             former && writer_.frames() > 0 ? std::optional(writer_.folder()) : std::nullopt);
  if (const coupling::VehicleRig* rig = simulation_.vehicle()) {
    parts_ = frameParts(*rig);
    if (simulation_.ground().grains)
      writer_.fact("soil_contact", setup.vehicle->soilTouchesShoesOnly ? "shoes" : "all");
    writer_.constant(output::kPitchRadius, rig->assembly().spec.pitchRadius());
    writer_.constant(output::kVehicleMass, rig->assembly().mass);
    if (const auto surface = undisturbedSurface(simulation_.ground())) writer_.surface(*surface);
  }
  if (const auto& bed = simulation_.ground().structure) writer_.bed(*bed);
  if (setup.mechanism)
    for (output::FramePart& part : output::mechanismParts(*setup.mechanism)) parts_.push_back(std::move(part));
  if (const coupling::Surfaces* surfaces = simulation_.surfaces())
    for (std::size_t i = 0; i < surfaces->count(); ++i)
      parts_.push_back({surfaces->surface(i).name, output::PartKind::surface,
                        output::surfaceMesh(record_.planes, surfaces->surface(i))});
  for (const coupling::Obstacle& o : drawnObstacles())
    parts_.push_back({o.surface.name, output::PartKind::surface, output::surfaceMesh(record_.planes, o.surface)});
  ground_ = simulation_.ground().rigid ? groundMesh(*simulation_.ground().rigid) : output::planeMesh(record_.planes);
  writer_.setParts(parts_, ground_);
  std::vector<std::string> names;
  for (const output::FramePart& part : parts_) names.push_back(part.name);
  if (simulation_.ground().grains) writer_.namesOfParts(names);
  squeezed_ = SqueezedRecord(columns_.channels(), names);
  drive_ = DriveRecord(columns_.channels());
  for (const output::Row& row : writer_.formerRows()) squeezed_.add(row), drive_.add(row);
  if (const auto& grains = simulation_.ground().grains;
      grains &&
      output::GrainsCsv::isRequested(record_.output.grainsCsv,
                                     static_cast<std::int64_t>(grains->count()) + setup.ground.grains->sources.total(),
                                     record_.run.duration, record_.run.outputInterval))
    grainsCsv_.emplace(options.folder, former ? std::optional(writer_.keptUpTo()) : std::nullopt, options.comm());
}

/// Obstacles that pictures do not already contain as surfaces.
std::vector<coupling::Obstacle> Recorder::drawnObstacles() const {
  return simulation_.ground().grains ? std::vector<coupling::Obstacle>{} : simulation_.setup().ground.obstacles;
}

void Recorder::row() {
  const output::Row row = columns_.row();
  writer_.row(row);
  squeezed_.add(row), drive_.add(row);
  if (grainsCsv_) grainsCsv_->add(simulation_.steps(), simulation_.time(), *simulation_.ground().grains);
  simulation_.restartMeans();
}

void Recorder::finalSurface() {
  if (!record_.output.finalSurface || !simulation_.actingGround()) return;
  const auto fields = simulation_.actingGround()->fieldsNow();
  if (!simulation_.vehicle()) {
    if (fields) writer_.soil(output::soilResult(*fields));
    return;
  }
  const std::vector<double> heights = simulation_.actingGround()->surfaceNow();
  const auto undisturbed = undisturbedSurface(simulation_.ground());
  // All ranks get the same result. Removed grains must not have changed the nodes.
  if (undisturbed && !heights.empty() && heights.size() == undisturbed->height.size())
    writer_.finalSurface(heights, undisturbed->x.size());
  if (fields) {
    const vehicle::Observation now = simulation_.vehicle()->observe();
    const output::Course course{now.position, {base::cos(now.heading), base::sin(now.heading), 0}};
    writer_.soil(output::soilResult(*fields, course));
  }
}

void Recorder::frame() {
  if (simulation_.steps() == framedAt_) return;
  framedAt_ = simulation_.steps();
  if (record_.output.frames) writer_.frame(frameWithFields());
}

/// Fields come last: computing them may sort the grains, which discards the forces of the last step.
output::Frame Recorder::frameWithFields() {
  output::Frame frame = currentFrame();
  if (fieldGrid_) frame.fields = std::make_shared<terrain::SoilFields>(fieldsOf(simulation_, *fieldGrid_));
  return frame;
}

void Recorder::lastFrame() {
  if (!record_.output.frames) return;
  output::Frame frame = currentFrame();
  if (const auto& grains = simulation_.ground().grains) frame.step = std::max(frame.step, grains->steps());
  frame.time = static_cast<double>(frame.step) * simulation_.timeStep();
  if (frame.step > framedAt_) writer_.frame(frame);
}

output::Frame Recorder::currentFrame() const {
  output::Frame frame;
  frame.step = simulation_.steps(), frame.time = simulation_.time();
  // Forces of the last step are unknown before the first step and after grains were removed.
  if (const auto& grains = simulation_.ground().grains)
    addGrains(frame, *grains, record_.output.contactForces,
              simulation_.steps() > begunAt_ && grains->system().arrays.knowsFormerMotion());
  if (const coupling::Ground* ground = simulation_.actingGround())
    if (const auto fields = ground->fieldsNow())
      frame.soil = std::make_shared<output::SoilSurface>(output::soilSurface(*fields, *simulation_.ground().surface));
  if (const coupling::FluidDomain* fluid = coupling::fluidOf(simulation_)) frame.fluid = fluidPoints(fluid->fluid());
  if (const coupling::VehicleRig* rig = simulation_.vehicle()) {
    for (std::size_t p = 0; p < rig->assembly().parts.size(); ++p)
      frame.partPoses.push_back(vehicle::partPose(rig->assembly().parts[p], rig->state()));
    if (const auto& bodies = simulation_.setup().mechanism)
      frame.partPoses.insert(frame.partPoses.end(),
                             rig->state().pose.begin() + static_cast<std::ptrdiff_t>(bodies->ofVehicle.bodies),
                             rig->state().pose.end());
  }
  if (const coupling::Mechanism* mechanism = simulation_.mechanism()) frame.partPoses = mechanism->state().pose;
  if (const coupling::Surfaces* surfaces = simulation_.surfaces())
    for (std::size_t i = 0; i < surfaces->count(); ++i) frame.partPoses.push_back(surfaces->pose(i, frame.step));
  for (const coupling::Obstacle& o : drawnObstacles()) frame.partPoses.push_back(o.surface.start);
  return frame;
}

void Recorder::picture(int width) {
  output::Frame whole = gathered(currentFrame(), simulation_.comm());
  if (!simulation_.comm().first()) return;
  std::vector<float> speeds; // not drawn
  if (whole.fluid) output::drawFluid(*whole.fluid, whole.positions, whole.radii, speeds);
  const setup::DrawnPlanes& planes = record_.planes;
  std::vector<output::FramePart> parts = parts_;
  if (const coupling::Surfaces* surfaces = simulation_.surfaces())
    for (std::size_t i = 0; i < surfaces->count(); ++i)
      for (output::FramePart& part : parts)
        if (part.name == surfaces->surface(i).name) part.mesh = output::surfaceMesh(planes, surfaces->surface(i), true);
  render::writePng(
      render::drawFrame(whole, parts, simulation_.ground().grains ? output::floorMesh(planes) : ground_, width),
      writer_.folder() / "picture.png");
}

} // namespace grouser::session
