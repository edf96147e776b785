// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/shell_word.hpp"

#include "tests/runs/folder_fixture.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace grouser::support {

namespace {

TEST(ShellWord, PlainWordsStayAsTheyAre) {
  EXPECT_EQ(shellLine({"build/bin/grouser", "run", "a.toml", "--set", "run.seed=1,2"}),
            "build/bin/grouser run a.toml --set run.seed=1,2");
}

class ShellLine : public test::FolderTest {};

/// Compares with the shell itself.
TEST_F(ShellLine, AShellTakesEachWordForOne) {
  const std::vector<std::string> words{"two words", "it's", "a=[1, 2]", "$HOME", "`x`",
                                       "",          "a;b",  "~",        "#",     "h\xc3\xbcgel"};
  const std::string file = folder_ / "words";
  const std::string each = "for word in " + shellLine(words) + "; do printf '<%s>' \"$word\"; done >'" + file + "'";
  ASSERT_EQ(std::system(each.c_str()), 0) << each;
  EXPECT_EQ(test::contents(file), "<two words><it's><a=[1, 2]><$HOME><`x`><><a;b><~><#><h\xc3\xbcgel>");
}

} // namespace
} // namespace grouser::support
