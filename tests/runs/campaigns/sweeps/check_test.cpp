// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/check_cases.hpp"
#include "runs/campaigns/sweeps/check_report.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "tests/runs/campaigns/sweeps/check_fixture.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <string>

namespace grouser::sweeps {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

TEST_F(Check, AFallsErrorByTheStepIsFoundWithItsOrder) {
  writeFall();
  const Outcome o = call("check fall.toml --out c");
  ASSERT_EQ(o.code, 0) << o.errors;
  const Json f = figure(json("c/check.json"), "grain.0.position.z [m] at the end");
  const double g = 9.81, duration = 0.1, step = 1e-3;
  EXPECT_NEAR(f.at("value").get<double>(), 1 - 0.5 * g * duration * (duration + step), 1e-8);
  const Json e = errorBy(f, "step");
  EXPECT_NEAR(e.at("order").get<double>(), 1, 0.01);
  EXPECT_NEAR(e.at("change").get<double>(), 0.5 * g * duration * step, 1e-7); // the exact error
  EXPECT_NEAR(f.at("bar").get<double>(), 1.25 * 0.5 * g * duration * step, 1e-6);
}

TEST_F(Check, SeriesCarryTheirBarsAtEveryTime) {
  writeFall();
  ASSERT_EQ(call("check fall.toml --axes step --out c").code, 0);
  std::ifstream file(folder_ / "c/series.csv");
  std::string head, line, last;
  std::getline(file, head);
  int rows = 0;
  while (std::getline(file, line)) last = line, ++rows;
  EXPECT_EQ(rows, 11);
  const std::string name = "grain.0.position.z [m]";
  EXPECT_NE(head.find("," + name + "," + name + " seeds +-," + name + " step +-," + name + " both +-"),
            std::string::npos)
      << head;
}

TEST_F(Check, TheFilesAreTheSameForOneJobTwoJobsAndSeveralCalls) {
  writeHeap();
  ASSERT_EQ(call("check heap.toml --seeds 3 --out one").code, 0);
  ASSERT_EQ(call("check heap.toml --seeds 3 --jobs 2 --out two").code, 0);
  // A call with a short time limit, one after the loss of a run, and one that completes the check.
  call("check heap.toml --seeds 3 --out some --seconds 0.05");
  fs::remove(folder_ / "some/base,seed=1/manifest.json");
  ASSERT_EQ(call("check heap.toml --seeds 3 --out some").code, 0);
  for (const char* name : {kCheckFile, kCheckSeries}) {
    const std::string text = contents((folder_ / "one" / name).string());
    ASSERT_FALSE(text.empty());
    EXPECT_EQ(text, contents((folder_ / "two" / name).string())) << name;
    EXPECT_EQ(text, contents((folder_ / "some" / name).string())) << name;
  }
  const Json check = json("one/check.json");
  EXPECT_EQ(check.at("skin"), "bitwise identical");
  EXPECT_EQ(check.at("seeds_matter"), true);
  const Json f = figure(check, "ground force z [N]");
  EXPECT_EQ(f.at("seeds"), 3);
  EXPECT_GT(f.at("seeds_half_width").get<double>(), 0);
  EXPECT_GT(f.at("bar").get<double>(), f.at("seeds_half_width").get<double>());
}

TEST_F(Check, WhatCannotRunIsShownAndTheOthersGoOn) {
  writeHeap();
  // Twice the scene's step exceeds the limit of its contacts.
  const Outcome o = call("check heap.toml --seeds 2 --axes step --set run.time_step=4e-4 --out c");
  ASSERT_EQ(o.code, 0) << o.errors;
  bool refused = false;
  const Json check = json("c/check.json");
  for (const Json& c : check.at("cases"))
    if (c.at("name") == "step_times_2") {
      refused = c.at("status") == "refused";
      EXPECT_NE(c.at("message").get<std::string>().find("time_step"), std::string::npos);
    }
  EXPECT_TRUE(refused);
  EXPECT_NE(o.out.find("step_times_2"), std::string::npos);
}

TEST_F(Check, ABudgetNamesWhatItLeavesOut) {
  writeHeap();
  const std::string words =
      "check heap.toml --seeds 4 --budget 1s --set run.time_step=1e-5 --set run.duration=0.4 --out c";
  const auto choice = [](const std::string& out) {
    const std::size_t at = out.find("budget    ");
    return at == std::string::npos ? out : out.substr(at, out.find('\n', at) - at);
  };
  const Outcome o = call(words);
  ASSERT_EQ(o.code, 0) << o.errors;
  EXPECT_NE(choice(o.out).find("skipped: "), std::string::npos) << o.out;
  bool named = false;
  const Json check = json("c/check.json");
  for (const Json& c : check.at("cases")) named = named || c.at("status") == "left out";
  EXPECT_TRUE(named);
  // A second call selects the same runs, regardless of the cost of the first.
  const Outcome again = call(words);
  ASSERT_EQ(again.code, 0) << again.errors;
  EXPECT_EQ(choice(again.out), choice(o.out));
}

/// A bed of 90 grains that settles before each run; `more` adds keys.
std::string bedScene(const std::string& more = "") {
  return "version = 1\n[run]\nduration = 0.01\noutput_interval = 0.005\nthreads = 1\n[material.sand]\nstiffness = "
         "1e4\n[terrain]\nheightmap = \"" +
         std::string(GROUSER_SOURCE_DIR) +
         "/assets/heightmaps/flat.png\"\nsize = [0.2, 0.12]\nheight_range = [0, 0]\nmaterial = \"sand\"\n"
         "grain_radius = 0.01\ndepth = 0.05\nsettle_time_limit = 5\n[output]\nplots = false\npicture = false\n"
         "frames = false\n" +
         more;
}

int count(const std::string& text, const std::string& what) {
  int found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

TEST_F(Check, TheFirstRunOfABudgetSettlesItsBedAlthoughThatOfAnotherSeedIsKept) {
  std::ofstream(folder_ / "bed.toml") << bedScene();
  const std::string keep = "export GROUSER_CACHE=\"$PWD/kept\"; ";
  const auto settling = [&](const std::string& folder) {
    return json(folder + "/manifest.json").at("figures").at("wall_settling_s").get<double>();
  };
  ASSERT_EQ(call("run bed.toml --out r", keep).code, 0);
  EXPECT_GT(settling("r"), 0);
  ASSERT_EQ(call("run bed.toml --out again", keep).code, 0);
  EXPECT_EQ(settling("again"), 0) << "its bed was cached";
  const Outcome o = call("check bed.toml --axes skin --seeds 2 --budget 60s --out c", keep);
  ASSERT_EQ(o.code, 0) << o.errors;
  EXPECT_NE(o.out.find("run 1 of 1  base,seed=2"), std::string::npos) << o.out; // the run's own was cached
  EXPECT_GT(json("c/choice.json").at("settling_s").get<double>(), 0);
  // If all beds are cached, their steps determine the settling time.
  ASSERT_EQ(call("check bed.toml --axes skin --seeds 2 --budget 60s --out d", keep).code, 0);
  EXPECT_GT(json("d/choice.json").at("settling_s").get<double>(), 0);
}

TEST_F(Check, AForcedBudgetMakesItsFirstRunOnce) {
  writeHeap();
  const std::string words = "check heap.toml --seeds 2 --axes skin --budget 60s --out c";
  ASSERT_EQ(call(words).code, 0);
  const Outcome o = call(words + " --force");
  ASSERT_EQ(o.code, 0) << o.errors;
  for (const char* run : {"base,seed=1", "base,seed=2", "skin,seed=1"})
    EXPECT_EQ(count(o.out, std::string(run) + std::string(28 - std::string(run).size(), ' ') + " finished in"), 1)
        << run << "\n"
        << o.out;
}

TEST_F(Check, WhatBoundsABedAtItsSidesLeavesTheWidthOut) {
  const auto width = [](const std::string& more) -> std::string {
    const auto file = std::filesystem::temp_directory_path() / fmt::format("grouser_sides_{}.toml", getpid());
    std::ofstream(file) << bedScene(more);
    const scene::Scene scene = setup::loadScene(file, {});
    const CheckCases cases = checkCases(file, {}, scene);
    fs::remove(file);
    for (const CheckCase& c : cases.cases)
      if (c.axis == CheckAxis::width) return "run";
    for (const CheckOmission& o : cases.omitted)
      if (o.axis == CheckAxis::width) return o.why;
    return "";
  };
  const auto plane = [](const char* point, const char* normal) {
    return fmt::format("[[plane]]\nname = \"side\"\npoint = {}\nnormal = {}\nmaterial = \"sand\"\n", point, normal);
  };
  const auto box = [](const char* position, const char* size) {
    return fmt::format("[[box]]\nposition = {}\nsize = {}\nmaterial = \"sand\"\n", position, size);
  };
  EXPECT_EQ(width(""), "run");
  EXPECT_EQ(width(plane("[0, 0.06, 0]", "[0, -1, 0]")),
            "plane 0 (side) is at a side of the bed and would not move with it");
  EXPECT_EQ(width(plane("[0, 0, -0.1]", "[0, 0, 1]")), "run") << "a level plane looks the same beside the bed";
  EXPECT_EQ(width(box("[0.1, 0, 0]", "[0.04, 0.04, 0.3]")), "run") << "a post inside it";
  EXPECT_EQ(width(box("[0.1, -0.07, 0]", "[0.3, 0.02, 0.2]")).substr(0, 14), "box 0 is at a ");
  EXPECT_EQ(width(box("[0.1, -0.2, 0]", "[0.3, 0.02, 0.2]")), "run") << "beyond the wider bed";
}

TEST_F(Check, ARunSaysWhetherItsSceneHasBeenChecked) {
  writeFall();
  const std::string keep = "export GROUSER_CACHE=$PWD/cache; ";
  const Outcome before = call("run fall.toml --out r", keep);
  ASSERT_EQ(before.code, 0) << before.errors;
  EXPECT_NE(before.out.find(", run\n  grouser check "), std::string::npos) << before.out;
  ASSERT_EQ(call("check fall.toml --out c", keep).code, 0);
  const Outcome after = call("run fall.toml --out r --force", keep);
  EXPECT_EQ(after.out.find("grouser check fall"), std::string::npos) << after.out;
  EXPECT_NE(after.out.find("grain.0.position.z [m] at the end"), std::string::npos) << after.out;
  EXPECT_NE(after.out.find(" +- "), std::string::npos);
  // An inferior check does not replace a better one.
  ASSERT_EQ(call("check fall.toml --axes precision --out less", keep).code, 0);
  const Outcome still = call("run fall.toml --out r --force", keep);
  EXPECT_NE(still.out.find("error bars from step"), std::string::npos) << still.out;
  // They do not apply to another scene.
  const Outcome other = call("run fall.toml --out r --force --set run.time_step=5e-4", keep);
  EXPECT_NE(other.out.find("grouser check "), std::string::npos) << other.out;
}

TEST_F(Check, BarsOfSomeFiguresDoNotTakeThePlaceOfThoseOfAll) {
  writeFall();
  const std::string keep = "export GROUSER_CACHE=$PWD/cache; ", of = " --of grain.0.position.z_at_the_end --out some";
  const auto keptFolder = [&] {
    for (const auto& file : fs::directory_iterator(folder_ / "cache"))
      if (file.path().filename().string().starts_with("check-"))
        return fs::path(Json::parse(contents(file.path().string())).at("folder").get<std::string>())
            .filename()
            .string();
    return std::string();
  };
  ASSERT_EQ(call("check fall.toml --bar 5%" + of, keep).code, 0);
  EXPECT_EQ(keptFolder(), "some");
  ASSERT_EQ(call("check fall.toml --axes precision --out all", keep).code, 0);
  EXPECT_EQ(keptFolder(), "all") << "fewer runs, but all figures";
  ASSERT_EQ(call("check fall.toml --bar 5% --force" + of, keep).code, 0);
  EXPECT_EQ(keptFolder(), "all");
}

TEST_F(Check, ARunOfOnesOwnIsNotWrittenOver) {
  writeFall();
  ASSERT_EQ(call("run fall.toml --out mine/base").code, 0);
  const std::string before = contents((folder_ / "mine/base/manifest.json").string());
  EXPECT_EQ(call("check fall.toml --out mine").code, 2);
  EXPECT_EQ(contents((folder_ / "mine/base/manifest.json").string()), before);
}

TEST_F(Check, AFileOfTheSceneThatHasChangedIsNoticed) {
  std::ofstream(folder_ / "ball.off") << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  std::ofstream(folder_ / "mesh.toml")
      << "version = 1\n[run]\nduration = 0.01\ntime_step = 1e-4\noutput_interval = 0.01\nthreads = 1\n"
         "[material.glass]\nstiffness = 1e4\n[[grain]]\nposition = [5, 5, 5]\nradius = 0.1\nmaterial = \"glass\"\n"
         "[[mesh]]\nfile = \"ball.off\"\nsphere_radius = 0.05\nposition = [0, 0, 0]\nmaterial = \"glass\"\n"
      << kQuiet;
  ASSERT_EQ(call("check mesh.toml --axes step --out c").code, 0);
  const Outcome again = call("check mesh.toml --axes step --out c");
  EXPECT_NE(again.out.find("base                         already finished"), std::string::npos) << again.out;
  std::ofstream(folder_ / "ball.off") << "OFF\n4 4 0\n0 0 0\n2 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  const Outcome changed = call("check mesh.toml --axes step --out c");
  EXPECT_EQ(changed.code, 0) << changed.errors;
  EXPECT_EQ(changed.out.find("already finished"), std::string::npos) << changed.out;
}

TEST_F(Check, WrongWordsAreRefusedBeforeAnythingIsWritten) {
  writeFall();
  const std::pair<const char*, const char*> cases[] = {{"--budget soon", "--budget soon"},
                                                       {"--axes step,colour", "--axes colour"},
                                                       {"--set run.seed=4", "run.seed"},
                                                       {"--seeds 1", "--seeds"},
                                                       {"--seeds 1001", "--seeds"},
                                                       {"--bar 0", "--bar"},
                                                       {"--jobs 0", "--jobs"},
                                                       {"--set run.time_step=-1", "time_step"}};
  for (const auto& [words, named] : cases) {
    const Outcome o = call(std::string("check fall.toml --out c ") + words);
    EXPECT_EQ(o.code, 2) << words;
    EXPECT_NE(o.errors.find(named), std::string::npos) << o.errors;
    EXPECT_FALSE(fs::exists(folder_ / "c")) << words;
  }
  fs::create_directory(folder_ / "mine");
  std::ofstream(folder_ / "mine/check.json") << "notes\n";
  EXPECT_EQ(call("check fall.toml --out mine").code, 2);
  EXPECT_EQ(contents((folder_ / "mine/check.json").string()), "notes\n");
  EXPECT_EQ(call("check missing.toml").code, 2);
}

TEST_F(Check, TheBarsOfScenesWithAKnownTruthHoldIt) {
  const std::string script = std::string(GROUSER_SOURCE_DIR) + "/tests/check_coverage --variants 1 --scenes ";
  const Outcome held = shell(script + "bounce,pendulum,column --out held --program \"$grouser\"");
  EXPECT_EQ(held.code, 0) << held.out << held.errors;
  EXPECT_NE(held.out.find("all        3 of 3 covered"), std::string::npos) << held.out;
  // Detects a program with error bars 1000 times too small.
  std::ofstream(folder_ / "boast")
      << "#!/bin/sh\n'" << programUnderTest().string()
      << "' \"$@\" && sed -i 's/\"bar\": \\([0-9.]*\\)/\"bar\": 0.00\\1/' \"$4/check.json\"\n";
  fs::permissions(folder_ / "boast", fs::perms::owner_all);
  const Outcome boasted = shell(script + "pendulum --out boasted --program ./boast");
  EXPECT_EQ(boasted.code, 1) << boasted.out << boasted.errors;
}

TEST_F(Check, WhereNothingEndsItSaysWhy) {
  writeFall();
  // Passes through a plane at 100 m/s.
  const Outcome o = call("check fall.toml --axes step --out c --set grain.0.velocity='[0, 0, -9000]'");
  EXPECT_NE(o.code, 0);
  EXPECT_NE(o.errors.find("error"), std::string::npos);
}

} // namespace
} // namespace grouser::sweeps
