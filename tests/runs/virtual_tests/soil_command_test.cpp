// SPDX-License-Identifier: BSD-3-Clause
// `grouser soil` from the command line: tables, files, slices, and errors without output files.
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <string>

namespace grouser::virtual_tests {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

/// Soft grains of 20 mm: the fewest steps.
constexpr const char* kSand =
    "version = 1\n[soil]\ntitle = \"a trial\"\ndescription = \"soft\"\n[material]\nstiffness = 5e3\nrestitution = "
    "0.3\nfriction = 0.5\n[bed]\ngrain_radius = 0.01\n[[published]]\nquantity = \"phi\"\n"
    "value = 25\nunit = \"deg\"\nsource = \"a book\"\n[[published]]\nquantity = \"n\"\nvalue = 1\nunit = \"-\"\n"
    "source = \"a book\"\n";
/// The smallest valid tests, with the longest stable steps.
constexpr const char* kSmallest =
    " --quick --plate-grains 5 --plate-ratio 1.5 "
    "--thickness 4.5 --bin 3 --pressure 20000 --inertial-number 0.05 --shear-loads 5000 10000 "
    "--plate-waves 10 --shear-strain 0.05 --shear-inertial-number 0.1 --threads 1 --device cpu";
constexpr const char* kLongSteps = " --steps-per-contact 10";

const std::string kSmall = std::string(kSmallest) + " --seeds 2 --large-seeds 2";

class SoilCommandTest : public ProgramTest {};

TEST_F(SoilCommandTest, LeavesOutTheWidePlatesWhereAsked) {
  put(folder_ / "sand.toml", kSand);
  // Two small plates, eight sheared samples, a large plate, and two plates on wide beds.
  for (const auto& [words, tests] : {std::pair{"", "0 of 13 tests"}, std::pair{" --no-wide", "0 of 11 tests"}}) {
    const Outcome o = call(fmt::format("soil sand.toml --out results{} --part 1/2 --seeds 2 --large-seeds 1 --seconds "
                                       "1e-9 --threads 1 --device cpu --force{}",
                                       *words ? "_narrow" : "", words));
    EXPECT_NE((o.out + o.errors).find(tests), std::string::npos) << o.out << o.errors;
  }
}

TEST_F(SoilCommandTest, MeasuresInSlicesAndWritesItsTables) {
  put(folder_ / "sand.toml", kSand);
  const std::string words = "soil sand.toml --out results" + kSmall + kLongSteps;
  const Outcome part = call(words + " --part 2/3");
  ASSERT_EQ(part.code, 0) << part.errors;
  EXPECT_FALSE(fs::exists(folder_ / "results" / "soil.json")) << "a part writes no tables";
  const auto poured = [&] {
    int files = 0;
    for (const auto& entry : fs::directory_iterator(folder_ / "results" / "runs"))
      files += entry.path().filename().string().rfind("poured_", 0) == 0;
    return files;
  };
  EXPECT_GE(poured(), 1) << "a sheared sample is reused for its other load";
  const Outcome o = call(words + " --resume --jobs 2");
  ASSERT_EQ(o.code, 0) << o.errors;
  EXPECT_EQ(poured(), 0);
  for (const char* word : {"coarse", "k_phi", "phi", "25  a book", "K", "porosity", "k_u"})
    EXPECT_NE(o.out.find(word), std::string::npos) << word << "\n" << o.out;
  const auto json = nlohmann::json::parse(contents(folder_ / "results" / "soil.json"));
  EXPECT_EQ(json.at("care"), "coarse");
  EXPECT_EQ(json.at("missing_tests"), 0);
  EXPECT_EQ(json.at("seeds").at("small"), 2);
  EXPECT_EQ(json.at("grain_radius_m"), 0.01);
  EXPECT_GT(json.at("constants").at("phi").at("value").get<double>(), 5);
  EXPECT_LT(json.at("constants").at("phi").at("value").get<double>(), 50);
  EXPECT_TRUE(json.at("constants").at("n").at("half_width").is_number());
  EXPECT_EQ(json.at("constants").at("phi").at("published").at(0).at("source"), "a book");
  for (const char* file : {"soil.txt", "constants.csv", "plates.csv", "shear.csv"}) {
    const std::string text = contents(folder_ / "results" / file);
    EXPECT_NE(text.find("coarse"), std::string::npos) << file;
  }
  const std::string before = contents(folder_ / "results" / "constants.csv");
  for (const std::string& same : {words + " --resume", words}) {
    const Outcome again = call(same);
    ASSERT_EQ(again.code, 0) << again.errors;
    EXPECT_EQ(contents(folder_ / "results" / "constants.csv"), before) << "the same tests yield the same numbers";
  }
  // The soil contact model, fitted to the same tests.
  const Outcome fit = call(words + " --resume --fit-scm");
  ASSERT_EQ(fit.code, 0) << fit.errors;
  EXPECT_NE(fit.out.find("model error with these constants"), std::string::npos) << fit.out;
  for (const char* group : {"plate 0.1 m", "plate 0.15 m", "shear 5 kPa", "shear 10 kPa"})
    EXPECT_NE(contents(folder_ / "results" / "scm_residuals.csv").find(group), std::string::npos) << group;
  const std::string scm = contents(folder_ / "results" / "scm_fit.toml");
  const double n = std::strtod(scm.c_str() + scm.find("n = ") + 4, nullptr);
  EXPECT_NEAR(n, json.at("constants").at("n").at("value").get<double>(), 1e-5 * n) << scm;
  EXPECT_NE(scm.find("elastic_ratio = "), std::string::npos) << scm;
  put(folder_ / "drive.toml",
      "version = 1\n[run]\nduration = 1\n[terrain]\nkind = \"scm\"\nmaterial = \"lete_sand\"\nheightmap = "
      "\"heightmaps/flat.png\"\nsize = [8, 4]\nheight_range = [0, 0]\n[vehicle]\nspec = "
      "\"vehicles/light_tracked.toml\"\n" +
          scm);
  const Outcome plan = call("plan drive.toml --no-probe");
  EXPECT_EQ(plan.code, 0) << plan.errors;
  EXPECT_NE(plan.out.find("(set in the scene)"), std::string::npos) << plan.out;
  EXPECT_TRUE(fs::exists(folder_ / "results" / "scm_fit.png"));
  // Results of the small plate only.
  for (const int seed : {1, 2}) fs::remove(folder_ / "results" / "runs" / fmt::format("coarse_large_seed{}.csv", seed));
  const Outcome alone = call(words + " --resume --seconds 1e-6 --fit-scm");
  ASSERT_EQ(alone.code, 0) << alone.errors;
  EXPECT_NE(alone.out.find("fit       skipped"), std::string::npos) << alone.out;
  EXPECT_NE(alone.out.find("n of this plate"), std::string::npos) << alone.out;
  EXPECT_NE(alone.out.find("with n = 1;"), std::string::npos) << alone.out;
  const auto small = nlohmann::json::parse(contents(folder_ / "results" / "soil.json"));
  EXPECT_EQ(small.at("missing_tests"), 2);
  EXPECT_FALSE(small.at("constants").contains("n"));
  EXPECT_NEAR(small.at("plates").at(0).at("n_alone").at("value").get<double>(),
              json.at("plates").at(0).at("n_alone").at("value").get<double>(), 1e-12);
  EXPECT_NEAR(small.at("plates").at(0).at("k_at_published_n").at("value").get<double>(),
              json.at("plates").at(0).at("k_at_published_n").at("value").get<double>(), 1e-9);
  EXPECT_TRUE(small.at("plates").at(1).at("k").at("value").is_null());
  EXPECT_TRUE(small.at("plates").at(1).at("k_u").at("value").is_null());
  const Outcome other = call(words + " --resume --grain-radius 0.012");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.errors.find("different options"), std::string::npos) << other.errors;
}

/// Measured plates as targets: trials, tables, the soil file, and reuse of finished tests.
TEST_F(SoilCommandTest, CalibratesOnMeasuredPlates) {
  put(folder_ / "plates.csv", "trial,plate_diameter_mm,sinkage_mm,pressure_kPa\n1,100,0,0\n1,100,20,20\n"
                              "2,100,0,0\n2,100,20,24\n");
  put(folder_ / "sand.toml",
      "version = 1\n[plates]\nfile = \"plates.csv\"\nsinkages = [0.005, 0.01]\n"
      "bin = 0.2\ndepth = 0.1\n[search]\nstiffness = [5e2, 5e5]\ndepth = [0.06, 0.11]\ntrials = 3\n[start]\nstiffness "
      "= 2e3\nrestitution = 0.3\nfriction = 0.5\n[bed]\n"
      "grain_radius = 0.01\n");
  const std::string words = std::string("soil --calibrate sand.toml --out found --seeds 2 --inertial-number 0.03 "
                                        "--quick --threads 1 --device cpu") +
                            kLongSteps;
  const Outcome o = call(words + " --jobs 2");
  ASSERT_EQ(o.code, 0) << o.errors;
  const auto record = nlohmann::json::parse(contents(folder_ / "found" / "calibration.json"));
  EXPECT_EQ(record.at("status"), "finished");
  const auto& trials = record.at("trials");
  ASSERT_GE(trials.size(), 2u);
  EXPECT_EQ(trials.at(0).at("kind"), "curves");
  EXPECT_NE(trials.at(0).at("parameters").at("stiffness"), trials.at(1).at("parameters").at("stiffness"));
  const auto pressure = [&](int trial) {
    return trials.at(trial).at("measured").at("100 mm at 10 mm").at("value").get<double>();
  };
  EXPECT_GT(pressure(1), pressure(0)) << "stiffer";
  EXPECT_EQ(trials.at(2).at("parameters"), trials.at(0).at("parameters"));
  EXPECT_NE(pressure(2), pressure(0)) << "the depths of the beds differ";
  const std::string points = contents(folder_ / "found" / "final" / "points.csv");
  EXPECT_EQ(std::count(points.begin(), points.end(), '\n'), 5) << "two tests, two sinkages\n" << points;
  EXPECT_NE(contents(folder_ / "found" / "calibration.txt").find("plate of 100 mm at 5 mm"), std::string::npos);
  EXPECT_NE(contents(folder_ / "found" / "sand.toml").find("m deep"), std::string::npos);
  double sinkage = 0, pressed = 0;
  const std::string curves = contents(folder_ / "found" / "final" / "curves.csv");
  ASSERT_EQ(std::sscanf(curves.c_str() + curves.find('\n') + 1, "coarse,0.1,1,%lf,%lf", &sinkage, &pressed), 2);
  EXPECT_TRUE(sinkage < -1e-3 && sinkage > -0.04) << sinkage << ": the plate starts at the highest grain";
  EXPECT_LT(pressed, 1000);
  EXPECT_TRUE(fs::exists(folder_ / "found" / "curves.png"));
  const std::string seed = "runs/coarse_plate100mm_seed1.csv";
  EXPECT_EQ(call(words + " --resume").code, 0);
  const auto again = nlohmann::json::parse(contents(folder_ / "found" / "calibration.json"));
  EXPECT_EQ(again.at("trials"), trials);
  EXPECT_FALSE(contents(folder_ / "found" / "final" / seed).empty());
  const Outcome page = call("report found");
  EXPECT_EQ(page.code, 0) << page.errors;
  // Counted from first contact, above the mean surface, the same plates carry less at a given sinkage.
  std::string targets = contents(folder_ / "sand.toml");
  put(folder_ / "sand.toml", targets.insert(targets.find("bin"), "contact_pressure = 100\n"));
  const Outcome zeroed = call(words + " --force");
  EXPECT_EQ(zeroed.code, 0) << zeroed.errors;
  EXPECT_NE(zeroed.out.find("zero sinkage at"), std::string::npos) << zeroed.out;
  const auto lower = nlohmann::json::parse(contents(folder_ / "found" / "calibration.json")).at("trials").at(0);
  EXPECT_LT(lower.at("measured").at("100 mm at 10 mm").at("value").get<double>(), pressure(0));
  // Its curves start at the mean sinkage at which the tests carry 100 Pa; their zero follows from the
  // runs' own sinkage, measured from the mean surface.
  const double contact = 0.5 * (20 * 0.1 / 20 + 20 * 0.1 / 24); // [mm]
  const std::string shifted = contents(folder_ / "found" / "final" / "curves.csv");
  ASSERT_EQ(std::sscanf(shifted.c_str() + shifted.find('\n') + 1, "coarse,0.1,1,%lf,%lf", &sinkage, &pressed), 2);
  EXPECT_NEAR(1e3 * sinkage, contact, 1e-4);
  EXPECT_GE(pressed, 100);
  double height = 0, all = 0;
  ASSERT_EQ(std::sscanf(zeroed.out.c_str() + zeroed.out.find("zero sinkage at"), "zero sinkage at %lf mm", &height), 1);
  for (int n = 1; n <= 2; ++n) {
    std::istringstream rows(
        contents(folder_ / "found" / "curves_1" / "runs" / fmt::format("coarse_plate100mm_seed{}.csv", n)));
    std::string row;
    std::getline(rows, row);
    for (double p = 0; p < 100 && std::getline(rows, row);) std::sscanf(row.c_str(), "%lf,%lf", &sinkage, &p);
    all -= sinkage;
  }
  EXPECT_NEAR(height, 1e3 * all / 2 + contact, 0.006);
}

TEST_F(SoilCommandTest, TiltsFourBedsForAnAngleOfReposeEvenWithOneSeed) {
  put(folder_ / "plates.csv", "trial,plate_diameter_mm,sinkage_mm,pressure_kPa\n1,100,0,0\n1,100,20,20\n");
  put(folder_ / "sand.toml", "version = 1\n[targets]\nrepose = 29\n[plates]\nfile = \"plates.csv\"\nsinkages = [0.01]\n"
                             "bin = 0.2\ndepth = 0.1\n[search]\nfriction = [0.3, 0.8]\n[start]\nstiffness = 2e3\n"
                             "friction = 0.5\n[bed]\ngrain_radius = 0.01\n");
  const Outcome o = call("soil --calibrate sand.toml --seeds 1 --quick --seconds 1e-9 --threads 1 --device cpu");
  EXPECT_NE((o.out + o.errors).find("5 tests of this trial are missing"), std::string::npos)
      << o.code << o.out << o.errors;
}

/// calibration.json contains each completed trial, and a resumed call records the same trials.
TEST_F(SoilCommandTest, ACalibrationKeepsItsTrials) {
  put(folder_ / "targets.toml",
      "version = 1\n[targets]\nphi = 24\nK = 12\nn = 1\nk = 1700\nb = 0.1\n[tolerances]\nphi = 40\nk = 1\n[start]\n"
      "stiffness = 1.2e4\nrestitution = 0.3\nfriction = 0.5\ncohesion = 25\nadhesion_radius = "
      "0.01\n[bed]\ngrain_radius = 0.01\n");
  std::string words =
      std::string("soil --calibrate targets.toml --out found --seeds 1 --large-seeds 1") + kSmallest + kLongSteps;
  words.replace(words.find("20000"), 5, "30000"); // half of the target, within the tolerance
  const auto record = [&] { return nlohmann::json::parse(contents(folder_ / "found" / "calibration.json")); };
  // In so short a time no test starts, on any machine.
  ASSERT_EQ(call(words + " --seconds 1e-9").code, 0);
  EXPECT_EQ(record().at("status"), "unfinished");
  ASSERT_EQ(call(words + " --seconds 1e-9").code, 0) << "the same call continues";
  EXPECT_EQ(record().at("missing").at("trial"), "shear_1");
  const Outcome o = call(words + " --resume --jobs 2");
  ASSERT_EQ(o.code, 0) << o.errors;
  const auto whole = record();
  EXPECT_EQ(whole.at("status"), "finished");
  EXPECT_FALSE(whole.contains("missing"));
  EXPECT_NE(whole.at("command").get<std::string>().find("--resume"), std::string::npos);
  ASSERT_EQ(whole.at("trials").size(), 2u) << "the first is close enough";
  const auto& shear = whole.at("trials").at(0);
  EXPECT_EQ(shear.at("name"), "shear_1");
  EXPECT_EQ(shear.at("parameters").at("friction"), 0.5);
  EXPECT_GT(shear.at("measured").at("phi").at("value").get<double>(), 5);
  EXPECT_TRUE(shear.at("measured").at("phi").at("half_width").is_null()) << "a single seed";
  const auto& plate = whole.at("trials").back();
  EXPECT_EQ(plate.at("kind"), "plate");
  EXPECT_EQ(plate.at("parameters"), shear.at("parameters"));
  EXPECT_NEAR(plate.at("measured").at("sinkage").at("value").get<double>(), 1e3 * 47.5 / 1700, 1e-9);
  const auto soil = nlohmann::json::parse(contents(folder_ / "found" / "final" / "soil.json"));
  EXPECT_EQ(whole.at("outcomes").at(0).at("verdict"), "not sought") << "n is a result, not a target";
  const auto& phi = whole.at("outcomes").at(1);
  EXPECT_EQ(phi.at("what"), "phi");
  EXPECT_EQ(phi.at("reached").at("value"), soil.at("constants").at("phi").at("value"));
  EXPECT_EQ(contents(folder_ / "found" / "calibration.txt").find("not reached") == std::string::npos,
            whole.dump().find("\"not reached\"") == std::string::npos);
  ASSERT_EQ(call(words + " --resume").code, 0);
  EXPECT_EQ(record().at("trials"), whole.at("trials"));
  EXPECT_EQ(record().at("outcomes"), whole.at("outcomes"));
  // Its wall time is unchanged: it did not run again.
  const std::string name = "runs/coarse_small_seed1.csv";
  EXPECT_EQ(contents(folder_ / "found" / "final" / name), contents(folder_ / "found" / "plate_1" / name));
}

TEST_F(SoilCommandTest, WhatEndsUnsoundlyIsDoneAgainWithShorterSteps) {
  std::string sand = kSand;
  sand.replace(sand.find("0.3"), 3, "0.9"); // grains that bounce, with the longest steps, are thrown about
  put(folder_ / "sand.toml", sand);
  const std::string words = "soil sand.toml --out results --steps-per-contact 6" + kSmall;
  const Outcome part = call(words + " --part 2/100"); // shear of the first seed under the lesser load
  ASSERT_EQ(part.code, 0) << part.errors;
  const Outcome o = call(words + " --resume --seconds 1e-6");
  ASSERT_EQ(o.code, 0) << o.errors;
  EXPECT_NE(o.out.find("with 1.5 times as many steps per contact"), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("coarse_shear5kPa_seed1: step "), std::string::npos) << o.out;
  const auto json = nlohmann::json::parse(contents(folder_ / "results" / "soil.json"));
  EXPECT_EQ(json.at("tests_with_shorter_steps"), nlohmann::json({"coarse_shear5kPa_seed1"}));
}

TEST_F(SoilCommandTest, PartsMayBeginTogether) {
  put(folder_ / "sand.toml",
      std::string(kSand).replace(std::string(kSand).find("[[published"), 0, "porosity = 0.42\n"));
  const std::string words = "\"$grouser\" soil sand.toml --out results --resume" + kSmall + kLongSteps;
  const Outcome o = shell(words + " --part 1/100 > first.log 2>&1 & first=$!; " + words +
                          " --part 2/100; second=$?; wait $first && exit $second");
  EXPECT_EQ(o.code, 0) << o.errors << contents(folder_ / "first.log");
  const fs::path runs = folder_ / "results" / "runs";
  EXPECT_TRUE(fs::exists(runs / "coarse_preparation.csv"));
  for (const auto& entry : fs::directory_iterator(runs))
    if (entry.path().filename().string().rfind("poured_", 0) == 0) fs::remove(entry.path()); // deletes the shear test
  EXPECT_EQ(std::distance(fs::directory_iterator(runs), {}), 3) << "one preparation and two tests only";
}

TEST_F(SoilCommandTest, WrongWordsEndWithTwoAndWriteNothing) {
  put(folder_ / "sand.toml", kSand);
  put(folder_ / "wrong.toml", std::string(kSand) + "colour = 1\n");
  const Outcome unknown = call("soil no_such_soil");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(unknown.error().find("no_such_soil"), std::string::npos) << unknown.errors;
  const Outcome key = call("soil wrong.toml --quick");
  EXPECT_EQ(key.code, 2);
  EXPECT_NE(key.error().find("wrong.toml:21"), std::string::npos) << key.errors;
  EXPECT_EQ(call("soil").code, 2);
  EXPECT_EQ(call("soil sand.toml --calibrate sand.toml").code, 2);
  EXPECT_NE(call("soil --calibrate sand.toml --fit-scm").error().find("--fit-scm"), std::string::npos);
  EXPECT_EQ(call("soil sand.toml --quick --thickness 3.6").code, 2);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(SoilCommandTest, TargetsThatCannotBeAreNamed) {
  const std::string rest = "[start]\nfriction = 0.5\n[bed]\ngrain_radius = 0.01\n";
  const auto error = [&](const std::string& targets) {
    put(folder_ / "targets.toml", "version = 1\n[targets]\n" + targets + rest);
    const Outcome o = call("soil --calibrate targets.toml --quick");
    EXPECT_EQ(o.code, 2) << targets;
    return o.error();
  };
  EXPECT_NE(error("k = 3000\n").find("targets.toml:3"), std::string::npos);
  EXPECT_NE(error("k_c = 10\nn = 1\n").find("k_phi"), std::string::npos);
  EXPECT_NE(error("k_c = 10\nk_phi = 1000\n").find("targets.n"), std::string::npos);
  EXPECT_NE(error("phy = 30\n").find("phi"), std::string::npos) << "nearest name";
  EXPECT_NE(error("K = 12\n").find("targets"), std::string::npos) << "no targets";
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

} // namespace
} // namespace grouser::virtual_tests
