// SPDX-License-Identifier: BSD-3-Clause
// Forecast of `grouser plan`: arithmetic, grain count, and runs that do not fit. No test depends on wall time.
#include "coupling/simulation.hpp"
#include "runs/campaigns/forecast/forecast.hpp"
#include "runs/campaigns/forecast/kept_ratios.hpp"
#include "runs/campaigns/forecast/machine_fit.hpp"
#include "runs/campaigns/forecast/probe.hpp"
#include "runs/campaigns/forecast/typical_times.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/setup/step_limit.hpp"
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <string>

namespace grouser::forecast {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

/// 90 grains on a rough floor; `more` adds keys.
std::string bedScene(const std::string& terrain = "", const std::string& more = "") {
  const std::string maps = std::string(GROUSER_SOURCE_DIR) + "/assets/heightmaps/";
  return "version = 1\n[run]\nduration = 0.02\nframe_interval = 0.01\n[material.sand]\nstiffness = 1e4\n"
         "[terrain]\nheightmap = \"" +
         maps + "flat.png\"\nsize = [0.2, 0.12]\nheight_range = [0, 0]\nmaterial = \"sand\"\ngrain_radius = 0.01\n" +
         "depth = 0.05\nsettle_time_limit = 5\n" + terrain + "[output]\nplots = false\npicture_width = 64\n" + more;
}

const char* const kBoxInBed = "[[box]]\nname = \"post\"\nposition = [0.1, 0, 0]\nsize = [0.05, 0.05, 0.3]\n"
                              "material = \"sand\"\n";

scene::Scene parsed(const std::string& text) { return setup::parseScene(text, "bed.toml"); }

std::int64_t counted(const scene::Scene& scene) { return countGrains(scene, setup::chooseTimeStep(scene)).grains; }

std::int64_t run(const scene::Scene& scene) {
  const coupling::Simulation simulation(setup::simulationSetup(scene), base::cpuExec(1),
                                        coupling::SettleProgress([](double, double) {}));
  return static_cast<std::int64_t>(simulation.ground().grains->count());
}

TEST(CountedGrains, BedHasAsManyAsItsRun) {
  for (const std::string& terrain : {std::string(), std::string("floor_grains = false\n")}) {
    const scene::Scene scene = parsed(bedScene(terrain));
    EXPECT_EQ(counted(scene), run(scene)) << terrain;
  }
}

TEST(CountedGrains, WhatStandsInTheBedTakesTheirPlaces) {
  const scene::Scene scene = parsed(bedScene("", kBoxInBed));
  EXPECT_EQ(counted(scene), run(scene));
  EXPECT_LT(counted(scene), counted(parsed(bedScene())));
}

TEST(CountedGrains, WhatIsPutOnTheBedCounts) {
  const std::string grain = "[[grain]]\nposition = [0.1, 0, 0]\nabove_bed = 0.01\nradius = 0.01\nmaterial = \"sand\"\n";
  const scene::Scene scene = parsed(bedScene("", grain));
  EXPECT_EQ(counted(scene), run(scene));
  EXPECT_EQ(counted(scene), counted(parsed(bedScene())) + 1);
}

TEST(CountedGrains, BedTooLargeToBeLaidSaysHowSureItIs) {
  const scene::Scene scene = parsed(bedScene());
  const CountedGrains sure = countGrains(scene, 1e-5), unsure = countGrains(scene, 1e-5, 10);
  EXPECT_TRUE(sure.exact && sure.doubt.empty());
  EXPECT_FALSE(unsure.exact);
  EXPECT_NE(unsure.doubt.find("within"), std::string::npos);
}

StepTimes::Group group(double steps, double seconds, double lists = 0, double parts = 0, double grains = 100) {
  return {steps, seconds, lists, parts, grains};
}

TEST(ProbedSteps, RestTakesWhatTheLastThirdTook) {
  StepTimes times;
  for (int k = 0; k < 6; ++k) times.groups.push_back(group(10, k < 3 ? 1.0 : 2.0));
  // The last two groups reach a third of 9 s: 0.2 s per step.
  EXPECT_DOUBLE_EQ(times.last().seconds / times.last().steps, 0.2);
  EXPECT_NEAR(costOfRun(times, 100, 1, 0).whole(), 9 + 40 * 0.2, 1e-12);
  // A run that ends within the probe takes the measured time of its steps.
  EXPECT_NEAR(costOfRun(times, 25, 1, 0).whole(), 2.5, 1e-12);
  EXPECT_EQ(costOfRun({}, 40, 1, 0).whole(), 0);
}

TEST(ProbedSteps, LongerStepsCountAsManyButTheirListsEndAsOften) {
  StepTimes times;
  times.groups.push_back(group(10, 1, 0.3, 0.2));
  const StepCost cost = costOfRun(times, 40, 4, 0);
  EXPECT_NEAR(cost.grains, 4 * 0.5, 1e-12);
  EXPECT_NEAR(cost.parts, 4 * 0.2, 1e-12);
  EXPECT_NEAR(cost.lists, 0.3, 1e-12);
}

TEST(ProbedSteps, GrainsThatEnterLaterMakeThemDearerAlongTheLine) {
  StepTimes times;
  for (int k = 1; k <= 6; ++k) times.groups.push_back(group(100, 100 * (1e-6 + 2e-8 * k), 0, 0, k));
  double probe = 0;
  for (const StepTimes::Group& g : times.groups) probe += g.seconds;
  // Exactly on a line of 1 us and 20 ns per grain.
  EXPECT_NEAR(costOfRun(times, 1600, 1, 50).whole(), probe + 1000 * (1e-6 + 2e-8 * 50), 1e-12);
}

Forecast someForecast() {
  Forecast f;
  f.preparation = {{"settling the bed", 3, "how"}, {"sphere sets", 0.25, ""}};
  f.steps = {{"grains", 10, ""}, {"neighbour lists", 1, ""}};
  f.output = {{"rows", 0.5, "7"}};
  f.process = 2e9, f.disk = 3e6, f.diskSpeed = 1e8;
  return f;
}

TEST(ForecastFigures, PartsAddUp) {
  const Forecast f = someForecast();
  EXPECT_DOUBLE_EQ(f.total(), 14.75);
  const auto json = nlohmann::json::parse(forecastJson(f));
  EXPECT_DOUBLE_EQ(json["total_s"].get<double>(), 14.75);
  for (const char* group : {"preparation", "steps", "output"}) {
    double sum = 0;
    for (const auto& [name, value] : json[group].items()) sum += name == "total_s" ? 0 : value.get<double>();
    EXPECT_DOUBLE_EQ(sum, json[group]["total_s"].get<double>()) << group;
  }
  const std::string text = forecastText(f);
  for (const char* part :
       {"settling the bed", "3.0 s       probed (how)", "total", "15 s", "2 GB", "3 MB, written at 100 MB/s"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST(ForecastFigures, AccuracyFollowsFromTheSourceOfEachPart) {
  Forecast f;
  f.probed = false;
  f.preparation = {{"settling the bed", 3, "", Source::probed}};
  f.steps = {{"grains", 10, "", Source::kept}};
  f.output = {{"rows", 6, "", Source::typical}};
  EXPECT_DOUBLE_EQ(f.bound(-1), 3 / 2.0 + 10 / 2.0 + 6 / 3.0);
  EXPECT_DOUBLE_EQ(f.bound(1), 3 * 2.0 + 10 * 2.0 + 6 * 3.0);
  const std::string text = forecastText(f);
  for (const char* part : {"(short probe, ", "3.0 s       probed", "10 s        kept", "6.0 s       typical",
                           "19 s (8.5 s to 44 s)", "within a factor of 2 (probed, kept) or 3 (typical)"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  const auto json = nlohmann::json::parse(forecastJson(f));
  EXPECT_EQ(json["sources"], nlohmann::json({{"settling the bed", "probed"}, {"grains", "kept"}, {"rows", "typical"}}));
  EXPECT_DOUBLE_EQ(json["least_s"].get<double>(), f.bound(-1));
  EXPECT_DOUBLE_EQ(json["most_s"].get<double>(), f.bound(1));
  f.probed = true;
  EXPECT_DOUBLE_EQ(f.accuracy(Source::probed), 1.5) << "the long probe is more accurate";
}

TEST(ForecastFigures, ProbeThatFailedTellsNoTotal) {
  Forecast f = someForecast();
  f.warning = "the timed steps failed";
  EXPECT_EQ(forecastText(f).find("  total"), std::string::npos);
  EXPECT_NE(forecastText(f).find("WARNING: the timed steps failed"), std::string::npos);
}

TEST(MachineFit, SaysWhatLacksAndWhatHelps) {
  Demand demand;
  demand.process = 3e9, demand.device = 2e9, demand.frames = 5e9;
  const Room ample{4e9, 3e9, 6e9, "/data"};
  EXPECT_EQ(misfit(demand, ample), "");
  EXPECT_EQ(misfit(demand, {}), "") << "unknown limits do not reject a run";
  const auto with = [&](auto change) {
    Room room = ample;
    change(room);
    return misfit(demand, room);
  };
  EXPECT_NE(with([](Room& r) { r.process = 1e9; }).find("fewer or larger grains"), std::string::npos);
  EXPECT_NE(with([](Room& r) { r.device = 1e9; }).find("on each GPU"), std::string::npos);
  const std::string disk = with([](Room& r) { r.disk = 1e9; });
  EXPECT_NE(disk.find("/data"), std::string::npos);
  EXPECT_NE(disk.find("frame_interval"), std::string::npos);
}

TEST(MachineFit, DemandGrowsWithGrainsAndFrames) {
  const scene::Scene scene = parsed(bedScene());
  const Demand one = demandOf(scene, 1'000'000, 1e-5, false), two = demandOf(scene, 2'000'000, 1e-5, false);
  // Frames at 0, 0.01 and 0.02 s.
  EXPECT_DOUBLE_EQ(one.frames, 3e6 * frameBytesOfGrain(scene));
  EXPECT_DOUBLE_EQ(two.frames, 2 * one.frames);
  EXPECT_GT(two.process, one.process + 3e8);
  EXPECT_EQ(one.device, 0);
  EXPECT_GT(demandOf(scene, 1'000'000, 1e-5, true).device, 3e8);
  scene::Scene fields = scene;
  fields.output.fieldsCell = 0.1, fields.output.fieldsLow = {0, 0, 0}, fields.output.fieldsHigh = {1, 2, 3};
  const double words = 6000 * 4 * (1 + 1 + 1 + 3 + 6 + 6); // three scalars, a vector, two tensors
  EXPECT_NEAR(demandOf(fields, 1'000'000, 1e-5, false).frames - one.frames, 3 * words, 0.25 * words);
  scene::Scene bare = fields;
  bare.output.frames = false;
  EXPECT_EQ(demandOf(bare, 1'000'000, 1e-5, false).frames, 0);
  EXPECT_EQ(demandOf(scene, 0, 1e-5, false).frames, 0);
  scene::Scene printed = bare;
  printed.output.grainsCsv = true;
  EXPECT_GT(demandOf(printed, 1'000'000, 1e-5, false).disk(), demandOf(bare, 1'000'000, 1e-5, false).disk() + 3e8);
}

class KeptTimes : public FolderTest {
protected:
  void SetUp() override {
    FolderTest::SetUp();
    setenv("GROUSER_CACHE", folder_.c_str(), 1);
  }
  void TearDown() override {
    unsetenv("GROUSER_CACHE");
    FolderTest::TearDown();
  }
};

TEST_F(KeptTimes, AreOfOneMachineAndTheLastOfEachKindOfWork) {
  EXPECT_TRUE(keptRatios("here").empty());
  keepRatios("here", {{"grains", 0.5}, {"rows", 2}});
  keepRatios("here", {{"grains", 0.7}});
  EXPECT_EQ(keptRatios("here"), (Ratios{{"grains", 0.7}, {"rows", 2}}));
  EXPECT_TRUE(keptRatios("elsewhere").empty());
  for (const auto& file : fs::directory_iterator(folder_)) std::ofstream(file.path()) << "{\"of\": \"here\", \"rat";
  EXPECT_TRUE(keptRatios("here").empty()) << "damaged";
}

TEST_F(KeptTimes, DamagedFilesAreIgnored) {
  keepRatios("here", {{"grains", 0.5}, {"rows", 1e4}, {"frames", 1e-3}});
  EXPECT_EQ(keptRatios("here"), (Ratios{{"grains", 0.5}})) << "off by more than a factor of 100";
  fs::path path;
  for (const auto& file : fs::directory_iterator(folder_))
    if (file.path().extension() == ".json") path = file.path();
  for (const char* text : {"[]", "{\"of\": \"here\", \"ratios\": [1, 2]}", "{\"of\": \"here\"}"}) {
    std::ofstream(path) << text;
    EXPECT_TRUE(keptRatios("here").empty()) << text;
  }
  std::ofstream(path) << "{\"of\": \"here\", \"ratios\": {\"grains\": 1e300, \"rows\": 3, \"frames\": \"4\"}}";
  EXPECT_EQ(keptRatios("here"), (Ratios{{"rows", 3}}));
  fs::remove(path);
  fs::create_directory(path);
  EXPECT_TRUE(keptRatios("here").empty()) << "the path is a folder";
  keepRatios("here", {{"grains", 0.5}});
  for (const auto& file : fs::directory_iterator(folder_))
    EXPECT_TRUE(file.path() == path || file.path().extension() == ".lock") << file.path();
}

TEST(TypicalTimes, ThreadsAreAtMostTheLogicalCores) {
  const int cores = base::cpuExec().threads;
  EXPECT_EQ(usefulThreads(base::cpuExec(1)), 1);
  EXPECT_EQ(usefulThreads(base::cpuExec(cores)), cores);
  EXPECT_EQ(usefulThreads(base::cpuExec(10 * cores)), cores);
}

TEST(TypicalTimes, SmallerGrainsBelowTracksMakeTheVehicleDearer) {
  scene::Scene scene = parsed(bedScene("", "[vehicle]\nspec = \"" + std::string(GROUSER_SOURCE_DIR) +
                                               "/assets/vehicles/light_tracked.toml\"\n"));
  const double pairs = pairsBelowTracks(scene), parts = typicalTimes(scene, 90, 1e5, base::cpuExec(1)).parts;
  EXPECT_GT(pairs, 100);
  scene.terrain->grainRadius = 0.005;
  EXPECT_NEAR(pairsBelowTracks(scene) / pairs, 4, 1e-9);
  EXPECT_NEAR(typicalTimes(scene, 90, 1e5, base::cpuExec(1)).parts - parts, 3 * 170e-9 * pairs, 1e-9);
}

/// Tests of the program itself.
class PlanProgram : public ProgramTest {
protected:
  void write(const std::string& text) const { std::ofstream(folder_ / "bed.toml") << text; }
};

TEST_F(PlanProgram, TellsTimeMemoryAndDiskByTheirPartsAndLeavesNothing) {
  write(bedScene());
  const Outcome o = call("plan bed.toml --json plan.json --threads 1");
  ASSERT_EQ(o.code, 0) << o.errors;
  for (const char* part : {"settling the bed", "neighbour lists", "rows", "frames", "picture", "\n  total  ",
                           "prediction on", "process memory", "disk space"})
    EXPECT_NE(o.out.find(part), std::string::npos) << part << "\n" << o.out;
  const auto json = nlohmann::json::parse(std::ifstream(folder_ / "plan.json"));
  const bool rested = json["sources"]["settling the bed"] == "probed"; // not on a busy machine
  EXPECT_NE(o.out.find(rested ? "steps to settle a tile of" : "not settled during the measurement; estimated"),
            std::string::npos)
      << o.out;
  double sum = 0;
  for (const char* group : {"preparation", "steps", "output"}) sum += json[group]["total_s"].get<double>();
  EXPECT_NEAR(json["total_s"].get<double>(), sum, 1e-9 * sum);
  EXPECT_GT(json["preparation"]["settling the bed"].get<double>(), 0);
  EXPECT_FALSE(json["output"].contains("plots"));
  EXPECT_EQ(o.out.find("H200"), std::string::npos) << "no figures of other machines:\n" << o.out;
  int left = 0;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    ++left;
    EXPECT_TRUE(entry.path().filename() == "bed.toml" || entry.path().filename() == "plan.json") << entry.path();
  }
  EXPECT_EQ(left, 2);
}

TEST_F(PlanProgram, KeptBedIsFoundAndNotSettledAgain) {
  write(bedScene());
  const std::string keep = "export GROUSER_CACHE=\"$PWD/kept\"; ";
  ASSERT_EQ(call("run bed.toml --out first", keep).code, 0);
  const Outcome kept = call("plan bed.toml", keep);
  EXPECT_NE(kept.out.find("cached bed"), std::string::npos) << kept.out;
  EXPECT_EQ(kept.out.find("settling the bed"), std::string::npos) << kept.out;
  const Outcome anew = call("plan bed.toml --no-cache", keep);
  EXPECT_NE(anew.out.find("settling the bed"), std::string::npos) << anew.out;
}

TEST_F(PlanProgram, ShortProbeNamesItsSourcesAndTheLongOneIsKeptForIt) {
  write(bedScene());
  const std::string keep = "export GROUSER_CACHE=\"$PWD/kept\"; ";
  const auto sources = [&](const std::string& words, const std::string& stage) {
    const Outcome o = call("plan bed.toml --threads 1 --json plan.json" + words, keep);
    EXPECT_EQ(o.code, 0) << o.errors;
    EXPECT_NE(o.errors.find("plan: " + stage), std::string::npos) << "progress:\n" << o.errors;
    return nlohmann::json::parse(std::ifstream(folder_ / "plan.json"));
  };
  const auto first = sources("", "timing a small bed");
  EXPECT_EQ(first["sources"]["grains"], "probed");
  EXPECT_EQ(first["sources"]["picture"], "typical");
  EXPECT_FALSE(first["long_probe"].get<bool>());
  EXPECT_LT(first["probe_s"].get<double>(), 5);
  const auto probed = sources(" --probe", "timing steps");
  for (const auto& [part, source] : probed["sources"].items())
    EXPECT_TRUE(source == "probed" || part == "settling the bed") << part; // which may not rest on a busy machine
  const auto again = sources("", "timing a small bed");
  EXPECT_EQ(again["sources"]["picture"], "kept");
  EXPECT_EQ(again["sources"]["grains"], "kept");
  EXPECT_EQ(call("plan bed.toml --threads 1 --no-cache --json plan.json", keep).code, 0);
  const auto uncached = nlohmann::json::parse(std::ifstream(folder_ / "plan.json"));
  EXPECT_EQ(uncached["sources"]["picture"], "typical") << "without the cache no stored ratios";
  // Typical time times stored ratio: the probed time itself.
  EXPECT_NEAR(again["output"]["picture"].get<double>() / probed["output"]["picture"].get<double>(), 1, 1e-6);
}

TEST_F(PlanProgram, BedOfTilesIsPreparedBeforeItIsCopied) {
  write(bedScene("tile = [0.12, 0.12]\nporosity = 0.42\n"));
  const Outcome o = call("plan bed.toml --set terrain.depth=0.08 --json plan.json");
  ASSERT_EQ(o.code, 0) << o.errors;
  const auto json = nlohmann::json::parse(std::ifstream(folder_ / "plan.json"));
  for (const char* part : {"friction for the porosity", "settling a tile", "settling the copies"})
    EXPECT_GT(json["preparation"].value(part, 0.0), 0) << part << "\n" << o.out;
}

TEST_F(PlanProgram, BedThatIsNotSettledIsPlannedByTypicalValues) {
  write(bedScene());
  const std::string keep = "export GROUSER_CACHE=\"$PWD/kept\"; ";
  for (const std::string probe : {"", " --probe"}) {
    const Outcome o =
        call("plan bed.toml --threads 1 --json plan.json --set terrain.settle_time_limit=0" + probe, keep);
    ASSERT_EQ(o.code, 0) << probe << o.errors;
    const auto json = nlohmann::json::parse(std::ifstream(folder_ / "plan.json"));
    EXPECT_EQ(json["sources"]["grains"], probe.empty() ? "typical" : "probed");
    EXPECT_FALSE(json["preparation"].contains("settling the bed"));
  }
}

TEST_F(PlanProgram, BedTooSmallForAPeriodicTileIsPlanned) {
  write(bedScene());
  for (const std::string probe : {"", " --probe"}) {
    const Outcome o = call("plan bed.toml --threads 1 --json plan.json --set 'terrain.size=[0.045, 0.045]'" + probe);
    ASSERT_EQ(o.code, 0) << probe << o.errors;
    const auto json = nlohmann::json::parse(std::ifstream(folder_ / "plan.json"));
    EXPECT_EQ(json["sources"]["settling the bed"], probe.empty() ? "typical" : "probed") << o.out;
    EXPECT_GT(json["preparation"]["settling the bed"].get<double>(), 0);
  }
}

TEST_F(PlanProgram, LongProbeWithoutACacheSavesNothing) {
  write(bedScene());
  const std::string keep = "export GROUSER_CACHE=\"$PWD/kept\"; ";
  ASSERT_EQ(call("plan bed.toml --threads 1 --probe --no-cache", keep).code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "kept"));
}

TEST_F(PlanProgram, WithoutProbeRunsNothing) {
  write(bedScene());
  const Outcome o = call("plan bed.toml --no-probe");
  EXPECT_EQ(o.code, 0);
  EXPECT_EQ(o.out.find("prediction on"), std::string::npos);
  EXPECT_NE(o.out.find("grain steps"), std::string::npos);
  const Outcome both = call("plan bed.toml --no-probe --json plan.json");
  EXPECT_EQ(both.code, 2);
  EXPECT_EQ(call("plan bed.toml --no-probe --probe").code, 2);
  EXPECT_EQ(call("plan bed.toml --threads some").code, 2);
}

TEST_F(PlanProgram, WhatDoesNotFitIsRefusedByPlanAndRun) {
  // A million frames of 86 thousand grains: 4 TB.
  write(
      "version = 1\n[run]\nduration = 100\ntime_step = 1e-6\nframe_interval = 1e-6\n[material.sand]\nstiffness = 1e4\n"
      "[[grains]]\nform = \"lattice\"\nlow = [0, 0, 0]\nhigh = [1, 1, 0.9]\nradius = 0.01\nmaterial = \"sand\"\n");
  for (const char* words : {"plan bed.toml", "run bed.toml"}) {
    const Outcome o = call(words, "ulimit -f 4000; "); // were it begun, it would end soon
    EXPECT_EQ(o.code, 2) << words;
    EXPECT_NE(o.error().find("bed.toml: exceeds the resources of this machine: its results require"), std::string::npos)
        << o.errors;
    EXPECT_NE(o.error().find("run.frame_interval"), std::string::npos) << o.errors;
  }
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(PlanProgram, MemoryThatTheShellLimitsCounts) {
  write("version = 1\n[run]\nduration = 1e-3\ntime_step = 1e-6\n[material.sand]\nstiffness = 1e4\n"
        "[[grains]]\nform = \"lattice\"\nlow = [0, 0, 0]\nhigh = [4, 4, 4]\nradius = 0.01\nmaterial = \"sand\"\n");
  const Outcome o = call("run bed.toml", "ulimit -v 3000000; ");
  EXPECT_EQ(o.code, 2) << o.errors;
  EXPECT_NE(o.error().find("of memory"), std::string::npos) << o.errors;
}

} // namespace
} // namespace grouser::forecast
