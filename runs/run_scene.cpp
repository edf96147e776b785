// SPDX-License-Identifier: BSD-3-Clause
#include "runs/run_scene.hpp"

#include "base/error.hpp"
#include "runs/build_info.hpp"
#include "runs/channels.hpp"
#include "runs/checkpoint.hpp"
#include "runs/former_output.hpp"
#include "runs/image.hpp"
#include "runs/mechanism_output.hpp"
#include "runs/picture.hpp"
#include "runs/progress.hpp"
#include "runs/simulation.hpp"
#include "runs/stop_signals.hpp"
#include "vehicle/observation_table.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>

namespace grouser::runs {

namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

base::Exec chooseExec(const Scene& scene) {
  if (scene.run.device == "cuda") return base::cudaExec();
  if (scene.run.device == "auto" && base::cudaAvailable()) return base::cudaExec();
  return base::cpuExec(scene.run.threads);
}

const char* kindName(vehicle::PartKind kind) {
  switch (kind) {
  case vehicle::PartKind::kChassis:
    return "chassis";
  case vehicle::PartKind::kShoe:
    return "shoe";
  case vehicle::PartKind::kSprocket:
    return "sprocket";
  case vehicle::PartKind::kRoadWheel:
    return "road_wheel";
  case vehicle::PartKind::kRoller:
    return "roller";
  case vehicle::PartKind::kIdler:
    return "idler";
  }
  return "part";
}

std::vector<FramePart> frameParts(const VehicleRig& rig) {
  std::vector<FramePart> parts;
  for (std::size_t p = 0; p < rig.assembly().parts.size(); ++p) {
    const vehicle::Part& part = rig.assembly().parts[p];
    parts.push_back({part.name, kindName(part.kind), rig.meshes()[rig.meshOfPart(p)]});
  }
  return parts;
}

/// The rigid surface as triangles, for pictures.
base::TriangleMesh groundMesh(const terrain::HeightField& field) {
  constexpr int kNodes = 160;
  base::TriangleMesh mesh;
  const terrain::Rectangle& a = field.area();
  for (int j = 0; j < kNodes; ++j)
    for (int i = 0; i < kNodes; ++i) {
      const double x = a.xMin + a.width() * i / (kNodes - 1), y = a.yMin + a.length() * j / (kNodes - 1);
      mesh.vertices.push_back({x, y, field.height(x, y)});
    }
  for (std::uint32_t j = 0; j + 1 < kNodes; ++j)
    for (std::uint32_t i = 0; i + 1 < kNodes; ++i) {
      const std::uint32_t v = j * kNodes + i;
      for (const std::uint32_t k : {v, v + 1, v + kNodes + 1, v, v + kNodes + 1, v + kNodes}) mesh.indices.push_back(k);
    }
  return mesh;
}

/// What a run writes: channels, rows and frames of one simulation.
class Recorder {
public:
  /// `former`: the checkpoint that the run goes on from, or null.
  Recorder(Simulation& simulation, const Scene& scene, const RunOptions& options, const base::Exec& exec,
           const Checkpoint* former)
      : simulation_(simulation), channels_(channelsOf(simulation, scene)), row_(channels_),
        record_(scene.output.record), frames_(scene.output.frames),
        writer_(options.folder, scene, channels_, writerOptions(scene, options, exec, channels_, former)) {
    if (const VehicleRig* rig = simulation.vehicle()) {
      parts_ = frameParts(*rig);
      writer_.constant("vehicle/pitch_radius", "m", rig->assembly().spec.pitchRadius());
      writer_.constant("vehicle/mass", "kg", rig->assembly().mass);
    }
    if (const Mechanism* mechanism = simulation.mechanism()) parts_ = mechanismParts(scene, mechanism->model());
    if (simulation.ground().rigid) ground_ = groundMesh(*simulation.ground().rigid);
    writer_.setParts(parts_, ground_);
  }

  void row() {
    row_.begin(simulation_.steps(), simulation_.time());
    if (const VehicleRig* rig = simulation_.vehicle())
      row_.setFrom("vehicle/position", vehicle::flatten(rig->observe()));
    const Simulation::Ledger l = simulation_.ledger();
    simulation_.checkEnergy(l);
    if (const auto& grains = simulation_.ground().grains) {
      row_.set("terrain/contacts", static_cast<double>(l.grainContacts));
      row_.set("terrain/max_overlap", l.deepestOverlap / grains->model().radius);
      row_.set("terrain/max_speed", l.fastestGrain);
      row_.set("terrain/rebuilds", static_cast<double>(grains->rebuilds()));
    }
    if (const Mechanism* mechanism = simulation_.mechanism()) setMechanismRow(row_, *mechanism, record_);
    row_.set("ledger/drive_work", l.driveWork);
    row_.set("ledger/kinetic", l.kinetic);
    row_.set("ledger/potential", l.potential);
    row_.set("ledger/elastic", l.elastic);
    row_.set("ledger/dissipated", l.dissipated);
    row_.set("ledger/residual", l.residual);
    if (!simulation_.mechanism()) row_.set("ledger/impulse_residual", l.impulseResidual);
    writer_.row(row_.row());
    simulation_.restartMeans();
  }

  void frame() {
    if (frames_) writer_.frame(currentFrame());
  }

  Frame currentFrame() const {
    Frame frame;
    frame.step = simulation_.steps(), frame.time = simulation_.time();
    if (const auto& grains = simulation_.ground().grains) {
      const terrain::GrainSnapshot s = grains->snapshot();
      for (std::size_t i = 0; i < s.position.size(); ++i) {
        frame.positions.push_back(s.position[i].as<float>());
        frame.speeds.push_back(norm(s.velocity[i]));
        frame.ids.push_back(static_cast<std::uint32_t>(i));
      }
      frame.radii.assign(s.position.size(), static_cast<float>(grains->model().radius));
    }
    if (const VehicleRig* rig = simulation_.vehicle())
      for (std::size_t p = 0; p < rig->assembly().parts.size(); ++p) frame.partPoses.push_back(rig->partPose(p));
    if (const Mechanism* mechanism = simulation_.mechanism()) frame.partPoses = mechanism->state().pose;
    return frame;
  }

  void picture(int width) {
    writePng(drawFrame(currentFrame(), parts_, simulation_.ground().grains ? base::TriangleMesh{} : ground_, width),
             writer_.folder() / "picture.png");
  }

  RunWriter& writer() { return writer_; }

private:
  static std::vector<Channel> channelsOf(const Simulation& simulation, const Scene& scene) {
    std::vector<Channel> channels;
    if (simulation.mechanism()) channels = mechanismChannels(simulation.mechanism()->model(), scene.output.record);
    if (simulation.vehicle())
      for (const vehicle::Quantity& q : vehicle::quantities(simulation.vehicle()->assembly()))
        channels.push_back(channelOf(q));
    if (simulation.ground().grains)
      for (const Channel& c : terrainChannels()) channels.push_back(c);
    for (const Channel& c : ledgerChannels()) channels.push_back(c);
    if (simulation.mechanism()) channels.pop_back(); // nothing touches, so there are no impulses to balance
    return channels;
  }
  static RunWriter::Options writerOptions(const Scene& scene, const RunOptions& options, const base::Exec& exec,
                                          const std::vector<Channel>& channels, const Checkpoint* former) {
    RunWriter::Options w;
    w.force = options.force;
    w.frames = scene.output.frames;
    w.metadata = {{"command_line", options.commandLine}, {"device", base::describe(exec)}};
    if (!former) return w;
    const std::int64_t step = former->state.steps;
    w.metadata["resumed_from_step"] = std::to_string(step);
    try {
      FormerOutput kept{readRows(options.folder, channels, step, former->rows), former->frames};
      if (w.frames && kept.frames > 0) checkFrames(options.folder, step, former->frames);
      w.former = std::move(kept);
    } catch (const base::InputError& error) {
      if (!options.force) throw;
      fmt::print(stderr, "grouser: warning: {}\n", error.what());
      w.former = FormerOutput{};
    }
    return w;
  }

  Simulation& simulation_;
  std::vector<Channel> channels_;
  RowBuilder row_;
  const std::vector<std::string> record_;
  bool frames_;
  std::vector<FramePart> parts_;
  base::TriangleMesh ground_;
  RunWriter writer_;
};

void describeBuild(const Simulation& simulation, const base::Exec& exec) {
  fmt::print("device    {}\n", base::describe(exec));
  if (const auto& grains = simulation.ground().grains)
    fmt::print("grains    {} of radius {:g} m, {:.0f} bytes each\n", grains->count(), grains->model().radius,
               static_cast<double>(grains->deviceBytes()) /
                   static_cast<double>(std::max<std::size_t>(1, grains->count())));
  if (simulation.settled().steps > 0)
    fmt::print("settled   in {:.2f} s simulated; kinetic energy a grain {:.2g} of m g radius\n",
               simulation.settled().time, simulation.settled().agitation);
  if (const VehicleRig* rig = simulation.vehicle()) {
    fmt::print("vehicle   {:.0f} kg, {} bodies, {} spheres ({} unique sets)\n", rig->assembly().mass,
               rig->assembly().model.bodies().size(), rig->totalSpheres(), rig->sphereSets().size());
  }
  if (const Mechanism* mechanism = simulation.mechanism()) fmt::print("{}", mechanismSize(*mechanism));
  std::fflush(stdout);
}

/// The checkpoint of a run, written again and again.
class Checkpoints {
public:
  Checkpoints(const Scene& scene, const RunOptions& options) : path_(options.folder / kCheckpointName) {
    checkpoint_.scene = resolvedToml(scene);
    checkpoint_.inputs = inputsOf(scene);
    checkpoint_.commit = buildInfo().commit;
  }

  void write(const Simulation& simulation, RunWriter& writer) {
    if (writtenAt_ == simulation.steps()) return;
    writer.sync();
    checkpoint_.timeStep = simulation.timeStep();
    checkpoint_.rows = writer.rows(), checkpoint_.frames = writer.frames();
    checkpoint_.state = simulation.save();
    writeCheckpoint(path_, checkpoint_);
    checkpoint_.state = {};
    writtenAt_ = simulation.steps();
  }
  /// "out/hills/checkpoint.h5, step 1000": where the last one is; empty while there is none.
  std::string last() const { return writtenAt_ < 0 ? "" : fmt::format("{}, step {}", path_.string(), writtenAt_); }
  /// The run goes on from one of this step.
  void begunAt(std::int64_t step) { writtenAt_ = step; }

private:
  std::filesystem::path path_;
  Checkpoint checkpoint_;
  std::int64_t writtenAt_ = -1;
};

/// Reads the checkpoint of a run to be resumed; null for one from the start.
std::unique_ptr<Checkpoint> formerRun(const Scene& scene, const RunOptions& options) {
  if (!options.resume) return nullptr;
  auto former = std::make_unique<Checkpoint>(readCheckpoint(*options.resume));
  checkSameScene(*former, *options.resume, scene);
  if (former->commit != buildInfo().commit)
    fmt::print(stderr,
               "grouser: warning: {} was written by commit {}, this is {}; the bits are the same only if the physics "
               "are\n",
               options.resume->string(), former->commit, buildInfo().commit);
  return former;
}

/// At the checkpoint, or at the start: then the bed is settled first.
std::unique_ptr<Simulation> makeSimulation(const Scene& scene, const base::Exec& exec, const Checkpoint* former) {
  if (former) return std::make_unique<Simulation>(scene, exec, former->state);
  std::unique_ptr<Progress> settling;
  auto simulation = std::make_unique<Simulation>(scene, exec, [&](double time, double agitation) {
    if (const int signal = StopSignals::received())
      throw Stopped(signal,
                    fmt::format("stopped by {} while the bed settled; nothing was written", StopSignals::name(signal)));
    if (!settling) settling = std::make_unique<Progress>("settling");
    settling->update(time / scene.terrain->settleTimeLimit,
                     fmt::format("t {:.2f} s, agitation {:.2g}", time, agitation));
  });
  if (settling) settling->finish("at rest");
  return simulation;
}

/// Steps to the end, with rows, frames and checkpoints on the way. Throws Stopped where a signal came.
void drive(Simulation& simulation, Recorder& recorder, Checkpoints& checkpoints, const Scene& scene,
           std::int64_t total) {
  const double dt = simulation.timeStep();
  const auto stepsOf = [dt](double interval) { return std::max<std::int64_t>(1, std::llround(interval / dt)); };
  const std::int64_t rowEvery = stepsOf(scene.run.outputInterval), frameEvery = stepsOf(scene.run.frameInterval);
  const std::int64_t saveEvery = scene.run.checkpointInterval > 0 ? stepsOf(scene.run.checkpointInterval) : total + 1;
  Progress progress("running");
  while (simulation.steps() < total) {
    simulation.step();
    if (simulation.steps() % rowEvery == 0) recorder.row();
    if (simulation.steps() % frameEvery == 0) recorder.frame();
    if (simulation.steps() % saveEvery == 0) checkpoints.write(simulation, recorder.writer());
    if (const int signal = StopSignals::received()) {
      checkpoints.write(simulation, recorder.writer());
      throw Stopped(signal, fmt::format("stopped by {} at {:.6g} s; go on with --resume ({})",
                                        StopSignals::name(signal), simulation.time(), checkpoints.last()));
    }
    if (progress.due())
      progress.update(static_cast<double>(simulation.steps()) / static_cast<double>(total),
                      fmt::format("t {:.3f} of {:g} s", simulation.time(), static_cast<double>(total) * dt));
  }
  // Before the last row: a run that goes on from here does not have it.
  checkpoints.write(simulation, recorder.writer());
  // The end is always written, whether or not the intervals meet it.
  if (simulation.steps() % rowEvery != 0) recorder.row();
  if (simulation.steps() % frameEvery != 0) recorder.frame();
  progress.finish(fmt::format("{} steps", simulation.steps()));
}

} // namespace

Summary runScene(const Scene& scene, const RunOptions& options) {
  const Clock::time_point start = Clock::now();
  const StopSignals signals;
  const base::Exec exec = chooseExec(scene);
  const std::unique_ptr<Checkpoint> former = formerRun(scene, options);
  const std::unique_ptr<Simulation> made = makeSimulation(scene, exec, former.get());
  Simulation& simulation = *made;
  const std::int64_t whole = std::llround(scene.run.duration / simulation.timeStep()), begin = simulation.steps(),
                     total = std::min(whole, options.steps.value_or(whole));
  if (begin > total)
    throw base::InputError(fmt::format("{}: is at step {}, this run ends at step {}; raise run.duration or --steps",
                                       options.resume->string(), begin, total));
  const double prepared = since(start);
  describeBuild(simulation, exec);

  Recorder recorder(simulation, scene, options, exec, former.get());
  Checkpoints checkpoints(scene, options);
  const Clock::time_point driving = Clock::now();
  if (former) {
    checkpoints.begunAt(begin);
    fmt::print("resumed   at step {}, {:.6g} s\n", begin, simulation.time());
  } else {
    recorder.row();
    recorder.frame();
  }
  try {
    drive(simulation, recorder, checkpoints, scene, total);
  } catch (const Stopped& stopped) {
    recorder.writer().stop(stopped.what());
    throw;
  } catch (const base::SimulationError& error) {
    const std::string last = checkpoints.last();
    const std::string message = error.what() + (last.empty() ? "" : fmt::format(" (last checkpoint: {})", last));
    recorder.writer().abandon(message);
    throw base::SimulationError(message);
  } catch (const std::exception& error) {
    recorder.writer().abandon(error.what());
    throw;
  }
  const double drove = since(driving);
  if (scene.output.picture) recorder.picture(scene.output.pictureWidth);

  Summary summary;
  summary.steps = simulation.steps(), summary.simulatedTime = simulation.time();
  summary.wallTime = since(start);
  summary.figures["wall_preparation_s"] = prepared;
  summary.figures["wall_steps_s"] = drove;
  summary.figures["microseconds_a_step"] = 1e6 * drove / static_cast<double>(std::max<std::int64_t>(1, total - begin));
  if (options.hash) summary.stateHash = simulation.stateHash();
  const Simulation::Ledger l = simulation.ledger();
  fmt::print("ledger    since the start [J]: drive work {:.4g} = kinetic {:+.4g}, potential {:+.4g}, elastic {:+.4g}, "
             "dissipated {:+.4g}; left over {:.3g}\n",
             l.driveWork, l.kinetic, l.potential, l.elastic, l.dissipated, l.residual);
  if (!simulation.mechanism())
    fmt::print("impulse   on vehicle plus on bed: ({:g}, {:g}, {:g}) N s\n", l.impulseResidual.x, l.impulseResidual.y,
               l.impulseResidual.z);
  fmt::print("wall      {:.1f} s preparation, {:.1f} s for {} steps of {:g} s ({:.0f} us a step)\n", prepared, drove,
             simulation.steps() - begin, simulation.timeStep(), summary.figures["microseconds_a_step"]);
  recorder.writer().finish(summary);
  return summary;
}

} // namespace grouser::runs
