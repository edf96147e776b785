// SPDX-License-Identifier: BSD-3-Clause
#include "base/table.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace grouser::base {
namespace {

enum class WheelKind { road, idler, spare };
enum class Side { left, right };

} // namespace

/// The key of a spare wheel is not supported.
template <> struct EnumWords<WheelKind> {
  static constexpr EnumWord<WheelKind> list[] = {{WheelKind::road, "road"}, {WheelKind::idler, "idler"}};
};
template <> struct EnumWords<Side> {
  static constexpr EnumWord<Side> list[] = {{Side::left, "left"}, {Side::right, "right"}};
};

namespace {

struct Wheel {
  double radius = 0.2;
  int count = 5;
  bool steered = false;
  WheelKind kind = WheelKind::road;
  Vec3d centre;
  std::array<double, 2> range{0, 1};
  std::vector<double> angles;
  std::vector<std::string> tags;
  std::optional<double> step;
  std::optional<double> width;
  std::optional<Side> side;
  std::vector<Side> brakes;
};

Table<Wheel> wheelTable() {
  Table<Wheel> t("wheel", "One wheel");
  t.add("radius", &Wheel::radius, "m", "rolling radius").above(0).atMost(10);
  t.add("count", &Wheel::count, "-", "how many").atLeast(1).atMost(20);
  t.add("steered", &Wheel::steered, "", "turns about z");
  t.add("kind", &Wheel::kind, "", "what it does");
  t.add("centre", &Wheel::centre, "m", "axle position");
  t.add("range", &Wheel::range, "m", "from, to");
  t.add("angles", &Wheel::angles, "rad", "of the spokes");
  t.add("tags", &Wheel::tags, "", "free words");
  t.add("step", &Wheel::step, "s", "time step").above(0).orWord("auto");
  t.add("width", &Wheel::width, "m", "of the tread").above(0);
  t.add("side", &Wheel::side, "", "where it is");
  t.add("brakes", &Wheel::brakes, "", "where it has one");
  return t;
}

/// Error message of reading `text`, after `version = 1` on line 1 and [wheel] on line 2; empty if valid.
std::string complaint(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    const Document doc = Document::parse("version = 1\n[wheel]\n" + text, "w.toml", overrides);
    doc.root().allowOnly({"version", "wheel"});
    doc.root().section("wheel").read(wheelTable());
    return "";
  } catch (const InputError& e) {
    return e.what();
  }
}

Wheel read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const Document doc = Document::parse("version = 1\n[wheel]\n" + text, "w.toml", overrides);
  return doc.root().section("wheel").read(wheelTable());
}

TEST(Document, SuppliedKeysStandWhereNoneIsGiven) {
  Document d = Document::parse("version = 1\n[wheel.a]\nkind = \"road\"\n[tyre]\nb = 3\n", "s.toml");
  d.supply("wheel", "a", "kind", "idler", "s.toml:9");
  d.supply("wheel", "b", "kind", "idler", "s.toml:9");
  d.supply("axle", "c", "kind", "spare", "s.toml:7");
  const Section root = d.root(), wheels = root.section("wheel");
  EXPECT_EQ(std::get<std::string>(wheels.section("a").node().find("kind")->value), "road") << "the file's own value";
  EXPECT_EQ(std::get<std::string>(wheels.section("b").node().find("kind")->value), "idler");
  EXPECT_EQ(wheels.section("b").origin(), "s.toml:9");
  EXPECT_EQ(std::get<std::string>(root.section("axle").section("c").node().find("kind")->value), "spare");
  EXPECT_THROW(d.supply("tyre", "b", "kind", "road", "s.toml:9"), InputError) << "b is a number";
}

TEST(Table, EveryTypeIsRead) {
  const Wheel w =
      read("radius = 1\ncount = 7\nsteered = true\nkind = \"idler\"\ncentre = [1, 2.5, -3]\nrange = [0, 2]\n"
           "angles = [0.1, 1]\ntags = [\"a\", \"b\"]\nstep = 1e-4\nwidth = 0.5\n"
           "side = \"right\"\nbrakes = [\"right\", \"left\"]\n");
  EXPECT_EQ(w.radius, 1.0);
  EXPECT_EQ(w.count, 7);
  EXPECT_TRUE(w.steered);
  EXPECT_EQ(w.kind, WheelKind::idler);
  EXPECT_EQ(w.centre, (Vec3d{1, 2.5, -3}));
  EXPECT_EQ(w.range, (std::array<double, 2>{0, 2}));
  EXPECT_EQ(w.angles, (std::vector<double>{0.1, 1}));
  EXPECT_EQ(w.tags, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(w.step, 1e-4);
  EXPECT_EQ(w.width, 0.5);
  EXPECT_EQ(w.side, Side::right);
  EXPECT_EQ(w.brakes, (std::vector{Side::right, Side::left}));
}

TEST(Table, WhatIsAbsentKeepsItsDefault) {
  const Wheel w = read("step = \"auto\"\n");
  EXPECT_EQ(w.radius, 0.2);
  EXPECT_FALSE(w.step.has_value());
  EXPECT_FALSE(w.width.has_value());
  EXPECT_FALSE(w.side.has_value());
}

struct Broken {
  const char* name;
  const char* text;
  const char* message;
};

class BrokenField : public ::testing::TestWithParam<Broken> {};

TEST_P(BrokenField, IsNamedWithPlaceValueAndRemedy) { EXPECT_EQ(complaint(GetParam().text), GetParam().message); }

INSTANTIATE_TEST_SUITE_P(
    Table, BrokenField,
    ::testing::Values(
        Broken{"OutOfRange", "\nradius = -1",
               "w.toml:4: wheel.radius = -1 [m] is outside (0, 10]; choose a value in that range (rolling radius)"},
        Broken{"AtOpenBound", "radius = 0.0",
               "w.toml:3: wheel.radius = 0 [m] is outside (0, 10]; choose a value in that range (rolling radius)"},
        Broken{"NotANumber", "radius = nan", "w.toml:3: wheel.radius = nan [m] is not finite; use a finite number"},
        Broken{"Infinite", "centre = [0, inf, 0]",
               "w.toml:3: wheel.centre = [0, inf, 0] [m] is not finite; use a finite number"},
        Broken{"WrongType", "radius = \"wide\"",
               "w.toml:3: wheel.radius = \"wide\" has the wrong type; expected a number [m] (rolling radius)"},
        Broken{"RealForInteger", "count = 2.5",
               "w.toml:3: wheel.count = 2.5 has the wrong type; expected a whole number [-] (how many)"},
        Broken{"IntegerOutOfRange", "count = 21",
               "w.toml:3: wheel.count = 21 [-] is outside [1, 20]; choose a value in that range (how many)"},
        Broken{"NumberForSwitch", "steered = 1",
               "w.toml:3: wheel.steered = 1 has the wrong type; expected true or false (turns about z)"},
        Broken{"UnknownWord", "kind = \"idle\"",
               "w.toml:3: wheel.kind = \"idle\" is not one of road, idler; did you mean \"idler\"? (what it does)"},
        Broken{"WordWithoutAName", "kind = \"spare\"",
               "w.toml:3: wheel.kind = \"spare\" is not one of road, idler; did you mean \"road\"? (what it does)"},
        Broken{
            "UnknownWordInAList", "brakes = [\"left\", \"rigth\"]",
            "w.toml:3: wheel.brakes = \"rigth\" is not one of left, right; did you mean \"right\"? (where it has one)"},
        Broken{"NumberForAWord", "side = 1",
               "w.toml:3: wheel.side = 1 has the wrong type; expected a string in quotes (where it is)"},
        Broken{
            "ShortVector", "centre = [1, 2]",
            "w.toml:3: wheel.centre = [1, 2] has the wrong type; expected three numbers [x, y, z] [m] (axle position)"},
        Broken{
            "WordWhereAutoIsMeant", "step = \"automatic\"",
            "w.toml:3: wheel.step = \"automatic\" has the wrong type; expected a number or \"auto\" [s] (time step)"},
        Broken{
            "ListWithText", "angles = [1, \"b\"]",
            "w.toml:3: wheel.angles = [1, \"b\"] has the wrong type; expected a list of numbers [a, b, ...] [rad] (of "
            "the spokes)"},
        Broken{"Date", "radius = 2020-01-01",
               "w.toml:3: dates and times are not supported; remove the value or put it in quotes"}),
    [](const auto& test) { return test.param.name; });

TEST(Table, UnknownKeyNamesTheNearest) {
  const std::string message = complaint("raduis = 1");
  EXPECT_EQ(message.find("w.toml:3: unknown key wheel.raduis; did you mean radius?"), 0u) << message;
}

TEST(Table, UnknownSectionNamesTheNearest) {
  const std::string message = complaint("[whel]\n");
  EXPECT_EQ(message.find("w.toml:3: unknown section whel; did you mean wheel?"), 0u) << message;
}

TEST(Table, SyntaxErrorNamesLineAndColumn) {
  const std::string message = complaint("radius = = 1");
  EXPECT_EQ(message.find("w.toml:3:10: not valid TOML"), 0u) << message;
}

TEST(Table, KeyGivenTwiceIsAnError) { EXPECT_NE(complaint("radius = 1\nradius = 2"), ""); }

TEST(Table, FirstOfSeveralMistakesInTheFileIsReported) {
  const std::string message = complaint("zzz = 1\naaa = 1");
  EXPECT_EQ(message.find("w.toml:3: unknown key wheel.zzz"), 0u) << message;
}

TEST(Table, MissingRequiredKeyIsNamedWithUnit) {
  Table<Wheel> t("wheel", "One wheel");
  t.add("radius", &Wheel::radius, "m", "rolling radius").above(0).required();
  const Document doc = Document::parse("version = 1\n[wheel]", "w.toml");
  try {
    doc.root().section("wheel").read(t, {}, {});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(
        e.what(),
        "w.toml:2: [wheel] lacks the required key radius [m]; add radius = a number, (0, inf) (rolling radius)");
  }
}

TEST(Table, VersionIsRequiredAndChecked) {
  EXPECT_THROW(Document::parse("[wheel]\n", "w.toml"), InputError);
  EXPECT_THROW(Document::parse("version = 2\n", "w.toml"), InputError);
  EXPECT_THROW(Document::parse("version = \"1\"\n", "w.toml"), InputError);
  EXPECT_NO_THROW(Document::parse("version = 1\n", "w.toml"));
}

TEST(Overrides, ReplaceAndAddValues) {
  EXPECT_EQ(read("radius = 1", {"wheel.radius=2.5"}).radius, 2.5);
  EXPECT_EQ(read("", {"wheel.count=3"}).count, 3);
  EXPECT_EQ(read("", {"wheel.kind=idler"}).kind, WheelKind::idler);
  EXPECT_EQ(read("", {"wheel.centre=[1, 2, 3]"}).centre, (Vec3d{1, 2, 3}));
}

TEST(Overrides, RemoveKeysAndSections) {
  EXPECT_EQ(read("radius = 2\ncount = 3", {"~wheel.count"}).count, read("").count);
  EXPECT_EQ(read("radius = 2\ncount = 3", {"~wheel.count", "wheel.count=5"}).count, 5) << "in their order";
  const Document whole = Document::parse("version = 1\n[wheel]\n[track]\nlength = 1\n", "w.toml", {"~track"});
  EXPECT_EQ(whole.root().node().find("track"), nullptr);
  EXPECT_NE(whole.root().node().find("wheel"), nullptr);
  for (const char* none : {"~wheel.radius", "~weel.radius", "~wheel.count.x"})
    EXPECT_NE(complaint("count = 1", {none}).find(std::string("--set ") + none + ": the file has no key"),
              std::string::npos)
        << none;
  EXPECT_NE(complaint("", {"~"}).find("not of the form"), std::string::npos);
  EXPECT_NE(complaint("", {"~version"}).find("key version is missing"), std::string::npos);
}

TEST(Overrides, AreCheckedLikeTheFile) {
  EXPECT_EQ(complaint("", {"wheel.radius=-2"}),
            "--set: wheel.radius = -2 [m] is outside (0, 10]; choose a value in that range (rolling radius)");
  EXPECT_EQ(complaint("", {"wheel.raduis=2"}).find("--set: unknown key wheel.raduis; did you mean radius?"), 0u);
  EXPECT_EQ(complaint("", {"weel.radius=2"}).find("--set: unknown section weel; did you mean wheel?"), 0u);
  EXPECT_NE(complaint("", {"wheel.radius"}).find("the value is missing"), std::string::npos);
  EXPECT_NE(complaint("", {"wheel..radius=1"}).find("not of the form"), std::string::npos);
  EXPECT_NE(complaint("radius = 1", {"wheel.radius.x=1"}).find("is a value, not a section"), std::string::npos);
  // An override cannot add a second key.
  EXPECT_NE(complaint("", {"wheel.kind=\"road\"\nradius = 3"}), "");
}

TEST(Overrides, ReachIntoListsAndQuotedNames) {
  const Document doc = Document::parse("version = 1\n[[grain]]\nradius = 1\n[[grain]]\nradius = 2\n[contact.\"a|b\"]\n",
                                       "s.toml", {"grain.1.radius=5", "contact.\"a|b\".friction=0.5"});
  EXPECT_EQ(std::get<std::int64_t>(doc.root().list("grain")[1].node().find("radius")->value), 5);
  EXPECT_EQ(doc.root().named("contact").front().first, "a|b");
  EXPECT_TRUE(doc.root().named("contact").front().second.has("friction"));
  EXPECT_THROW(Document::parse("version = 1\n[[grain]]\nradius = 1\n", "s.toml", {"grain.1.radius=5"}), InputError);
}

TEST(Table, WrittenValuesReadBackToTheSameBits) {
  Wheel w;
  w.radius = 0.1 + 0.2, w.centre = {1e-300, -2.0 / 3.0, 1e6}, w.kind = WheelKind::idler, w.angles = {3, 5e-324},
  w.tags = {"a \"b\"\\\n"};
  w.width = 7, w.side = Side::left, w.brakes = {Side::right};
  const Wheel back = read(wheelTable().write(w));
  EXPECT_EQ(back.radius, w.radius);
  EXPECT_EQ(back.centre, w.centre);
  EXPECT_EQ(back.angles, w.angles);
  EXPECT_EQ(back.tags, w.tags);
  EXPECT_EQ(back.width, w.width);
  EXPECT_EQ(back.step, w.step);
  EXPECT_EQ(back.kind, w.kind);
  EXPECT_EQ(back.side, w.side);
  EXPECT_EQ(back.brakes, w.brakes);
}

TEST(Table, DescriptionShowsUnitDefaultRangeAndHelp) {
  const std::string text = describe(wheelTable());
  EXPECT_NE(text.find("| `radius` | m | 0.2 | (0, 10] | rolling radius |"), std::string::npos) << text;
  EXPECT_NE(text.find("| `kind` |  | \"road\" | one of road, idler | what it does |"), std::string::npos) << text;
  EXPECT_NE(text.find("| `side` |  | none | one of left, right | where it is |"), std::string::npos) << text;
  EXPECT_NE(text.find("| `step` | s | \"auto\" | (0, inf) | time step |"), std::string::npos) << text;
}

TEST(NearestWord, CountsSwapsAsOneEdit) {
  EXPECT_EQ(editDistance("raduis", "radius"), 1);
  EXPECT_EQ(editDistance("Radius", "radius"), 0);
  EXPECT_EQ(editDistance("", "abc"), 3);
  EXPECT_EQ(nearestWord("drivr", {"drive", "driver"}), "driver") << "a missing letter";
  EXPECT_EQ(nearestWord("drivr", {"driver", "drive"}), "driver");
  EXPECT_EQ(nearestWord("driv", {"driver", "drive"}), "drive") << "the nearest one";
  EXPECT_EQ(nearestWord("fricton", {"density", "friction", "fraction"}), "friction");
}

/// Tracks with two former names of the length: span, and before that reach.
struct Track {
  double length = 1;
  std::vector<Side> sides;
};

Table<Track> trackTable() {
  Table<Track> t("track", "One track");
  t.add("length", &Track::length, "m", "around").above(0).formerly("reach").formerly("span");
  t.add("sides", &Track::sides, "", "where they are");
  return t;
}

Document trackDocument(const std::string& text, const std::string& where = "track",
                       const std::vector<std::string>& overrides = {}) {
  Document doc = Document::parse("version = 1\n" + text, "t.toml", overrides);
  doc.renameKeys(where, trackTable().formerKeys());
  return doc;
}

TEST(FormerKeys, AreReadAndNoted) {
  for (const std::string former : {"reach", "span"}) {
    const Document doc = trackDocument("[track]\n" + former + " = 7\n");
    EXPECT_EQ(doc.root().section("track").read(trackTable()).length, 7) << former;
    EXPECT_EQ(doc.notes(), std::vector{"t.toml:3: track." + former +
                                       " is now called length; rename it (the next version rejects the old name)"});
  }
  EXPECT_TRUE(trackDocument("[track]\nlength = 7\n").notes().empty());
  EXPECT_TRUE(trackDocument("[wheel]\nspan = 7\n").notes().empty()); // key of another section
}

TEST(FormerKeys, AreNotedOnceForAllEntriesOfAList) {
  const Document doc = trackDocument("[[track]]\nlength = 1\n[[track]]\nspan = 2\n[[track]]\nspan = 3\n");
  const std::vector<Section> tracks = doc.root().list("track");
  EXPECT_EQ(tracks[1].read(trackTable()).length, 2);
  EXPECT_EQ(tracks[2].read(trackTable()).length, 3);
  ASSERT_EQ(doc.notes().size(), 1u);
  EXPECT_EQ(doc.notes().front().find("t.toml:5: track.1.span is now called length"), 0u) << doc.notes().front();
}

TEST(FormerKeys, AreFoundInNamedAndInnerSections) {
  const Document named = trackDocument("[track.a]\nspan = 2\n[track.b]\nspan = 3\n", "track.*");
  EXPECT_EQ(named.root().named("track")[1].second.read(trackTable()).length, 3);
  const Document inner = trackDocument("[vehicle.track]\nspan = 4\n", "vehicle.track");
  EXPECT_EQ(inner.root().section("vehicle").section("track").read(trackTable()).length, 4);
  EXPECT_EQ(inner.notes().front().find("t.toml:3: vehicle.track.span"), 0u) << inner.notes().front();
}

TEST(FormerKeys, MayBeOverridden) {
  const Document doc = trackDocument("[track]\nspan = 4\n", "track", {"track.span=5"});
  EXPECT_EQ(doc.root().section("track").read(trackTable()).length, 5);
}

TEST(FormerKeys, BesideTheirNewNamesAreAnError) {
  const auto complaintAbout = [](const std::string& text, const std::vector<std::string>& overrides) -> std::string {
    try {
      trackDocument(text, "track", overrides);
      return "";
    } catch (const InputError& e) {
      return e.what();
    }
  };
  EXPECT_EQ(complaintAbout("[track]\nlength = 2\nspan = 4\n", {}),
            "t.toml:4: track.span is the former name of track.length, which is also set at t.toml:3; remove span");
  EXPECT_EQ(complaintAbout("[track]\nlength = 2\n", {"track.span=4"}),
            "--set: track.span is the former name of track.length, which is also set at t.toml:3; remove span");
  EXPECT_NE(complaintAbout("[track]\nspan = 2\nreach = 4\n", {}), ""); // two former names
}

TEST(FormerKeys, AreNotShownAndTheirValuesAreChecked) {
  EXPECT_EQ(describe(trackTable()).find("span"), std::string::npos);
  const Document doc = trackDocument("[track]\nspan = -1\n");
  try {
    doc.root().section("track").read(trackTable());
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(),
                 "t.toml:3: track.length = -1 [m] is outside (0, inf); choose a value in that range (around)");
  }
}

TEST(DescribeFields, NoLineBeginsLikeAList) {
  std::string help = "xx";
  for (int i = 0; i < 60; ++i) help += " abc +"; // the 120th column is before a sign
  EXPECT_EQ(describeFields("s", help + " d", {}, {}).find("\n+ "), std::string::npos);
}

TEST(Document, MissingFileIsAnInputError) {
  try {
    Document::load("/nonexistent/x.toml");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(), "/nonexistent/x.toml: no such file; check the path of the TOML file");
  }
  EXPECT_THROW(Document::load("/"), InputError);
}

} // namespace
} // namespace grouser::base
