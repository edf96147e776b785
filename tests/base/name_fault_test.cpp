// SPDX-License-Identifier: BSD-3-Clause
// Names and texts of a user: characters that mislead a reader are refused, or escaped in messages.
#include "base/name_fault.hpp"
#include "base/table.hpp"
#include "tests/message_of.hpp"

#include <gtest/gtest.h>

#include <string>

namespace grouser::base {
namespace {

/// Characters that reverse the text behind them, byte by byte, since the linter takes them in literals for an attack.
const std::string kOverride{'\xE2', '\x80', '\xAE'}, kIsolate{'\xE2', '\x81', '\xA7'};

TEST(NameFault, ControlAndInvisibleCharactersAreRefusedAndEscaped) {
  const std::pair<std::string, std::string> bad[] = {{"a\x1B[31mb", "a\\x1B[31mb"}, // terminal escape
                                                     {"a\x7F", "a\\x7F"},           // DEL
                                                     {"a\xC2\x9B", "a\\u009B"},     // C1: escape of 8-bit terminals
                                                     {"a" + kOverride + ".b", "a\\u202E.b"}, // right-to-left override
                                                     {"a\xE2\x80\x8E", "a\\u200E"},          // left-to-right mark
                                                     {"a\xD8\x9C", "a\\u061C"},              // Arabic letter mark
                                                     {"a\xE2\x80\x8B", "a\\u200B"},          // zero-width space
                                                     {"a" + kIsolate, "a\\u2067"},           // right-to-left isolate
                                                     {"a\xE2\x80\xA9", "a\\u2029"},          // paragraph separator
                                                     {"\xEF\xBB\xBF", "\\uFEFF"},            // byte-order mark
                                                     {"a\xC2\xAD", "a\\u00AD"},              // soft hyphen
                                                     {"\xF3\xA0\x81\x81", "\\U000E0041"},    // tag
                                                     {"a\xFF", "a\\xFF"},                    // no UTF-8
                                                     {"a\xE2\x80", "a\\xE2\\x80"},           // cut off
                                                     {"\xC0\xAF", "\\xC0\\xAF"}};            // overlong
  for (const auto& [text, shown] : bad) {
    EXPECT_TRUE(hasControlCharacter(text)) << shown;
    EXPECT_NE(nameFault(text).find("control character"), std::string::npos) << shown;
    EXPECT_EQ(escaped(text), shown);
  }
  for (const char* good : {"left wheel", "Rad \xC3\xA4", "\xE8\xBD\xAE", "\xD8\xB9\xD8\xAC\xD9\x84\xD8\xA9",
                           "\xF0\x9F\x9A\x9C", "a\xE2\x80\x8D-"}) {
    EXPECT_EQ(nameFault(good), "") << good;
    EXPECT_EQ(escaped(good), good);
  }
  EXPECT_EQ(escaped("two\nlines\t."), "two\nlines\t.");
}

TEST(NameFault, LengthsAreCountedInCharacters) {
  std::string wheels;
  for (int i = 0; i < 64; ++i) wheels += "\xE8\xBD\xAE";
  EXPECT_EQ(characters(wheels), 64u);
  EXPECT_EQ(nameFault(wheels), "");
  EXPECT_EQ(nameFault(wheels + "a"), "has 65 characters, more than 64; shorten it");
  EXPECT_EQ(textFault(std::string(200, 'a')), "");
  EXPECT_NE(textFault(std::string(201, 'a')), "");
}

TEST(NameFault, MessagesShowTextsEscapedAndLongOnesAbbreviated) {
  const Document document =
      Document::parse("version = 1\nname = \"a\\u202Eb\"\ntext = \"" + std::string(5000, 'x') + "\"\n", "a.toml");
  const Section root = document.root();
  EXPECT_EQ(test::messageOf([&] { root.fail("name", "is bad"); }), "a.toml:2: name = \"a\\u202Eb\" is bad");
  const std::string text = test::messageOf([&] { root.fail("text", "is long"); });
  EXPECT_EQ(text, "a.toml:3: text = \"" + std::string(40, 'x') + "\"... (5000 characters) is long");
  // A character is not cut in two.
  const Document wheels = Document::parse(
      "version = 1\ntext = \"" + std::string(39, 'x') + "\xE8\xBD\xAE" + std::string(5000, 'x') + "\"\n", "b.toml");
  EXPECT_NE(
      test::messageOf([&] { wheels.root().fail("text", "is long"); }).find("x\xE8\xBD\xAE\"... (5040 characters)"),
      std::string::npos);
  // Written TOML is read as the same text.
  const std::string written = toToml(FieldValue("a" + kOverride + "\xF3\xA0\x81\x81" + "b\x7F"));
  EXPECT_EQ(written, "\"a\\u202E\\U000E0041b\\u007F\"");
  const Document again = Document::parse("version = 1\nname = " + written, "b.toml");
  EXPECT_EQ(std::get<std::string>(again.root().node().find("name")->value),
            "a" + kOverride + "\xF3\xA0\x81\x81" + "b\x7F");
}

TEST(NameFault, NumbersBeyondTheRangeAreNamed) {
  const auto fault = [](const std::string& line, const std::vector<std::string>& sets = {}) {
    return test::messageOf([&] { Document::parse("version = 1\n" + line, "a.toml", sets); });
  };
  EXPECT_EQ(fault("x = 1e400"),
            "a.toml:2: the number 1e400 is out of the range of double precision, 1.8e308; use a smaller number");
  EXPECT_NE(fault("x = [0, -1e400]").find("is out of the range of double precision"), std::string::npos);
  EXPECT_NE(fault("x = 99999999999999999999").find("out of the range of integers (64 bits)"), std::string::npos);
  for (const char* set : {"x=1e400", "x=-1e400", "x=[0, 0, 1e400]", "x={y=1e999}"})
    EXPECT_EQ(fault("", {set}).find(std::string("--set ") + set + ": the number 1e"), 0u) << fault("", {set});
  EXPECT_EQ(fault("", {"x=99999999999999999999"}).find("--set x=99999999999999999999: the number 9999"), 0u);
  EXPECT_EQ(fault("x = 1e308"), "");
  EXPECT_EQ(fault("", {"x=dry_sand", "y=1.2.3"}), "");
  EXPECT_NE(fault("x = 1.2.3").find("not valid TOML"), std::string::npos);
}

} // namespace
} // namespace grouser::base
