// SPDX-License-Identifier: BSD-3-Clause
// Interrupted calls: the last line is the command to continue, and it works; partial runs resume from their
// checkpoints, bitwise identical.
#include "runs/support/file_lock.hpp"
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <filesystem>
#include <future>
#include <string>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

/// A grain that falls and bounces, 5e5 steps: more than a second, so that a signal arrives before its end on a busy
/// machine too.
constexpr const char* kFall =
    "version = 1\n[run]\nduration = 0.5\ntime_step = 1e-6\noutput_interval = 1e-3\nthreads = 1\n[material.glass]\n"
    "[[grain]]\nposition = [0, 0, 1]\nradius = 0.01\nmaterial = \"glass\"\n[[plane]]\npoint = [0, 0, 0.98]\n"
    "material = \"glass\"\n[output]\nplots = false\npicture = false\nframes = false\n";

class StoppedCall : public ProgramTest {
protected:
  void SetUp() override {
    ProgramTest::SetUp();
    put(folder_ / "fall.toml", kFall);
  }
  /// Sends a signal once a shell condition holds: INT to the program and all its children, as Ctrl-C in a
  /// terminal does (shells without a terminal ignore it in the background), others only to the program.
  Outcome stop(const std::string& words, const std::string& signal, const std::string& until) const {
    const std::string start =
        "/usr/bin/python3 -c \"import os, signal, sys; signal.signal(signal.SIGINT, signal.SIG_DFL); os.setpgrp(); "
        "os.execv(sys.argv[1], sys.argv[1:])\" \"$grouser\" ";
    const std::string send =
        signal == "INT" ? "/usr/bin/python3 -c \"import os; os.killpg($pid, 2)\"" : "kill -" + signal + " $pid";
    return shell(start + words + " & pid=$!\nfor i in $(seq 3000); do " + until + " && break; sleep 0.01; done\n" +
                 send + "\nwait $pid\nexit $?");
  }
  /// Text after "with: "; empty if an interrupted call prints none.
  static std::string nextOf(const Outcome& o) {
    const std::string before = " with: ";
    const std::size_t at = o.errors.rfind(before);
    return at == std::string::npos ? ""
                                   : o.errors.substr(at + before.size(), o.errors.find('\n', at) - at - before.size());
  }
  nlohmann::json manifest(const std::string& run) const {
    return nlohmann::json::parse(contents(folder_ / run / "manifest.json"));
  }
};

TEST_F(StoppedCall, OfARunNamesTheCommandThatGoesOn) {
  const std::string words = "run fall.toml --set run.seed=4 --out r --force";
  const Outcome stopped = stop(words, "INT", "[ -s r/timeseries.csv ]");
  ASSERT_EQ(stopped.code, 130) << stopped.errors;
  EXPECT_NE(stopped.errors.find("; resume with: " + programUnderTest().string() +
                                " run fall.toml --set run.seed=4 --out r --resume\n"),
            std::string::npos)
      << stopped.errors;
  const Outcome on = shell(nextOf(stopped) + " --hash");
  ASSERT_EQ(on.code, 0) << on.errors;
  EXPECT_NE(on.out.find("resumed "), std::string::npos) << on.out;
  EXPECT_EQ(on.hash(), call("run fall.toml --set run.seed=4 --out whole --hash").hash());
}

TEST_F(StoppedCall, OfASweepGoesOnFromTheCheckpointsOfItsRuns) {
  const std::string words = "sweep fall.toml --set run.seed=1,2 --jobs 2 --out s";
  const Outcome stopped = stop(words, "INT", "[ -s s/seed=1/timeseries.csv ] && [ -s s/seed=2/timeseries.csv ]");
  ASSERT_EQ(stopped.code, 130) << stopped.errors;
  EXPECT_NE(stopped.errors.find(" after 0 of 2 runs; resume with: "), std::string::npos) << stopped.errors;
  EXPECT_EQ(manifest("s/seed=1")["status"], "stopped");
  const Outcome on = shell(nextOf(stopped));
  ASSERT_EQ(on.code, 0) << on.errors << on.out;
  for (const char* run : {"s/seed=1", "s/seed=2"})
    EXPECT_NE(contents(folder_ / run / "log.txt").find("resumed "), std::string::npos) << "the run was restarted";
  const Outcome whole = call("sweep fall.toml --set run.seed=1,2 --out whole");
  ASSERT_EQ(whole.code, 0) << whole.errors;
  EXPECT_EQ(manifest("s/seed=2")["state_hash"], manifest("whole/seed=2")["state_hash"]);
  EXPECT_EQ(contents(folder_ / "s/seed=2/timeseries.csv"), contents(folder_ / "whole/seed=2/timeseries.csv"));
}

TEST_F(StoppedCall, OfASweepThatWasKilledGoesOnByTheSameCommand) {
  const std::string words = "sweep fall.toml --set run.seed=1,2 --out s";
  const Outcome killed = stop(words, "KILL", "[ -s s/seed=1/timeseries.csv ]");
  ASSERT_EQ(killed.code, 137) << killed.errors;
  const Outcome on = call(words); // its run gets a SIGTERM and writes a checkpoint
  ASSERT_EQ(on.code, 0) << on.errors << on.out;
  EXPECT_NE(on.out.find("resumes from its checkpoint"), std::string::npos) << on.out;
}

TEST_F(StoppedCall, SweepWaitsForTheCheckpointOfARunThatIsStillEnding) {
  const std::string words = "sweep fall.toml --set run.seed=1 --out s";
  ASSERT_EQ(stop(words, "TERM", "[ -s s/seed=1/timeseries.csv ]").code, 143);
  const fs::path run = folder_ / "s/seed=1", checkpoint = run / "checkpoint.h5", aside = folder_ / "aside.h5";
  const nlohmann::json stopped = manifest("s/seed=1");
  nlohmann::json running = stopped;
  running["status"] = "running";
  fs::rename(checkpoint, aside);
  put(run / "manifest.json", running.dump());
  support::FileLock lock; // as held by the run until its end
  ASSERT_TRUE(lock.take(run));
  std::future<Outcome> on = std::async(std::launch::async, [&] { return call(words); });
  EXPECT_EQ(on.wait_for(std::chrono::seconds(1)), std::future_status::timeout);
  fs::rename(aside, checkpoint);
  put(run / "manifest.json", stopped.dump());
  lock.release();
  const Outcome ended = on.get();
  ASSERT_EQ(ended.code, 0) << ended.errors << ended.out;
  EXPECT_NE(ended.out.find("resumes from its checkpoint"), std::string::npos) << ended.out;
}

TEST_F(StoppedCall, WithADamagedCheckpointBeginsThatRunAnew) {
  const std::string words = "sweep fall.toml --set run.seed=1,2 --out s";
  ASSERT_EQ(stop(words, "TERM", "[ -s s/seed=1/timeseries.csv ]").code, 143);
  fs::resize_file(folder_ / "s/seed=1/checkpoint.h5", 1000);
  const Outcome on = call(words + " --resume");
  ASSERT_EQ(on.code, 0) << on.errors << on.out;
  EXPECT_NE(on.out.find("restarts: "), std::string::npos) << on.out;
  EXPECT_EQ(manifest("s/seed=1")["status"], "finished");
}

TEST_F(StoppedCall, OfACheckGoesOn) {
  const std::string words = "check fall.toml --axes step --seeds 2 --out c";
  const Outcome stopped = stop(words, "INT", "ls c/*/timeseries.csv > /dev/null 2>&1");
  ASSERT_EQ(stopped.code, 130) << stopped.errors;
  const Outcome on = shell(nextOf(stopped));
  ASSERT_EQ(on.code, 0) << on.errors << on.out;
  EXPECT_TRUE(fs::exists(folder_ / "c/check.json"));
}

TEST_F(StoppedCall, OfForcedSweepDoesNotRunAllAgain) {
  const Outcome stopped = stop("sweep fall.toml --set run.seed=1,2 --out s --force", "INT",
                               "grep -q finished s/seed=1/manifest.json 2>/dev/null");
  ASSERT_EQ(stopped.code, 130) << stopped.errors;
  EXPECT_EQ(nextOf(stopped).find("--force"), std::string::npos) << stopped.errors;
  const Outcome on = shell(nextOf(stopped));
  ASSERT_EQ(on.code, 0) << on.errors;
  EXPECT_NE(on.out.find("seed=1                       already finished"), std::string::npos) << on.out;
}

} // namespace
} // namespace grouser::commands
