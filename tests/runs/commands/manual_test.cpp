// SPDX-License-Identifier: BSD-3-Clause
// Manual and shell completion agree with --help.
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <string>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

using Manual = ProgramTest;

/// "--out" and the like.
std::set<std::string> optionsIn(const std::string& text) {
  static const std::regex option("--[a-z][a-z-]*");
  return {std::sregex_token_iterator(text.begin(), text.end(), option), {}};
}

std::string withoutEscapes(const std::string& roff) { return std::regex_replace(roff, std::regex("\\\\-"), "-"); }

TEST_F(Manual, PagesHaveEveryOptionOfHelpAndNoMore) {
  const std::set<std::string> none;
  for (const std::string command : {"run", "sweep", "check", "plan", "soil", "render", "report", "fields", "manual"}) {
    const std::string help = call(command + " --help").out;
    const Outcome page = call("manual " + command);
    EXPECT_EQ(page.code, 0) << page.errors;
    EXPECT_EQ(page.out.find(".TH GROUSER\\-" + std::string(1, static_cast<char>(std::toupper(command[0])))),
              page.out.find(".TH"))
        << page.out.substr(0, 200);
    EXPECT_EQ(optionsIn(withoutEscapes(page.out)), optionsIn(help)) << command;
    EXPECT_NE(optionsIn(help), none);
  }
}

TEST_F(Manual, ThePageOfTheProgramNamesEveryCommandAndTheExitCodes) {
  const std::string page = withoutEscapes(call("manual").out);
  for (const char* word : {"grouser-run", "grouser-manual", "grouser-bench", "Exit codes", "GROUSER_CACHE"})
    EXPECT_NE(page.find(word), std::string::npos) << word;
  EXPECT_NE(withoutEscapes(call("manual bench").out).find(".SH GROUSER BENCH BED"), std::string::npos);
}

TEST_F(Manual, OutAndOutputAreNamesOfOneOption) {
  const std::string options = call("manual --markdown").out;
  EXPECT_NE(options.find("`--out, --output TEXT`"), std::string::npos);
  for (const char* alone : {"`--out TEXT`", "`--output TEXT`"}) EXPECT_EQ(options.find(alone), std::string::npos);
}

TEST_F(Manual, FilesAreWrittenBelowAFolder) {
  EXPECT_EQ(call("manual --folder made").code, 0);
  EXPECT_EQ(contents(folder_ / "made/man/man1/grouser-run.1"), call("manual run").out);
  EXPECT_EQ(contents(folder_ / "made/bash-completion/completions/grouser"), call("manual --completion").out);
}

TEST_F(Manual, OfNoCommandNamesTheNearest) {
  const Outcome o = call("manual runn");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.error().find("did you mean \"run\""), std::string::npos) << o.errors;
  EXPECT_EQ(call("manual run --completion").code, 2);
}

} // namespace
} // namespace grouser::commands
