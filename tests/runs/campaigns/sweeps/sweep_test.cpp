// SPDX-License-Identifier: BSD-3-Clause
// Sweeps: product of values, names, skipped runs of a second call, and other runs after a failed run.
#include "runs/campaigns/sweeps/sweep.hpp"
#include "runs/setup/load_scene.hpp"

#include "base/error.hpp"
#include "runs/campaigns/sweeps/runner.hpp"
#include "runs/output/output.hpp"
#include "tests/message_of.hpp"
#include "tests/runs/csv_fixture.hpp"
#include "tests/runs/program_fixture.hpp"
#include "tests/runs/scene_fixture.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace grouser::sweeps {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

class Sweep : public ProgramTest {
protected:
  void SetUp() override {
    ProgramTest::SetUp();
    writeScene("1e-3");
  }

  /// A grain that falls onto a plane; at 100 m/s its overlap would be v sqrt(m / k) = 1e-2 m, five times
  /// max_overlap: the run then fails.
  void writeScene(const std::string& duration) const {
    std::ofstream(scene()) << "version = 1\n[run]\nduration = " << duration
                           << "\ntime_step = 1e-5\noutput_interval = 1e-4\nthreads = 1\n[material.glass]\n[[grain]]\n"
                              "position = [0, 0, 1]\nradius = 0.01\nmaterial = \"glass\"\n"
                              "[[plane]]\npoint = [0, 0, 0.98]\nmaterial = \"glass\"\n"
                              "[output]\nplots = false\npicture = false\nframes = false\n";
  }
  fs::path scene() const { return folder_ / "fall.toml"; }
  fs::path out() const { return folder_ / "out"; }

  SweepOptions options() const {
    SweepOptions o;
    o.program = programUnderTest(), o.folder = out(), o.plot = false;
    return o;
  }
  int sweep(const Words& sets, int jobs = 1, bool force = false) const {
    SweepOptions o = options();
    o.jobs = jobs, o.force = force;
    return runSweep(planSweep(scene(), {sets}), o);
  }
  /// Time of a run's last manifest; skipped runs keep it.
  fs::file_time_type ended(const std::string& run) const { return fs::last_write_time(out() / run / "manifest.json"); }
};

TEST(SweepValues, SplitAtCommasOutsideBracketsAndQuotes) {
  EXPECT_EQ(splitValues("0.5,1, 2"), (Words{"0.5", "1", "2"}));
  EXPECT_EQ(splitValues("[1, 2],[3, 4]"), (Words{"[1, 2]", "[3, 4]"}));
  EXPECT_EQ(splitValues("\"a,b\",'c,d'"), (Words{"\"a,b\"", "'c,d'"}));
  EXPECT_EQ(splitValues("[0, 0, 1]"), Words{"[0, 0, 1]"});
  EXPECT_EQ(splitValues("1,"), (Words{"1", ""}));
}

TEST_F(Sweep, PrintsWarningsOfItsRunsOnceWithTheirNumber) {
  put(folder_ / "soil.toml", "version = 1\n[run]\nduration = 1e-3\n[material.sand]\nsoil = \"sandy_loam\"\n"
                             "grain_radius = 0.02\n[[plane]]\nmaterial = \"sand\"\n[[grain]]\n"
                             "position = [0, 0, 0.03]\nradius = 0.02\nmaterial = \"sand\"\n[output]\nplots = false\n"
                             "picture = false\nframes = false\n");
  const Outcome sweep = call("sweep soil.toml --set run.skin=0.4,0.5 --out soil");
  EXPECT_NE(sweep.out.find("WARNING in 2 of 2 runs: material.sand: "), std::string::npos) << sweep.out << sweep.errors;
}

TEST_F(Sweep, WarnsThatSeedsOfADeterministicSceneAreEqual) {
  const Outcome sweep = call("sweep fall.toml --set run.skin=0.5 --seeds 2 --out s");
  EXPECT_NE(sweep.errors.find("WARNING: nothing in these scenes is random"), std::string::npos) << sweep.errors;
  EXPECT_EQ(call("sweep fall.toml --set run.skin=0.5 --out t").errors.find("random"), std::string::npos);
}

TEST_F(Sweep, IsTheProductOfAllListsNamedByTheirValues) {
  const SweepPlan plan = planSweep(scene(), {{"run.seed=1,2", "run.skin=0.5", "grain.0.velocity=[0, 0, 1],[1,0,0]"}});
  EXPECT_EQ(plan.keys, (Words{"run.seed", "grain.0.velocity"}));
  Words names;
  for (const SweepRun& run : plan.runs) {
    names.push_back(run.name);
    EXPECT_EQ(run.scene.run.skin, 0.5) << "a single value applies to all";
  }
  EXPECT_EQ(names, (Words{"seed=1,velocity=0_0_1", "seed=1,velocity=1_0_0", "seed=2,velocity=0_0_1",
                          "seed=2,velocity=1_0_0"}));
  EXPECT_EQ(plan.runs[3].scene.run.seed, 2);
  EXPECT_EQ(plan.runs[3].scene.grains[0].velocity, (base::Vec3d{1, 0, 0}));
}

TEST_F(Sweep, NamesTellKeysOfOneLastWordApart) {
  std::ofstream(scene(), std::ios::app) << "[material.steel]\n";
  const SweepPlan plan = planSweep(scene(), {{"material.glass.friction=0.1,0.2", "material.steel.friction=0.3,0.4"}});
  EXPECT_EQ(plan.runs[1].name, "material.glass.friction=0.1,material.steel.friction=0.4");
}

TEST_F(Sweep, AnEntryOfAListIsNamedByItsWholeKey) {
  const SweepPlan plan = planSweep(scene(), {{"grain.0.position.2=1,2"}});
  EXPECT_EQ(plan.runs[1].name, "grain.0.position.2=2");
}

TEST_F(Sweep, ValuesThatLookAlikeAsFolderNamesGetTheirOwn) {
  std::ofstream(scene(), std::ios::app) << "[material.\"a b\"]\n[material.a_b]\n";
  const SweepPlan plan = planSweep(scene(), {{"grain.0.material=\"a b\",a_b"}});
  EXPECT_EQ(plan.runs[0].name, "material=a_b");
  EXPECT_EQ(plan.runs[1].name, "material=a_b~2");
}

TEST_F(Sweep, OneValueIsASweepOfOneRun) {
  const SweepPlan plan = planSweep(scene(), {{"run.seed=3"}});
  ASSERT_EQ(plan.runs.size(), 1u);
  EXPECT_EQ(plan.runs[0].name, "seed=3");
}

TEST_F(Sweep, WrongValuesAreFoundBeforeAnythingRuns) {
  for (const Words& sets : {Words{}, Words{"run.seed=1,-2"}, Words{"run.seed=1,,2"}, Words{"run.seed=1,1"},
                            Words{"run.seed=1,2", "run.seed=3"}, Words{"run.sead=1,2"}, Words{"run.seed"},
                            Words{"run.time_step=1e-5,1e-2"}})
    EXPECT_THROW(planSweep(scene(), {sets}), base::InputError) << (sets.empty() ? "" : sets[0]);
}

TEST_F(Sweep, ACaseIsKeysThatChangeTogether) {
  SweepLists lists;
  lists.cases = {"as it is", "fast: grain.0.velocity=[0, 0, 1], run.duration=2e-3"};
  lists.sets = {"run.skin=0.3,0.5"}, lists.seeds = 2;
  const SweepPlan plan = planSweep(scene(), lists);
  EXPECT_EQ(plan.keys, (Words{"case", "run.skin", "run.seed"}));
  ASSERT_EQ(plan.runs.size(), 8u);
  EXPECT_EQ(plan.runs[0].name, "as_it_is,skin=0.3,seed=1");
  EXPECT_EQ(plan.runs[7].name, "fast,skin=0.5,seed=2");
  EXPECT_EQ(plan.runs[7].values, (Words{"fast", "0.5", "2"}));
  EXPECT_EQ(plan.runs[0].scene.run.duration, 1e-3);
  EXPECT_EQ(plan.runs[7].scene.run.duration, 2e-3);
  EXPECT_EQ(plan.runs[7].scene.grains[0].velocity, (base::Vec3d{0, 0, 1}));
  EXPECT_EQ(plan.runs[7].scene.run.seed, 2);
  EXPECT_EQ(plan.runs[7].scene.run.skin, 0.5);
}

TEST_F(Sweep, ACaseMaySetWhatOneValueSetsForTheOthers) {
  SweepLists lists;
  lists.cases = {"base", "long: run.duration=2e-3"};
  lists.sets = {"run.duration=1e-4"};
  SweepOptions o = options();
  o.jobs = 2; // the runs share the threads, regardless of --threads
  const SweepPlan plan = planSweep(scene(), lists, {"run.threads=0", "run.device=cpu"});
  EXPECT_EQ(plan.runs[0].scene.run.duration, 1e-4);
  EXPECT_EQ(plan.runs[1].scene.run.duration, 2e-3);
  EXPECT_EQ(runSweep(plan, o), 0);
  lists.sets = {"run.duration=1e-4,2e-4"};
  EXPECT_THROW(planSweep(scene(), lists), base::InputError);
}

TEST_F(Sweep, WrongCasesAreFoundBeforeAnythingRuns) {
  const auto wrong = [&](const Words& cases, const Words& sets, int seeds) {
    SweepLists lists;
    lists.cases = cases, lists.sets = sets, lists.seeds = seeds;
    EXPECT_THROW(planSweep(scene(), lists), base::InputError) << cases[0];
  };
  wrong({""}, {}, 0);
  wrong({": run.seed=1"}, {}, 0);
  wrong({"run.seed=1"}, {}, 0); // no name
  wrong({"a: run.seed"}, {}, 0);
  wrong({"a: run.seed="}, {}, 0);
  wrong({"a", "a: run.seed=1"}, {}, 0);
  wrong({"a: run.seed=1, run.seed=2"}, {}, 0);
  wrong({"a: run.seed=1"}, {"run.seed=1,2"}, 0);
  wrong({"a: run.seed=1"}, {}, 2);
  wrong({"a: run.sead=1"}, {}, 0);
  for (const char* name : {".", "..", "/", "\u00fc", "<b>", "a\tb", "summary.csv", "summary.png", "intervals.csv"})
    wrong({name}, {}, 0);
}

TEST_F(Sweep, LeavesAFolderARunAndASummary) {
  EXPECT_EQ(sweep({"run.seed=1,2"}, 2), 0);
  for (const char* run : {"seed=1", "seed=2"})
    for (const char* file : {"results.h5", "timeseries.csv", "manifest.json", "scene.toml", "log.txt"})
      EXPECT_TRUE(fs::exists(out() / run / file)) << run << "/" << file;
  const Csv csv(out() / "summary.csv");
  ASSERT_EQ(csv.rows.size(), 2u);
  EXPECT_EQ(csv.at(1, "run"), "seed=2");
  EXPECT_EQ(csv.at(1, "run.seed"), "2");
  EXPECT_EQ(csv.at(1, "status"), "finished");
  EXPECT_EQ(csv.at(1, "steps"), "100");
  EXPECT_EQ(csv.at(1, "state hash").size(), 16u);
  EXPECT_EQ(csv.at(0, "state hash"), csv.at(1, "state hash")) << "a single grain does not depend on the seed";
  EXPECT_EQ(csv.at(0, "speed [m/s]"), "no such cell") << "no vehicle, no speed";
  EXPECT_GE(std::stod(csv.at(0, "wall time [s]")), 0);
}

TEST_F(Sweep, RunsThatEndBeforeTheyAreUpToSpeedAreNamed) {
  const std::string words = "sweep '" + std::string(GROUSER_SOURCE_DIR) +
                            "/runs/scenes/rigid_control.toml' --set output.plots=false --set output.picture=false "
                            "--set driver.drive_start=0.45 --set driver.drive_ramp=0.005 ";
  const Outcome brief = call(words + "--set run.duration=0.02 --set vehicle.sphere_radius=0.03 --seeds 2 --out brief",
                             "export GROUSER_CACHE=cache\n");
  EXPECT_EQ(brief.code, 0) << brief.errors;
  EXPECT_NE(brief.out.find("note      2 of 2 runs ended before the vehicle reached full speed, so they have no means"),
            std::string::npos)
      << brief.out;
  EXPECT_EQ(brief.out.find("slip [-]"), std::string::npos) << "a heading without values";
  EXPECT_EQ(call("sweep fall.toml --set run.seed=1,2").out.find("note"), std::string::npos) << "no vehicle, no drive";
}

TEST_F(Sweep, TheSummaryHasTheLoadsOnSurfaces) {
  // The grain touches it from the start.
  std::ofstream(scene(), std::ios::app) << "[[box]]\nname = \"belt\"\nposition = [0, 0, 0.49]\nsize = [1, 1, 1]\n"
                                           "material = \"glass\"\nvelocity = [0.1, 0, 0]\n";
  ASSERT_EQ(sweep({"run.duration=0.05", "run.output_interval=1e-3", "box.0.velocity.0=0.1,0.2"}), 0);
  const Csv csv(out() / "summary.csv");
  const double weight = 2500 * 4.0 / 3 * 3.14159265 * 1e-6 * 9.81;
  for (std::size_t row = 0; row < 2; ++row) {
    const auto number = [&](const char* column) { return std::stod(csv.at(row, column)); };
    EXPECT_EQ(csv.at(row, "run"), row == 0 ? "box.0.velocity.0=0.1" : "box.0.velocity.0=0.2");
    EXPECT_EQ(number("steady from [s]"), 0.025);
    EXPECT_NEAR(number("belt force z [N]"), -weight, 0.05 * weight) << "at rest except for residual settling motion";
    EXPECT_NEAR(number("belt position x at the end [m]"), row == 0 ? 0.005 : 0.01, 1e-12);
    EXPECT_EQ(number("belt force y [N]"), 0);
    EXPECT_NEAR(number("belt torque z [N m]"), 0, 1e-9) << "grain and centre are in one plane";
  }
}

TEST_F(Sweep, CalledAgainRunsOnlyWhatIsMissingHalfDoneOrOfAnotherScene) {
  ASSERT_EQ(sweep({"run.seed=1,2"}), 0);
  const auto one = ended("seed=1"), two = ended("seed=2");
  // One more value, and a run killed halfway.
  std::string manifest = contents(out() / "seed=2/manifest.json");
  manifest.replace(manifest.find("finished"), 8, "running");
  std::ofstream(out() / "seed=2/manifest.json") << manifest;
  EXPECT_NE(messageOf([&] { sweep({"run.seed=1,2,3"}); }).find("seed=2/manifest.json: wrong checksum"),
            std::string::npos);
  EXPECT_EQ(contents(out() / "seed=2/manifest.json"), manifest) << "a damaged run is not deleted";
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(manifest);
  json.erase("checksum");
  std::ofstream(out() / "seed=2/manifest.json") << json.dump(2);
  ASSERT_EQ(sweep({"run.seed=1,2,3"}), 0);
  EXPECT_EQ(ended("seed=1"), one);
  EXPECT_NE(ended("seed=2"), two);
  EXPECT_EQ(Csv(out() / "summary.csv").at(2, "status"), "finished");
  // Threads do not change the scene; a longer duration does.
  SweepOptions o = options();
  ASSERT_EQ(runSweep(planSweep(scene(), {{"run.seed=1,2,3"}}, {"run.threads=2"}), o), 0);
  EXPECT_EQ(ended("seed=1"), one);
  writeScene("2e-3");
  ASSERT_EQ(sweep({"run.seed=1,2,3"}), 0);
  EXPECT_NE(ended("seed=1"), one);
  EXPECT_EQ(Csv(out() / "summary.csv").at(0, "steps"), "200");
}

TEST_F(Sweep, SeedsGiveIntervalsAndDifferences) {
  // A named box at a height independent of the seed: each case's interval has zero width, and the force on a box
  // with two grains is twice that with one.
  std::ofstream(scene(), std::ios::app) << "[[box]]\nname = \"pan\"\nposition = [0, 0, 0.49]\nsize = [1, 1, 1]\n"
                                           "material = \"glass\"\n";
  SweepLists lists;
  lists.cases = {"light", "heavy: material.glass.density=5000"};
  lists.sets = {"run.duration=0.05", "run.output_interval=1e-3"}, lists.seeds = 3;
  ASSERT_EQ(runSweep(planSweep(scene(), lists), options()), 0);
  const Csv csv(out() / "intervals.csv");
  int seen = 0;
  for (std::size_t row = 0; row < csv.rows.size(); ++row) {
    if (csv.at(row, "figure") != "pan force z [N]") continue;
    ++seen;
    EXPECT_EQ(csv.at(row, "case"), seen == 1 ? "light" : "heavy");
    EXPECT_EQ(csv.at(row, "seeds"), "3");
    EXPECT_EQ(csv.number(row, "half width"), 0);
    EXPECT_NEAR(csv.number(row, "difference to the first [-]"), seen == 1 ? 0 : 1, 0.1);
    EXPECT_NEAR(csv.number(row, "half width of the difference [-]"), 0, 1e-14) << "except for rounding of the mean";
  }
  EXPECT_EQ(seen, 2);
  EXPECT_EQ(csv.at(0, "run.seed"), "no such cell");
}

TEST_F(Sweep, NoRunIsBegunAfterTheTimeGivenAndACallAgainGoesOn) {
  SweepOptions o = options();
  o.seconds = 1e-9;
  EXPECT_EQ(runSweep(planSweep(scene(), {{"run.seed=1,2"}}), o), 0);
  EXPECT_EQ(Csv(out() / "summary.csv").at(1, "status"), "pending");
  EXPECT_FALSE(fs::exists(out() / "seed=1"));
  EXPECT_EQ(sweep({"run.seed=1,2"}), 0);
  EXPECT_EQ(Csv(out() / "summary.csv").at(1, "status"), "finished");
}

TEST_F(Sweep, ForceRunsAll) {
  ASSERT_EQ(sweep({"run.seed=1,2"}), 0);
  const auto one = ended("seed=1");
  ASSERT_EQ(sweep({"run.seed=1,2"}, 1, true), 0);
  EXPECT_NE(ended("seed=1"), one);
}

TEST_F(Sweep, AFailedRunStopsNoOther) {
  EXPECT_EQ(sweep({"grain.0.velocity=[0,0,1],[0,0,-145],[0,0,2]"}), 1);
  const Csv csv(out() / "summary.csv");
  EXPECT_EQ(csv.at(0, "status"), "finished");
  EXPECT_EQ(csv.at(1, "status"), "failed");
  EXPECT_NE(csv.at(1, "message").find("pass through"), std::string::npos) << csv.at(1, "message");
  EXPECT_EQ(csv.at(1, "state hash"), "");
  EXPECT_EQ(csv.at(2, "status"), "finished");
  EXPECT_EQ(csv.rows[1].size(), csv.header.size()) << "a message with commas occupies one cell";
}

TEST_F(Sweep, ARunThatIsKilledIsAFailedRun) {
  const fs::path killer = folder_ / "killer";
  std::ofstream(killer) << "#!/bin/sh\nkill -9 $$\n";
  fs::permissions(killer, fs::perms::owner_all);
  SweepOptions o = options();
  o.program = killer;
  EXPECT_EQ(runSweep(planSweep(scene(), {{"run.seed=1,2"}}), o), 2);
  EXPECT_NE(Csv(out() / "summary.csv").at(0, "message").find("signal 9"), std::string::npos);
}

TEST_F(Sweep, WithoutItsProgramIsAnErrorThatNamesIt) {
  SweepOptions o = options();
  o.program = folder_ / "none";
  try {
    runSweep(planSweep(scene(), {{"run.seed=1,2"}}), o);
    ADD_FAILURE() << "not thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), o.program.string() + " cannot be started: No such file or directory");
  }
}

TEST_F(Sweep, AnErrorEndsItsRunsWhichSaveTheirWork) {
  const fs::path saves = folder_ / "saves";
  put(saves,
      "#!/bin/sh\ntrap 'sleep 0.2; echo saved; exit' TERM\necho ready\nfor k in $(seq 400); do sleep 0.05; done\n");
  fs::permissions(saves, fs::perms::owner_all);
  SweepOptions o = options();
  o.program = saves, o.jobs = 2;
  const SweepPlan plan = planSweep(scene(), {Words{"run.seed=1,2"}});
  const auto logs = [&] { return contents(out() / "seed=1/log.txt") + contents(out() / "seed=2/log.txt"); };
  const auto fails = [&](const std::vector<SweepOutcome>& outcomes) {
    if (outcomes[1].status != output::RunStatus::running) return;
    for (int look = 0; look < 500 && logs() != "ready\nready\n"; ++look) usleep(10'000);
    throw std::runtime_error("the table cannot be written");
  };
  EXPECT_THROW(runMissing(plan, o, "fails", fails), std::runtime_error);
  EXPECT_EQ(logs(), "ready\nsaved\nready\nsaved\n");
}

TEST_F(Sweep, TablesOfAnEarlierOneDoNotStay) {
  ASSERT_EQ(call("sweep fall.toml --set material.glass.restitution=0.3,0.9 --seeds 2 --out s").code, 0);
  ASSERT_TRUE(fs::exists(folder_ / "s/intervals.csv"));
  ASSERT_EQ(call("sweep fall.toml --set material.glass.restitution=0.5,0.6 --out s").code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "s/intervals.csv")) << "other values";
}

TEST_F(Sweep, TheFolderOfARunIsNone) {
  ASSERT_EQ(call("run fall.toml --out one").code, 0);
  const Outcome o = call("sweep fall.toml --set run.seed=1,2 --out one");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.error().find("one: contains the results of a run"), std::string::npos) << o.errors;
  EXPECT_FALSE(fs::exists(folder_ / "one/summary.csv"));
  EXPECT_EQ(call("sweep fall.toml --set output.folder=a,b").code, 2);
}

TEST_F(Sweep, WhoeverStartedItMayIgnoreEndsOfProcesses) {
  const Outcome o = shell("/usr/bin/python3 -c \"import os, signal, sys; signal.signal(signal.SIGCHLD, "
                          "signal.SIG_IGN); os.execv(sys.argv[1], sys.argv[1:])\" \"$grouser\" sweep fall.toml "
                          "--set run.seed=1,2 --out s");
  EXPECT_EQ(o.code, 0) << o.errors;
}

TEST_F(Sweep, RunsAtTheSameTimeTakeTheGpusInTurn) {
  unsetenv("GROUSER_GPU");
  // A program that only prints its GPU; slow on the first.
  const fs::path program = folder_ / "says.sh";
  std::ofstream(program) << "#!/bin/sh\necho gpu $GROUSER_GPU\n[ $GROUSER_GPU = 1 ] || sleep 2\n";
  fs::permissions(program, fs::perms::owner_all);
  SweepOptions o = options();
  o.program = program, o.jobs = 2;
  const SweepPlan plan = planSweep(scene(), {Words{"grain.0.radius=0.01,0.011,0.012,0.013"}});
  runMissing(plan, o, "gpus", [](const std::vector<SweepOutcome>&) {});
  std::vector<std::string> given;
  for (const SweepRun& run : plan.runs) given.push_back(contents(out() / run.name / "log.txt"));
  // Each new run takes the place of a finished one.
  EXPECT_EQ(given, (std::vector<std::string>{"gpu 0\n", "gpu 1\n", "gpu 1\n", "gpu 1\n"}));
}

TEST_F(Sweep, AWrongFirstGpuTakesNothingAway) {
  ASSERT_EQ(sweep({"grain.0.radius=0.01"}), 0);
  const auto before = ended("radius=0.01");
  setenv("GROUSER_GPU", "first", 1);
  EXPECT_THROW(sweep({"grain.0.radius=0.01"}, 1, true), base::InputError);
  unsetenv("GROUSER_GPU");
  ASSERT_TRUE(fs::exists(out() / "radius=0.01" / "results.h5"));
  EXPECT_EQ(ended("radius=0.01"), before);
}

TEST_F(Sweep, FoldersOfOtherOriginAreKept) {
  fs::create_directories(out() / "seed=2");
  std::ofstream(out() / "seed=2/thesis.txt") << "precious";
  EXPECT_THROW(sweep({"run.seed=1,2"}), base::InputError);
  EXPECT_FALSE(fs::exists(out() / "seed=1")) << "error before any run";
  EXPECT_EQ(sweep({"run.seed=1,2"}, 1, true), 0);
  EXPECT_EQ(contents(out() / "seed=2/thesis.txt"), "precious");
}

TEST_F(Sweep, TablesOfOtherOriginAreKept) {
  fs::create_directories(out());
  for (const char* name : {"summary.csv", "summary.png", "intervals.csv"}) {
    put(out() / name, "run,marks,status\nthesis,1,good\n");
    const Outcome o = call("sweep fall.toml --set run.seed=1,2 --out out");
    EXPECT_EQ(o.code, 2) << name;
    EXPECT_NE(o.error().find(std::string("out/") + name + ": exists but was not written by a sweep"), std::string::npos)
        << o.errors;
    EXPECT_FALSE(fs::exists(out() / "seed=1")) << "error before any run";
    EXPECT_EQ(contents(out() / name), "run,marks,status\nthesis,1,good\n");
    fs::remove(out() / name);
  }
  put(out() / "summary.csv", "");
  EXPECT_EQ(sweep({"run.seed=1,2"}, 1, true), 0);
  EXPECT_EQ(sweep({"run.seed=1,2"}), 0) << "its own folder";
}

TEST_F(Sweep, ExitCodesAreZeroTwoAndThree) {
  const Outcome sound = call("sweep fall.toml --set run.seed=1,2");
  EXPECT_EQ(sound.code, 0) << sound.errors;
  EXPECT_TRUE(fs::exists(folder_ / "out/fall_sweep/seed=2/results.h5"));
  EXPECT_NE(sound.out.find("run 2 of 2  seed=2"), std::string::npos) << sound.out;
  EXPECT_EQ(call("sweep fall.toml --set run.seed=1,-1 --out a").code, 2);
  EXPECT_FALSE(fs::exists(folder_ / "a"));
  const Outcome unsound = call("sweep fall.toml --set 'grain.0.velocity=[0,0,1],[0,0,-145]' --out b");
  EXPECT_EQ(unsound.code, 3);
  EXPECT_NE(unsound.errors.find("1 of 2 runs failed"), std::string::npos) << unsound.errors;
}

TEST_F(Sweep, StoppedOneEndsItsRunsAndSaysWhatIsReady) {
  writeScene("1e-3");
  const Outcome stopped = shell("\"$grouser\" sweep fall.toml --set run.duration=1e-3,50 --jobs 2 --out s & pid=$!\n"
                                "while [ ! -s s/duration=50/timeseries.csv ] || ! grep -q finished "
                                "s/duration=1e-3/manifest.json; do sleep 0.01; done\nsleep 0.2\n"
                                "kill -TERM $pid\nwait $pid\nexit $?");
  EXPECT_EQ(stopped.code, 143) << stopped.errors;
  EXPECT_NE(stopped.errors.find("grouser: stopped by SIGTERM after 1 of 2 runs; resume with: "), std::string::npos)
      << stopped.errors;
  EXPECT_NE(contents(folder_ / "s/duration=50/manifest.json").find("\"stopped\""), std::string::npos);
}

TEST_F(Sweep, AFailureThatStaysIsNotRunAgain) {
  SweepPlan plan = planSweep(scene(), {{"grain.0.velocity=[0,0,1],[0,0,-145]"}});
  // Each run contains its scene: the plan's is not used.
  plan.scene = folder_ / "none.toml";
  for (SweepRun& run : plan.runs) run.file = scene();
  SweepOptions o = options();
  o.keepFailures = true;
  const auto again = [&] { return runMissing(plan, o, "sweep", [](const std::vector<SweepOutcome>&) {}); };
  const std::vector<SweepOutcome> first = again();
  ASSERT_EQ(first[0].status, output::RunStatus::finished) << first[0].message;
  ASSERT_EQ(first[1].status, output::RunStatus::failed);
  const std::string fast = plan.runs[1].name;
  const auto before = ended(fast);
  const std::vector<SweepOutcome> second = again();
  EXPECT_EQ(ended(fast), before);
  EXPECT_EQ(second[1].status, output::RunStatus::failed);
  EXPECT_EQ(second[1].message, first[1].message);
  o.keepFailures = false;
  again();
  EXPECT_NE(ended(fast), before);
}

} // namespace
} // namespace grouser::sweeps
