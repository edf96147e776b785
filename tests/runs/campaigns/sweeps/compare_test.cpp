// SPDX-License-Identifier: BSD-3-Clause
// One scene on several kinds of ground: its conversion, differences and verdicts, and tables.
#include "runs/campaigns/sweeps/compare_results.hpp"

#include "base/error.hpp"
#include "runs/campaigns/sweeps/compare.hpp"
#include "runs/campaigns/sweeps/grounds.hpp"
#include "runs/campaigns/sweeps/run_manifest.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/step_limit.hpp"
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

namespace grouser::sweeps {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;
using scene::TerrainKind;
using Words = std::vector<std::string>;

fs::path shipped(const std::string& name) { return fs::path(GROUSER_SOURCE_DIR) / "runs/scenes" / name; }

bool has(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string fault(const fs::path& scene, const Words& sets, TerrainKind ground) {
  try {
    groundOverrides(scene, sets, ground);
    return "";
  } catch (const base::InputError& error) {
    return error.what();
  }
}

TEST(Grounds, ABedLosesItsGrains) {
  const fs::path scene = shipped("deep_bed.toml");
  const Words sets = {"terrain.material=lete_sand", "terrain.depth=0.3", "scm.c=0", "run.duration=1"};
  const Words rigid = groundOverrides(scene, sets, TerrainKind::rigid),
              scm = groundOverrides(scene, sets, TerrainKind::scm);
  for (const Words& words : {rigid, scm}) {
    EXPECT_TRUE(has(words, "~terrain.depth"));
    EXPECT_TRUE(has(words, "~terrain.grain_radius"));
    EXPECT_FALSE(has(words, "terrain.depth=0.3")) << "only a bed has this key";
    EXPECT_TRUE(has(words, "run.duration=1"));
  }
  EXPECT_FALSE(has(rigid, "scm.c=0"));
  EXPECT_TRUE(has(scm, "scm.c=0"));
  const scene::Scene hard = setup::loadScene(scene, rigid), soft = setup::loadScene(scene, scm);
  EXPECT_EQ(hard.terrain->kind, TerrainKind::rigid);
  EXPECT_EQ(soft.terrain->kind, TerrainKind::scm);
  EXPECT_EQ(soft.scm->cohesion, 0.0);
  const scene::Scene bed = setup::loadScene(scene, groundOverrides(scene, sets, TerrainKind::granular));
  EXPECT_EQ(bed.terrain->depth, 0.3);
  EXPECT_FALSE(bed.scm) << "a bed has no [scm]";
}

TEST(Grounds, DeformableSoilBecomesABed) {
  const fs::path scene = shipped("scm_drive.toml");
  EXPECT_NE(fault(scene, {}, TerrainKind::granular)
                .find("granular ground requires terrain.grain_radius [m]; add --set terrain.grain_radius=VALUE"),
            std::string::npos);
  EXPECT_NE(fault(scene, {"terrain.grain_radius=0.05"}, TerrainKind::granular).find("--set terrain.depth=VALUE"),
            std::string::npos);
  const Words sets = {"terrain.grain_radius=0.05", "terrain.depth=0.3"};
  EXPECT_EQ(setup::loadScene(scene, groundOverrides(scene, sets, TerrainKind::granular)).terrain->depth, 0.3);
  EXPECT_TRUE(setup::loadScene(scene, groundOverrides(scene, sets, TerrainKind::scm)).terrain->deformable());
  EXPECT_EQ(setup::loadScene(scene, groundOverrides(scene, sets, TerrainKind::rigid)).terrain->material, "lete_sand");
}

TEST(Grounds, NameWhatIsMissing) {
  EXPECT_NE(
      fault(shipped("rigid_control.toml"), {}, TerrainKind::scm).find("is not one; add --set terrain.material=SOIL"),
      std::string::npos);
  EXPECT_EQ(fault(shipped("rigid_control.toml"), {"terrain.material=dry_sand"}, TerrainKind::scm), "");
  EXPECT_EQ(fault(shipped("rigid_control.toml"), {"scm.n=1"}, TerrainKind::scm), "") << "the loader lists the others";
  EXPECT_NE(fault(shipped("drum.toml"), {}, TerrainKind::scm).find("[terrain] is missing"), std::string::npos);
}

TEST(Grounds, EverySceneOfAVehicleIsConverted) {
  int scenes = 0;
  for (const auto& entry : fs::directory_iterator(shipped(""))) {
    if (entry.path().extension() != ".toml") continue;
    const scene::Scene own = setup::loadScene(entry.path());
    if (!own.terrain || !own.vehicle || own.fluid) continue; // fluid requires rigid ground
    ++scenes;
    for (const TerrainKind ground : {TerrainKind::rigid, TerrainKind::scm, TerrainKind::granular}) {
      Words sets = {"terrain.material=lete_sand"};
      if (!own.terrain->granular() && ground == TerrainKind::granular)
        sets.insert(sets.end(), {"terrain.grain_radius=0.05", "terrain.depth=0.3"});
      EXPECT_NO_THROW(
          EXPECT_EQ(setup::loadScene(entry.path(), groundOverrides(entry.path(), sets, ground)).terrain->kind, ground))
          << entry.path() << " " << base::wordOf(ground);
    }
  }
  EXPECT_GT(scenes, 10);
}

TEST(Grounds, KeysOfASweepMayBeInItsLists) {
  const fs::path scene = shipped("scm_drive.toml");
  const SweepLists lists{{"terrain.depth=0.3,0.4", "terrain.grain_radius=0.05"}};
  const Words words = groundOverrides(scene, lists, {"run.threads=1"}, TerrainKind::granular);
  EXPECT_EQ(words, (Words{"run.threads=1", "terrain.kind=\"granular\""}));
  EXPECT_THROW(groundOverrides(scene, {{"terrain.kind=rigid,scm"}}, {}, TerrainKind::scm), base::InputError);
}

TEST(Compare, GroundsAreTwoDifferentOnes) {
  EXPECT_EQ(groundsOf({"scm", "rigid"}), (std::vector{TerrainKind::scm, TerrainKind::rigid}));
  for (const Words& words : {Words{"scm"}, {"scm", "scm"}, {"scm", "mud"}})
    EXPECT_THROW(groundsOf(words), base::InputError) << words.back();
}

VariantResult resultWith(TerrainKind ground, const std::vector<double>& values) {
  VariantResult g;
  g.variant = base::wordOf(ground), g.random = ground == TerrainKind::granular, g.values = {values};
  g.runs = g.ended = static_cast<int>(values.size());
  g.figures = {g.random ? jobs::interval95(values) : support::Estimate{values.front(), 0}};
  return g;
}

TEST(Compare, DifferencesHaveTheScatterOfTheirSeeds) {
  const VariantResult scm = resultWith(TerrainKind::scm, {2.0}), rigid = resultWith(TerrainKind::rigid, {1.5}),
                      bed = resultWith(TerrainKind::granular, {1.0, 1.1, 1.2});
  EXPECT_DOUBLE_EQ(variantDifference(rigid, scm, 0).value, 0.5);
  EXPECT_EQ(variantDifference(rigid, scm, 0).halfWidth, 0);
  // Student: 4.303 * 0.1 / sqrt(3)
  for (const support::Estimate& d : {variantDifference(scm, bed, 0), variantDifference(bed, scm, 0)}) {
    EXPECT_NEAR(std::fabs(d.value), 0.9, 1e-12); // round-off
    EXPECT_NEAR(d.halfWidth, 4.303 * 0.1 / std::sqrt(3), 1e-4);
  }
  EXPECT_LT(variantDifference(scm, bed, 0).value, 0);
  const VariantResult other = resultWith(TerrainKind::granular, {2.0, 2.1, 2.2});
  EXPECT_NEAR(variantDifference(bed, other, 0).halfWidth,
              jobs::unpairedChange(bed.values[0], other.values[0]).halfWidth, 1e-15);
}

TEST(Compare, VerdictsReferToTheLargerMean) {
  EXPECT_EQ(variantVerdict({0.049, 0}, 1, 1.049, 5), "equal");
  EXPECT_EQ(variantVerdict({0.06, 0}, 1, 1.06, 5), "differs");
  EXPECT_EQ(variantVerdict({1.02, 0}, 20, 21.02, 5), "equal") << "less than 5 % of 21.02, more than of 20";
  EXPECT_EQ(variantVerdict({-1.02, 0}, 21.02, 20, 5), "equal");
  EXPECT_EQ(variantVerdict({0.06, 0.02}, 1, 1.06, 5), "inconclusive");
  EXPECT_EQ(variantVerdict({0.06, INFINITY}, 1, 1.06, 5), "inconclusive") << "one seed";
}

TEST(Compare, TablesHaveEveryPairOfGrounds) {
  Comparison all;
  all.columns = {"speed [m/s]"};
  all.variants = {resultWith(TerrainKind::rigid, {1.0}), resultWith(TerrainKind::scm, {0.9}),
                  resultWith(TerrainKind::granular, {0.5, 0.6, 0.7})};
  all.variants[2].doubt = "1.2 teeth";
  for (const auto& [a, b] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}})
    all.differences.push_back({a, b, {variantDifference(all.variants[a], all.variants[b], 0)}, {"differs"}});
  const std::string csv = comparisonCsv(all), text = comparisonText(all, 5);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 1 + 1 + 2);
  EXPECT_NE(csv.find("speed [m/s],scm,1,0.9,0,,rigid,-0.1"), std::string::npos) << csv;
  EXPECT_NE(text.find("granular is inconclusive: 1.2 teeth"), std::string::npos) << text;
  EXPECT_NE(text.find("granular - scm"), std::string::npos) << text;
  const nlohmann::ordered_json json = comparisonJson(all);
  EXPECT_EQ(json["rows"][0]["differences"].size(), 3u);
  EXPECT_EQ(json["rows"][0]["means"][2]["values"].size(), 3u);
  all.variants[0].figures[0] = {NAN, NAN}, all.differences[0].verdicts[0] = all.differences[1].verdicts[0] = "";
  const std::string none = comparisonText(all, 5);
  EXPECT_NE(none.find("rigid is inconclusive: its runs end before the vehicle reaches full speed"), std::string::npos)
      << none;
  EXPECT_EQ(none.find("scm - rigid"), std::string::npos) << none;
}

TEST(Compare, ContactMethodsAreTwoDifferentOnes) {
  using scene::ContactMethod;
  EXPECT_EQ(contactsOf({"complementarity", "penalty"}),
            (std::vector{ContactMethod::complementarity, ContactMethod::penalty}));
  for (const Words& words : {Words{"penalty"}, {"penalty", "penalty"}, {"penalty", "springs"}})
    EXPECT_THROW(contactsOf(words), base::InputError) << words.back();
}

TEST(Compare, EachContactMethodHasItsOwnKeys) {
  const Words sets = {"run.residual=1e-3", "complementarity.friction=associated", "run.seed=4"};
  EXPECT_EQ(contactOverrides(shipped("container.toml"), sets, scene::ContactMethod::penalty),
            (Words{"run.seed=4", "run.contact=penalty"}));
  EXPECT_EQ(contactOverrides(shipped("container.toml"), sets, scene::ContactMethod::complementarity),
            (Words{sets[0], sets[1], sets[2], "~run.time_step", "run.contact=complementarity"}));
  EXPECT_EQ(contactOverrides(shipped("container.toml"), {"run.time_step=1e-3"}, scene::ContactMethod::complementarity),
            (Words{"run.time_step=1e-3", "run.contact=complementarity"}));
  EXPECT_EQ(contactOverrides(shipped("container.toml"), {"~run.time_step"}, scene::ContactMethod::complementarity),
            (Words{"~run.time_step", "run.contact=complementarity"}));
}

class CompareRuns : public ProgramTest {};

TEST_F(CompareRuns, PenaltyContactsDropTheKeysOfComplementarityInTheFile) {
  const fs::path scene = folder_ / "solved.toml";
  std::ofstream(scene) << "version = 1\n[run]\nduration = 1\ntime_step = 1e-3\ncontact = \"complementarity\"\n"
                          "residual = 1e-4\n[complementarity]\nstrict = true\n";
  EXPECT_EQ(contactOverrides(scene, {}, scene::ContactMethod::penalty),
            (Words{"~run.residual", "~complementarity", "~run.time_step", "run.contact=penalty"}));
  EXPECT_EQ(contactOverrides(scene, {}, scene::ContactMethod::complementarity), (Words{"run.contact=complementarity"}));
}

TEST_F(CompareRuns, HaveOneFolderAGroundAndAreNotRepeated) {
  CompareOptions options;
  options.grounds = {TerrainKind::rigid, TerrainKind::scm};
  options.fixed = {"run.duration=0.004", "output.picture=false", "output.plots=false", "output.frames=false",
                   "run.threads=1"};
  options.sweep.program = programUnderTest(), options.sweep.folder = folder_ / "out", options.sweep.plot = false;
  EXPECT_EQ(runCompare(shipped("scm_drive.toml"), options), 0);
  const auto time = [&](const char* name) { return fs::last_write_time(folder_ / "out" / name / "manifest.json"); };
  const auto rigid = time("rigid"), scm = time("scm");
  EXPECT_EQ(runCompare(shipped("scm_drive.toml"), options), 0);
  EXPECT_EQ(time("rigid"), rigid);
  EXPECT_EQ(time("scm"), scm);
  for (const char* file : {"compare.txt", "compare.csv", "compare.json", "summary.csv"})
    EXPECT_TRUE(fs::exists(folder_ / "out" / file)) << file;
  options.grounds.push_back(TerrainKind::granular);
  try {
    runCompare(shipped("scm_drive.toml"), options);
    ADD_FAILURE() << "a bed without grains";
  } catch (const base::InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("--grounds granular: "), 0u) << error.what();
  }
}

TEST_F(CompareRuns, ContactMethodsHaveRunsOfTheSameSeeds) {
  CompareOptions options;
  options.contacts = {scene::ContactMethod::penalty, scene::ContactMethod::complementarity}, options.seeds = 2;
  options.fixed = {"run.duration=0.004",  "output.picture=false", "output.plots=false",
                   "output.frames=false", "grains.0.number=100",  "run.threads=1"};
  options.sweep.program = programUnderTest(), options.sweep.folder = folder_ / "out", options.sweep.plot = false;
  EXPECT_EQ(runCompare(shipped("drum.toml"), options), 0);
  for (const char* name : {"penalty,seed=1", "penalty,seed=2", "complementarity,seed=1", "complementarity,seed=2"})
    EXPECT_TRUE(fs::exists(folder_ / "out" / name / "manifest.json")) << name;
  const SweepPlan plan = planCompare(shipped("drum.toml"), options);
  EXPECT_EQ(plan.runs[1].scene.run.contact, scene::ContactMethod::penalty);
  EXPECT_EQ(plan.runs[2].scene.run.contact, scene::ContactMethod::complementarity);
  EXPECT_EQ(plan.runs[2].values, (Words{"complementarity", "1"}));
}

TEST_F(CompareRuns, ContactMethodsHaveMultiplesOfTheirOwnSteps) {
  CompareOptions options;
  options.contacts = {scene::ContactMethod::penalty, scene::ContactMethod::complementarity}, options.seeds = 2;
  options.steps = {0.25, 1};
  options.fixed = {"run.duration=0.15",   "output.picture=false", "output.plots=false",
                   "output.frames=false", "grains.0.number=100",  "run.threads=1"};
  const SweepPlan plan = planCompare(shipped("drum.toml"), options);
  ASSERT_EQ(plan.runs.size(), 8u);
  EXPECT_EQ(plan.runs[0].name, "penalty_x0.25,seed=1");
  EXPECT_EQ(plan.runs[6].name, "complementarity,seed=1");
  const auto step = [&](std::size_t k) { return setup::chooseTimeStep(plan.runs[k].scene); };
  EXPECT_NEAR(step(0), 0.25 * step(2), 1e-6 * step(2));
  EXPECT_NEAR(step(4), 0.25 * step(6), 1e-6 * step(6));
  EXPECT_GT(step(6), 10 * step(2));
  options.sweep.program = programUnderTest(), options.sweep.folder = folder_ / "out", options.sweep.plot = false;
  EXPECT_EQ(runCompare(shipped("drum.toml"), options), 0);
  std::ifstream file(folder_ / "out" / "compare.txt");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  EXPECT_NE(text.find("difference from penalty_x0.25 [% of its mean]"), std::string::npos) << text;
  EXPECT_NE(text.find(" reference"), std::string::npos) << text;
  const double overlap = RunManifest(folder_ / "out" / "complementarity,seed=1").figure("solver_max_overlap");
  EXPECT_GT(overlap, 1e-4);
  EXPECT_LT(overlap, 0.1);
}

TEST_F(CompareRuns, TheCostOfAResumedRunIsExtrapolatedToAllSteps) {
  std::ofstream(folder_ / "manifest.json")
      << R"({"steps": 1000, "figures": {"resumed_at_step": 750, "wall_steps_s": 2}})";
  EXPECT_EQ(RunManifest(folder_).ofAllSteps("wall_steps_s"), 8);
  std::ofstream(folder_ / "manifest.json") << R"({"steps": 1000, "figures": {"wall_steps_s": 2}})";
  EXPECT_EQ(RunManifest(folder_).ofAllSteps("wall_steps_s"), 2);
}

} // namespace

} // namespace grouser::sweeps
