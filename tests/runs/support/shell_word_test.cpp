// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/shell_word.hpp"

#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

namespace grouser::support {

namespace {

TEST(ShellWord, PlainWordsStayAsTheyAre) {
  EXPECT_EQ(shellLine({"build/bin/grouser", "run", "a.toml", "--set", "run.seed=1,2"}),
            "build/bin/grouser run a.toml --set run.seed=1,2");
}

class ShellLine : public test::ProgramTest {};

/// The shell itself is asked.
TEST_F(ShellLine, AShellTakesEachWordForOne) {
  const std::vector<std::string> words{"two words", "it's", "a=[1, 2]", "$HOME", "`x`",
                                       "",          "a;b",  "~",        "#",     "h\xc3\xbcgel"};
  const test::Outcome o = shell("for word in " + shellLine(words) + "; do printf '<%s>' \"$word\"; done");
  EXPECT_EQ(o.out, "<two words><it's><a=[1, 2]><$HOME><`x`><><a;b><~><#><h\xc3\xbcgel>") << o.errors;
}

} // namespace
} // namespace grouser::support
