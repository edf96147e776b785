// SPDX-License-Identifier: BSD-3-Clause
// Soils on the command line, and in result files.
#include "runs/commands/soils.hpp"
#include "tests/runs/program_fixture.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <string>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

class SoilsOfUser : public ProgramTest {
protected:
  void SetUp() override {
    ProgramTest::SetUp();
    fs::create_directories(folder_ / "soils");
    std::string own = contents(fs::path(GROUSER_SOURCE_DIR) / "assets/soils/reference_spheres.toml");
    put(folder_ / "soils/mine.toml", own);
    put(folder_ / "grain.toml",
        "version = 1\n[run]\nduration = 1e-3\ntime_step = 1e-5\n[[grain]]\nposition = [0, 0, 1]\nradius = 0.0135\n"
        "material = \"mine\"\n[output]\nplots = false\npicture = false\n");
  }
};

TEST(SoilsDocument, HasTheTableOfTheProgram) {
  const std::string document = contents(fs::path(GROUSER_SOURCE_DIR) / "docs/soils.md");
  EXPECT_NE(document.find(fmt::format("\n{}", soilsTable())), std::string::npos)
      << "build/bin/grouser soils --markdown prints the table that belongs there";
}

TEST_F(SoilsOfUser, AreListedBesideTheOthers) {
  const Outcome list = call("soils");
  EXPECT_EQ(list.code, 0) << list.errors;
  EXPECT_NE(list.out.find("\nmine "), std::string::npos) << list.out;
  EXPECT_NE(list.out.find("\nlete_sand "), std::string::npos) << list.out;
  const Outcome table = call("soils --markdown");
  EXPECT_EQ(table.out, soilsTable()) << "only those of assets/soils";
  EXPECT_EQ(table.out.find("mine"), std::string::npos);
}

TEST_F(SoilsOfUser, OneIsToldWithItsSources) {
  const Outcome one = call("soils lete_sand");
  EXPECT_EQ(one.code, 0) << one.errors;
  EXPECT_NE(one.out.find("LETE sand, calibrated"), std::string::npos) << one.out;
  EXPECT_NE(one.out.find("Wong 2008"), std::string::npos) << one.out;
  EXPECT_NE(one.out.find("measured with its contact parameters"), std::string::npos) << one.out;
  EXPECT_NE(call("soils dry_sand").out.find("no measurements yet"), std::string::npos);
  const Outcome none = call("soils lete_snad");
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.error().find("did you mean \"lete_sand\"?"), std::string::npos) << none.errors;
  EXPECT_EQ(call("soils lete_sand --markdown").code, 2);
}

TEST_F(SoilsOfUser, StandInWhatARunPrintsAndLeaves) {
  const Outcome run = call("run grain.toml --out out");
  ASSERT_EQ(run.code, 0) << run.errors;
  EXPECT_NE(run.errors.find("note: material.mine: the soil mine is uncalibrated"), std::string::npos) << run.errors;
  EXPECT_NE(run.out.find("soil      mine: "), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("stiffness [N/m] 500000"), std::string::npos) << run.out;
  const auto manifest = nlohmann::json::parse(contents(folder_ / "out/manifest.json"));
  const auto& soil = manifest.at("soils").at("mine");
  EXPECT_EQ(soil.at("file").get<std::string>(), fs::canonical(folder_ / "soils/mine.toml").string());
  EXPECT_EQ(soil.at("scale").get<double>(), 0.5);
  EXPECT_EQ(soil.at("scaled").at("stiffness [N/m]").get<double>(), 5e5);
  EXPECT_NE(manifest.at("inputs").get<std::string>().find("material.mine.soil " + soil.at("hash").get<std::string>()),
            std::string::npos);
  EXPECT_NE(contents(folder_ / "out/scene.toml").find("soil_hash = " + soil.at("hash").dump()), std::string::npos);
}

TEST_F(SoilsOfUser, HaveIntervalsOfTheirConstantsMarkedWhereAssumed) {
  const Outcome lete = call("soils lete_sand");
  EXPECT_NE(lete.out.find("0.793 +- 0.078 - (assumed): Wong"), std::string::npos) << lete.out;
  EXPECT_NE(lete.out.find("correlation of 0.9"), std::string::npos) << lete.out;
  EXPECT_NE(call("soils dry_sand").out.find("0.025 (0.02 to 0.025) +- 0.005 m: "), std::string::npos);
  put(folder_ / "drive.toml",
      "version = 1\n[run]\nduration = 1\n[terrain]\nkind = \"scm\"\nmaterial = \"lete_sand\"\nheightmap = "
      "\"heightmaps/flat.png\"\nsize = [8, 4]\nheight_range = [0, 0]\n[vehicle]\nspec = "
      "\"vehicles/light_tracked.toml\"\n"
      "[scm]\nc = 500\n");
  const Outcome plan = call("plan drive.toml --no-probe --set scm.constants_draw=1");
  EXPECT_NE(plan.out.find("lete_sand (published): sample 1"), std::string::npos) << plan.out;
  EXPECT_NE(plan.out.find("0.73116     0.793 +- 0.078 - (assumed)"), std::string::npos) << plan.out;
  EXPECT_NE(plan.out.find("500 Pa (set in the scene)"), std::string::npos) << plan.out;
}

TEST_F(SoilsOfUser, StandInThePlan) {
  const Outcome plan = call("plan grain.toml --no-probe");
  ASSERT_EQ(plan.code, 0) << plan.errors;
  EXPECT_NE(plan.errors.find("is uncalibrated"), std::string::npos) << plan.errors;
  EXPECT_NE(plan.out.find("mine: "), std::string::npos) << plan.out;
}

TEST_F(SoilsOfUser, WithAMistakeEndTheProgramWithTheLine) {
  put(folder_ / "soils/mine.toml", "version = 1\n[soil]\ntitle = 3\n");
  for (const char* words : {"run grain.toml", "plan grain.toml", "soils mine"}) {
    const Outcome o = call(words);
    EXPECT_EQ(o.code, 2) << words;
    EXPECT_NE(o.error().find("mine.toml:3: soil.title = 3"), std::string::npos) << o.errors;
  }
}

} // namespace
} // namespace grouser::commands
