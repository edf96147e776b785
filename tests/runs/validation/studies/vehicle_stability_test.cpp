// SPDX-License-Identifier: BSD-3-Clause
// Stability maps of the vehicle: verdicts are correct, steps above the predicted limit are rejected; without that
// check a guard stops the run and names the step.
#include "coupling/simulation.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/validation/studies/vehicle_stability.hpp"
#include "tests/runs/folder_fixture.hpp"
#include "tests/runs/program_fixture.hpp"
#include "tests/runs/shared_cache.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

namespace grouser::studies {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

VehicleTrial soundTrial() {
  VehicleTrial t;
  t.figures = {0.5, 0.4, 0.39, 0.001, 2000, 5000, NAN, 3000, 1, 1e5, 1e-13, 0.5, 2000};
  return t;
}
VehicleTrial stoppedTrial(base::Cause cause) {
  VehicleTrial t = soundTrial();
  t.end = TrialEnd::stopped, t.blamed = cause, t.cause = base::wordOf(cause);
  return t;
}

constexpr base::Cause kUnstable = base::Cause::unstableContacts, kThrown = base::Cause::thrownTrack,
                      kSkips = base::Cause::skippingTrack, kPressed = base::Cause::excessiveOverlap;

TEST(VehicleVerdict, RunsThatAgreeAreSound) {
  EXPECT_EQ(judge(soundTrial(), soundTrial(), false).verdict, MapVerdict::sound);
  VehicleTrial near = soundTrial();
  near.figures.speed *= 1.02, near.figures.tension *= 0.95;
  EXPECT_EQ(judge(soundTrial(), near, false).verdict, MapVerdict::sound);
}

/// It reverses within the window, brakes and drives: 0.08 m/s of 2 m/s, 80 W of 2 kW.
TEST(VehicleVerdict, AMeanOfBothSignsIsComparedWithItsMagnitude) {
  VehicleTrial run = soundTrial(), finer = run;
  run.figures.speed = 0.1, finer.figures.speed = 0.18;
  run.figures.power = -20, finer.figures.power = 60;
  run.figures.powerMagnitude = finer.figures.powerMagnitude = 2000;
  run.figures.speedMagnitude = finer.figures.speedMagnitude = 2;
  EXPECT_EQ(judge(run, finer, false).verdict, MapVerdict::sound);
  std::vector<TrialPair> pairs(6, {run, finer});
  for (TrialPair& p : pairs) p.run.figures.speedMagnitude = p.finer.figures.speedMagnitude = 0.2;
  EXPECT_EQ(judge(pairs, false).verdict, MapVerdict::silentlyWrong) << "half of so slow a motion is error";
}

TEST(VehicleVerdict, EveryComparedFigureThatDiffersMakesARunSilentlyWrong) {
  for (const bool onBed : {false, true})
    for (const ComparedFigure& c : comparedFigures(onBed)) {
      VehicleTrial run = soundTrial();
      run.figures.sinkage = 0.03;
      VehicleTrial finer = run;
      finer.figures.*c.value += 0.9 * c.floor;
      EXPECT_EQ(judge(run, finer, onBed).verdict, MapVerdict::sound) << c.name;
      finer.figures.*c.value = 1.01 * (run.figures.*c.value + c.floor) / (1 - c.relative) + 0.01 * c.floor;
      for (const auto& [a, b] : {std::pair{run, finer}, std::pair{finer, run}}) {
        const Judgement judgement = judge(a, b, onBed);
        EXPECT_EQ(judgement.verdict, MapVerdict::silentlyWrong) << c.name;
        EXPECT_EQ(judgement.why.find(c.name), 0u) << judgement.why;
      }
      for (const double none : {double(NAN), double(INFINITY)}) {
        finer.figures.*c.value = none;
        for (const auto& [a, b] : {std::pair{run, finer}, std::pair{finer, run}})
          EXPECT_EQ(judge(a, b, onBed).verdict, MapVerdict::silentlyWrong) << c.name << " " << none;
      }
    }
}

TEST(VehicleVerdict, BooksThatDoNotCloseAreSilentlyWrong) {
  for (const double energyResidual : {1e-6, -1e-6, double(NAN)}) {
    VehicleTrial run = soundTrial();
    run.figures.energyResidual = energyResidual;
    EXPECT_EQ(judge(run, soundTrial(), false).verdict, MapVerdict::silentlyWrong) << energyResidual;
    EXPECT_EQ(judge(soundTrial(), run, false).verdict, MapVerdict::silentlyWrong) << energyResidual;
  }
}

TEST(VehicleVerdict, AStopIsTrueWhereTheFinerRunConfirmsItsCause) {
  const auto verdict = [](const VehicleTrial& run, const VehicleTrial& finer) {
    return judge(run, finer, true).verdict;
  };
  EXPECT_EQ(verdict(stoppedTrial(kUnstable), soundTrial()), MapVerdict::stopped);
  EXPECT_EQ(verdict(stoppedTrial(kUnstable), stoppedTrial(kUnstable)), MapVerdict::wrongCause)
      << "a shorter step removes the fault";
  EXPECT_EQ(verdict(stoppedTrial(kUnstable), stoppedTrial(kThrown)), MapVerdict::wrongCause) << "not later";
  VehicleTrial later = stoppedTrial(kThrown);
  later.reached = 0.5;
  EXPECT_EQ(verdict(stoppedTrial(kUnstable), later), MapVerdict::stopped) << "it ran beyond that time";
  later.blamed = kUnstable;
  EXPECT_EQ(verdict(stoppedTrial(kUnstable), later), MapVerdict::wrongCause) << "a shorter step no longer helps";
  EXPECT_EQ(verdict(stoppedTrial(kThrown), stoppedTrial(kThrown)), MapVerdict::stopped);
  EXPECT_EQ(verdict(stoppedTrial(kThrown), stoppedTrial(kSkips)), MapVerdict::stopped) << "one event seen in two ways";
  EXPECT_EQ(verdict(stoppedTrial(kThrown), soundTrial()), MapVerdict::wrongCause) << "the step is the cause";
  EXPECT_EQ(verdict(stoppedTrial(kThrown), stoppedTrial(kPressed)), MapVerdict::wrongCause);
  EXPECT_EQ(verdict(stoppedTrial(base::Cause::unknown), soundTrial()), MapVerdict::wrongCause);
  EXPECT_EQ(verdict(soundTrial(), stoppedTrial(kThrown)), MapVerdict::silentlyWrong);
  VehicleTrial refused = soundTrial();
  refused.end = TrialEnd::refused, refused.cause = "scene.toml:4: time_step";
  EXPECT_EQ(verdict(refused, VehicleTrial{}), MapVerdict::refused);
  EXPECT_EQ(judge(refused, VehicleTrial{}, true).why, refused.cause);
  EXPECT_EQ(verdict(soundTrial(), refused), MapVerdict::silentlyWrong) << "no confirmation";
}

/// A pair and five neighbours with these tensions [N]; the tolerance is 5 % and 50 N.
std::vector<TrialPair> neighbours(const std::array<double, 6>& atSteps, const std::array<double, 6>& atQuarters) {
  std::vector<TrialPair> pairs;
  for (std::size_t i = 0; i < atSteps.size(); ++i) {
    pairs.push_back({soundTrial(), soundTrial()});
    pairs.back().run.step = 1e-4 * (1 - 0.005 * static_cast<double>(i));
    pairs.back().run.figures.tension = atSteps[i], pairs.back().finer.figures.tension = atQuarters[i];
  }
  return pairs;
}

TEST(VehicleNeighbours, WhatTheyScatterByIsNoErrorOfTheStep) {
  const std::vector<TrialPair> pairs =
      neighbours({5000, 5600, 4700, 5900, 5100, 5300}, {5700, 4900, 5400, 5100, 5600, 5000});
  ASSERT_TRUE(figuresDisagree(pairs[0].run, pairs[0].finer, false));
  EXPECT_EQ(judge({pairs[0]}, false).verdict, MapVerdict::silentlyWrong) << "a single pair is not conclusive";
  const Judgement judgement = judge(pairs, false);
  EXPECT_EQ(judgement.verdict, MapVerdict::scatters);
  EXPECT_EQ(judgement.why.find("tension is 5000 N, but 5700 N at a quarter of the step"), 0u) << judgement.why;
  // The means differ by 420 N: above the tolerance of 337 N, below Welch's interval of 580 N.
  EXPECT_EQ(
      judge(neighbours({5000, 5600, 4700, 5900, 5100, 5300}, {5700, 6000, 5500, 5700, 5900, 5600}), false).verdict,
      MapVerdict::scatters);
}

TEST(VehicleNeighbours, ADifferenceBeyondTheirScatterIsSilentlyWrong) {
  // Means 5320 and 7200: their scatter, 460 and 290, explains 600 at 95 %.
  const Judgement judgement =
      judge(neighbours({5000, 5600, 4700, 5900, 5100, 5300}, {7700, 6900, 7400, 7100, 7600, 7000}), false);
  EXPECT_EQ(judgement.verdict, MapVerdict::silentlyWrong);
  EXPECT_EQ(judgement.why.find("the mean of tension is 5320 N over 5 steps"), 0u) << judgement.why;
  // The run warns of the ground impact.
  std::vector<TrialPair> struck =
      neighbours({5000, 5600, 4700, 5900, 5100, 5300}, {7700, 6900, 7400, 7100, 7600, 7000});
  struck[0].run.figures.blow = 3.9;
  EXPECT_EQ(judge(struck, false).verdict, MapVerdict::silentlyWrong);
  struck[0].run.figures.blow = 4.1;
  EXPECT_EQ(judge(struck, false).verdict, MapVerdict::warned);
  struck[2].finer.figures.energyResidual = 1e-6;
  EXPECT_EQ(judge(struck, false).verdict, MapVerdict::silentlyWrong) << "an impact does not break the energy balance";
  // The same for a figure in which the pair itself agrees.
  std::vector<TrialPair> pairs = neighbours({5000, 5600, 4700, 5900, 5100, 5300}, {5700, 4900, 5400, 5100, 5600, 5000});
  for (std::size_t i = 1; i < pairs.size(); ++i) pairs[i].finer.figures.power = 3000;
  pairs[0].finer.figures.power = 2100;
  EXPECT_EQ(judge(pairs, false).why.find("the mean of power is"), 0u) << judge(pairs, false).why;
}

TEST(VehicleNeighbours, ADifferenceThatMayBeIsNone) {
  // A difference of 100 N without scatter: less than a twentieth.
  EXPECT_EQ(
      judge(neighbours({5000, 5000, 5000, 5000, 5000, 5000}, {5400, 5010, 5010, 5010, 5010, 5010}), false).verdict,
      MapVerdict::scatters);
}

TEST(VehicleNeighbours, ScatterThatTheStepMakesIsSilentlyWrong) {
  // All quarters yield 5000: the difference is due to the steps, though Welch's interval extends from here to
  // 5000.
  const Judgement judgement =
      judge(neighbours({5700, 4400, 7000, 4900, 5600, 5200}, {5000, 5020, 4990, 5010, 5000, 4980}), false);
  EXPECT_EQ(judgement.verdict, MapVerdict::silentlyWrong);
  EXPECT_NE(judgement.why.find("the step causes this scatter"), std::string::npos) << judgement.why;
  EXPECT_EQ(
      judge(neighbours({5700, 5000, 5020, 4990, 5010, 4980}, {5000, 5900, 4400, 5010, 5600, 4800}), false).verdict,
      MapVerdict::scatters)
      << "the quarters scatter, too";
}

TEST(VehicleNeighbours, OneThatIsNotSoundMakesThePointWrong) {
  const std::array<double, 6> steps{5000, 5600, 4700, 5900, 5100, 5300}, quarters{5700, 4900, 5400, 5100, 5600, 5000};
  for (const bool finer : {false, true}) {
    std::vector<TrialPair> pairs = neighbours(steps, quarters);
    VehicleTrial& trial = finer ? pairs[2].finer : pairs[2].run;
    const VehicleTrial sound = trial;
    trial = stoppedTrial(kUnstable);
    EXPECT_EQ(judge(pairs, false).verdict, MapVerdict::silentlyWrong);
    EXPECT_NE(judge(pairs, false).why.find("unstable"), std::string::npos) << judge(pairs, false).why;
    trial = sound, trial.figures.energyResidual = 1e-6;
    EXPECT_EQ(judge(pairs, false).verdict, MapVerdict::silentlyWrong);
    trial = sound, trial.figures.speed = NAN;
    EXPECT_EQ(judge(pairs, false).verdict, MapVerdict::silentlyWrong);
  }
}

TEST(VehicleNeighbours, AreAskedForFiguresAlone) {
  VehicleTrial apart = soundTrial();
  apart.figures.speed *= 2;
  EXPECT_TRUE(figuresDisagree(soundTrial(), apart, false));
  EXPECT_FALSE(figuresDisagree(soundTrial(), soundTrial(), false));
  EXPECT_FALSE(figuresDisagree(soundTrial(), stoppedTrial(kThrown), false));
  EXPECT_FALSE(figuresDisagree(stoppedTrial(kThrown), apart, false));
  apart.figures.energyResidual = 1e-6;
  EXPECT_FALSE(figuresDisagree(soundTrial(), apart, false));
  // Neighbours do not change other verdicts, either.
  std::vector<TrialPair> pairs = neighbours({5000, 9000, 1000, 5000, 4000, 7000}, {5000, 9000, 1000, 5000, 4000, 7000});
  EXPECT_EQ(judge(pairs, false).verdict, MapVerdict::sound);
  pairs[0].finer = stoppedTrial(kThrown);
  EXPECT_EQ(judge(pairs, false).verdict, MapVerdict::silentlyWrong);
}

TEST(VehicleSeeds, ScatterIsThatOfSoundPointsOfOneMap) {
  const VehicleMap seeds{"seeds", "", {}, {}}, grains{"grains", "", {}, {}};
  std::vector<JudgedPoint> points;
  for (const double speed : {0.5, 0.6}) {
    JudgedPoint p{&seeds, nullptr, {{soundTrial(), soundTrial()}}, {}};
    p.pairs[0].run.figures.speed = speed, p.pairs[0].finer.figures.speed = 0.4;
    points.push_back(p);
  }
  points.push_back(points.back()), points.back().map = &grains, points.back().pairs[0].run.figures.speed = 9;
  points.push_back(points.front()), points.back().judgement.verdict = MapVerdict::stopped;
  // Root mean square of 0.1 and 0.2; a fifth of 0.55 and 0.05 m/s.
  const std::string text = seedScatterTable(points);
  EXPECT_NE(text.find("  2 beds"), std::string::npos) << text;
  EXPECT_NE(text.find("speed                   0.55 +- 0.0707          0.4 +- 0             0.158      0.16 m/s"),
            std::string::npos)
      << text;
  points.erase(points.begin());
  EXPECT_EQ(seedScatterTable(points), "") << "a single seed shows no scatter";
}

class VehicleMaps : public FolderTest {
protected:
  TrialPlace place() const { return {folder_, nullptr, sharedSpheres()}; }
};

TEST_F(VehicleMaps, StepsBeyondTheLineAreRefusedAndThoseBelowAreNot) {
  std::set<std::string> names;
  for (const std::string& name : vehicleMapNames()) {
    const VehicleMap map = vehicleMap(name, false, folder_);
    EXPECT_EQ(map.name, name);
    EXPECT_TRUE(names.insert(name).second);
    EXPECT_GE(map.points.size(), name == "seeds" ? 4u : 9u) << name;
    EXPECT_FALSE(map.lines.empty()) << name;
    int refused = 0, stepped = 0;
    for (const MapPoint& p : map.points) {
      const double longest = longestStep(p.what, folder_);
      const bool beyond = p.step > longest;
      stepped += p.y == p.step, refused += beyond;
      if (beyond) {
        const VehicleTrial trial = tryVehicle(p.what, p.step, place());
        EXPECT_EQ(trial.end, TrialEnd::refused) << name << " " << p.x << " " << p.y;
        EXPECT_NE(trial.cause.find("time_step"), std::string::npos) << trial.cause;
      } else {
        EXPECT_NO_THROW(sceneOf(p.what, p.step, folder_)) << name << " " << p.x << " " << p.y;
      }
    }
    // Steps are one axis of such a map; the last step exceeds the limit.
    EXPECT_EQ(refused * mapShares(false).size(), stepped > 0 && !map.onBed ? map.points.size() : 0) << name;
  }
  EXPECT_THROW(vehicleMap("none", true, folder_), base::InputError);
}

/// An impact of rigid links lasts one step: sparse samples miss it, or count it for all skipped samples.
TEST_F(VehicleMaps, TensionIsTheMeanOverAllStepsOfTheWindow) {
  VehicleCase what = vehicleMap("stiffness", true, folder_).points.front().what;
  what.from = 0.04, what.until = 0.07;
  constexpr double kStep = 1e-4;
  constexpr int kBegin = 400, kEnd = 700; // one hundred samples: every third step
  const VehicleTrial trial = tryVehicle(what, kStep, place());
  ASSERT_EQ(trial.end, TrialEnd::sound) << trial.cause;
  coupling::Simulation run(
      setup::simulationSetup(sceneOf(what, kStep, folder_)), base::cpuExec(1), [](double, double) {}, {}, nullptr,
      sharedSpheres());
  double sum = 0, pins = 0, pace = 0;
  while (run.steps() < kEnd) {
    run.step();
    if (run.steps() <= kBegin) continue;
    if ((run.steps() - kBegin) % 3 == 0) pace += 0.01 * std::fabs(run.vehicle()->observe().velocity.x);
    for (const vehicle::TrackObservation& track : run.vehicle()->observe().tracks)
      for (const double tension : track.tension) sum += tension, ++pins;
  }
  EXPECT_NEAR(trial.figures.tension, sum / pins, 1e-12 * sum / pins) << "rounding";
  EXPECT_NEAR(trial.figures.speedMagnitude, pace, 1e-12 * pace) << "rounding";
  EXPECT_GE(trial.figures.powerMagnitude, (1 - 1e-9) * std::fabs(trial.figures.power));
}

TEST_F(VehicleMaps, AStepThatIsMuchTooLongIsCaughtEvenWhereNobodyRefusesIt) {
  const VehicleMap map = vehicleMap("stiffness", true, folder_);
  const VehicleCase& what = map.points.front().what;
  const double longest = longestStep(what, folder_);
  const VehicleTrial wild = tryVehicle(what, 8 * longest, place(), StepCheck::none);
  ASSERT_EQ(wild.end, TrialEnd::stopped);
  EXPECT_TRUE(blamesStep(wild.blamed)) << wild.cause;
  EXPECT_LT(wild.reached, what.until);
}

/// The vehicle lands on its idlers, which press the shoes with a hundred times their static load. The run is sound at
/// the accepted step, and the energy guard stops it at twice that step.
TEST_F(VehicleMaps, AnImpactFarStifferThanTheWeightAtRestIsCaught) {
  const VehicleMap map = vehicleMap("drop", false, folder_);
  const auto point =
      std::find_if(map.points.begin(), map.points.end(), [](const MapPoint& p) { return p.x == 3 && p.step > 1e-4; });
  ASSERT_NE(point, map.points.end());
  EXPECT_EQ(tryVehicle(point->what, point->step, place()).end, TrialEnd::sound);
  const VehicleTrial trial = tryVehicle(point->what, 2 * point->step, place(), StepCheck::none);
  ASSERT_EQ(trial.end, TrialEnd::stopped);
  EXPECT_TRUE(blamesStep(trial.blamed)) << trial.cause;
}

/// Friction couples six heavy shoes to a light idler; the step limit refuses this step. At 1.5 times the step the
/// energy guard detects the instability.
TEST_F(VehicleMaps, AnIdlerThatTremblesOnHeavyShoesIsRefusedAndCaught) {
  const VehicleMap map = vehicleMap("mass", false, folder_);
  const auto point = std::find_if(map.points.begin(), map.points.end(), [](const MapPoint& p) { return p.x == 65; });
  ASSERT_NE(point, map.points.end());
  const double step = 3.7e-4;
  const VehicleTrial refused = tryVehicle(point->what, step, place());
  EXPECT_EQ(refused.end, TrialEnd::refused);
  EXPECT_NE(refused.cause.find("idler in contact with 6 shoes"), std::string::npos) << refused.cause;
  const VehicleTrial trial = tryVehicle(point->what, 1.5 * step, place(), StepCheck::none);
  ASSERT_EQ(trial.end, TrialEnd::stopped);
  EXPECT_TRUE(blamesStep(trial.blamed)) << trial.cause;
}

class VehicleStudy : public ProgramTest {};

TEST_F(VehicleStudy, GoesOnWithWhatIsThereAndDrawsEveryVerdict) {
  const std::string words = "study stability --scene vehicle --quick --maps gravity,mass --out results";
  const fs::path runs = folder_ / "results" / "runs";
  // The second of each two points exceeds the limit: it is rejected and needs no run.
  const Outcome part = call(words + " --part 2/2");
  ASSERT_EQ(part.code, 0) << part.errors;
  EXPECT_TRUE(fs::exists(runs / "gravity_1.csv") && fs::exists(runs / "mass_1.csv"));
  EXPECT_FALSE(fs::exists(runs / "gravity_0.csv") || fs::exists(folder_ / "results" / "vehicle.csv"));

  const std::string numbers =
      "step [s],end,reached [s],wall [s],cause,speed [m/s],height [m],lowest height [m],pitch [rad],"
      "power [W],tension [N],sinkage [m],dissipated [J],integration error [J],turnover "
      "[J],left over [-],speed magnitude [m/s],power magnitude [W],blow [weights]\n";
  const std::string row = "1e-4,0,0.7,1,0,0.5,0.4,0.39,0,2000,5000,nan,3000,1,1e5,0,0.5,2000,1.2\n";
  put(runs / "gravity_0.csv", numbers + row + row);
  put(runs / "gravity_0.txt", "\n\n");
  const Outcome sound = call(words + " --resume --seconds 1e-9");
  ASSERT_EQ(sound.code, 0) << sound.errors;
  EXPECT_NE(sound.out.find("runs are missing"), std::string::npos) << sound.out;
  EXPECT_NE(sound.out.find("refused: gravity"), std::string::npos) << sound.out;
  const std::string csv = contents(folder_ / "results" / "vehicle.csv");
  EXPECT_NE(csv.find(",sound,"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",refused,"), std::string::npos) << csv;
  EXPECT_TRUE(fs::exists(folder_ / "results" / "vehicle.png") || sound.errors.find("python3") != std::string::npos);

  // A contradicting finer run leads to a separate exit code.
  const auto withSpeeds = [&numbers](double run, double finer) {
    return fmt::format("{}1e-4,0,0.7,1,0,{},0.4,0.39,0,2000,5000,nan,3000,1,1e5,0,0.5,2000,1.2\n"
                       "2.5e-5,0,0.7,1,0,{},0.4,0.39,0,2000,5000,nan,3000,1,1e5,0,0.5,2000,1.2\n",
                       numbers, run, finer);
  };
  put(runs / "gravity_0.csv", withSpeeds(0.5, 0.9));
  const Outcome open = call(words + " --resume --seconds 1e-9");
  EXPECT_EQ(open.code, 0) << open.errors;
  EXPECT_EQ(open.out.find("silently wrong: gravity"), std::string::npos) << "its neighbours have not run";
  const auto beside = [&](const std::array<double, 5>& run, const std::array<double, 5>& finer) {
    for (std::size_t k = 0; k < run.size(); ++k) {
      put(runs / fmt::format("gravity_0_beside_{}.csv", k), withSpeeds(run[k], finer[k]));
      put(runs / fmt::format("gravity_0_beside_{}.txt", k), "\n\n");
    }
    return call(words + " --resume --seconds 1e-9");
  };
  const Outcome scatters = beside({0.9, 0.5, 0.8, 0.6, 0.7}, {0.5, 0.8, 0.6, 0.7, 0.9});
  EXPECT_EQ(scatters.code, 0) << scatters.errors;
  EXPECT_NE(scatters.out.find("scatters: gravity"), std::string::npos) << scatters.out;
  EXPECT_NE(scatters.out.find("speed                    0.7 +- 0.158"), std::string::npos) << scatters.out;
  EXPECT_NE(contents(folder_ / "results" / "vehicle.csv").find(",scatters,"), std::string::npos);
  EXPECT_NE(contents(folder_ / "results" / "vehicle_neighbours.csv").find("2.5e-05,sound,"), std::string::npos);
  const Outcome wrong = beside({0.5, 0.5, 0.5, 0.5, 0.5}, {0.9, 0.9, 0.9, 0.9, 0.9});
  EXPECT_EQ(wrong.code, 3) << wrong.out;
  EXPECT_NE(wrong.out.find("silently wrong: gravity"), std::string::npos) << wrong.out;
  EXPECT_NE(wrong.errors.find("1 points are silently wrong"), std::string::npos) << wrong.errors;

  const Outcome other = call("study stability --scene vehicle --quick --maps drop --out results --resume");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.errors.find("different options"), std::string::npos) << other.errors;
}

TEST_F(VehicleStudy, RefusesWordsOfOtherMaps) {
  for (const char* words :
       {"--scene boat", "--scene vehicle --maps round", "--maps drop", "--seconds 3", "--part 1/2", "--resume",
        "--threads 2", "--random 3 --scene vehicle", "--random 3 --seconds 4", "--scene vehicle --grains 20",
        "--scene vehicle --column 4", "--scene vehicle --part 3/2", "--scene vehicle --seconds -1"}) {
    const Outcome o = call(std::string("study stability --quick --out results ") + words);
    EXPECT_EQ(o.code, 2) << words << "\n" << o.out;
  }
  EXPECT_FALSE(fs::exists(folder_ / "results")) << "no run has started";
  EXPECT_NE(call("study stability --help").out.find("--maps"), std::string::npos);
}

} // namespace
} // namespace grouser::studies
