// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/bed.hpp"

#include "base/sphere.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::terrain {

double BedOptions::smallestRadius() const {
  if (const auto* layers = std::get_if<LayerOptions>(&grains)) return layers->radius;
  return std::get<RandomBedOptions>(grains).radii.smallest();
}
double BedOptions::largestRadius() const {
  if (const auto* layers = std::get_if<LayerOptions>(&grains)) return layers->radius;
  return terrain::largestRadius(std::get<RandomBedOptions>(grains));
}
double BedOptions::meanRadius() const {
  if (const auto* layers = std::get_if<LayerOptions>(&grains)) return layers->radius;
  return std::get<RandomBedOptions>(grains).radii.meanPower(1);
}
double BedOptions::meanVolume() const {
  if (const auto* layers = std::get_if<LayerOptions>(&grains)) return base::sphereVolume(layers->radius);
  return base::sphereVolume(1) * std::get<RandomBedOptions>(grains).radii.meanPower(3);
}

BedPlan planBed(const HeightField& surface, const BedOptions& options) {
  return std::visit([&](const auto& how) { return planBed(surface, how); }, options.grains);
}

std::int64_t fixedGrains(const BedPlan& plan, const BedOptions& options) {
  return options.floorGrains ? floorGrainCount(plan.walls, *options.floorGrains) : 0;
}

std::vector<Seed> layBed(const HeightField& surface, const BedOptions& options) {
  std::vector<Seed> floor;
  if (options.floorGrains) {
    const BedPlan plan = planBed(surface, options);
    floor = layFloorGrains(plan.floor, plan.walls, *options.floorGrains);
  }
  std::vector<Seed> grains;
  if (const auto* layers = std::get_if<LayerOptions>(&options.grains)) {
    double highest = 0;
    for (const Seed& s : floor) highest = std::max(highest, s.radius);
    // On a slope the vertical distance is larger than `highest`, which is measured along the normal.
    const double slope = surface.bounds().slope;
    grains = layGrains(surface, *layers, highest * std::sqrt(1 + slope * slope));
  } else {
    grains = layGrains(surface, std::get<RandomBedOptions>(options.grains), floor);
  }
  floor.insert(floor.end(), grains.begin(), grains.end());
  return floor;
}

} // namespace grouser::terrain
