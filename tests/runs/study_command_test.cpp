// SPDX-License-Identifier: BSD-3-Clause
// The studies of grains as a user calls them: help, tables, plots, and nothing overwritten.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <sys/wait.h>
#include <vector>

namespace grouser::runs {
namespace {

namespace fs = std::filesystem;

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

struct StudyCall {
  std::string name, options; ///< options that make it quick
  std::vector<std::string> files, words;
};

class StudyCommand : public testing::TestWithParam<StudyCall> {
protected:
  void SetUp() override {
    program_ = fs::read_symlink("/proc/self/exe").parent_path() / "grouser";
    ASSERT_TRUE(fs::exists(program_)) << "build the target grouser first";
    folder_ = fs::path(testing::TempDir()) / ("grouser_study_" + GetParam().name);
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  int call(const std::string& words) {
    const std::string command =
        "cd '" + folder_.string() + "' && '" + program_.string() + "' study " + words + " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    out_ = contents(folder_ / "out.txt"), errors_ = contents(folder_ / "err.txt");
    return WEXITSTATUS(status);
  }

  fs::path program_, folder_;
  std::string out_, errors_;
};

TEST_P(StudyCommand, WritesItsTablesAndKeepsThem) {
  const StudyCall& study = GetParam();
  EXPECT_EQ(call("--help"), 0);
  EXPECT_NE(out_.find(study.name), std::string::npos) << out_;
  EXPECT_EQ(call(study.name + " --help"), 0);
  for (const char* option : {"--quick", "--out", "--force"}) EXPECT_NE(out_.find(option), std::string::npos) << option;

  ASSERT_EQ(call(study.name + " " + study.options + " --out results"), 0) << errors_;
  for (const std::string& word : study.words) EXPECT_NE(out_.find(word), std::string::npos) << word << "\n" << out_;
  for (const std::string& file : study.files) {
    const fs::path path = folder_ / "results" / file;
    if (path.extension() == ".png" && errors_.find("python3") != std::string::npos) continue; // no matplotlib here
    EXPECT_TRUE(fs::exists(path) && fs::file_size(path) > 100) << path << "\n" << errors_;
  }
  const auto json = nlohmann::json::parse(contents(folder_ / "results" / "study.json"));
  EXPECT_EQ(json.at("study"), study.name);
  EXPECT_FALSE(json.at("commit").get<std::string>().empty());
  EXPECT_FALSE(json.at("machine").get<std::string>().empty());

  EXPECT_EQ(call(study.name + " " + study.options + " --out results"), 2) << "there are results in it";
  EXPECT_NE(errors_.find("--force"), std::string::npos) << errors_;
  EXPECT_EQ(call(study.name + " --colour blue"), 2);
}

INSTANTIATE_TEST_SUITE_P(Grains, StudyCommand,
                         testing::Values(StudyCall{"impact",
                                                   "--quick --phases 4 --leaving 1 --collisions 20 --repeats 1",
                                                   {"impact.csv", "orders.csv", "cheapest.csv", "convergence.csv",
                                                    "speeds.csv", "impact.png"},
                                                   {"order of the worst error", "cheapest step", "published",
                                                    "closed forms"}},
                                         StudyCall{"stability",
                                                   "--quick --grains 20 --column 3",
                                                   {"stability.csv", "limits.csv", "stability.png"},
                                                   {"predicted limit", "at 0.95 of the limit", "a run refuses"}},
                                         StudyCall{"precision",
                                                   "--quick --grains 200 --configurations 2 --drift-grains 50 "
                                                   "--gas-time 0.05 --bed-time 0.05 --runs 2 --threads 1",
                                                   {"touch.csv", "drift.csv", "macroscopic.csv", "precision.png"},
                                                   {"float from the origin", "growth", "std. error"}}),
                         [](const auto& study) { return study.param.name; });

} // namespace
} // namespace grouser::runs
