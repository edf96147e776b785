// SPDX-License-Identifier: BSD-3-Clause
// Commands of the grain studies: help, tables, plots, no overwriting.
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace grouser::studies {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

struct StudyCall {
  std::string name, options; ///< options for a short run
  std::vector<std::string> files, words;
};

class StudyCommand : public ProgramTest, public testing::WithParamInterface<StudyCall> {};

TEST_P(StudyCommand, WritesItsTablesAndKeepsThem) {
  const StudyCall& study = GetParam();
  const Outcome all = call("study --help"), help = call("study " + study.name + " --help");
  EXPECT_EQ(all.code, 0);
  EXPECT_NE(all.out.find(study.name), std::string::npos) << all.out;
  EXPECT_EQ(help.code, 0);
  for (const char* option : {"--quick", "--out", "--force"})
    EXPECT_NE(help.out.find(option), std::string::npos) << option;

  const std::string words = "study " + study.name + " " + study.options + " --out results";
  const Outcome o = call(words);
  ASSERT_EQ(o.code, 0) << o.errors;
  for (const std::string& word : study.words) EXPECT_NE(o.out.find(word), std::string::npos) << word << "\n" << o.out;
  for (const std::string& file : study.files) {
    const fs::path path = folder_ / "results" / file;
    if (path.extension() == ".png" && o.errors.find("python3") != std::string::npos) continue; // no matplotlib here
    EXPECT_TRUE(fs::exists(path) && fs::file_size(path) > 100) << path << "\n" << o.errors;
  }
  const auto json = nlohmann::json::parse(contents(folder_ / "results" / "study.json"));
  EXPECT_EQ(json.at("study"), study.name);
  EXPECT_FALSE(json.at("commit").get<std::string>().empty());
  EXPECT_FALSE(json.at("machine").get<std::string>().empty());

  const bool inPieces = fs::exists(folder_ / "results" / "recipe.json"); // the same call continues
  const Outcome again = call(words);
  EXPECT_EQ(again.code, inPieces ? 0 : 2);
  EXPECT_EQ(again.errors.find("--force") == std::string::npos, inPieces) << again.errors;
  EXPECT_EQ(call("study " + study.name + " --colour blue").code, 2);
}

class RandomStudy : public ProgramTest {};

TEST_F(RandomStudy, GoesOnWithTheTableThatAStoppedCallHasLeft) {
  const fs::path table = folder_ / "results" / "random.csv";
  ASSERT_EQ(call("study stability --random 1 --seed 3 --out results").code, 0);
  const std::string one = contents(table);
  const Outcome two = call("study stability --random 2 --seed 3 --resume --out results");
  ASSERT_EQ(two.code, 0) << two.errors;
  const std::string both = contents(table);
  EXPECT_EQ(both.substr(0, one.size()), one);
  EXPECT_EQ(std::count(both.begin(), both.end(), '\n'), 3);
  for (const char* word : {"longest step without blow-up", "longest step without alarm", "2 scenes"})
    EXPECT_NE(two.out.find(word), std::string::npos) << word << "\n" << two.out;
  const Outcome other = call("study stability --random 2 --seed 4 --resume --out results");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.errors.find("seed 3"), std::string::npos) << other.errors;
  EXPECT_EQ(call("study stability --seed 4").code, 2) << "only for random scenes";
}

class PieceStudy : public ProgramTest {};

std::string withoutLastColumn(const std::string& csv) {
  std::string text, line;
  for (std::istringstream lines(csv); std::getline(lines, line);) text += line.substr(0, line.rfind(',')) + "\n";
  return text;
}

TEST_F(PieceStudy, PartsShareTheRunsAndALastCallMakesTheTables) {
  const std::string words = "study plates --quick --cases rough --seeds 2 --threads 1 --out results";
  const fs::path runs = folder_ / "results" / "runs";
  const Outcome part = call(words + " --part 2/2");
  ASSERT_EQ(part.code, 0) << part.errors;
  EXPECT_FALSE(fs::exists(runs / "rough_seed1.csv"));
  ASSERT_TRUE(fs::exists(runs / "rough_seed2.csv"));
  EXPECT_FALSE(fs::exists(folder_ / "results" / "plates.csv")) << "only after all runs";
  const std::string second = contents(runs / "rough_seed2.csv");

  // A bed of an interrupted call is reused.
  ASSERT_EQ(call(words + " --part 1/2 --resume --keep-beds").code, 0);
  const std::string first = contents(runs / "rough_seed1.csv");
  fs::remove(runs / "rough_seed1.csv");
  fs::create_directories(runs / "rough_seed1");
  fs::rename(folder_ / "results" / "bed_rough_seed1.txt", runs / "rough_seed1" / "bed.txt");
  const Outcome continues = call(words + " --part 1/2 --resume");
  ASSERT_EQ(continues.code, 0) << continues.errors;
  EXPECT_EQ(continues.errors.find("lift"), std::string::npos) << continues.errors;
  EXPECT_EQ(withoutLastColumn(contents(runs / "rough_seed1.csv")), withoutLastColumn(first)) << "except for wall time";
  EXPECT_FALSE(fs::exists(runs / "rough_seed1"));

  // Completed runs are reused.
  put(runs / "rough_seed1.csv", second);
  const Outcome all = call(words + " --resume");
  ASSERT_EQ(all.code, 0) << all.errors;
  EXPECT_EQ(contents(runs / "rough_seed1.csv"), second);
  EXPECT_EQ(contents(runs / "rough_seed2.csv"), second);
  EXPECT_EQ(all.out.find("+- 0"), std::string::npos) << "two equal runs have no scatter\n" << all.out;
  EXPECT_TRUE(fs::exists(folder_ / "results" / "plates.csv"));

  const Outcome other = call(words + " --resume --friction 0.3");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.errors.find("different options"), std::string::npos) << other.errors;
  EXPECT_EQ(call(words).code, 0) << "the same call continues";

  // A truncated file.
  put(runs / "rough_seed1.csv", "sinkage [m],force [N]\n0.1\n");
  EXPECT_EQ(call(words + " --resume").code, 2);
}

TEST_F(PieceStudy, RefusesWhatIsNoPartNoCaseAndNoAngle) {
  for (const char* words : {"--part 0/2", "--part 3/2", "--part 1", "--part a/b", "--part 1/2x", "--cases base,round",
                            "--angle -1", "--angle-error 1", "--seeds 1", "--device tpu", "--sinkage 0"}) {
    const Outcome o = call(std::string("study plates --quick --out results ") + words);
    EXPECT_EQ(o.code, 2) << words << "\n" << o.out;
  }
  EXPECT_FALSE(fs::exists(folder_ / "results")) << "no run has started";
  EXPECT_EQ(call("study shear-angle --quick --stresses 1 --out results").code, 2);
  EXPECT_EQ(call("study preparation --quick --porosities 0.9 --out results").code, 2);
  EXPECT_EQ(call("study preparation --help").code, 0);
}

TEST_F(PieceStudy, GivenOptionsWinOverThoseOfAQuickPass) {
  const Outcome o = call(
      "study plates --quick --cases rough --seeds 3 --strip-depth 2 --sinkage 0.1 --threads 1 --seconds 1e-9 --out "
      "results");
  ASSERT_EQ(o.code, 0) << o.errors;
  const auto recipe = nlohmann::json::parse(contents(folder_ / "results" / "recipe.json"));
  EXPECT_EQ(recipe.at("strip_depth"), 2);
  EXPECT_EQ(recipe.at("sinkage"), 0.1);
  EXPECT_EQ(recipe.at("breadth_d"), 4) << "not given";
  EXPECT_NE(o.out.find("3 seeds"), std::string::npos) << o.out;
  EXPECT_NE(call("study plates --help").out.find("1.5 with --quick"), std::string::npos);

  const Outcome angle = call("study shear-angle --quick --stresses 1000 --rolling-frictions 0.1 --seeds 3 --threads 1 "
                             "--seconds 1e-9 --out angle");
  EXPECT_NE(angle.errors.find("0 of 3 samples"), std::string::npos) << angle.errors;
}

TEST_F(PieceStudy, RefusesPlatesAndBedsThatCannotBe) {
  const std::pair<const char*, std::vector<const char*>> mistakes[] = {
      {"--strip-thickness 4", {"--strip-thickness 4 [d], case base", "4.38 d", "increase this value"}},
      {"--sinkage 2 --strip-depth 0.5",
       {"--sinkage 2 [plate widths], case base", "at most 0.396", "--strip-depth = 0.5"}},
      {"--cases deep --sinkage 2 --strip-depth 0.5", {"case deep", "at most 0.896", "--strip-depth = 0.5"}},
      {"--cases old --breadth 100", {"--sinkage 0.2 [plate widths], case old", "a smaller --breadth than 100 d"}},
      {"--cases graded --fine-depth 5",
       {"--fine-depth 5 [plate widths], case graded", "less than", "--strip-depth = 2"}},
      {"--cases circular --breadth 2",
       {"--circular-depth 2 [plate widths], case circular", "at least 2.5", "--breadth"}},
      {"--cases wide --breadth 2 --strip-bin 1.6 --strip-depth 9", {}},
      {"--cases base --breadth 2 --strip-bin 1.6", {"--strip-bin 1.6 [plate widths], case base", "at least 2.19"}}};
  for (const auto& [words, says] : mistakes) {
    const Outcome o = call(std::string("study plates --out results --threads 1 --seconds 1 ") + words,
                           says.empty() ? "timeout 1 " : "timeout 20 ");
    EXPECT_EQ(o.code, says.empty() ? 124 : 2) << words << "\n" << o.errors;
    for (const char* part : says) EXPECT_NE(o.error().find(part), std::string::npos) << part << "\n" << o.errors;
    EXPECT_EQ(fs::exists(folder_ / "results"), says.empty()) << words;
    fs::remove_all(folder_ / "results");
  }
}

INSTANTIATE_TEST_SUITE_P(
    Grains, StudyCommand,
    ::testing::Values(
        StudyCall{
            "impact",
            "--quick --phases 4 --leaving 1 --collisions 20 --repeats 1",
            {"impact.csv", "orders.csv", "cheapest.csv", "convergence.csv", "speeds.csv", "impact.png"},
            {"order of the worst error", "cheapest step", "published", "linear clamped law", "closed-form values"}},
        StudyCall{"stability",
                  "--quick --grains 20 --column 3",
                  {"stability.csv", "limits.csv", "stability.png"},
                  {"predicted limit", "at 0.95 of the limit", "calm up to"}},
        StudyCall{"precision",
                  "--quick --grains 200 --configurations 2 --drift-grains 50 "
                  "--gas-time 0.05 --bed-time 0.05 --runs 2 --threads 1",
                  {"touch.csv", "drift.csv", "macroscopic.csv", "precision.png"},
                  {"float from the origin", "growth", "std. error"}},
        StudyCall{"features",
                  "--quick --pairs 3 --threads 1 --features friction,radii,output,off_rolling",
                  {"features.csv", "recipe.json", "features.png"},
                  {"ns/(grain step)", "rolling_friction = 0", "a row and a frame"}},
        StudyCall{"shear-angle",
                  "--quick --threads 1",
                  {"shear_angle.csv", "angles.csv", "recipe.json", "shear_angle.png"},
                  {"peak tau/sigma", "core angle", "inconclusive"}},
        StudyCall{
            "plates",
            "--quick --threads 1 --cases base,old,fine,graded --angle 24 --angle-error 1",
            {"plates.csv", "differences.csv", "bearing.csv", "costs.csv", "recipe.json", "plates.png"},
            {"pressure [kPa]", "old to base", "graded to fine", "measured/theory", "times fewer grains than fine"}}),
    [](const auto& study) {
      std::string name = study.param.name;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

class FluidStudy : public ProgramTest {};

TEST_F(FluidStudy, PrintsOrdersBarsAndFiles) {
  const Outcome o = call("study fluid --cases sound --device cpu --out results");
  ASSERT_EQ(o.code, 0) << o.errors;
  EXPECT_NE(o.out.find("plane sound wave of 1 m: relative errors"), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("within 0.002"), std::string::npos) << o.out;
  EXPECT_EQ(o.out.find("beyond"), o.out.find("above the tolerance")) << o.out;
  std::istringstream csv(contents(folder_ / "results" / "fluid.csv"));
  std::string line;
  int lines = 0;
  while (std::getline(csv, line)) ++lines;
  EXPECT_EQ(lines, 1 + 3 * 2) << "three spacings of two quantities";
  EXPECT_TRUE(fs::exists(folder_ / "results" / "fluid.png"));
  const Outcome quick = call("study fluid --cases couette --quick --device cpu --out quick");
  EXPECT_EQ(quick.code, 0) << quick.errors;
  EXPECT_EQ(quick.out.find("within"), std::string::npos) << "the bar is that of the finest spacing\n" << quick.out;
  const Outcome wrong = call("study fluid --cases waves --out other");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.error().find("--cases waves: unknown case; did you mean wave? (cases: tank, sound"),
            std::string::npos)
      << wrong.errors;
  EXPECT_FALSE(fs::exists(folder_ / "other"));
}

} // namespace
} // namespace grouser::studies
