// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/runs/folder_fixture.hpp"

#include <sys/wait.h>

#include <chrono>
#include <cstdlib>
#include <regex>

namespace grouser::test {

/// Result of a call of the program.
struct Outcome {
  int code = -1; ///< its exit status; 128 + the signal if one ended it, as in a shell
  std::string out, errors;
  double seconds = 0;

  /// "state-hash 0123456789abcdef step 100", or the whole output without one.
  std::string hash() const {
    std::smatch match;
    return std::regex_search(out, match, std::regex("state-hash [0-9a-f]{16} step [0-9]+")) ? match.str()
                                                                                            : out + errors;
  }
  bool hasHash() const { return hash().rfind("state-hash ", 0) == 0; }

  /// Error message of the program: the rest of that line; empty if there is none, or if another
  /// follows.
  std::string error() const {
    const std::string before = "grouser: error: ";
    const std::size_t at = errors.find(before);
    if (at == std::string::npos || errors.find(before, at + 1) != std::string::npos) return "";
    const std::size_t from = at + before.size();
    return errors.substr(from, errors.find('\n', from) - from);
  }
};

/// The program is in the folder of the tests.
inline std::filesystem::path programUnderTest() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "grouser";
}

/// Shell commands in `folder`, with the program as $grouser. Their output is written next to the folder, to FOLDER.out
/// and FOLDER.err: `folder` holds only files of the program or the test. Each run starts without kept files.
inline Outcome shellIn(const std::filesystem::path& folder, const std::string& commands) {
  const std::string out = folder.string() + ".out", errors = folder.string() + ".err";
  const auto start = std::chrono::steady_clock::now();
  const std::string all = "cd '" + folder.string() + "' && export GROUSER_CACHE= && grouser='" +
                          programUnderTest().string() + "' && { " + commands + "\n} >'" + out + "' 2>'" + errors + "'";
  const int status = std::system(all.c_str());
  Outcome o;
  o.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  o.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  o.out = contents(out), o.errors = contents(errors);
  return o;
}

/// A test that calls the program from the command line, in its own folder.
class ProgramTest : public FolderTest {
protected:
  void SetUp() override {
    FolderTest::SetUp();
    ASSERT_TRUE(std::filesystem::exists(programUnderTest())) << "build the target grouser first";
  }
  void TearDown() override {
    for (const char* stream : {".out", ".err"}) std::filesystem::remove(folder_.string() + stream);
    FolderTest::TearDown();
  }

  Outcome shell(const std::string& commands) const { return shellIn(folder_, commands); }
  /// `grouser WORDS`; `before`: shell commands that run first.
  Outcome call(const std::string& words, const std::string& before = "") const {
    return shell(before + "\"$grouser\" " + words);
  }
};

} // namespace grouser::test
