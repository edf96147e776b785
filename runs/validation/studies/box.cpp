// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/box.hpp"

#include "base/random.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/grain_model.hpp"
#include "runs/setup/load_scene.hpp"

#include <fmt/format.h>

#include <cmath>

namespace grouser::studies {

using base::Vec3d;

terrain::Grains fill(const StudyBox& box, const base::Exec& exec) {
  scene::Scene scene = setup::parseScene(
      fmt::format("version = 1\n[run]\nduration = 1\n[material.soil]\ndensity = {}\nstiffness = {}\n"
                  "restitution = {}\nfriction = {}\n[[grain]]\nposition = [0, 0, 0]\nradius = {}\n"
                  "material = \"soil\"\n",
                  StudyBox::kDensity, StudyBox::kStiffness, box.restitution, box.friction, StudyBox::kRadius),
      "study");
  scene.run.gravity = {0, 0, -box.gravity};
  scene.run.precision = box.precision;

  constexpr std::uint64_t kSeed = 1, kJitter = base::purpose("study.box"), kShaken = base::purpose("study.shaken");
  const auto side = static_cast<std::int64_t>(std::ceil(std::sqrt(static_cast<double>(box.grains) / box.layers)));
  const double spacing = box.spacing * StudyBox::kRadius, gap = 0.9 * (box.spacing - 2) * StudyBox::kRadius;
  const base::PositionScale scale = studyBoxScale();
  std::vector<terrain::GrainSpec> start;
  for (std::int64_t i = 0; i < box.grains; ++i) {
    const auto id = static_cast<std::uint64_t>(i);
    const auto random = [&](std::uint64_t k) { return base::uniform(kSeed, kJitter, id, k) - 0.5; };
    Vec3d p{(static_cast<double>(i % side) + 0.5) * spacing, (static_cast<double>(i / side % side) + 0.5) * spacing,
            (static_cast<double>(i / (side * side)) + 0.5) * spacing};
    Vec3d v;
    for (int a = 0; a < 3; ++a) {
      const auto k = static_cast<std::uint64_t>(a);
      p[a] += gap * random(k), v[a] = 2 * box.speed * random(3 + k);
      // Put positions on the grid first, so that displacements are whole units of length.
      p[a] = std::floor(p[a] * scale.perMetre + 0.5) * scale.unit;
      if (box.shaken > 0)
        p[a] += std::floor((2 * base::uniform(box.seed, kShaken, id, k) - 1) * box.shaken + 0.5) * scale.unit;
    }
    start.push_back({p, v, {}});
  }
  const double edge = static_cast<double>(side) * spacing, height = box.layers * spacing;
  setup::Surroundings around;
  around.walls = {{{0, 0, 1}, 0, "soil"},
                  {{1, 0, 0}, 0, "soil"},
                  {{-1, 0, 0}, -edge, "soil"},
                  {{0, 1, 0}, 0, "soil"},
                  {{0, -1, 0}, -edge, "soil"}};
  if (box.gravity == 0) around.walls.push_back({{0, 0, -1}, -height, "soil"});
  terrain::Boundaries boundaries;
  const terrain::GrainModel model =
      setup::grainModel(scene, setup::grainKinds(scene), StudyBox::kTimeStep, around, boundaries);
  return terrain::Grains(exec, model, boundaries, start);
}

base::PositionScale studyBoxScale() { return base::positionScale(2 * StudyBox::kRadius); }

std::int64_t studyBoxDiameter() {
  return static_cast<std::int64_t>(std::floor(2 * StudyBox::kRadius * studyBoxScale().perMetre + 0.5));
}

} // namespace grouser::studies
