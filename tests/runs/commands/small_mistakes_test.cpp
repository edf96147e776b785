// SPDX-License-Identifier: BSD-3-Clause
// Typing errors and shell mistakes: the message names each.
#include "tests/runs/commands/mistake_fixture.hpp"

#include <fmt/format.h>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

class SmallMistakes : public ProgramTest {
protected:
  void SetUp() override {
    ProgramTest::SetUp();
    put(folder_ / "grains.toml", kGrains);
  }
  /// Exit code 2 within seconds, and a message with these words.
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
                  {"--set", "material.glas is not a material of grains.toml; did you mean glass?"});
  EXPECT_EQ(call("plan grains.toml --set material.glass.stiffness=1e5").code, 0);
  EXPECT_EQ(call("plan grains.toml --set 'contact.\"glass|glass\".friction=0.1'").code, 0);
}

TEST_F(SmallMistakes, FaultsOfACaseNameTheCase) {
  const std::pair<const char*, const char*> mistakes[] = {
      {"run.duratio=1", "error: --case b: unknown key run.duratio; did you mean duration?"},
      {"run.duration=-1", "error: --case b: run.duration = -1 [s] is outside"},
      {"material.glas.friction=0.1", "error: --case b: material.glas is not a material of grains.toml"},
      {"grain.7.radius=1", "error: --case b: grain.7.radius=1: there is no entry 7"},
      {"grain.0.radius=7", "error: --case b: grains.toml:5: material.glass.stiffness [N/m] is too low"}};
  for (const auto& [set, message] : mistakes)
    expectRefused(fmt::format("sweep grains.toml --out o --case a --case 'b: {}' --set run.skin=0.3,0.4", set),
                  {message});
  // Mistakes that also occur without the case do not count.
  expectRefused("sweep grains.toml --out o --case 'a: run.duration=1' --set run.skin=0.3,-4",
                {"error: --set: run.skin"});
}

TEST_F(SmallMistakes, AKeyIsSetOnce) {
  for (const char* command : {"run grains.toml --out o", "plan grains.toml", "bench step grains.toml --steps 1"})
    expectRefused(command + std::string(" --set run.duration=1 --set run.skin=0.3 --set run.duration=2"),
                  {"--set: run.duration is set twice, as 1 and as 2; remove one\n"});
  expectRefused("run grains.toml --out o --set 'contact.\"glass|glass\".friction=0.1' --set "
                "contact.'glass|glass'.friction=0.2",
                {"set twice, as 0.1 and as 0.2"});
  expectRefused("run grains.toml --out o --device cpu --set run.device=cuda",
                {"as cuda and as cpu", "--device also sets"});
}

TEST_F(SmallMistakes, AnOptionIsNoValueOfTheOneBefore) {
  for (const char* words : {"study preparation --porosities --quick --out o",
                            "study shear-angle --stresses --quick --out o", "run grains.toml --steps --force --out o",
                            "sweep grains.toml --seeds 2 --out --force", "run grains.toml --out --steps=3"})
    expectRefused(words, {"requires a value, but is followed by the option --"});
  EXPECT_FALSE(fs::exists(folder_ / "--force"));
  expectRefused("study preparation --porosities --quick --out o",
                {"--porosities: requires a value, but is followed by the option --quick; add a value"});
  EXPECT_EQ(call("plan grains.toml --set run.gravity=[0,0,-1]").code, 0);
}

const char* const kSieved = R"(version = 1
[run]
duration = 0.01
[material.soil]
stiffness = 1e5
[terrain]
heightmap = "map.png"
size = [1, 1]
height_range = [0, 0]
material = "soil"
depth = 0.2
radius_distribution = "sieve"
sieve_size = [0.02, 0.03, 0.05]
sieve_passing = [0, 0.4, 1]
)";

TEST_F(SmallMistakes, FaultsOfRadiiNameTheKeyThatGivesThem) {
  put(folder_ / "sieved.toml", kSieved);
  put(folder_ / "map.png", picture());
  expectRefused("plan sieved.toml --set terrain.sieve_size=[2e-6,3e-6,5e-6]",
                {"for grains of the sieves of terrain.sieve_size, to 5e-06 m; use larger"});
  expectRefused("run sieved.toml --out o --set terrain.size=[0.9,0.9] --set terrain.sieve_size=[2e-5,3e-5,5e-5]",
                {"--set: terrain.sieve_size = [2e-05, 3e-05, 5e-05] [m] results in about"});
  expectRefused("plan sieved.toml --set terrain.sieve_size=[0.1,0.2,0.5]",
                {"radius 0.1165 m, the median of sieve_size; set at least 0.233\n"});
  const std::string bed = replaced(replaced(kSieved, "radius_distribution = \"sieve\"\n", "grain_radius = 1e-6\n"),
                                   "sieve_size = [0.02, 0.03, 0.05]\nsieve_passing = [0, 0.4, 1]\n", "");
  put(folder_ / "fine.toml", bed);
  expectRefused("plan fine.toml", {"for grains of terrain.grain_radius = 1e-06 m"}); // the mean, as in the scene file
}

TEST_F(SmallMistakes, ABedThatDoesNotSettleIsSaidToFall) {
  put(folder_ / "loose.toml", replaced(kSieved, "depth = 0.2", "depth = 0.3\nporosity = 0.42\nsettle_time_limit = 0"));
  put(folder_ / "map.png", picture());
  const Outcome o = call("plan loose.toml --no-probe");
  EXPECT_EQ(o.code, 0) << o.errors;
  EXPECT_NE(o.errors.find(
                "WARNING: terrain.settle_time_limit = 0: the bed is not settled, so the grains fall as a loose column"),
            std::string::npos)
      << o.errors;
  EXPECT_NE(o.errors.find("without terrain.porosity = 0.42"), std::string::npos) << o.errors;
  EXPECT_EQ(call("plan loose.toml --no-probe --set terrain.settle_time_limit=3").errors, "");
}

TEST_F(SmallMistakes, OutputThatCannotBePrintedIsAnError) {
  for (const char* words :
       {"plan grains.toml", "fields", "--help", "run --help", "--version", "run grains.toml --out o"}) {
    const Outcome o = shell("\"$grouser\" " + std::string(words) + " >/dev/full");
    EXPECT_EQ(o.code, 3) << words;
    EXPECT_NE(o.errors.find("grouser: error: cannot write to standard output"), std::string::npos) << words << "\n"
                                                                                                   << o.errors;
  }
}

TEST_F(SmallMistakes, DevicesAndPipesAreNoScenes) {
  expectRefused("run /dev/zero --out o", {"/dev/zero is a device (a regular file is required)"});
  expectRefused("plan /dev/zero", {"/dev/zero is a device (a regular file is required)"});
  ASSERT_EQ(shell("mkfifo pipe.toml").code, 0);
  expectRefused("run pipe.toml --out o", {"pipe.toml is a FIFO (a regular file is required)"});
  expectRefused("plan .", {". is a folder (a regular file is required)"});
}

TEST_F(SmallMistakes, SectionWithALetterLeftOutIsThatSection) {
  put(folder_ / "bench.toml", replaced(kGrains, "[output]", "[drivr]\nsprocket_speed = 1\n[output]"));
  expectRefused("plan bench.toml", {"unknown section drivr; did you mean driver?"});
}

TEST_F(SmallMistakes, MissingCheckpointIsNamed) {
  for (const char* out : {"", " --out elsewhere"})
    expectRefused(std::string("run grains.toml --resume nosuch/checkpoint.h5") + out,
                  {"--resume nosuch/checkpoint.h5: no such file"});
}

TEST_F(SmallMistakes, MoreRanksThanGrainsAreNoPlan) {
  expectRefused("plan grains.toml --ranks 100000", {"--ranks 100000: the scene has only 2 grains", "use at most 2"});
  const Outcome o = call("plan grains.toml --ranks 2");
  EXPECT_EQ(o.code, 0) << o.errors;
}

} // namespace
} // namespace grouser::commands
