// SPDX-License-Identifier: BSD-3-Clause
// Specialised kernels exist for the scenes of runs/scenes and for beds of every soil of assets/soils.
#include "runs/scene/scene.hpp"
#include "runs/setup/bed_alone.hpp"
#include "runs/setup/contact_pairs.hpp"
#include "runs/setup/grain_memory.hpp"
#include "runs/setup/load_scene.hpp"
#include "terrain/kernel_choice.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace grouser::setup {
namespace {

namespace fs = std::filesystem;

/// Scenes without a specialised kernel, by name, with the reason. A kernel costs compile time.
const std::map<std::string, std::string> kExceptions = {};

/// Names of cases with a general kernel, or no SIMD on a CPU; followed by the kernel in words.
using Slow = std::map<std::string, std::string>;

void addSlow(Slow& slow, const std::string& name, const scene::Scene& scene) {
  const ContactPairs pairs(scene);
  if (!pairs.kinds.any()) return;
  const KernelTraits traits = kernelTraits(scene, pairs);
  // A bed settles before parts load its grains.
  for (const unsigned features : {traits.features, traits.features & ~terrain::kLoads}) {
    const terrain::KernelChoice step = terrain::stepKernel(features, traits.model);
    const std::string text = terrain::stepKernelText(features, traits.model);
    if (step.general()) slow.emplace(name + ": kernel of the grains", text);
    if (step.noSimd || step.simdGeneral()) slow.emplace(name + ": SIMD", text);
  }
  if (traits.features & terrain::kBoundaries && terrain::boundaryKernel(traits.features, traits.model).general())
    slow.emplace(name + ": kernel of walls and floor", terrain::boundaryKernelText(traits.features, traits.model));
}

void addSlowOf(Slow& slow, const std::string& name, const scene::Scene& scene) {
  addSlow(slow, name, scene);
  if (isPutOnBed(scene)) addSlow(slow, name + ", its bed", sceneOfBed(scene));
}

std::vector<fs::path> filesIn(const std::string& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(std::string(GROUSER_SOURCE_DIR) + "/" + folder))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  EXPECT_FALSE(files.empty()) << folder;
  return files;
}

scene::Scene bedOf(const std::string& soil, bool vehicle, const std::string& sections = "") {
  std::string text = "version = 1\n[run]\nduration = 1\n" + sections +
                     "[terrain]\nheightmap = \"heightmaps/flat.png\"\nsize = [6, 4]\n"
                     "height_range = [0, 0]\ndepth = 0.3\ngrain_radius = 0.03\nmaterial = \"" +
                     soil + "\"\n";
  if (vehicle)
    text += "[vehicle]\nspec = \"vehicles/light_tracked.toml\"\nposition = [2, 0]\n[driver]\nsprocket_speed = 1\n";
  return parseScene(text, "bed.toml");
}

Slow slowOfAll() {
  Slow slow;
  for (const fs::path& file : filesIn("runs/scenes")) addSlowOf(slow, file.filename().string(), loadScene(file));
  for (const fs::path& file : filesIn("assets/soils"))
    for (const bool vehicle : {false, true})
      addSlowOf(slow, "soil " + file.stem().string() + (vehicle ? " under a vehicle" : ""),
                bedOf(file.stem().string(), vehicle));
  return slow;
}

TEST(SceneKernels, ShippedScenesAndSoilsHaveTheirOwnAndSimd) {
  for (const auto& [name, text] : slowOfAll())
    EXPECT_TRUE(kExceptions.count(name)) << name << ": " << text
                                         << "\nAdd a kernel to terrain/detail/kernel_lists.hpp, or an exception here.";
}

TEST(SceneKernels, BedsOfEveryLawHaveTheirOwnInSimd) {
  for (const std::string law : {"linear", "hertz", "eepa", "eepa_linear", "luding"})
    for (const bool vehicle : {false, true}) {
      const std::string springs =
          law == "hertz" || law == "eepa" ? "young = 1e7\npoisson = 0.3\n" : "stiffness = 1e6\n";
      const scene::Scene scene =
          bedOf("soil", vehicle,
                "[material.soil]\ndensity = 2600\nrestitution = 0.5\nfriction = 0.5\nrolling_friction = 0.1\nlaw = \"" +
                    law + "\"\n" + springs);
      const ContactPairs pairs(scene);
      const KernelTraits traits = kernelTraits(scene, pairs);
      const terrain::KernelChoice step = terrain::stepKernel(traits.features, traits.model);
      EXPECT_TRUE(!step.noSimd && !step.simdGeneral()) << terrain::stepKernelText(traits.features, traits.model);
    }
}

TEST(SceneKernels, NoExceptionIsOutOfDate) {
  const Slow slow = slowOfAll();
  for (const auto& [name, reason] : kExceptions) EXPECT_TRUE(slow.count(name)) << name << " needs no exception";
}

} // namespace
} // namespace grouser::setup
