// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/child_process.hpp"
#include "runs/support/program_call.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <thread>

namespace grouser::support {
namespace {

namespace fs = std::filesystem;
using test::contents;

class ChildProcesses : public test::FolderTest {
protected:
  static Program shell(const std::string& commands) { return {.words = {"sh", "-c", commands}}; }
  static std::string outputOf(ChildProcess& child) {
    std::string text;
    while (child.read(text)) continue;
    return text;
  }
  /// The process id in the first line of a program's output.
  static pid_t processOf(ChildProcess& child) {
    std::string text;
    while (text.find('\n') == std::string::npos && child.read(text)) continue;
    return std::stoi(text);
  }
  static bool isThere(pid_t process) { return kill(process, 0) == 0 || errno != ESRCH; }
  static std::string errorOf(const Program& program) {
    try {
      const ChildProcess child(program);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  /// The text of the file once it has this line, or after 10 s.
  static std::string awaited(const fs::path& file, const std::string& line) {
    for (int look = 0; look < 1000 && contents(file).find(line + "\n") == std::string::npos; ++look)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return contents(file);
  }
  static std::ptrdiff_t openFiles() {
    return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
  }
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

TEST_F(ChildProcesses, ThatCannotBeStartedAreAnErrorWithItsCause) {
  EXPECT_EQ(errorOf({.words = {"/no/such/program", "--help"}}),
            "/no/such/program cannot be started: No such file or directory");
  EXPECT_EQ(errorOf({.words = {folder_.string()}}), folder_.string() + " cannot be started: Permission denied");
  const fs::path log = folder_ / "none" / "log.txt";
  EXPECT_EQ(errorOf({.words = {"true"}, .log = log}), log.string() + " cannot be written: No such file or directory");
  EXPECT_EQ(errorOf({.words = {"true"}}), "");
}

TEST_F(ChildProcesses, OutputGoesIntoAFileOrAPipe) {
  ChildProcess piped(shell("echo one; echo two >&2"));
  EXPECT_EQ(outputOf(piped), "one\ntwo\n");
  EXPECT_EQ(piped.output(), -1);
  const auto log = [&](const std::string& words, bool append) {
    Program program = shell("echo " + words + "; echo two >&2");
    program.log = folder_ / "log.txt", program.append = append;
    EXPECT_EQ(ChildProcess(program).wait().status, 0);
    return contents(program.log);
  };
  EXPECT_EQ(log("former", false), "former\ntwo\n");
  EXPECT_EQ(log("one", false), "one\ntwo\n");
  EXPECT_EQ(log("more", true), "one\ntwo\nmore\ntwo\n");
}

TEST_F(ChildProcesses, InputComesThroughAPipe) {
  const std::string much(300'000, 'x'); // more than a pipe's capacity
  ChildProcess reader({.words = {"cat"}, .log = folder_ / "log.txt", .input = true});
  EXPECT_TRUE(reader.write("first ") && reader.write(much));
  EXPECT_EQ(reader.wait().status, 0);
  EXPECT_EQ(contents(folder_ / "log.txt"), "first " + much);
  ChildProcess deaf({.words = {"true"}, .log = folder_ / "log.txt", .input = true});
  EXPECT_FALSE(deaf.write(much)) << "and SIGPIPE did not end this process";
  EXPECT_EQ(deaf.wait().status, 0);
}

TEST_F(ChildProcesses, InheritNoPipesOfOthersAndLeaveNoneOpen) {
  const std::ptrdiff_t before = openFiles();
  {
    ChildProcess reader({.words = {"cat"}, .log = folder_ / "log.txt", .input = true});
    const ChildProcess other(shell("exec sleep 20"));
    EXPECT_EQ(reader.wait().status, 0);
    EXPECT_LT(seconds(), 10) << "its input ends although the other process exists";
    EXPECT_NE(errorOf({.words = {"/no/such/program"}, .input = true}), "");
  }
  EXPECT_EQ(openFiles(), before);
}

TEST_F(ChildProcesses, HaveVariablesOfTheirOwn) {
  setenv("GROUSER_TEST_KEPT", "kept", 1);
  Program program = shell("echo $GROUSER_TEST_KEPT $GROUSER_TEST_NEW");
  program.environment = {{"GROUSER_TEST_NEW", "new"}};
  ChildProcess child(program);
  EXPECT_EQ(outputOf(child), "kept new\n");
  EXPECT_EQ(std::getenv("GROUSER_TEST_NEW"), nullptr);
  unsetenv("GROUSER_TEST_KEPT");
}

TEST_F(ChildProcesses, EndWithAStatusOrASignal) {
  const ProcessEnd failed = ChildProcess(shell("exit 3")).wait();
  EXPECT_EQ(failed.status, 3);
  EXPECT_EQ(failed.text(), "ended with exit code 3");
  const ProcessEnd killed = ChildProcess(shell("kill -9 $$")).wait();
  EXPECT_EQ(killed.status, -1);
  EXPECT_EQ(killed.signal, SIGKILL);
  EXPECT_EQ(killed.text(), "ended by signal 9 (Killed)");
  ChildProcess waits({.words = {"cat"}, .log = folder_ / "log.txt", .input = true});
  EXPECT_FALSE(waits.ended());
  EXPECT_EQ(waits.wait().status, 0);
  EXPECT_EQ(waits.ended()->status, 0) << "it remains available";
}

TEST_F(ChildProcesses, HaveTheDefaultOfBrokenPipes) {
  const auto former = std::signal(SIGPIPE, SIG_IGN);
  EXPECT_EQ(ChildProcess(shell("kill -PIPE $$")).wait().signal, SIGPIPE);
  std::signal(SIGPIPE, former);
}

TEST_F(ChildProcesses, EndWithTheirObject) {
  pid_t process = 0;
  {
    ChildProcess program(shell("echo $$; exec sleep 20"));
    process = processOf(program);
    EXPECT_TRUE(isThere(process));
  }
  EXPECT_FALSE(isThere(process));
  {
    ChildProcess function([](const Descriptor& report) {
      std::signal(SIGTERM, SIG_IGN);
      report.write(std::to_string(getpid()) + "\n");
      sleep(20);
    });
    process = processOf(function);
    EXPECT_TRUE(isThere(process));
  }
  EXPECT_FALSE(isThere(process));
  EXPECT_LT(seconds(), 10);
}

TEST_F(ChildProcesses, EndWithTheirParent) {
  const fs::path log = folder_ / "log.txt";
  ChildProcess parent([&](const Descriptor& report) {
    Program program = shell("trap 'echo saved; exit' TERM; echo ready; for k in $(seq 400); do sleep 0.05; done");
    program.log = log;
    const ChildProcess saves(program), function([](const Descriptor&) { sleep(20); });
    awaited(log, "ready");
    report.write("both run");
    std::raise(SIGKILL);
  });
  // The function also has the report open: it ends when both have closed it.
  EXPECT_EQ(outputOf(parent), "both run");
  EXPECT_LT(seconds(), 10);
  EXPECT_EQ(parent.wait().signal, SIGKILL);
  EXPECT_EQ(awaited(log, "saved"), "ready\nsaved\n");
}

TEST_F(ChildProcesses, AreAskedToEndOnlyOnce) {
  const fs::path log = folder_ / "log.txt";
  {
    Program program = shell("trap 'echo asked' TERM; echo ready; for k in $(seq 20); do sleep 0.05; done; echo over");
    program.log = log;
    ChildProcess child(program);
    awaited(log, "ready");
    child.terminate();
    awaited(log, "asked");
    child.terminate();
  } // waits for it; no further input
  EXPECT_EQ(contents(log), "ready\nasked\nover\n");
}

TEST_F(ChildProcesses, OfFunctionsLeaveCtrlCToTheirParent) {
  ChildProcess child([](const Descriptor& report) {
    std::raise(SIGINT);
    std::raise(SIGHUP);
    report.write("goes on");
  });
  EXPECT_EQ(outputOf(child), "goes on");
  EXPECT_EQ(child.wait().status, 0);
  EXPECT_EQ(ChildProcess([](const Descriptor&) { throw std::runtime_error("not caught"); }).wait().signal, SIGABRT);
}

TEST_F(ChildProcesses, CalledAndWaitedForHaveAnOutcome) {
  const CallOutcome good = callProgram({"sh", "-c", "echo $WORD; exit 4"}, {{"WORD", "hello"}});
  EXPECT_TRUE(good.started);
  EXPECT_EQ(good.status, 4);
  EXPECT_EQ(good.output, "hello\n");
  const CallOutcome missing = callProgram({"no-such-program"});
  EXPECT_FALSE(missing.started);
  EXPECT_EQ(missing.status, -1);
  EXPECT_EQ(missing.output, "no-such-program cannot be started: No such file or directory");
  const CallOutcome killed = callProgram({"sh", "-c", "echo hello; kill -9 $$"});
  EXPECT_TRUE(killed.started);
  EXPECT_EQ(killed.status, -1);
  EXPECT_EQ(lastLine(killed.output), "sh was ended by signal 9 (Killed)");
}

} // namespace
} // namespace grouser::support
