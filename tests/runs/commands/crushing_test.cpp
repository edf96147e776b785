// SPDX-License-Identifier: BSD-3-Clause
// Output on squeezed and crushed grains, and with soil_contact = "shoes"; identical on several ranks.
#include "runs/support/hdf5_file.hpp"
#include "tests/runs/ranks_fixture.hpp"
#include "tests/system/guard_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace grouser::commands {

using namespace test; // fixtures and pieces of scenes

namespace {

/// Grains that a roller presses into the floor.
std::string pressed(const std::string& material) {
  return test::run(0.24, "time_step = 1e-4\n") + soil(0.5, 0.5, material, "1e5") + test::floor() + walls(0.2) +
         grains({60, 0.19, 0, 0.3, "0.03"}) +
         "[[mesh]]\nname = \"tup\"\nfile = \"meshes/roller.obj\"\nposition = [0, 0, 0.5]\nvelocity = [0, 0, -2]\n"
         "sphere_radius = 0.02\nmaterial = \"soil\"\n";
}

class SqueezedGrains : public OnRanks {
protected:
  static constexpr const char* kQuiet = " --threads 1 --set output.plots=false --set output.picture=false";
  /// The lines of the output that begin with a word.
  static std::string lines(const Outcome& o, const std::string& word) {
    std::string found;
    for (std::size_t at = o.out.find("\n" + word); at != std::string::npos; at = o.out.find("\n" + word, at + 1))
      found += o.out.substr(at, o.out.find('\n', at + 1) - at);
    return found;
  }
};

TEST_F(SqueezedGrains, CrushedOnesAreTakenOutAlikeOnRanksAndInResumedRuns) {
  put(folder_ / "scene.toml", pressed("crushing_strength = 1e5\n"));
  const std::string words = std::string("run scene.toml --force --hash") + kQuiet + " --out ";
  const Outcome one = OnRanks::run(1, words + "one");
  ASSERT_EQ(one.code, 0) << one.errors;
  ASSERT_TRUE(one.hasHash());
  EXPECT_NE(lines(one, "crushed"), "") << one.out;
  for (const int ranks : {2, 3}) {
    const Outcome more = OnRanks::run(ranks, words + "more");
    EXPECT_EQ(more.hash(), one.hash()) << more.errors;
    EXPECT_EQ(lines(more, "crush"), lines(one, "crush"));
    EXPECT_EQ(lines(more, "overlaps"), lines(one, "overlaps"));
    EXPECT_EQ(contents(folder_ / "more/timeseries.csv"), contents(folder_ / "one/timeseries.csv")) << "on ranks";
  }
  const Outcome begun = OnRanks::run(1, words + "two --steps 2203");
  ASSERT_EQ(begun.code, 0) << begun.errors;
  EXPECT_NE(lines(begun, "crushed"), "") << "some grains before the stop: " << begun.out;
  const Outcome rest = OnRanks::run(2, words + "two --resume");
  EXPECT_EQ(rest.hash(), one.hash()) << rest.errors;
  EXPECT_EQ(lines(rest, "crush"), lines(one, "crush"));
  EXPECT_EQ(lines(rest, "overlaps"), lines(one, "overlaps"));
  EXPECT_EQ(contents(folder_ / "two/timeseries.csv"), contents(folder_ / "one/timeseries.csv")) << "resumed";
  // Grains keep their numbers.
  const support::Hdf5File frames = support::Hdf5File::open(folder_ / "one" / "frames.h5");
  const std::vector<double> first = frames.numbers("/000000/grains/id"), last = frames.numbers("/000003/grains/id");
  EXPECT_EQ(first.size(), 60u);
  EXPECT_LT(last.size(), 60u);
  EXPECT_TRUE(std::is_sorted(last.begin(), last.end()));
  EXPECT_GT(last.back() + 1, static_cast<double>(last.size())) << "removed grains leave gaps";
}

TEST_F(SqueezedGrains, AreCountedInTheSeriesAndNamedInTheSummary) {
  put(folder_ / "scene.toml", pressed("crushing_strength = 1e5\n"));
  const Outcome o = OnRanks::run(1, std::string("run scene.toml --out o") + kQuiet);
  ASSERT_EQ(o.code, 0) << o.errors;
  const support::Hdf5File results = support::Hdf5File::open(folder_ / "o" / "results.h5");
  const auto most = [&](const std::string& name) {
    const std::vector<double> all = results.numbers("/terrain/" + name + "/value");
    return *std::max_element(all.begin(), all.end());
  };
  EXPECT_GT(most("squeezed_by_parts"), 0);
  EXPECT_GT(most("capped"), 0);
  EXPECT_GT(most("cut_impulse"), 0);
  EXPECT_GE(most("crushed"), 1);
  EXPECT_GE(most("part_overlap"), 1);
  EXPECT_EQ(most("part_overlap_by"), 0);
  EXPECT_NE(lines(o, "          largest overlap with a part:").find("by tup at"), std::string::npos) << o.out;
  EXPECT_NE(contents(folder_ / "o/manifest.json").find("\"deepest_in_a_part\""), std::string::npos);
  EXPECT_NE(contents(folder_ / "o/manifest.json").find("\"crushed_mass_kg\""), std::string::npos);
}

TEST_F(SqueezedGrains, PlanListsCrushingOffWhereThereIsNone) {
  put(folder_ / "off.toml", pressed(""));
  put(folder_ / "on.toml", pressed("crushing_strength = 1e5\n"));
  EXPECT_NE(OnRanks::run(1, "plan off.toml").out.find("  off  crushing grains"), std::string::npos);
  EXPECT_NE(OnRanks::run(1, "plan on.toml").out.find("  on   crushing grains"), std::string::npos);
}

TEST_F(SqueezedGrains, SoilThatMeetsTheShoesAloneIsSaidEverywhere) {
  const std::string words = "run '" GROUSER_SOURCE_DIR "/tests/scenes/coupled.toml' --steps 20 --hash --force"
                            " --set terrain.settle_time_limit=0 --set vehicle.sphere_radius=0.03" +
                            std::string(kQuiet) + " --out ";
  const Outcome shoes = OnRanks::run(1, words + "shoes --set vehicle.soil_contact=shoes"),
                all = OnRanks::run(1, words + "all");
  ASSERT_EQ(shoes.code, 0) << shoes.errors;
  EXPECT_NE(lines(shoes, "soil").find("track shoes only"), std::string::npos) << shoes.out;
  EXPECT_EQ(lines(all, "soil"), "");
  EXPECT_NE(contents(folder_ / "shoes/manifest.json").find("\"soil_contact\": \"shoes\""), std::string::npos);
  EXPECT_NE(contents(folder_ / "all/manifest.json").find("\"soil_contact\": \"all\""), std::string::npos);
  EXPECT_EQ(support::Hdf5File::open(folder_ / "shoes" / "results.h5").text("/", "soil_contact"), "shoes");
}

} // namespace
} // namespace grouser::commands
