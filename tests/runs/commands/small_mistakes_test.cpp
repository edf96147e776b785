// SPDX-License-Identifier: BSD-3-Clause
// Slips of the keyboard and of the shell: each is named for what it is.
#include "tests/runs/commands/mistake_fixture.hpp"

namespace grouser::commands {

using namespace test; // fixtures

namespace {

class SmallMistakes : public ProgramTest {
protected:
  void SetUp() override {
    ProgramTest::SetUp();
    put(folder_ / "grains.toml", kGrains);
  }
  /// Refused with code 2 within seconds, and these words.
  void expectRefused(const std::string& words, const std::vector<std::string>& parts) {
    const Outcome o = shell("timeout 20 \"$grouser\" " + words);
    EXPECT_EQ(o.code, 2) << words << "\n" << o.errors;
    for (const std::string& part : parts) EXPECT_NE(o.errors.find(part), std::string::npos) << o.errors;
    EXPECT_FALSE(fs::exists(folder_ / "o"));
  }
};

TEST_F(SmallMistakes, MaterialOfAnOverrideMustBeInTheScene) {
  for (const char* command : {"run grains.toml --out o", "plan grains.toml", "sweep grains.toml --out o"})
    expectRefused(command + std::string(" --set material.glas.stiffness=1e5"),
                  {"--set", "material.glas is no material of grains.toml; did you mean glass?"});
  EXPECT_EQ(call("plan grains.toml --set material.glass.stiffness=1e5").code, 0);
  EXPECT_EQ(call("plan grains.toml --set 'contact.\"glass|glass\".friction=0.1'").code, 0);
}

TEST_F(SmallMistakes, OutputThatCannotBePrintedIsAnError) {
  for (const char* words :
       {"plan grains.toml", "fields", "--help", "run --help", "--version", "run grains.toml --out o"}) {
    const Outcome o = shell("\"$grouser\" " + std::string(words) + " >/dev/full");
    EXPECT_EQ(o.code, 3) << words;
    EXPECT_NE(o.errors.find("grouser: error: the standard output could not be written"), std::string::npos)
        << words << "\n"
        << o.errors;
  }
}

TEST_F(SmallMistakes, DevicesAndPipesAreNoScenes) {
  expectRefused("run /dev/zero --out o", {"/dev/zero: is no file"});
  expectRefused("plan /dev/zero", {"/dev/zero: is no file"});
  ASSERT_EQ(shell("mkfifo pipe.toml").code, 0);
  expectRefused("run pipe.toml --out o", {"pipe.toml: is no file"});
  expectRefused("plan .", {".: is no file"});
}

TEST_F(SmallMistakes, SectionWithALetterLeftOutIsThatSection) {
  put(folder_ / "bench.toml", replaced(kGrains, "[output]", "[drivr]\nsprocket_speed = 1\n[output]"));
  expectRefused("plan bench.toml", {"unknown section drivr; did you mean driver?"});
}

TEST_F(SmallMistakes, MissingCheckpointIsNamed) {
  for (const char* out : {"", " --out elsewhere"})
    expectRefused(std::string("run grains.toml --resume nosuch/checkpoint.h5") + out,
                  {"--resume nosuch/checkpoint.h5: there is no such file"});
}

TEST_F(SmallMistakes, MoreRanksThanGrainsAreNoPlan) {
  expectRefused("plan grains.toml --ranks 100000", {"--ranks 100000: the scene has 2 grains", "plan for 2 at most"});
  const Outcome o = call("plan grains.toml --ranks 2");
  EXPECT_EQ(o.code, 0) << o.errors;
}

} // namespace
} // namespace grouser::commands
