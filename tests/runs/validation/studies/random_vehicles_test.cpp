// SPDX-License-Identifier: BSD-3-Clause
// Random vehicles: reproducible from the seed, of all kinds, mostly valid; a few run.
#include "base/error.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/storage/sphere_cache.hpp"
#include "runs/validation/studies/random_vehicles.hpp"
#include "tests/runs/program_fixture.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <set>

namespace grouser::studies {

using namespace test; // fixtures

namespace {

class RandomVehiclesDrawn : public FolderTest {};

TEST_F(RandomVehiclesDrawn, AreRepeatableAndOfAllKinds) {
  std::set<std::string> scenes, bases, drives;
  int beds = 0, rigid = 0, bumps = 0, automatic = 0;
  constexpr int kDrawn = 100;
  for (int k = 0; k < kDrawn; ++k) {
    const RandomVehicle v = randomVehicle(1, k);
    EXPECT_EQ(randomVehicle(1, k).what.scene, v.what.scene);
    scenes.insert(v.what.scene), bases.insert(v.base), drives.insert(v.drive);
    beds += v.onBed, rigid += v.rigidArms, bumps += v.bump, automatic += v.stepShare == 0;
  }
  EXPECT_EQ(scenes.size(), std::size_t{kDrawn});
  EXPECT_NE(randomVehicle(2, 0).what.scene, randomVehicle(1, 0).what.scene);
  EXPECT_EQ(bases.size(), kRandomBases.size());
  EXPECT_EQ(drives.size(), kRandomDrives.size());
  // Shares of 0.3, 0.4 (a fifth plus all robots), 0.14 and 0.5; four standard deviations of 100 draws.
  EXPECT_NEAR(beds, 30, 18);
  EXPECT_NEAR(rigid, 40, 20);
  EXPECT_NEAR(bumps, 14, 14);
  EXPECT_NEAR(automatic, 50, 20);
}

TEST_F(RandomVehiclesDrawn, AreMostlyValid) {
  int refused = 0;
  for (int k = 0; k < 40; ++k) {
    try {
      // Assembly checks whether its track closes, for its largest step.
      setup::chooseTimeStep(sceneOf(randomVehicle(1, k).what, 0, folder_));
    } catch (const base::InputError& error) {
      ++refused;
      std::printf("%d: %s\n", k, error.what());
    }
  }
  std::printf("%d of 40 are refused\n", refused);
  EXPECT_LT(refused, 15);
}

TEST_F(RandomVehiclesDrawn, EndSoundOrWithACause) {
  int ran = 0;
  storage::SphereCache spheres{support::KeptFiles(folder_ / "kept")}; // each vehicle is converted once
  // One over a bump, also at a quarter of its step, and one on a bed.
  ASSERT_TRUE(randomVehicle(7, 0).bump && randomVehicle(7, 2).onBed);
  for (const int k : {0, 2}) {
    RandomVehicle v = randomVehicle(7, k);
    v.what.from = 0.14, v.what.until = 0.2; // it drives from 0.12 s
    TrialPlace place;
    place.folder = folder_, place.spheres = &spheres;
    const RandomOutcome outcome = tryRandomVehicle(v, place);
    const Judgement judgement = judgeRandom(v, outcome);
    ran += outcome.trials[0].end == TrialEnd::sound;
    EXPECT_NE(judgement.verdict, MapVerdict::silentlyWrong) << k << ": " << judgement.why;
    EXPECT_NE(judgement.verdict, MapVerdict::wrongCause) << k << ": " << judgement.why;
  }
  EXPECT_GT(ran, 0);
}

TEST(RandomVehicle, OfABedIsJudgedByItsBooksAndItsCause) {
  RandomVehicle bed;
  bed.onBed = true;
  VehicleTrial t;
  t.figures = {0.5, 0.4, 0.39, 0.001, 2000, 5000, NAN, 3000, 1, 1e5, 1e-13};
  const auto verdict = [&bed](const VehicleTrial& trial) { return judgeRandom(bed, {{trial}}).verdict; };
  EXPECT_EQ(verdict(t), MapVerdict::sound);
  t.figures.energyResidual = 1e-6;
  EXPECT_EQ(verdict(t), MapVerdict::silentlyWrong);
  t.figures.energyResidual = 0, t.figures.speed = NAN;
  EXPECT_EQ(verdict(t), MapVerdict::silentlyWrong);
  t.end = TrialEnd::stopped, t.cause = "of a cause that nobody knows", t.blamed = base::Cause::unknown;
  EXPECT_EQ(verdict(t), MapVerdict::wrongCause);
  t.blamed = base::Cause::skippingTrack;
  EXPECT_EQ(verdict(t), MapVerdict::stopped);
  t.end = TrialEnd::refused;
  EXPECT_EQ(verdict(t), MapVerdict::refused);
}

class RandomVehicleStudy : public ProgramTest {};

TEST_F(RandomVehicleStudy, LeavesTheSceneOfEachToBeRunAgain) {
  // Number 29 of seed 1 is invalid: a roller overlaps a shoe.
  ASSERT_EQ(call("study random-vehicles --part 30/100 --out results").code, 0);
  const std::string cause = contents(folder_ / "results/runs/vehicle_29.txt");
  const Outcome again = call("plan results/runs/vehicle_29.toml --no-probe");
  EXPECT_EQ(again.code, 2) << again.errors;
  ASSERT_FALSE(again.error().empty()) << again.errors;
  EXPECT_NE(cause.find(again.error()), std::string::npos) << cause << again.errors;
}

TEST_F(RandomVehicleStudy, SaysWhatIsWrongOfRunsThatAreThere) {
  const std::string words = "study random-vehicles --vehicles 2 --out results";
  const Outcome none = call(words + " --seconds 1e-9");
  ASSERT_EQ(none.code, 0) << none.errors;
  EXPECT_NE(none.out.find("vehicles missing"), std::string::npos) << none.out;
  const std::string numbers =
      "step [s],end,reached [s],wall [s],cause,speed [m/s],height [m],lowest height [m],pitch [rad],"
      "power [W],tension [N],sinkage [m],dissipated [J],integration error [J],turnover "
      "[J],left over [-],speed magnitude [m/s],power magnitude [W],blow [weights]\n";
  const std::string row = "1e-4,0,0.4,1,0,0.5,0.4,0.39,0,2000,5000,nan,3000,1,1e5,0,0.5,2000,1.2\n";
  const std::filesystem::path runs = folder_ / "results" / "runs";
  for (const char* name : {"vehicle_0", "vehicle_1"}) {
    put(runs / (std::string(name) + ".csv"), numbers + row + row);
    put(runs / (std::string(name) + ".txt"), "\n\n");
  }
  const Outcome sound = call(words + " --resume");
  ASSERT_EQ(sound.code, 0) << sound.errors;
  EXPECT_NE(contents(folder_ / "results" / "random_vehicles.csv").find(",sound,"), std::string::npos);
  // Speeds of 0.5 and 0.9 m/s, with scatter or repeated by all neighbouring steps.
  const auto apart = [&numbers](const std::array<double, 12>& speeds, double blow = 1.2) {
    std::string text = numbers;
    for (const double speed : speeds)
      text += fmt::format("1e-4,0,0.4,1,0,{},0.4,0.39,0,2000,5000,nan,3000,1,1e5,0,0.5,2000,{}\n", speed, blow);
    return text;
  };
  put(runs / "vehicle_1.txt", "\n\n\n\n\n\n\n\n\n\n\n\n");
  put(runs / "vehicle_1.csv", apart({0.5, 0.9, 0.9, 0.5, 0.5, 0.8, 0.8, 0.6, 0.6, 0.7, 0.7, 0.9}));
  const Outcome scatters = call(words + " --resume");
  EXPECT_EQ(scatters.code, 0) << scatters.errors;
  EXPECT_NE(scatters.out.find("scatters: vehicle 1"), std::string::npos) << scatters.out;
  put(runs / "vehicle_1.csv", apart({0.5, 0.9, 0.5, 0.9, 0.5, 0.9, 0.5, 0.9, 0.5, 0.9, 0.5, 0.9}));
  const Outcome wrong = call(words + " --resume");
  EXPECT_EQ(wrong.code, 3) << wrong.out;
  EXPECT_NE(wrong.out.find("silently wrong: vehicle 1"), std::string::npos) << wrong.out;
  put(runs / "vehicle_1.csv", apart({0.5, 0.9, 0.5, 0.9, 0.5, 0.9, 0.5, 0.9, 0.5, 0.9, 0.5, 0.9}, 5.3));
  const Outcome warned = call(words + " --resume");
  EXPECT_EQ(warned.code, 0) << warned.errors;
  EXPECT_NE(warned.out.find("warned: vehicle 1"), std::string::npos) << warned.out;
  EXPECT_EQ(call(words + " --resume --seed 2").code, 2) << "runs of another seed";
  for (const char* bad : {"--vehicles 0", "--seed -1", "--part 3/2", "--grains 4"})
    EXPECT_EQ(call(std::string("study random-vehicles --out other ") + bad).code, 2) << bad;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "other"));
}

} // namespace
} // namespace grouser::studies
