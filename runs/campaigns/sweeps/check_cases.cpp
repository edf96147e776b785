// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/check_cases.hpp"

#include "base/error.hpp"
#include "base/table.hpp"
#include "runs/campaigns/sweeps/bed_sides.hpp"
#include "runs/campaigns/sweeps/overrides.hpp"
#include "runs/campaigns/sweeps/scene_check.hpp"
#include "runs/campaigns/sweeps/sweep_plan.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/soil.hpp"
#include "runs/setup/grain_count.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/scm_setup.hpp"
#include "runs/setup/step_limit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

namespace grouser::sweeps {

namespace {

using Overrides = std::vector<std::string>;

constexpr double kFiner = 0.8, kLarger = 1.5, kWiderSkin = 1.5;
constexpr double kCostOfDouble = 1.6, kCostOfSpheres = 1.3,
                 kCostOfNodes = 1.8; // approximate cost of a run / cost of a base run

std::string set(const std::string& key, double value) { return fmt::format("{}={}", key, value); }

/// Name as part of a key; quoted if it contains characters other than letters, digits and _.
std::string keyWord(const std::string& name) {
  const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; });
  return plain && !name.empty() ? name : fmt::format("\"{}\"", name);
}

/// Creates the cases of one scene.
class Cases {
public:
  Cases(const std::filesystem::path& file, const Overrides& fixed, const scene::Scene& scene)
      : file_(file), fixed_(fixed), scene_(scene), step_(setup::chooseTimeStep(scene)),
        grains_(static_cast<double>(setup::plannedGrains(scene))) {
    all_.seeded = seedMatters(scene);
    CheckCase base;
    base.name = "base", base.what = "unchanged scene";
    all_.cases.push_back(base);
  }

  CheckCases make(int draws) {
    for (const int refinement : all_.seeded ? std::vector{1} : std::vector{1, 2, 3}) addStep(refinement);
    addSkin();
    addDepth(), addWidth(), addFloor(), addGrainSize(), addSpheres(), addPrecision(), addNodes(), addDraws(draws);
    for (const int refinement : all_.seeded ? std::vector{-1} : std::vector{-1, -2}) addStep(refinement);
    return std::move(all_);
  }

private:
  void omit(CheckAxis axis, const std::string& why) {
    all_.omitted.push_back({axis, scene_.deformable() ? "deformable soil has no grains and no seeds" : why});
  }

  /// Loads the scene with the overrides, and adds the case, even if it is invalid.
  void add(CheckAxis axis, const std::string& name, const std::string& what, const Overrides& overrides,
           double costOfStep = 1, int refinement = 0) {
    CheckCase c;
    c.axis = axis, c.name = name, c.what = what, c.overrides = overrides, c.refinement = refinement;
    c.cost = c.settling = std::ldexp(1.0, refinement); // estimate for invalid cases
    try {
      Overrides all = fixed_;
      for (const std::string& o : overrides) putOverride(all, o);
      const scene::Scene scene = setup::loadScene(file_, all);
      checkScene(scene);
      const double grains = static_cast<double>(setup::plannedGrains(scene));
      const double steps = scene_.run.tolerance ? 1 : step_ / setup::chooseTimeStep(scene);
      c.settling = costOfStep * steps * (grains_ > 0 ? std::max(grains, 1.0) / grains_ : 1);
      c.cost = c.settling * (scene_.run.tolerance ? 1 : scene.run.duration / scene_.run.duration);
    } catch (const base::InputError& error) {
      c.refused = error.what();
    }
    all_.cases.push_back(std::move(c));
  }

  /// Rows, frames and the end coincide with steps of both the base and the finer run.
  void addStep(int refinement) {
    const double factor = std::ldexp(1.0, -refinement);
    const std::string name =
        refinement > 0 ? fmt::format("step_over_{}", 1 << refinement) : fmt::format("step_times_{}", 1 << -refinement);
    if (scene_.run.tolerance) {
      const double tolerance = factor * *scene_.run.tolerance;
      add(CheckAxis::step, name, fmt::format("run.tolerance {} m/s or rad/s", tolerance),
          {set("run.tolerance", tolerance)}, std::sqrt(1 / factor), refinement);
      return;
    }
    // Coarse steps deviate from 2^k h, so that the run ends at the same time as the base.
    const double end = std::max(1.0, std::round(scene_.run.duration / step_)) * step_;
    const double step = refinement > 0 ? factor * step_ : end / std::max(1.0, std::round(end / (factor * step_)));
    const auto whole = [this](double time) { return std::max(1.0, std::round(time / step_)) * step_; };
    Overrides overrides = {set("run.time_step", step), set("run.duration", end)};
    if (refinement > 0)
      overrides.insert(overrides.end(), {set("run.output_interval", whole(scene_.run.outputInterval)),
                                         set("run.frame_interval", whole(scene_.run.frameInterval))});
    add(CheckAxis::step, name, fmt::format("time step {:.4g} s", step), overrides, 1, refinement);
  }

  void addSkin() {
    if (grains_ == 0) return omit(CheckAxis::skin, "no grains");
    constexpr double kWidest = 2;
    const double wider = kWiderSkin * scene_.run.skin;
    const double skin = wider <= kWidest ? wider : scene_.run.skin / kWiderSkin;
    add(CheckAxis::skin, "skin", fmt::format("run.skin {:g}", skin), {set("run.skin", skin)});
  }

  const scene::Terrain* bed() const {
    return scene_.terrain && scene_.terrain->granular() ? &*scene_.terrain : nullptr;
  }

  void addDepth() {
    const scene::Terrain* t = bed();
    if (!t) return omit(CheckAxis::depth, "no bed of grains");
    if (t->layers) {
      const double layers = std::max(*t->layers + 1.0, std::round(kLarger * *t->layers));
      return add(CheckAxis::depth, "deeper", fmt::format("{:g} layers", layers), {set("terrain.layers", layers)});
    }
    const double depth = kLarger * *t->depth;
    add(CheckAxis::depth, "deeper", fmt::format("depth {:.4g} m", depth), {set("terrain.depth", depth)});
  }

  void addWidth() {
    const scene::Terrain* t = bed();
    if (!t) return omit(CheckAxis::width, "no bed of grains");
    if (const std::string other = surfaceAtSides(scene_, kLarger); !other.empty())
      return omit(CheckAxis::width, fmt::format("{} is at a side of the bed and would not move with it", other));
    const double width = kLarger * t->size[1];
    Overrides overrides = {fmt::format("terrain.size=[{}, {}]", t->size[0], width)};
    if (t->tile) overrides.push_back(fmt::format("terrain.tile=[{}, {}]", (*t->tile)[0], kLarger * (*t->tile)[1]));
    if (const auto& y = scene_.run.domainY)
      overrides.push_back(fmt::format("run.domain_y=[{}, {}]", (*y)[0] - 0.5 * (kLarger - 1) * ((*y)[1] - (*y)[0]),
                                      (*y)[1] + 0.5 * (kLarger - 1) * ((*y)[1] - (*y)[0])));
    const bool hilly = t->heightRange[0] != t->heightRange[1];
    add(CheckAxis::width, "wider",
        fmt::format("{:.4g} m wide{}", width, hilly ? ", height-map scaled accordingly" : ""), overrides);
  }

  void addFloor() {
    const scene::Terrain* t = bed();
    if (!t) return omit(CheckAxis::floor, "no bed of grains");
    add(CheckAxis::floor, t->floorGrains ? "smooth_floor" : "rough_floor",
        t->floorGrains ? "no fixed grains on the floor" : "fixed grains on the floor",
        {fmt::format("terrain.floor_grains={}", !t->floorGrains)});
  }

  void addGrainSize() {
    const scene::Terrain* t = bed();
    if (!t) return omit(CheckAxis::grainSize, "no bed of grains");
    Overrides overrides;
    double share = kFiner;
    if (t->layers) { // whole layers of the same depth
      const double layers = std::max(*t->layers + 1.0, std::round(*t->layers / kFiner));
      share = *t->layers / layers;
      overrides.push_back(set("terrain.layers", layers));
    }
    if (t->radiusDistribution == terrain::RadiusLaw::sieve) {
      std::vector<double> openings = t->sieveSize;
      for (double& o : openings) o *= share;
      overrides.push_back(fmt::format("terrain.sieve_size=[{}]", fmt::join(openings, ", ")));
    } else {
      overrides.push_back(set("terrain.grain_radius", share * *t->grainRadius));
    }
    if (t->coarsestRadius) overrides.push_back(set("terrain.coarsest_radius", share * *t->coarsestRadius));
    addSoilOf(share, overrides);
    if (scene_.run.timeStep) overrides.push_back(set("run.time_step", share * step_));
    add(CheckAxis::grainSize, "finer", fmt::format("grain radii x {:.3g}, stiffness and cohesion scaled", share),
        overrides);
  }

  /// Scales stiffness and cohesion of the bed's material, which preserves strains and strength.
  void addSoilOf(double share, Overrides& overrides) const {
    const scene::Material& soil = scene_.material(scene_.terrain->material);
    const std::string section = fmt::format("material.{}.", keyWord(soil.name));
    // Values from a soil file scale with the radius automatically.
    const auto given = [&](const char* key) { return !scene::goesWithGrains(scene_, soil.name, key); };
    if (!soil.soil.empty() && given("grain_radius"))
      overrides.push_back(set(section + "grain_radius", share * *soil.grainRadius));
    if (soil.stiffness && given("stiffness")) overrides.push_back(set(section + "stiffness", share * *soil.stiffness));
    if (soil.cohesion > 0 && given("cohesion")) overrides.push_back(set(section + "cohesion", share * soil.cohesion));
    for (const scene::ContactPair& pair : scene_.contacts) {
      if (pair.first != soil.name && pair.second != soil.name) continue;
      const std::string of = fmt::format("contact.\"{}|{}\".", pair.first, pair.second);
      if (pair.stiffness) overrides.push_back(set(of + "stiffness", share * *pair.stiffness));
      if (pair.cohesion && *pair.cohesion > 0) overrides.push_back(set(of + "cohesion", share * *pair.cohesion));
    }
  }

  void addSpheres() {
    Overrides overrides;
    // Not half the default radius: an explicit radius represents thin parts more coarsely than the automatic radius.
    if (scene_.vehicle) overrides.push_back(set("vehicle.sphere_refinement", 2 * scene_.vehicle->sphereRefinement));
    for (std::size_t m = 0; m < scene_.meshes.size(); ++m)
      overrides.push_back(set(fmt::format("mesh.{}.sphere_refinement", m), 2 * scene_.meshes[m].sphereRefinement));
    if (overrides.empty()) return omit(CheckAxis::spheres, "neither vehicle nor mesh");
    add(CheckAxis::spheres, "half_spheres", "sphere radius of parts halved", overrides, kCostOfSpheres);
  }

  void addPrecision() {
    if (grains_ == 0) return omit(CheckAxis::precision, "no grains");
    const bool single = scene_.run.precision == terrain::Precision::single;
    add(CheckAxis::precision, single ? "double" : "single",
        fmt::format("forces in {} precision", single ? "double" : "single"),
        {fmt::format("run.precision={}", single ? "double" : "single")}, single ? kCostOfDouble : 1 / kCostOfDouble);
  }

  void addNodes() {
    if (!scene_.deformable()) return;
    const double spacing = 0.5 * setup::scmSetup(scene_)->spacing;
    add(CheckAxis::nodeSpacing, "half_nodes", fmt::format("node spacing {:.4g} m", spacing),
        {set("scm.node_spacing", spacing)}, kCostOfNodes);
  }

  void addDraws(int draws) {
    if (draws == 0) return;
    const auto drawn = [](int number) { return fmt::format("{}={}", kDrawKey, number); };
    if (!scene_.deformable())
      throw base::InputError(
          fmt::format("--draws {}: requires deformable soil; set terrain.kind = \"scm\", or remove --draws", draws));
    if (scene_.scm && scene_.scm->constantsDraw > 0)
      throw base::InputError(fmt::format(
          "--draws {}: the scene sets scm.constants_draw = {}; remove this key to start from the nominal constants",
          draws, scene_.scm->constantsDraw));
    Overrides first = fixed_;
    putOverride(first, drawn(1));
    setup::loadScene(file_, first); // throws if all constants are set
    for (int number = 1; number <= draws; ++number)
      add(CheckAxis::parameter, fmt::format("draw_{}", number), fmt::format("sample {} of the soil constants", number),
          {drawn(number)});
  }

  const std::filesystem::path& file_;
  const Overrides& fixed_;
  const scene::Scene& scene_;
  double step_, grains_;
  CheckCases all_;
};

} // namespace

CheckAxis checkAxisOf(const std::string& word) {
  const std::optional<CheckAxis> axis = base::valueOf<CheckAxis>(word);
  if (axis && axis != CheckAxis::base) return *axis;
  std::vector<std::string> words;
  for (const CheckAxis known : kCheckAxes) words.emplace_back(base::wordOf(known));
  throw base::InputError(fmt::format("--axes {}: unknown axis; axes: {}", word, fmt::join(words, ", ")));
}

bool seedMatters(const scene::Scene& scene) {
  const auto isRandom = [](const scene::GrainFill& fill) {
    return fill.form == scene::FillForm::random ||
           (fill.form == scene::FillForm::lattice && (fill.jitter > 0 || fill.radiusTo));
  };
  return (scene.terrain && scene.terrain->granular()) || !scene.sources.empty() ||
         std::any_of(scene.fills.begin(), scene.fills.end(), isRandom);
}

double runsOfBarCases(const scene::Scene& scene, int seeds) {
  double runs = 1 + 2; // the base and half its step
  if (scene.vehicle || !scene.meshes.empty()) runs += kCostOfSpheres;
  if (scene.deformable()) runs += kCostOfNodes;
  // Finer grains require a shorter step, and the bed contains 1 / share^3 times as many.
  if (scene.terrain && scene.terrain->granular())
    runs += kLarger + kLarger + 1 + 1 / (kFiner * kFiner * kFiner * kFiner);
  return runs * (seedMatters(scene) ? seeds : 1);
}

double runsOfWholeCheck(const scene::Scene& scene, int seeds) {
  const bool grains = (scene.terrain && scene.terrain->granular()) || !scene.grains.empty() || !scene.fills.empty() ||
                      !scene.sources.empty();
  const bool seeded = seedMatters(scene);
  const double others = (seeded ? 0.5 : 4 + 8 + 0.5 + 0.25) + (grains ? kCostOfDouble : 0); // steps, precision
  return runsOfBarCases(scene, seeds) + others * (seeded ? seeds : 1) + (grains ? 1 : 0);
}

CheckCases checkCases(const std::filesystem::path& file, const std::vector<std::string>& fixed,
                      const scene::Scene& scene, int draws) {
  return Cases(file, fixed, scene).make(draws);
}

} // namespace grouser::sweeps
