// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/forecast/forecast.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/campaigns/forecast/kept_ratios.hpp"
#include "runs/campaigns/forecast/machine_fit.hpp"
#include "runs/campaigns/forecast/scene_figures.hpp"
#include "runs/campaigns/forecast/typical_times.hpp"
#include "runs/scene/scene.hpp"
#include "runs/session/output_times.hpp"
#include "runs/setup/bed_alone.hpp"
#include "runs/setup/bed_options.hpp"
#include "runs/setup/contact_pairs.hpp"
#include "runs/setup/grain_memory.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/storage/bed_cache.hpp"
#include "runs/storage/sphere_cache.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/private_folder.hpp"
#include "runs/support/progress.hpp"
#include "terrain/kernel_choice.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace grouser::forecast {

namespace fs = std::filesystem;

namespace {

constexpr double kMaxCopied =
    60'000; // maximum grains of the probed part on a CPU; kMaxTaken on a GPU, where few grains take as long as many
constexpr double kMaxTaken = 400'000; // maximum number of grains of a cached bed that is used unchanged
constexpr double kTrials = 4;         // number of small beds settled to find the friction for a porosity
constexpr double kStride = 4;         // ratio of softened to real time step [-]
constexpr double kFurtherPlot = 0.3;  // time of a further plot / time of the first plot, which starts Python [-]
constexpr double kShort = 0.25;       // duration of the short probe's steps [s]
constexpr double kFewGrains = 50'000; // maximum grains of a scene without a bed for the short probe
constexpr double kCutMeshes = 2;      // typical time for sphere sets of meshes [s]
constexpr int kTestedThreads = 4;     // maximum thread count with a probed (not typical) forecast
constexpr double kNoFigure = 1e-4;    // ratios of shorter parts are not stored [s]

constexpr const char* kStepText = "steps"; // add() prints number and time of the steps

std::string stepTime(double seconds) {
  return seconds < 1e-3 ? fmt::format("{:.3g} us", 1e6 * seconds)
         : seconds < 1  ? fmt::format("{:.3g} ms", 1e3 * seconds)
                        : fmt::format("{:.3g} s", seconds);
}

bool hasBed(const scene::Scene& scene) { return scene.terrain && scene.terrain->granular(); }

/// Computes the forecast of a scene.
class Forecaster {
public:
  /// `ratios`: empty for typical values only.
  Forecaster(const scene::Scene& scene, const CountedGrains& counted, const ForecastOptions& options, Ratios ratios)
      : scene_(scene), probed_(scene), options_(options), counted_(counted), ratios_(std::move(ratios)),
        exec_(support::chooseDevice(scene.run.device, scene.run.threads, nullptr)),
        timeStep_(setup::chooseTimeStep(scene)), grains_(static_cast<double>(counted.grains)), laying_(counted.laying),
        steps_(std::max(1.0, std::round(scene.run.duration / timeStep_))) {
    f_.onDevice = base::describe(exec_);
    spheres_ = options.cache ? storage::SphereCache::ofUser() : std::nullopt;
    if (options.cache && hasBed(scene) && scene.terrain->cache) beds_ = storage::BedCache::ofUser();
    f_.probed = options.probe;
    if (!options.probe) options_.seconds = kShort;
    if (grains_ > 0) {
      const setup::KernelTraits traits = setup::kernelTraits(scene, setup::ContactPairs(scene));
      soil_ = terrain::stepKernelText(traits.features, traits.model) + (scene.terrain ? scene.terrain->material : "");
    }
    if (const auto& v = scene.vehicle)
      vehicle_ = fmt::format("{} {} on {}", v->spec, v->sphereRadius.value_or(0),
                             hasBed(scene)
                                 ? fmt::format("{} {}", scene.terrain->material, setup::bedOptions(scene).meanRadius())
                             : grains_ > 0 ? "grains"
                                           : "rigid");
  }

  Forecast made() {
    const Stopwatch all;
    findBed();
    if (!options_.probe) findTypical();
    const bool sound = modelled_ ? model() : step();
    if (simulation_) f_.cuts = coupling::cutReports(*simulation_);
    if (sound) {
      if (options_.probe) options_.stage("timing rows, frames, checkpoint and plots");
      output_ = options_.probe ? timeOutput() : typical_.output;
      output();
      prepare();
    }
    memory();
    if (sound && options_.probe && options_.cache) {
      simulation_.reset(); // frees memory for the model
      keep();
    }
    f_.spent = all.seconds();
    return f_;
  }

  /// Hardware, device, threads and build to which stored ratios apply.
  static std::string machineOf(const scene::Scene& scene) {
    return fmt::format("{}; {}; {}", support::machineText(),
                       base::describe(support::chooseDevice(scene.run.device, scene.run.threads, nullptr)),
                       support::buildInfo().commit);
  }

private:
  /// Performs one more step.
  session::OutputTimes timeOutput() {
    const setup::RecordSetup record = setup::recordSetup(probed_, setup::provenanceOf(probed_));
    const fs::path place = roomOf(exec_, options_.folder, false).place; // beside the results
    const support::PrivateFolder scratch(".grouser-plan", access(place.c_str(), W_OK) == 0 ? place : fs::path());
    return session::timeOutput(*simulation_, record, exec_, scratch.path() / "out", scene_.output.plots);
  }

  /// Typical times, the sphere sets in the cache, and whether steps are modelled.
  void findTypical() {
    // A lookup in a folder that cannot exist shows whether any set is needed.
    const storage::SphereCache cache =
        spheres_ ? *spheres_ : storage::SphereCache(support::KeptFiles("/dev/null/none"));
    const double spheres = scene_.vehicle ? keptSpheres(scene_, grains_, cache, f_.cuts) : 0;
    typical_ = typicalTimes(scene_, grains_, spheres, exec_);
    if (scene_.vehicle && spheres == 0) uncut_ = typical_.cutting;
    modelled_ = hasBed(scene_) || grains_ > kFewGrains || uncut_ > 0;
    if (!modelled_ || !hasMeshes()) return; // the steps of the probe generate sphere sets
    std::vector<spheredecomp::CutReport> cuts;
    if (!keptMeshes(scene_, grains_, timeStep_, cache, cuts)) uncut_ += kCutMeshes;
    f_.cuts.insert(f_.cuts.end(), cuts.begin(), cuts.end());
  }

  /// Step times from a small tile of the bed, and typical times.
  bool model() {
    double grain = typical_.grain, list = typical_.list;
    if (settles()) {
      options_.stage("timing a small bed");
      try {
        settle(setup::groundSetup(pieceOf(scene_, grains_, kMaxCopied), timeStep_), 2 * kShort);
      } catch (const base::InputError&) { // too small a bed for a periodic tile
        tile_ = typicalTile(typical_, timeStep_);
      }
    }
    if (tiled_) {
      const double each = kLarge / std::max(1.0, tile_.grains) / usefulThreads(exec_);
      if (exec_.onCpu()) {
        grain = each * std::max(0.3 * tile_.resting, tile_.resting - kStepAlone);
        list = each * tile_.list;
      } else { // few grains take as long as many
        grain = std::max(grain, tile_.resting / grains_);
        list = std::max(list, tile_.list / grains_);
      }
    }
    if (exec_.onCpu() && !tiled_) grain += kStepAlone / std::max(1.0, grains_);
    const double parts = hasParts() ? typical_.parts : 0, each = grains_ * grain + parts;
    times_.groups = {{1, each, 0, parts / each, grains_}};
    lists_ = grains_ * list, scale_ = 1, pieceGrains_ = grains_;
    own_ = typical_.placing + (kept_ ? grains_ * typical_.reading : 0);
    return true;
  }

  bool settles() const { return hasBed(scene_) && scene_.terrain->settleTimeLimit > 0; }

  void settle(const coupling::GroundSetup& piece, double seconds) {
    tile_ = settleTile(piece, scene_.terrain->porosity.has_value(), exec_.onCpu() ? base::cpuExec(1) : exec_, seconds);
    tiled_ = true;
  }

  bool hasMeshes() const { return !scene_.meshes.empty() || scene_.mechanism.hasMeshes(); }
  bool hasParts() const { return scene_.vehicle || !scene_.meshes.empty() || !scene_.mechanism.empty(); }

  /// Stores ratios of probed to modelled times of the scene. Ignores failures.
  void keep() {
    options_.stage("storing the measurements for later plans");
    try {
      keepRatios(machineOf(scene_), measuredOverModelled());
    } catch (const std::exception&) {
      return;
    }
  }

  Ratios measuredOverModelled() const {
    ForecastOptions quick = options_;
    quick.probe = false;
    Forecaster other(scene_, counted_, quick, {});
    const Forecast model = other.made();
    Ratios ratios;
    const auto compare = [&](const std::vector<ForecastPart>& probed, const std::vector<ForecastPart>& modelled) {
      for (const ForecastPart& p : probed)
        for (const ForecastPart& m : modelled)
          if (p.name == m.name && p.source == Source::probed && p.seconds > kNoFigure && m.seconds > kNoFigure &&
              other.isModelled(m.name))
            ratios[workOf(p.name)] = p.seconds / m.seconds;
    };
    compare(f_.preparation, model.preparation), compare(f_.steps, model.steps), compare(f_.output, model.output);
    return ratios;
  }

  bool isModelled(const std::string& part) const {
    static const std::set<std::string> kSteps{"grains",    "neighbour lists", "vehicle", "meshes",
                                              "mechanism", "sphere sets",     "placing", "placing parts"};
    return modelled_ || (!options_.probe && !kSteps.contains(part));
  }

  /// Kind of work of a part, the key of stored ratios.
  std::string workOf(const std::string& part) const {
    static const std::set<std::string> kOfVehicle{"vehicle", "placing parts", "sphere sets"},
        kOfMachine{"picture", "plots", "creating files", "placing the bed", "cached bed"};
    return fmt::format("{}: {}", part, kOfMachine.contains(part) ? "" : kOfVehicle.contains(part) ? vehicle_ : soil_);
  }

  void findBed() {
    if (!beds_ || (options_.probe && grains_ > kMaxTaken)) return;
    const std::string origin = setup::originOfBed(scene_);
    kept_ = !origin.empty() && beds_->find(origin);
  }

  void build() {
    bool copied = hasBed(scene_) && !kept_;
    if (copied) {
      try {
        const scene::Scene piece = pieceOf(probed_, grains_, exec_.onCpu() ? kMaxCopied : kMaxTaken);
        options_.stage("settling a tile of the bed");
        if (settles()) settle(setup::simulationSetup(piece).ground, 1.5 * options_.seconds);
        coupling::SimulationSetup setup = copiedBed(piece);
        const Stopwatch building;
        make(std::move(setup));
        own_ = building.seconds();
      } catch (const base::InputError&) { // too small a bed for a periodic tile
        copied = false, whole_ = true;
      }
    }
    if (!copied) {
      const Stopwatch building;
      make(setup::simulationSetup(probed_));
      own_ = building.seconds();
    }
    const auto& grains = simulation_->ground().grains;
    pieceGrains_ = grains ? static_cast<double>(grains->count()) : 0;
    // The scale does not include grains that enter later.
    scale_ = copied && pieceGrains_ > 0 ? grains_ / pieceGrains_ : 1;
  }

  void make(coupling::SimulationSetup setup) {
    options_.stage(scene_.vehicle ? "building a part of the scene: bed, sphere sets, vehicle"
                                  : "building a part of the scene");
    simulation_ = std::make_unique<coupling::Simulation>(
        std::move(setup), exec_, coupling::SettleProgress([](double, double) {}), base::Comm(),
        beds_ && kept_ ? &*beds_ : nullptr, spheres_ ? &*spheres_ : nullptr);
  }

  /// Scenes without a bed change most during the run: softer contacts allow a longer part of the run in the same time.
  bool stepSoft() {
    const bool soft = !hasBed(scene_) && !scene_.vehicle && grains_ > 0 && scene_.mechanism.empty();
    if (!soft) return false;
    try {
      probed_ = softened(scene_, timeStep_, kStride);
      build();
      times_ = timeSteps(*simulation_, exec_, 2 * options_.seconds, // no settling
                         std::max<std::int64_t>(1, std::llround(steps_ / kStride) - 2));
      stride_ = kStride;
      return true;
    } catch (const base::SimulationError&) {
    } catch (const base::InputError&) {}
    probed_ = scene_;
    return false;
  }

  /// Times the steps. Returns false if they fail.
  bool step() {
    if (stepSoft()) return true;
    if (scene_.vehicle) probed_ = hurried(scene_);
    build();
    options_.stage("timing steps");
    try {
      if (scene_.vehicle) {
        const Stopwatch hurrying;
        while (simulation_->time() < kHurry && hurrying.seconds() < 2 * options_.seconds) simulation_->step();
      }
      times_ =
          timeSteps(*simulation_, exec_, options_.seconds, simulation_->steps() + static_cast<std::int64_t>(steps_));
    } catch (const base::SimulationError& error) {
      f_.warning = fmt::format("the timed steps failed, so there is no run-time estimate: {}", error.what());
      return false;
    }
    return true;
  }

  void prepare() {
    const bool spheres = scene_.vehicle || hasMeshes();
    const double cut = spheres_ ? spheres_->cutting() : 0;
    if (kept_) {
      add(f_.preparation, "cached bed", own_ - cut, "in the cache");
    } else if (whole_) {
      add(f_.preparation, "settling the bed", own_ - cut, "the whole bed");
    } else if (hasBed(scene_)) {
      settling();
      add(f_.preparation, "placing the bed", laying_ + grains_ * kLaid, "");
    }
    if (!kept_ && !whole_ && (spheres || !hasBed(scene_))) {
      const double settled =
          hasBed(scene_) && !modelled_ ? tile_.fallen * tile_.seconds : 0; // time to settle the copied tile again
      add(f_.preparation, spheres ? "placing parts" : "placing", std::max(0.0, own_ - cut - settled),
          modelled_ ? "" : "as measured");
    }
    if (spheres) add(f_.preparation, "sphere sets", uncut_, spheresText(cut));
  }

  /// Origin of the sphere sets; `cut`: their time in the probe [s].
  std::string spheresText(double cut) const {
    if (cut > 0)
      return fmt::format("generated in {:.2g} s{}", cut, spheres_->saved() > 0 ? "; cached for the run" : "");
    if (uncut_ > 0) return spheres_ ? "generated and cached by the first run" : "generated in each run; no cache";
    if (simulation_ && !spheres_) return f_.cuts.empty() ? "none needed" : "generated with the parts; no cache";
    return !f_.cuts.empty() || (spheres_ && spheres_->found() > 0) ? "in the cache" : "none needed";
  }

  void settling() {
    if (scene_.terrain->settleTimeLimit <= 0) return;
    // Steps and lists cost more while grains fall than at rest.
    const StepTimes::Group last = times_.last();
    const double each = last.seconds / std::max(1.0, last.steps) * (1 - last.lists - last.parts);
    const double whole = scale_ * (each * tile_.falling / std::max(1e-300, tile_.resting) +
                                   lists() * tile_.rebuilds / std::max(1.0, tile_.steps));
    std::string how = fmt::format("{:.0f} steps to settle a tile of {:.0f} grains", tile_.steps, tile_.grains);
    if (!tile_.complete) how = "not settled during the measurement; estimated";
    if (scene_.terrain->porosity) {
      const double sample = sampleGrains(scene_, timeStep_);
      add(f_.preparation, "friction for the porosity", kTrials * tile_.seconds * sample / tile_.grains,
          fmt::format("{:g} small beds of {:.0f} grains", kTrials, sample));
    }
    if (scene_.terrain->tile) {
      const double cells = std::min(1.0, (*scene_.terrain->tile)[0] * (*scene_.terrain->tile)[1] /
                                             (scene_.terrain->size[0] * scene_.terrain->size[1]));
      add(f_.preparation, "settling a tile", tile_.steps * whole * cells, how);
      add(f_.preparation, "settling the copies", kCopiesRest / timeStep_ * whole, "");
      return;
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
      add(f_.output, "plots", o.plot * (1 + kFurtherPlot * (plots - 1)), fmt::format("{:.0f} plots by Python", plots));
    }
    add(f_.output, "creating files", o.begin, "");
    f_.disk = (frames * o.frameBytes + o.checkpointBytes) * std::max(1.0, scale_) + demand().rows;
    const double wrote = o.frame + o.checkpoint;
    if (wrote > 0 && options_.probe) f_.diskSpeed = (o.frameBytes + o.checkpointBytes) / wrote;
  }

  /// Time of one list rebuild of the probed part [s]. The simulation cannot be stepped afterwards.
  double lists() {
    if (lists_ < 0) lists_ = timeOfLists(*simulation_, exec_);
    return lists_;
  }

  void stepsOfRun() {
    if (!hasBed(scene_)) {
      const StepCost cost = costOfRun(times_, steps_, stride_, meanLater());
      addSteps(cost.grains, cost.lists, cost.parts, "same rebuild interval as measured");
      return;
    }
    const StepTimes::Group last = times_.last();
    const double each = last.seconds / std::max(1.0, last.steps);
    double perStep = last.lists * each * scale_;
    std::string how = "same rebuild interval as measured";
    // In a bed at rest, no list needs a rebuild: the rebuild interval follows from the expected grain speed.
    if (const double speed = speedOf(scene_); speed > 0) {
      const double reach = 0.5 * scene_.run.skin * setup::ContactPairs(scene_).kinds.largest;
      const double between = std::max(1.0, reach / (speed * timeStep_));
      const double predicted = lists() * scale_ / between;
      if (predicted > perStep)
        perStep = predicted, how = fmt::format("one rebuild per {:.0f} steps at {:.2g} m/s", between, speed);
    }
    addSteps(steps_ * each * (1 - last.lists - last.parts) * scale_, steps_ * perStep, steps_ * each * last.parts, how);
  }

  void addSteps(double grains, double lists, double parts, const std::string& how) {
    const bool apart = hasParts() || grains_ == 0;
    if (grains_ > 0) add(f_.steps, "grains", apart ? grains : grains + parts, kStepText);
    if (grains_ > 0) add(f_.steps, "neighbour lists", lists, how);
    if (apart)
      add(f_.steps, scene_.vehicle ? "vehicle" : scene_.mechanism.empty() ? "meshes" : "mechanism", parts, kStepText);
  }

  /// Mean number of grains over the steps after the probe.
  double meanLater() const {
    double mean = pieceGrains_;
    const double from = simulation_ ? std::min(simulation_->time(), scene_.run.duration) : 0, to = scene_.run.duration;
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
    f_.process = all.process, f_.device = all.device, f_.checkpoint = all.checkpoint;
    if (f_.disk == 0) f_.disk = all.disk();
  }

  void add(std::vector<ForecastPart>& parts, const char* name, double seconds, const std::string& how) const {
    ForecastPart part{name, std::max(0.0, seconds), how};
    const bool ofSettling = part.name.starts_with("settling") || part.name.starts_with("friction");
    const bool estimated = ofSettling && !whole_ && !tile_.complete;
    if (isModelled(name)) {
      const bool ofTile =
          tiled_ && exec_.onCpu() && usefulThreads(exec_) <= kTestedThreads && (&parts == &f_.steps || ofSettling);
      part.source = ofTile && !(part.name == "vehicle" || part.name == "meshes" || part.name == "mechanism")
                        ? Source::probed
                        : Source::typical;
      const auto kept = ratios_.find(workOf(name));
      if (kept != ratios_.end()) part.seconds *= kept->second, part.source = Source::kept;
    }
    if (how == kStepText) part.how = fmt::format("{:.0f} steps of {}", steps_, stepTime(part.seconds / steps_));
    if (estimated) part.source = Source::typical;
    parts.push_back(part);
  }

  static constexpr double kLaid = 2e-6;      // time to place a grain on the device [s]
  static constexpr double kCopiesRest = 0.2; // simulated time until the copies are at rest [s]
  /// Fixed cost of a tile's step on one thread [s], and the cost of a grain in a bed larger than the CPU cache over
  /// that of a grain in the tile [-].
  static constexpr double kStepAlone = 25e-6, kLarge = 1.3;

  const scene::Scene& scene_;
  scene::Scene probed_; ///< scene modified for a quicker probe
  ForecastOptions options_;
  const CountedGrains& counted_;
  Ratios ratios_;
  std::string soil_, vehicle_; ///< keys of kept ratios: kernel and material; file, spheres and ground of the vehicle
  TypicalTimes typical_;
  double uncut_ = 0;      ///< time of sphere sets that are not yet generated [s]
  bool modelled_ = false; ///< steps follow from a tile and typical times
  base::Exec exec_;
  double timeStep_, grains_, laying_, steps_;
  Forecast f_;
  std::optional<storage::SphereCache> spheres_;
  std::optional<storage::BedCache> beds_;
  bool kept_ = false;
  bool tiled_ = false; ///< a tile of the bed was settled
  bool whole_ = false; ///< the long probe settled the whole bed
  SettledTile tile_;
  std::unique_ptr<coupling::Simulation> simulation_;
  double own_ = 0;    ///< time to build the probed part [s]
  double lists_ = -1; ///< [s]; below 0: not measured
  session::OutputTimes output_;
  double stride_ = 1; ///< length of a step of the probe / length of a step of the run
  double pieceGrains_ = 0, scale_ = 1;
  StepTimes times_;
};

} // namespace

Forecast forecastOf(const scene::Scene& scene, const CountedGrains& counted, const ForecastOptions& options) {
  const bool kept = !options.probe && options.cache;
  return Forecaster(scene, counted, options, kept ? keptRatios(Forecaster::machineOf(scene)) : Ratios()).made();
}

} // namespace grouser::forecast
