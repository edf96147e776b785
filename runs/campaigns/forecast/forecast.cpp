// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/forecast/forecast.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/campaigns/forecast/machine_fit.hpp"
#include "runs/scene/scene.hpp"
#include "runs/session/output_times.hpp"
#include "runs/setup/bed_alone.hpp"
#include "runs/setup/bed_options.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/setup/scene_surfaces.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/storage/bed_cache.hpp"
#include "runs/storage/sphere_cache.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/json_text.hpp"
#include "runs/support/progress.hpp"
#include "vehicle/spec_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace grouser::forecast {

namespace fs = std::filesystem;

namespace {

constexpr double kMostCopied =
    60'000; // grains of a piece on a CPU; a GPU, where few take as long as many, has kMostTaken
constexpr double kMostTaken = 400'000; // grains of a kept bed that is taken as it is
constexpr double kTrials = 4;          // small beds that a porosity is looked for with
constexpr double kStride = 4;          // of soft steps
constexpr double kFurtherPlot = 0.3;   // of the first one's time, with which Python begins [-]

std::string time(double seconds) {
  return seconds < 0.095  ? fmt::format("{:.2f} s", seconds)
         : seconds < 9.95 ? fmt::format("{:.1f} s", seconds)
                          : support::Progress::duration(seconds);
}

bool hasBed(const scene::Scene& scene) { return scene.terrain && scene.terrain->granular(); }

/// Of the small bed that frictions are tried on, with its floor.
double sampleGrains(const scene::Scene& scene, double timeStep) {
  const scene::Scene bed = setup::isPutOnBed(scene) ? setup::sceneOfBed(scene) : scene;
  const coupling::GroundSetup ground = setup::groundSetup(bed, timeStep);
  const auto& preparation = ground.grains->bed->preparation;
  if (!preparation) return 0;
  const terrain::BedOptions& options = preparation->sample->grains->bed->options;
  const terrain::BedPlan plan = terrain::planBed(*preparation->sample->surface, options);
  return static_cast<double>(plan.grains + terrain::fixedGrains(plan, options));
}

/// The quickest that grains will go [m/s]: with the track of a vehicle, or with a surface that is moved.
double speedOf(const scene::Scene& scene) {
  double speed = 0;
  if (scene.vehicle) {
    const scene::SpeedTable table = scene.driver.speeds();
    const double pitch = vehicle::readVehicleSpec(scene.vehicle->source()).pitchRadius();
    if (scene.driver.course) speed = std::fabs(scene.driver.course->speed);
    for (const std::vector<double>* side : {&table.left, &table.right})
      for (const double w : *side) speed = std::max(speed, std::fabs(w) * pitch);
  }
  for (const setup::SceneSurface& s : setup::surfacesOf(scene)) {
    double own = s.section.velocity ? norm(*s.section.velocity) : 0;
    if (s.section.spin) own += norm(*s.section.spin) * norm(s.geometry.half);
    if (s.section.amplitude) own += 2 * base::kPi * s.section.frequency.value_or(0) * norm(*s.section.amplitude);
    speed = std::max(speed, own);
  }
  return speed;
}

/// The scene's forecast while it is put together.
class Forecaster {
public:
  Forecaster(const scene::Scene& scene, const CountedGrains& counted, const ForecastOptions& options)
      : scene_(scene), probed_(scene), options_(options),
        exec_(support::chooseDevice(scene.run.device, scene.run.threads, nullptr)),
        timeStep_(setup::chooseTimeStep(scene)), grains_(static_cast<double>(counted.grains)), laying_(counted.laying),
        steps_(std::max(1.0, std::round(scene.run.duration / timeStep_))) {
    f_.onDevice = base::describe(exec_);
    spheres_ = options.cache ? storage::SphereCache::ofUser() : std::nullopt;
    if (options.cache && hasBed(scene) && scene.terrain->cache) beds_ = storage::BedCache::ofUser();
  }

  Forecast made() {
    const Stopwatch all;
    findBed();
    const bool sound = step();
    f_.cuts = coupling::cutReports(*simulation_);
    if (sound) output_ = timeOutput();
    if (sound) output();
    if (sound) prepare();
    memory();
    f_.spent = all.seconds();
    return f_;
  }

private:
  /// It steps once more.
  session::OutputTimes timeOutput() {
    const setup::RecordSetup record = setup::recordSetup(probed_, setup::provenanceOf(probed_));
    return session::timeOutput(*simulation_, record, exec_, scratch(), scene_.output.plots);
  }

  void findBed() {
    if (!beds_ || grains_ > kMostTaken) return;
    const std::string origin = setup::originOfBed(scene_);
    kept_ = !origin.empty() && beds_->find(origin);
  }

  void build() {
    const bool copied = hasBed(scene_) && !kept_;
    if (copied) {
      const scene::Scene piece = pieceOf(probed_, grains_, exec_.onCpu() ? kMostCopied : kMostTaken);
      if (scene_.terrain->settleTimeLimit > 0)
        tile_ = settleTile(setup::simulationSetup(piece), scene_.terrain->porosity.has_value(),
                           exec_.onCpu() ? base::cpuExec(1) : exec_, 1.5 * options_.seconds);
      coupling::SimulationSetup setup = copiedBed(piece);
      const Stopwatch building;
      make(std::move(setup));
      own_ = building.seconds();
    } else {
      const Stopwatch building;
      make(setup::simulationSetup(probed_));
      own_ = building.seconds();
    }
    const auto& grains = simulation_->ground().grains;
    pieceGrains_ = grains ? static_cast<double>(grains->count()) : 0;
    // What enters later is no reason to take the piece for a small one.
    scale_ = copied && pieceGrains_ > 0 ? grains_ / pieceGrains_ : 1;
  }

  void make(coupling::SimulationSetup setup) {
    simulation_ = std::make_unique<coupling::Simulation>(
        std::move(setup), exec_, coupling::SettleProgress([](double, double) {}), base::Comm(),
        beds_ && kept_ ? &*beds_ : nullptr, spheres_ ? &*spheres_ : nullptr);
  }

  /// Grains without a bed change most while they run: soft ones get farther in the same time.
  bool stepSoft() {
    const bool soft = !hasBed(scene_) && !scene_.vehicle && grains_ > 0 && scene_.mechanism.empty();
    if (!soft) return false;
    try {
      probed_ = softened(scene_, timeStep_, kStride);
      build();
      times_ = timeSteps(*simulation_, exec_, 2 * options_.seconds, // nothing has to be settled first
                         std::max<std::int64_t>(1, std::llround(steps_ / kStride) - 2));
      stride_ = kStride;
      return true;
    } catch (const base::SimulationError&) {
    } catch (const base::InputError&) {}
    probed_ = scene_;
    return false;
  }

  /// Whether the steps went well.
  bool step() {
    if (stepSoft()) return true;
    if (scene_.vehicle) probed_ = hurried(scene_);
    build();
    try {
      if (scene_.vehicle) {
        const Stopwatch hurrying;
        while (simulation_->time() < kHurry && hurrying.seconds() < 2 * options_.seconds) simulation_->step();
      }
      times_ =
          timeSteps(*simulation_, exec_, options_.seconds, simulation_->steps() + static_cast<std::int64_t>(steps_));
    } catch (const base::SimulationError& error) {
      f_.warning = fmt::format("the probe's steps failed, so nothing is told of the run's: {}", error.what());
      return false;
    }
    return true;
  }

  void prepare() {
    const bool spheres = scene_.vehicle || !scene_.meshes.empty();
    const double cut = spheres_ ? spheres_->cutting() : 0;
    if (kept_) {
      add(f_.preparation, "bed, kept", own_ - cut, "taken from a run before");
    } else if (hasBed(scene_)) {
      settling();
      add(f_.preparation, "laying the bed", laying_ + grains_ * kLaid, "");
    }
    if (!kept_ && (spheres || !hasBed(scene_))) {
      const double settled = hasBed(scene_) ? tile_.fallen * tile_.seconds : 0; // of the tile again, to be copied
      add(f_.preparation, spheres ? "parts, placing" : "placing", std::max(0.0, own_ - cut - settled),
          "as the probe's");
    }
    if (spheres)
      add(f_.preparation, "sphere sets", 0,
          cut > 0    ? fmt::format("cut now in {}, kept for the run", time(cut))
          : spheres_ ? "kept from a run before"
                     : "cut with the parts, as nothing is kept");
  }

  void settling() {
    if (scene_.terrain->settleTimeLimit <= 0) return;
    // A grain's step costs what it costs at rest in the piece, and more while grains fall; so do their lists.
    const StepTimes::Group last = times_.last();
    const double each = last.seconds / std::max(1.0, last.steps) * (1 - last.lists - last.parts);
    const double whole = scale_ * (each * tile_.falling / std::max(1e-300, tile_.resting) +
                                   lists() * tile_.rebuilds / std::max(1.0, tile_.steps));
    std::string how = fmt::format("{:.0f} steps to rest of a tile of {:.0f} grains", tile_.steps, tile_.grains);
    if (!tile_.complete) how += ", whose time was up: rest guessed half a second after the fall";
    if (scene_.terrain->tile) {
      const double cells = std::min(1.0, (*scene_.terrain->tile)[0] * (*scene_.terrain->tile)[1] /
                                             (scene_.terrain->size[0] * scene_.terrain->size[1]));
      add(f_.preparation, "settling a tile", tile_.steps * whole * cells, how);
      add(f_.preparation, "settling its copies", kCopiesRest / timeStep_ * whole, "");
      return;
    }
    if (scene_.terrain->porosity) {
      const double sample = sampleGrains(scene_, timeStep_);
      add(f_.preparation, "friction for the porosity", kTrials * tile_.seconds * sample / tile_.grains,
          fmt::format("{:g} small beds of {:.0f} grains", kTrials, sample));
    }
    add(f_.preparation, "settling the bed", tile_.steps * whole, how);
  }

  void output() {
    const auto count = [&](double interval) {
      return std::floor(std::min(steps_, scene_.run.duration / interval) + 1e-9) + 1;
    };
    stepsOfRun();
    const session::OutputTimes o = output_;
    const double rows = count(scene_.run.outputInterval), frames = count(scene_.run.frameInterval);
    add(f_.output, "rows", rows * o.row * std::max(1.0, scale_), fmt::format("{:.0f}", rows));
    if (scene_.output.frames)
      add(f_.output, "frames", frames * o.frame * std::max(1.0, scale_),
          fmt::format("{:.0f} of {:.3g} MB", frames, 1e-6 * o.frameBytes * std::max(1.0, scale_)));
    const double every = scene_.run.checkpointInterval;
    const double saves = 1 + (every > 0 ? std::floor(scene_.run.duration / every) : 0);
    add(f_.output, "checkpoints", saves * o.checkpoint * std::max(1.0, scale_), fmt::format("{:.0f}", saves));
    if (scene_.output.picture) add(f_.output, "picture", o.picture, "");
    if (o.plot > 0) {
      const double plots = scene_.vehicle ? 6 : hasBed(scene_) ? 2 : 1;
      add(f_.output, "plots", o.plot * (1 + kFurtherPlot * (plots - 1)), fmt::format("{:.0f} by Python", plots));
    }
    add(f_.output, "files begun", o.begin, "");
    f_.disk = (frames * o.frameBytes + o.checkpointBytes) * std::max(1.0, scale_) + demand().rows;
    const double wrote = o.frame + o.checkpoint;
    if (wrote > 0) f_.diskSpeed = (o.frameBytes + o.checkpointBytes) / wrote;
  }

  /// One list of the piece made anew [s]; afterwards it takes no step.
  double lists() {
    if (lists_ < 0) lists_ = timeOfLists(*simulation_, exec_);
    return lists_;
  }

  void stepsOfRun() {
    if (!hasBed(scene_)) {
      const StepCost cost = costOfRun(times_, steps_, stride_, meanLater());
      addSteps(cost.grains, cost.lists, cost.parts, "as often as in the probe");
      return;
    }
    const StepTimes::Group last = times_.last();
    const double each = last.seconds / std::max(1.0, last.steps);
    double perStep = last.lists * each * scale_;
    std::string how = "as often as in the probe";
    // In a bed at rest no list ends: how often one does follows from how quickly its grains go.
    if (const double speed = speedOf(scene_); speed > 0) {
      const double reach = 0.5 * scene_.run.skin * simulation_->ground().grains->model().radius;
      const double between = std::max(1.0, reach / (speed * timeStep_));
      const double told = lists() * scale_ / between;
      if (told > perStep) perStep = told, how = fmt::format("one in {:.0f} steps, at {:.2g} m/s", between, speed);
    }
    addSteps(steps_ * each * (1 - last.lists - last.parts) * scale_, steps_ * perStep, steps_ * each * last.parts, how);
  }

  void addSteps(double grains, double lists, double parts, const std::string& how) {
    if (grains_ > 0)
      add(f_.steps, "grains", grains, fmt::format("{:.0f} steps of {:.4g} us", steps_, 1e6 * grains / steps_));
    if (grains_ > 0) add(f_.steps, "neighbour lists", lists, how);
    const bool parted = scene_.vehicle || !scene_.meshes.empty() || !scene_.mechanism.empty();
    if (parted || grains_ == 0)
      add(f_.steps,
          scene_.vehicle             ? "vehicle"
          : scene_.mechanism.empty() ? "meshes"
                                     : "mechanism",
          parts, fmt::format("{:.0f} steps of {:.4g} us", steps_, 1e6 * parts / steps_));
    else
      f_.steps.front().seconds += parts;
  }

  /// Grains in the mean over the steps that the probe has not taken.
  double meanLater() const {
    double mean = pieceGrains_;
    const double from = std::min(simulation_->time(), scene_.run.duration), to = scene_.run.duration;
    if (scene_.sources.empty() || to <= from) return mean;
    mean = grains_;
    for (const scene::Source& s : scene_.sources) {
      const double end = s.start + s.every * std::ceil(static_cast<double>(s.total) / static_cast<double>(s.number));
      const double lasts = std::clamp(end, from, to) - from;
      const double missing =
          static_cast<double>(s.total) * std::clamp((end - from) / std::max(1e-300, end - s.start), 0.0, 1.0);
      mean -= 0.5 * missing * lasts / (to - from);
    }
    return mean;
  }

  Demand demand() const { return demandOf(scene_, static_cast<std::int64_t>(grains_), timeStep_, !exec_.onCpu()); }

  void memory() {
    const Demand all = demand();
    f_.process = all.process, f_.device = all.device;
    if (f_.disk == 0) f_.disk = all.disk();
  }

  /// A folder of this process beside where the results will go.
  fs::path scratch() const {
    const fs::path place = roomOf(exec_, options_.folder, false).place;
    const fs::path folder = fmt::format(".grouser-plan-{}", getpid());
    return access(place.c_str(), W_OK) == 0 ? place / folder : fs::temp_directory_path() / folder;
  }

  static void add(std::vector<ForecastPart>& parts, const char* name, double seconds, const std::string& how) {
    parts.push_back({name, std::max(0.0, seconds), how});
  }

  static constexpr double kLaid = 2e-6;      // of a grain, to put it on the device [s]
  static constexpr double kCopiesRest = 0.2; // simulated time that copies need to rest [s]

  const scene::Scene& scene_;
  scene::Scene probed_; ///< with what makes it quicker to probe
  const ForecastOptions& options_;
  base::Exec exec_;
  double timeStep_, grains_, laying_, steps_;
  Forecast f_;
  std::optional<storage::SphereCache> spheres_;
  std::optional<storage::BedCache> beds_;
  bool kept_ = false;
  SettledTile tile_;
  std::unique_ptr<coupling::Simulation> simulation_;
  double own_ = 0;    ///< to build the piece [s]
  double lists_ = -1; ///< [s]; below 0: not measured
  session::OutputTimes output_;
  double stride_ = 1; ///< steps of the run that one of the probe stands for
  double pieceGrains_ = 0, scale_ = 1;
  StepTimes times_;
};

std::string partsText(const char* title, const std::vector<ForecastPart>& parts) {
  if (parts.empty()) return "";
  std::string text = fmt::format("  {:<24} {}\n", title, time(Forecast::sum(parts)));
  for (const ForecastPart& p : parts)
    text += fmt::format("    {:<22} {}{}\n", p.name, time(p.seconds), p.how.empty() ? "" : " (" + p.how + ")");
  return text;
}

std::string bytes(double b) {
  return b >= 1e9 ? fmt::format("{:.3g} GB", 1e-9 * b) : fmt::format("{:.3g} MB", 1e-6 * b);
}

} // namespace

double Forecast::sum(const std::vector<ForecastPart>& parts) {
  double all = 0;
  for (const ForecastPart& p : parts) all += p.seconds;
  return all;
}

Forecast forecastOf(const scene::Scene& scene, const CountedGrains& counted, const ForecastOptions& options) {
  return Forecaster(scene, counted, options).made();
}

std::string forecastText(const Forecast& f) {
  std::string text = f.cuts.empty() ? "" : "\nmeshes as spheres\n";
  for (const spheredecomp::CutReport& cut : f.cuts) text += fmt::format("  {}\n", spheredecomp::protrusionLine(cut));
  for (const spheredecomp::CutReport& cut : f.cuts)
    if (const std::string warning = spheredecomp::protrusionWarning(cut); !warning.empty())
      text += fmt::format("\nWARNING: {}\n", warning);
  text += fmt::format("\nto expect on {}, by a probe of {}\n", f.onDevice, time(f.spent));
  text += partsText("preparation", f.preparation);
  text += partsText("steps", f.steps);
  text += partsText("output", f.output);
  if (f.warning.empty()) text += fmt::format("  {:<24} {}\n", "in all", time(f.total()));
  text += fmt::format("  {:<24} about {}\n", "memory of the process", bytes(f.process));
  if (f.device > 0) text += fmt::format("  {:<24} about {}\n", "memory of the GPU", bytes(f.device));
  text += fmt::format("  {:<24} about {}{}\n", "on the disk", bytes(f.disk),
                      f.diskSpeed > 0 ? fmt::format(", written at {}/s", bytes(f.diskSpeed)) : "");
  if (!f.warning.empty()) text += fmt::format("\nwarning: {}\n", f.warning);
  return text;
}

std::string forecastJson(const Forecast& f) {
  nlohmann::ordered_json json;
  json["machine"] = support::machineText(), json["commit"] = support::buildInfo().commit;
  json["device"] = f.onDevice;
  json["total_s"] = f.total(), json["probe_s"] = f.spent;
  const auto put = [&json](const char* name, const std::vector<ForecastPart>& parts) {
    json[name]["total_s"] = Forecast::sum(parts);
    for (const ForecastPart& p : parts) json[name][p.name] = p.seconds;
  };
  put("preparation", f.preparation), put("steps", f.steps), put("output", f.output);
  json["process_bytes"] = f.process, json["device_bytes"] = f.device, json["disk_bytes"] = f.disk;
  if (!f.warning.empty()) json["warning"] = f.warning;
  return support::jsonText(json, 2) + "\n";
}

} // namespace grouser::forecast
