// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/runs/folder_fixture.hpp"

#include <sys/wait.h>

#include <chrono>
#include <cstdlib>
#include <regex>

namespace grouser::test {

/// What a call of the program left.
struct Outcome {
  int code = -1; ///< its exit status; 128 + the signal where one ended it, as of a shell
  std::string out, errors;
  double seconds = 0;

  /// "state-hash 0123456789abcdef step 100", or everything where there is none.
  std::string hash() const {
    std::smatch match;
    return std::regex_search(out, match, std::regex("state-hash [0-9a-f]{16} step [0-9]+")) ? match.str()
                                                                                            : out + errors;
  }
  bool hasHash() const { return hash().rfind("state-hash ", 0) == 0; }

  /// What the program calls an error, in its own words: the rest of that line; empty where there is none, or another
  /// after it.
  std::string error() const {
    const std::string before = "grouser: error: ";
    const std::size_t at = errors.find(before);
    if (at == std::string::npos || errors.find(before, at + 1) != std::string::npos) return "";
    const std::size_t from = at + before.size();
    return errors.substr(from, errors.find('\n', from) - from);
  }
};

/// The program lies beside the tests.
inline std::filesystem::path programUnderTest() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "grouser";
}

/// Commands of a shell in `folder`, with the program as $grouser. What they print lies beside the folder, in FOLDER.out
/// and FOLDER.err: all that is in it the program or the test has put there. Nothing is kept from run to run.
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

/// A test that calls the program as a user does, in a folder of its own.
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
  /// `grouser WORDS`; `before`: for the shell, to do first.
  Outcome call(const std::string& words, const std::string& before = "") const {
    return shell(before + "\"$grouser\" " + words);
  }
};

} // namespace grouser::test
