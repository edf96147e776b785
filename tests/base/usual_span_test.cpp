// SPDX-License-Identifier: BSD-3-Clause
// Notes on values outside the usual span of their key, which name the unit that was probably meant.
#include "base/error.hpp"
#include "base/table.hpp"
#include "tests/message_of.hpp"

#include <gtest/gtest.h>

namespace grouser::base {
namespace {

struct Pile {
  double angle = 0, length = 1, ratio = 0, pause = 1, exponent = 1, young = 1e9;
  std::optional<double> pressure;
  Vec3d gravity;
  std::vector<double> times;
};

Table<Pile> pileTable() {
  Table<Pile> t("pile", "A pile");
  t.add("angle", &Pile::angle, "deg", "angle of repose").plausible(4, 50).atLeast(0).atMost(90);
  t.add("length", &Pile::length, "m", "length").plausible(0.01, 10).above(0).atMost(1e5);
  t.add("ratio", &Pile::ratio, "-", "ratio").plausible(0, 1).atLeast(-1).atMost(1);
  t.add("pressure", &Pile::pressure, "Pa", "pressure").plausible(100, 1e6, "absolute pressure?");
  t.add("gravity", &Pile::gravity, "m/s2", "gravity").plausible(1.2, 30);
  t.add("pause", &Pile::pause, "s", "pause").plausible(0.01, 60);
  t.add("exponent", &Pile::exponent, "-", "exponent").plausible(0.1, 2);
  t.add("young", &Pile::young, "Pa", "Young's modulus").plausible(2e4, 1.3e12);
  t.add("times", &Pile::times, "s", "times").plausible(0, 100);
  return t;
}

std::vector<std::string> notesOn(const std::string& keys) {
  const Document document = Document::parse("version = 1\n[pile]\n" + keys, "a.toml");
  document.root().section("pile").read(pileTable());
  document.root().section("pile").read(pileTable()); // a second reading adds nothing
  std::vector<std::string> notes;
  for (const UnusualValue& unusual : document.unusual()) notes.push_back(unusual.note);
  return notes;
}

TEST(UsualSpan, ValuesOutsideAreNotedWithPlaceAndLikelyUnit) {
  const std::vector<std::string> notes = notesOn("angle = 0.54\n");
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0], "a.toml:3: pile.angle = 0.54 [deg] is outside the usual span, 4 to 50 deg; in radians? 0.54 rad "
                      "= 30.94 deg");
}

TEST(UsualSpan, UsualValuesAndZeroAreNotNoted) {
  EXPECT_TRUE(notesOn("angle = 30\nlength = 0.01\nratio = 1\npressure = 1e6\ngravity = [0, 0, -9.81]\ntimes = [0, 5]\n")
                  .empty());
  EXPECT_TRUE(notesOn("angle = 0\nratio = 0\npressure = 0\ngravity = [0, 0, 0]\n").empty());
}

TEST(UsualSpan, TheLargestComponentCounts) {
  EXPECT_EQ(notesOn("gravity = [0, 0.1, -9.81]\n").size(), 0u);
  EXPECT_NE(notesOn("gravity = [0, 0, -9810]\n").at(0).find("in mm/s2? -9810 mm/s2 = -9.81 m/s2"), std::string::npos);
  EXPECT_NE(notesOn("gravity = [0, 0, -1]\n").at(0).find("in multiples of g? -1 g = -9.807 m/s2"), std::string::npos);
  EXPECT_NE(notesOn("times = [0, 500, 2000]\n").at(0).find("in milliseconds? 2000 ms = 2 s"), std::string::npos);
}

TEST(UsualSpan, TheFirstUnitThatFitsIsNamedOrElseTheMistakeOfTheKey) {
  EXPECT_NE(notesOn("length = 500\n").at(0).find("in millimetres? 500 mm = 0.5 m"), std::string::npos);
  EXPECT_NE(notesOn("pressure = 1.3\n").at(0).find("in kPa? 1.3 kPa = 1300 Pa"), std::string::npos);
  EXPECT_NE(notesOn("pressure = 1e8\n").at(0).find("; absolute pressure?"), std::string::npos);
  EXPECT_NE(notesOn("gravity = [0, 0, -300]\n").at(0).find("in cm/s2"), std::string::npos);
}

TEST(UsualSpan, FractionsOfATurnInRadiansAreNotedInsideTheSpanToo) {
  for (const char* turn : {"6.2832", "4.7124"})
    EXPECT_NE(
        notesOn(std::string("angle = ") + turn + "\n").at(0).find("fraction of a turn in radians; check the value"),
        std::string::npos);
  EXPECT_TRUE(notesOn("angle = 4.5\n").empty());
}

TEST(UsualSpan, UnitsThatNobodyUsesForTheQuantityAreNotNamed) {
  // Kilometres, minutes, and 1 %: each factor leads into the span, but nobody enters these values so.
  for (const char* keys : {"length = 1e-4\n", "length = 0.002\n", "pause = 0.001\n", "pause = 1e-320\n",
                           "pause = 9e7\n", "exponent = 20\n"}) {
    const std::vector<std::string> notes = notesOn(keys);
    ASSERT_EQ(notes.size(), 1u) << keys;
    EXPECT_NE(notes[0].find("; check the value and its unit"), std::string::npos) << notes[0];
  }
  const std::string error = test::messageOf([] { notesOn("ratio = 1.0000001\n"); });
  EXPECT_NE(error.find("is outside [-1, 1]; choose a value"), std::string::npos) << error;
  EXPECT_NE(notesOn("young = 70\n").at(0).find("in GPa? 70 GPa = 7e+10 Pa"), std::string::npos);
}

TEST(UsualSpan, ErrorsOfTheHardRangeNameTheUnitToo) {
  const std::string error = test::messageOf([] { notesOn("ratio = 5\n"); });
  EXPECT_NE(error.find("a.toml:3: pile.ratio = 5 [-] is outside [-1, 1]; in percent? 5 % = 0.05; choose a value"),
            std::string::npos)
      << error;
}

TEST(UsualSpan, TheHelpShowsIt) {
  const std::string text = describe(pileTable());
  EXPECT_NE(text.find("| `angle` | deg | 0.0 | [0, 90]; usually 4 to 50 | angle of repose |"), std::string::npos);
  EXPECT_NE(text.find("| `pressure` | Pa | none | usually 100 to 1e+06 | pressure |"), std::string::npos) << text;
}

} // namespace
} // namespace grouser::base
