// SPDX-License-Identifier: BSD-3-Clause
// The program on the command line: exit codes, one clear error line, no lost results.
#include "tests/runs/program_fixture.hpp"
#include "tests/runs/scene_fixture.hpp"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

class CommandLine : public ProgramTest {
protected:
  /// A falling grain: the smallest scene that runs.
  void writeGrain(const std::string& name = "grain.toml", const std::string& more = "") const {
    std::ofstream(folder_ / name)
        << "version = 1\n[run]\nduration = 1e-3\ntime_step = 1e-5\n"
        << more
        << "[material.glass]\n[[grain]]\nposition = [0, 0, 1]\nradius = 0.01\nmaterial = \"glass\"\n"
           "[output]\nplots = false\npicture_width = 64\n";
  }

  /// A cube of 0.1 m.
  void writeCube() const {
    std::ofstream file(folder_ / "cube.obj");
    for (const char* x : {"-0.05", "0.05"})
      for (const char* y : {"-0.05", "0.05"})
        for (const char* z : {"-0.05", "0.05"}) file << "v " << x << ' ' << y << ' ' << z << '\n';
    file << "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";
  }
};

TEST_F(CommandLine, VersionNamesCommitCompilerAndCuda) {
  const Outcome o = call("--version");
  EXPECT_EQ(o.code, 0);
  for (const char* part : {"grouser ", "commit ", "compiler ", "flags ", "CUDA "})
    EXPECT_NE(o.out.find(part), std::string::npos);
}

TEST_F(CommandLine, HelpOfEveryCommandEndsWell) {
  for (const char* command : {"", "run", "sweep", "events", "bench", "bench bed", "bench step", "bench contacts",
                              "hash", "sinkage", "plan", "spheres", "render", "fields", "soil", "manual", "report"}) {
    const Outcome o = call(std::string(command) + " --help");
    EXPECT_EQ(o.code, 0) << command;
    EXPECT_NE(o.out.find("Usage"), std::string::npos) << command;
  }
}

TEST_F(CommandLine, WrongWordsEndWithTwoAndOneLine) {
  writeGrain();
  for (const char* words :
       {"", "rum", "run", "run grain.toml --devise cpu", "run grain.toml --steps 0", "run grain.toml --device gpu",
        "run grain.toml --threads -1", "run grain.toml --set run.duration", "run nosuch.toml",
        "run grain.toml --set run.duratio=1", "sinkage nosuch.h5", "sinkage grain.toml", "plan nosuch.toml",
        "spheres nosuch.obj --radius 0.01", "spheres x.obj", "spheres x.obj --radius 1 --count 5"}) {
    const Outcome o = call(words);
    EXPECT_EQ(o.code, 2) << words << "\n" << o.errors;
    EXPECT_EQ(o.errors.rfind("grouser: error: ", 0), 0u) << words << "\n" << o.errors;
    EXPECT_EQ(std::count(o.errors.begin(), o.errors.end(), '\n'), 1) << words << "\n" << o.errors;
    EXPECT_FALSE(fs::exists(folder_ / "out")) << words;
  }
}

TEST_F(CommandLine, WrongNumberNamesOptionValueAndRange) {
  writeGrain();
  const std::pair<const char*, const char*> mistakes[] = {
      {"run grain.toml --steps -1", "--steps: -1 is not a whole number of at least 1"},
      {"run grain.toml --steps abc", "--steps: abc is not a whole number of at least 1"},
      {"run grain.toml --steps 1.5", "--steps: 1.5 is not a whole number of at least 1"},
      {"run grain.toml --threads 2000", "--threads: 2000 is not a whole number from 0 to 1024"},
      {"spheres x.obj --radius -1", "--radius: -1 is not a length in metres above 0"},
      {"spheres x.obj --radius inf", "--radius: inf is not a length in metres above 0"},
      {"spheres x.obj --count 0", "--count: 0 is not a whole number of at least 1"}};
  for (const auto& [words, message] : mistakes) {
    const Outcome o = call(words);
    EXPECT_EQ(o.code, 2) << words;
    EXPECT_NE(o.errors.find(message), std::string::npos) << o.errors;
  }
}

TEST_F(CommandLine, UnknownCommandNamesTheNearest) {
  EXPECT_NE(call("spheers x.obj").errors.find("\"spheers\" is not a command; did you mean \"spheres\"?"),
            std::string::npos);
  EXPECT_NE(call("bench stp").errors.find("\"bench stp\" is not a command; did you mean \"bench step\"?"),
            std::string::npos);
}

TEST_F(CommandLine, AnOptionOfOtherCommandsNamesThem) {
  const std::string errors = call("run grain.toml --seeds 3").errors;
  EXPECT_NE(errors.find("; --seeds is an option of: "), std::string::npos) << errors;
  for (const char* const command : {"sweep", "compare", "check"})
    EXPECT_NE(errors.find(command), std::string::npos) << errors;
  EXPECT_NE(call("compare grain.toml --ground rigid,scm").errors.find("; did you mean --grounds?"), std::string::npos);
  EXPECT_NE(call("run grain.toml --thread 1").errors.find("; did you mean --threads?"), std::string::npos);
}

TEST_F(CommandLine, SpheresAreNotWrittenOverAFileUnlessForced) {
  writeCube();
  std::ofstream(folder_ / "s.csv") << "precious";
  const Outcome refused = call("spheres cube.obj --radius 0.02 --csv s.csv");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.errors.find("--force"), std::string::npos) << refused.errors;
  EXPECT_EQ(contents(folder_ / "s.csv"), "precious");
  EXPECT_EQ(call("spheres cube.obj --radius 0.02 --csv s.csv --force").code, 0);
  EXPECT_EQ(contents(folder_ / "s.csv").rfind("x [m],y [m],z [m],radius [m]\n", 0), 0u);
}

TEST_F(CommandLine, AnInternalErrorAsksToBeReported) {
  // An internal script fails with an unexpected error.
  fs::create_directories(folder_ / "share/runs/report");
  std::ofstream(folder_ / "share/runs/report/report.py") << "raise SystemExit('a fault of the script')\n";
  fs::create_directory(folder_ / "results");
  const Outcome o = call("report results --out page.html", "GROUSER_SHARE=share ");
  EXPECT_EQ(o.code, 1) << o.errors;
  EXPECT_EQ(o.error().rfind("internal error: ", 0), 0u) << o.errors;
  EXPECT_NE(o.error().find("a fault of the script"), std::string::npos) << o.errors;
  EXPECT_NE(o.error().find("report it with the command line: "), std::string::npos) << o.errors;
  EXPECT_TRUE(o.error().ends_with("grouser report results --out page.html")) << o.errors;
}

TEST_F(CommandLine, FullDiskIsSaidAndLeavesNoPart) {
  writeCube();
  // Files of at most 512 bytes: the write fails halfway, as on a full disk.
  const Outcome o = call("spheres cube.obj --radius 0.01 --csv s.csv", "ulimit -f 1; ");
  EXPECT_EQ(o.code, 3);
  EXPECT_NE(o.errors.find("s.csv: could not be written completely; is the disk full?"), std::string::npos) << o.errors;
  EXPECT_FALSE(fs::exists(folder_ / "s.csv"));
}

TEST_F(CommandLine, FullDiskAtAnyTimeOfARunIsSaidOnceAndInTheManifest) {
  writeGrain();
  int begun = 0, complete = 0;
  for (const int blocks :
       {0, 1, 4, 8, 16, 32, 64, 128, 192, 256, 320, 384, 448, 1024}) { // file size limit in units of 512 bytes
    const std::string folder = "full" + std::to_string(blocks);
    const Outcome o = call("run grain.toml --out " + folder, "ulimit -f " + std::to_string(blocks) + "; ");
    if (o.code == 0) {
      ++complete;
      continue;
    }
    // Without a single block the folder is rejected before any work.
    EXPECT_EQ(o.code, blocks > 0 ? 3 : 2) << blocks << "\n" << o.errors;
    if (blocks > 0) { // messages, too
      EXPECT_EQ(o.errors.rfind("grouser: error: ", 0), 0u) << blocks << "\n" << o.errors;
      EXPECT_NE(o.errors.find("is the disk full"), std::string::npos) << blocks << "\n" << o.errors;
    }
    if (!fs::exists(folder_ / folder)) continue;
    ++begun;
    const std::string manifest = contents(folder_ / folder / "manifest.json");
    EXPECT_EQ(manifest.find("\"finished\""), std::string::npos) << blocks;
  }
  EXPECT_GT(begun, 0) << "no limit took effect during a run";
  EXPECT_GT(complete, 0);
}

TEST_F(CommandLine, BrokenSceneEndsWithTwoAndTouchesNothing) {
  std::ofstream(folder_ / "broken.toml") << replaced(goodScene(), "grain_radius = 0.05", "grain_radius = -1");
  const Outcome o = call("run broken.toml");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.errors.find("broken.toml:19: terrain.grain_radius = -1 [m] is outside (0, 10]"), std::string::npos)
      << o.errors;
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(CommandLine, RunLeavesItsFilesAndPrintsTheHashLast) {
  writeGrain();
  const Outcome o = call("run grain.toml --hash --threads 1 --set output.plots=true");
  ASSERT_EQ(o.code, 0) << o.errors;
  for (const char* name :
       {"results.h5", "timeseries.csv", "manifest.json", "scene.toml", "frames.h5", "frames.xdmf", "picture.png"})
    EXPECT_TRUE(fs::exists(folder_ / "out/grain" / name)) << name;
  const std::size_t last = o.out.rfind('\n', o.out.size() - 2) + 1;
  EXPECT_EQ(o.out.rfind("state-hash ", last), last) << o.out;
  EXPECT_NE(o.out.find(" step 100\n", last), std::string::npos) << o.out;
  const std::string manifest = contents(folder_ / "out/grain/manifest.json");
  EXPECT_NE(manifest.find("picture.png"), std::string::npos);
  // If Python and its packages are installed, the plots are drawn and listed; otherwise a warning appears.
  const bool isWarned = o.errors.find("WARNING: no plots") != std::string::npos;
  EXPECT_NE(manifest.find("ledger.png") != std::string::npos, isWarned) << o.errors;
}

TEST_F(CommandLine, SmallScenesLeaveEveryGrainAsText) {
  writeGrain("two.toml", "output_interval = 3e-4\n");
  const std::string grain = "[[grain]]\nposition = [0.1, 0, 1]\nvelocity = [0.25, 0, 0]\nradius = 0.01\nmaterial = "
                            "\"glass\"\n";
  std::ofstream(folder_ / "two.toml", std::ios::app) << grain;
  ASSERT_EQ(call("run two.toml --out whole").code, 0);
  std::istringstream file(contents(folder_ / "whole/grains.csv"));
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line.rfind("step,time [s],id,position.x [m],", 0), 0u) << line;
  std::vector<std::vector<double>> rows;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
  }
  ASSERT_EQ(rows.size(), 10u) << "steps 0, 30, 60, 90 and 100, the last";
  for (const auto& row : rows) ASSERT_EQ(row.size(), 13u);
  EXPECT_EQ(rows[9][0], 100);
  EXPECT_EQ(rows[9][2], 1);
  EXPECT_NEAR(rows[9][3], 0.1 + 0.25e-3, 1e-9); // the position quantum: 1e-8 of a diameter
  EXPECT_NEAR(rows[9][8], -9.81e-3, 1e-9);      // the resolution of a float at 0.01 m/s
  EXPECT_EQ(rows[9][12], 0.01);

  ASSERT_EQ(call("run two.toml --out cut --steps 70").code, 0);
  ASSERT_EQ(call("run two.toml --out cut --resume cut/checkpoint.h5").code, 0);
  EXPECT_EQ(contents(folder_ / "cut/grains.csv"), contents(folder_ / "whole/grains.csv"));

  ASSERT_EQ(call("run two.toml --out none --set output.grains_csv=false").code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "none/grains.csv"));
  ASSERT_EQ(call("run two.toml --out many --set run.output_interval=1e-5 --set run.duration=6 --steps 2").code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "many/grains.csv")) << "1.2e6 lines unless requested";
}

TEST_F(CommandLine, GrainsAsTextGoOnFromBetweenTwoRowsWhereTheFirstRowsHadNone) {
  writeGrain("drip.toml", "output_interval = 3e-4\n");
  std::string scene = contents(folder_ / "drip.toml");
  scene.resize(scene.find("[[grain]]"));
  put(folder_ / "drip.toml", scene + "[[source]]\nlow = [0, 0, 1]\nhigh = [0, 0, 1]\nradius = 0.01\nmaterial = "
                                     "\"glass\"\nevery = 1.0\nstart = 4e-4\ntotal = 1\n[output]\nplots = false\n");
  ASSERT_EQ(call("run drip.toml --out whole").code, 0);
  ASSERT_EQ(call("run drip.toml --out cut --steps 70").code, 0); // ends with a row of its own
  ASSERT_EQ(call("run drip.toml --out cut --resume cut/checkpoint.h5").code, 0);
  EXPECT_EQ(contents(folder_ / "cut/grains.csv"), contents(folder_ / "whole/grains.csv"));
}

TEST_F(CommandLine, FilledFolderIsKeptUnlessForced) {
  writeGrain();
  fs::create_directories(folder_ / "results");
  std::ofstream(folder_ / "results/results.h5") << "precious";
  const Outcome refused = call("run grain.toml --out results");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.errors.find("--force"), std::string::npos);
  EXPECT_EQ(contents(folder_ / "results/results.h5"), "precious");
  EXPECT_EQ(call("run grain.toml --out results --force --steps 5").code, 0);
  EXPECT_NE(contents(folder_ / "results/results.h5"), "precious");
}

TEST_F(CommandLine, ResolvedSceneRunsToTheSameHash) {
  writeGrain();
  const Outcome first = call("run grain.toml --hash --set run.seed=3 --out a");
  const Outcome second = call("run a/scene.toml --hash --out b");
  ASSERT_EQ(second.code, 0) << second.errors;
  EXPECT_EQ(first.hash(), second.hash());
}

TEST_F(CommandLine, HashOfTheCheckpointIsTheHashOfTheRun) {
  writeGrain();
  const Outcome run = call("run grain.toml --hash");
  ASSERT_EQ(run.code, 0) << run.errors;
  const Outcome hash = call("hash out/grain/checkpoint.h5");
  EXPECT_EQ(hash.code, 0) << hash.errors;
  EXPECT_EQ(hash.out, run.hash() + "\n");
  EXPECT_EQ(call("hash out/grain").out, hash.out) << "the file in the run's folder";
  EXPECT_NE(call("render out").error().find("out/frames.h5"), std::string::npos);
}

TEST_F(CommandLine, ResumeFindsTheCheckpointByFolderOrByName) {
  writeGrain();
  const Outcome whole = call("run grain.toml --hash --out whole");
  ASSERT_EQ(whole.code, 0) << whole.errors;
  ASSERT_EQ(call("run grain.toml --steps 40").code, 0);
  EXPECT_EQ(call("run grain.toml --resume --steps 70 --hash").hash().substr(28), "step 70");
  EXPECT_EQ(call("run grain.toml --resume out/grain/checkpoint.h5 --hash").hash(), whole.hash());
  EXPECT_EQ(contents(folder_ / "out/grain/timeseries.csv"), contents(folder_ / "whole/timeseries.csv"));
  const Outcome filled = call("run grain.toml");
  EXPECT_NE(filled.errors.find("resume with --resume"), std::string::npos) << filled.errors;
}

TEST_F(CommandLine, ResumeOfWhatIsNotThereEndsWithTwo) {
  writeGrain();
  ASSERT_EQ(call("run grain.toml --out a").code, 0);
  for (const char* words :
       {"run grain.toml --resume", "run grain.toml --resume nosuch.h5", "run grain.toml --resume grain.toml",
        "run grain.toml --resume a/results.h5", "run grain.toml --out b --resume a/checkpoint.h5",
        "run grain.toml --out a --resume --set run.gravity=[0,0,-2]", "hash a/results.h5", "hash"}) {
    const Outcome o = call(words);
    EXPECT_EQ(o.code, 2) << words << "\n" << o.errors;
    EXPECT_EQ(std::count(o.errors.begin(), o.errors.end(), '\n'), 1) << words << "\n" << o.errors;
  }
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  EXPECT_FALSE(fs::exists(folder_ / "b"));
}

TEST_F(CommandLine, TerminatedRunEndsWith143AndIsResumed) {
  writeGrain("long.toml");
  const std::string scene = "run long.toml --set run.duration=100 --set output.frames=false --out run";
  const Outcome stopped = shell("\"$grouser\" " + scene +
                                " & pid=$!\nwhile [ ! -s run/timeseries.csv ]; do sleep 0.01; done\n"
                                "kill -TERM $pid\nwait $pid\nexit $?");
  EXPECT_EQ(stopped.code, 143) << stopped.errors;
  EXPECT_NE(stopped.errors.find("grouser: stopped by SIGTERM"), std::string::npos) << stopped.errors;
  const Outcome at = call("hash run/checkpoint.h5");
  ASSERT_EQ(at.code, 0) << at.errors;
  const long long step = std::stoll(at.out.substr(at.out.rfind(' ')));
  const Outcome on = call(scene + " --resume --hash --steps " + std::to_string(step + 100));
  ASSERT_EQ(on.code, 0) << on.errors;
  EXPECT_NE(on.out.find(" step " + std::to_string(step + 100) + "\n"), std::string::npos) << on.out;
}

TEST_F(CommandLine, ALostTerminalAndTheSignalOfABatchSystemLeaveACheckpoint) {
  writeGrain("long.toml");
  for (const auto& [name, code] : {std::pair<std::string, int>{"HUP", 129}, {"USR1", 138}}) {
    const Outcome stopped = shell("\"$grouser\" run long.toml --set run.duration=100 --set output.frames=false --out " +
                                  name + " & pid=$!\nwhile [ ! -s " + name +
                                  "/timeseries.csv ]; do sleep 0.01; done\n"
                                  "kill -" +
                                  name + " $pid\nwait $pid\nexit $?");
    EXPECT_EQ(stopped.code, code) << stopped.errors;
    EXPECT_NE(stopped.errors.find("grouser: stopped by SIG" + name), std::string::npos) << stopped.errors;
    EXPECT_TRUE(fs::exists(folder_ / name / "checkpoint.h5"));
  }
}

TEST_F(CommandLine, ClosedOrFullStandardStreamsHarmNoRun) {
  writeGrain();
  const std::string hash = call("run grain.toml --hash --out open").hash();
  for (const char* streams : {"2>&-", "2>/dev/full", "<&-", "<&- 2>&-"}) {
    const Outcome o = call(std::string("run grain.toml --hash --force --out closed ") + streams);
    EXPECT_EQ(o.code, 0) << streams << o.errors;
    EXPECT_EQ(o.hash(), hash) << streams;
  }
  // With standard output closed, printed results must not end up in files of the run.
  const Outcome o = call("run grain.toml --hash --force --out closed >&-");
  EXPECT_EQ(o.code, 3) << o.errors;
  EXPECT_NE(o.error().find("cannot write to standard output"), std::string::npos) << o.errors;
  EXPECT_EQ(call("run grain.toml --resume --hash --out closed").hash(), hash);
}

TEST_F(CommandLine, AFileNameThatIsNoUtf8IsFine) {
  writeGrain("h\xfcgel.toml");
  const Outcome o = call("run h\xfcgel.toml --out r\xfcn");
  EXPECT_EQ(o.code, 0) << o.errors;
  EXPECT_NE(contents(folder_ / "r\xfcn" / "manifest.json").find("h\xef\xbf\xbdgel.toml"), std::string::npos);
}

TEST_F(CommandLine, StepsThatEndARunAreNamed) {
  writeGrain();
  ASSERT_EQ(call("run grain.toml --steps 50 --out run").code, 0);
  EXPECT_NE(contents(folder_ / "run" / "manifest.json").find("\"ended_by\": \"--steps 50\""), std::string::npos);
  ASSERT_EQ(call("run grain.toml --resume --out run").code, 0);
  EXPECT_EQ(contents(folder_ / "run" / "manifest.json").find("ended_by"), std::string::npos);
}

TEST_F(CommandLine, PlanRunsNothing) {
  std::ofstream(folder_ / "scene.toml") << goodScene();
  const Outcome o = call("plan scene.toml");
  ASSERT_EQ(o.code, 0) << o.errors;
  for (const char* part :
       {"on   grains", "on   vehicle", "off  picture", "off  planes", "grain steps", "time step", "memory"})
    EXPECT_NE(o.out.find(part), std::string::npos) << part << "\n" << o.out;
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(CommandLine, FieldsNameEveryDriverKey) {
  const Outcome o = call("fields");
  EXPECT_EQ(o.code, 0);
  EXPECT_NE(o.out.find("| `sprocket_speed` | rad/s | none | [-100, 100]; usually at most 60 |"), std::string::npos);
}

} // namespace
} // namespace grouser::commands
