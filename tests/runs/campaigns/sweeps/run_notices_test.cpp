// SPDX-License-Identifier: BSD-3-Clause
// Warnings and notes of runs: each kind once, with the number of runs, in texts and files of all campaigns.
#include "runs/campaigns/sweeps/run_notices.hpp"
#include "runs/campaigns/sweeps/sweep_files.hpp"
#include "runs/scene/scene.hpp"
#include "tests/runs/csv_fixture.hpp"
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace grouser::sweeps {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

class RunNotices : public ProgramTest {
protected:
  SweepPlan plan_;

  void addRun(const std::string& name, const std::string& log) {
    plan_.runs.emplace_back().name = name;
    fs::create_directory(folder_ / name);
    put(folder_ / name / kRunLog, log);
  }
  static std::size_t count(const std::string& text, const std::string& words) {
    std::size_t found = 0;
    for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++found;
    return found;
  }
  /// A light body and a moving plane: the run warns that they pass through each other, which no check of the scene
  /// file itself reports.
  void writeBody() const {
    put(folder_ / "body.toml",
        "version = 1\n[run]\nduration = 0.01\ntime_step = 1e-4\noutput_interval = 0.002\nthreads = 1\n"
        "[material.glass]\nstiffness = 1e4\n[[grain]]\nposition = [0, 0, 0.5]\nradius = 0.01\nmaterial = \"glass\"\n"
        "[[body]]\nname = \"cube\"\nmass = 1\ninertia = [1, 1, 1]\nposition = [0, 0, 1]\nmaterial = \"glass\"\n"
        "[[body.shape]]\nkind = \"box\"\nsize = [0.1, 0.1, 0.1]\n"
        "[[plane]]\nname = \"lift\"\nnormal = [0, 0, 1]\npoint = [0, 0, 0]\nmaterial = \"glass\"\n"
        "velocity = [0, 0, -0.1]\n[output]\nplots = false\npicture = false\nframes = false\n");
  }
  static constexpr const char* kPasses = "bodies pass through planes, boxes, cylinders and meshes that move";
};

TEST_F(RunNotices, EachKindIsListedOnceWithItsRunsAndWarningsComeFirst) {
  addRun("a", "grouser: note: 3 grains fit in a pad\nWARNING: the speed varies from 0.1 to 2e-3 m/s\nresults a\n");
  addRun("b", "WARNING: the speed varies from 0.5 to 1 m/s\nWARNING: k_phi2 is not calibrated\n"
              "WARNING: k_phi2 is not calibrated\nnote      the bed is 0.2 m deep\n");
  addRun("c", "");
  const std::vector<RunNotice> all = runNotices(plan_, folder_);
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(noticesText(all, 3), "WARNING in 2 of 3 runs, e.g. a: the speed varies from 0.1 to 2e-3 m/s\n"
                                 "WARNING in 1 of 3 runs: k_phi2 is not calibrated\n"
                                 "note in 1 of 3 runs: 3 grains fit in a pad\n"
                                 "note in 1 of 3 runs: the bed is 0.2 m deep\n");
  const auto json = noticesJson(all);
  EXPECT_EQ(json[0].at("kind"), "warning");
  EXPECT_EQ(json[0].at("runs"), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(json[3].at("kind"), "note");
  EXPECT_EQ(noticesOfRun(plan_.runs[0], folder_),
            "note: 3 grains fit in a pad; WARNING: the speed varies from 0.1 to 2e-3 m/s");
  EXPECT_EQ(noticesOfRun(plan_.runs[2], folder_), "");
}

TEST_F(RunNotices, SinkagesOnRigidGroundAreExplainedOnceAndOnlyIfThereAreSome) {
  for (const char* name : {"scm", "rigid", "rigid2"}) {
    addRun(name, "");
    scene::Scene& scene = plan_.runs.back().scene;
    scene.vehicle.emplace(), scene.terrain.emplace();
    scene.terrain->kind = *name == 's' ? scene::TerrainKind::scm : scene::TerrainKind::rigid;
  }
  EXPECT_TRUE(runNotices(plan_, folder_).empty());
  const std::vector<RunNotice> all = runNotices(plan_, folder_, true);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].runs, (std::vector<std::string>{"rigid", "rigid2"}));
  EXPECT_EQ(noticesText(all, 3).find("note in 2 of 3 runs: shoes do not sink into rigid ground"), 0u);
  plan_.runs.erase(plan_.runs.begin() + 1, plan_.runs.end());
  EXPECT_TRUE(runNotices(plan_, folder_, true).empty());
}

TEST_F(RunNotices, CompareListsThemInItsTextAndFiles) {
  writeBody();
  const Outcome o = call("compare body.toml --contact penalty,complementarity --seeds 1 --out c");
  ASSERT_EQ(o.code, 0) << o.errors;
  const std::string words = std::string("WARNING in 2 of 2 runs: ") + kPasses;
  EXPECT_EQ(count(o.out, words), 1u) << o.out;
  EXPECT_EQ(contents(folder_ / "c/compare.txt").find(words), 0u) << "the first line";
  const auto json = nlohmann::json::parse(contents(folder_ / "c/compare.json"));
  EXPECT_EQ(json.at("notices").at(0).at("text").get<std::string>().find(kPasses), 0u);
  const std::string summary = contents(folder_ / "c/summary.csv");
  EXPECT_NE(summary.find(",warnings and notes\n"), std::string::npos) << summary;
  EXPECT_EQ(count(summary, kPasses), 2u) << summary;
}

TEST_F(RunNotices, CheckListsThemInItsTextAndFile) {
  writeBody();
  const Outcome o = call("check body.toml --axes step --out c");
  ASSERT_EQ(o.code, 0) << o.errors;
  EXPECT_EQ(count(o.out, std::string(" runs: ") + kPasses), 1u) << o.out;
  const auto json = nlohmann::json::parse(contents(folder_ / "c/check.json"));
  EXPECT_EQ(json.at("notices").at(0).at("kind"), "warning");
}

TEST_F(RunNotices, SweepHasThemInItsSummary) {
  writeBody();
  const Outcome o = call("sweep body.toml --set plane.0.velocity=[0,0,-0.1],[0,0,-0.2] --out s");
  ASSERT_EQ(o.code, 0) << o.errors;
  EXPECT_EQ(count(o.out, std::string("WARNING in 2 of 2 runs: ") + kPasses), 1u) << o.out;
  EXPECT_EQ(count(contents(folder_ / "s/summary.csv"), kPasses), 2u);
}

TEST_F(RunNotices, ASecondCampaignInAFolderLearnsWhoUsesIt) {
  writeBody();
  const Outcome o = shell(R"(
"$grouser" sweep body.toml --set run.duration=1000,1001 --set 'run.gravity=[0,0,0]' --out s >first.txt 2>&1 &
first=$!
for i in $(seq 600); do [ -e s/duration=1000/timeseries.csv ] && break; sleep 0.05; done
"$grouser" sweep body.toml --set run.skin=0.3,0.5 --out s; echo "code $?"
"$grouser" check body.toml --out s; echo "code $?"
"$grouser" compare body.toml --contact penalty,complementarity --out s; echo "code $?"
"$grouser" events --only grade --levels 0.1 --out s; echo "code $?"
"$grouser" run body.toml --out s; echo "code $?"
"$grouser" sweep body.toml --set run.skin=0.3,0.5 --force --out s; echo "code $?"
ls s
kill $first; wait $first; echo "first $first")");
  EXPECT_EQ(count(o.out, "code 2\n"), 6u) << o.out << o.errors;
  const std::string first = o.out.substr(o.out.rfind("first ") + 6);
  EXPECT_EQ(count(o.errors, "s: in use by process " + first.substr(0, first.find('\n')) + " since 20"), 6u) << o.errors;
  EXPECT_EQ(count(o.errors, "--force"), 0u) << o.errors;
  EXPECT_EQ(o.out.find("skin="), std::string::npos) << "nothing is written: " << o.out;
}

TEST_F(RunNotices, EqualValuesAreRefusedWithBothSpellings) {
  writeBody();
  const auto refused = [&](const std::string& list, const std::string& words) {
    const Outcome o = call("sweep body.toml --out s " + list);
    EXPECT_EQ(o.code, 2) << list << o.out;
    EXPECT_NE(o.error().find(words), std::string::npos) << o.errors;
    EXPECT_FALSE(fs::exists(folder_ / "s")) << list;
  };
  refused("--set run.skin=0.1,0.10,1e-1", "0.1 and 0.10 are the same value; remove one");
  refused("--set run.skin=0.2,1e-1,+0.1", "1e-1 and +0.1 are the same value; remove one");
  refused("--set run.seed=1000,1_000", "1000 and 1_000 are the same value");
  refused("--set 'plane.0.velocity=[0, 0, -0.1],[0,0.0,-1e-1]'", "are the same value");
  refused("--set 'grain.0.material=glass,\"glass\"'", "are the same value");
  refused("--case 'a: run.skin=0.3' --case 'b: run.skin=0.30'", "the runs a and b are equal");
  const Outcome steps = call("compare body.toml --contact penalty,complementarity --steps 0.5,1,0.50 --out s");
  EXPECT_EQ(steps.code, 2);
  EXPECT_NE(steps.error().find("--steps: 0.5 and 0.5 are the same value"), std::string::npos) << steps.errors;
}

} // namespace
} // namespace grouser::sweeps
