// SPDX-License-Identifier: BSD-3-Clause
// Files of grains: valid lines are read to the last digit, and an invalid one causes one error with its place.
#include "base/error.hpp"
#include "runs/scene/scene.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace grouser::scene {
namespace {

class GrainFile : public test::FolderTest {
protected:
  std::string file() const { return (folder_ / "table_of_grains.csv").string(); }
  std::vector<Grain> read(const std::string& text) const {
    test::put(file(), text);
    GrainFill fill;
    fill.velocity = {0, 0, -1};
    return readGrainFile(file(), fill);
  }
  std::string refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const base::InputError& e) {
      return e.what();
    }
    return "";
  }
};

const Grain kMoving{{0.1, -0.2, 0.3}, {1, 2, 3}, {4, 5, 6}, 0.01, "", false};

TEST_F(GrainFile, EverySeparatorAndLineEndGivesTheSameGrain) {
  const char* withUnits = "\xEF\xBB\xBFX [m], Y [m], Z [m], radius [m], vx [m/s], vy [m/s], vz [m/s], wx [rad/s], "
                          "wy [rad/s], wz [rad/s]\n0.1,-0.2,0.3,0.01,1,2,3,4,5,6\n";
  for (const char* text :
       {"0.1,-0.2,0.3,0.01,1,2,3,4,5,6\n", "0.1, -0.2 ,0.3,\t0.01, 1,2,3, 4,5,6", "0.1;-0.2;0.3;0.01;1;2;3;4;5;6\r\n",
        "0.1 -0.2 0.3 0.01 1 2 3 4 5 6\r", "  0.1\t-0.2\t0.3\t0.01\t1\t2\t3\t4\t5\t6 \n",
        "0.1   -0.2 \t 0.3  0.01 1 2 3 4 5 6", "\xEF\xBB\xBF+0.1,-0.2,3e-1,1E-2,1.,+2,3e0,4,5,6 # a comment, with 7\n",
        "\n# x, y, z, r [mm]\r\n\r\n0.1,-0.2,0.3,0.01,1,2,3,4,5,6\r\n",
        "x,y,z,r,vx,vy,vz,wx,wy,wz\n0.1,-0.2,0.3,0.01,1,2,3,4,5,6\n", withUnits,
        "x [m] y [m] z (m) r[m] vx vy vz wx wy wz\n0.1 -0.2 0.3 0.01 1 2 3 4 5 6\n",
        "\"x\";\"y\";\"z\";\"r\";\"vx\";\"vy\";\"vz\";\"wx\";\"wy\";\"wz\"\n0.1;-0.2;0.3;0.01;1;2;3;4;5;6"}) {
    std::vector<Grain> all;
    ASSERT_NO_THROW(all = read(text)) << text;
    ASSERT_EQ(all.size(), 1u) << text;
    EXPECT_EQ(all[0], kMoving) << text;
  }
}

TEST_F(GrainFile, AllLinesHaveOneWidth) {
  EXPECT_EQ(read("0,0,0,0.1\r1,0,0,0.1\r\n").at(1).velocity, (base::Vec3d{0, 0, -1})) << "the scene's velocity";
  EXPECT_EQ(read("0,0,0,0.1,4,5,6\n1 0 0 0.1 1 2 3\n").at(1).velocity, (base::Vec3d{1, 2, 3}));
  EXPECT_EQ(read("2 0 0 0.1 1 2 3 4 5 6\n").at(0).spin, (base::Vec3d{4, 5, 6}));
  // A line truncated by three numbers would get the scene's velocity.
  for (const char* text : {"0,0,0,0.1\n1,0,0,0.1,1,2,3\n", "0,0,0,0.1,1,2,3\n1,0,0,0.1\n"})
    EXPECT_NE(refusal(text).find("use the same number in all lines"), std::string::npos) << refusal(text);
}

TEST_F(GrainFile, EmptyFieldIsAnErrorAtItsColumnAndShiftsNothing) {
  // If skipped, the first would make a grain of seven numbers, and another a radius from the following text.
  const std::pair<const char*, const char*> empty[] = {{"0.1,0.2,0.3,0.01,,,,1,2,3", ":1:18: column 5 is empty"},
                                                       {"0.1,0.2,,0.3,0.02", ":1:9: column 3 is empty"},
                                                       {",0.1,0.2,0.3,0.01", ":1:1: column 1 is empty"},
                                                       {"0,0,0,0.1,", ":1:11: column 5 is empty"},
                                                       {"0,0,0,0.1 , ", ":1:12: column 5 is empty"},
                                                       {"0;0; ;0.1", ":1:5: column 3 is empty"},
                                                       {"0 0 0 0.1\n0,0,0,0.1,#1,2,3", ":2:11: column 5 is empty"},
                                                       {"0\t0\t0\t0.1\t\t\t\t1\t2\t3", ":1:11: column 5 is empty"},
                                                       {"0 0 0 0.1\t \t\t1 2 3", ":1:12: column 5 is empty"},
                                                       {"\t\t\t0 0 0 0.1", ":1:2: column 1 is empty"},
                                                       {"x,y,,r\n0,0,0,1", ":1:5: column 3 is empty"}};
  for (const auto& [text, place] : empty)
    EXPECT_NE(refusal(text).find(file() + place), std::string::npos) << refusal(text);
}

TEST_F(GrainFile, WhatIsNoNumberIsAnErrorAtItsPlace) {
  const std::pair<const char*, const char*> wrong[] = {
      {"0,0,nan,0.1", ":1:5: column 3, z = nan [m] is not finite"},
      {"inf 0 0 0.1", ":1:1: column 1, x = inf [m] is not finite"},
      {"0,0,0,-0.1", ":1:7: column 4, r = -0.1 [m] is outside (0, 1000]"},
      {"0,0,0,0", ":1:7: column 4, r = 0 [m] is outside (0, 1000]"},
      {"0,0,0,1e4", ":1:7: column 4, r = 1e4 [m] is outside (0, 1000]"},
      {"0,0,0,1e400", ":1:7: column 4, r = 1e400 [m] is outside the range"},
      {"0,0,0,1e-400", ":1:7: column 4, r = 1e-400 [m] is outside the range"},
      {"0,0,0,0.1,2e4,0,0", ":1:11: column 5, vx = 2e4 [m/s] is outside [-10000, 10000]"},
      {"0,0,0,0.1,0,0,0,0,0,-2e6", "column 10, wz = -2e6 [rad/s] is outside [-1e+06, 1e+06]"},
      {"0,1 0,2 0,3 0,01", ":1:3: column 2, y = 1 0 [m] is not a number; write decimals with a point"},
      {"1,5;2;3", ":1:4: line contains both commas and semicolons"},
      {"1;2,5;3", ":1:4: line contains both commas and semicolons"},
      {"0.1 0.2, 0.3, 0.01", ":1:1: column 1, x = 0.1 0.2 [m] is not a number"},
      {"1d-3 0 0 0.1", "x = 1d-3 [m] is not a number"},
      {"0x10,0,0,0.1", "x = 0x10 [m] is not a number"},
      {"+-1,0,0,0.1", "x = +-1 [m] is not a number"},
      {"0,0,0,+", "r = + [m] is not a number"},
      {"0,0,0,0.1 m", "r = 0.1 m [m] is not a number"},
      {"0,0,0,\"0.1\"", "r = \"0.1\" [m] is in quotes; remove them"},
      {"\"0\",\"0\",\"0\",\"0.1\"", ":1:1: column 1, x = \"0\" [m] is in quotes; remove them"},
      {"0,0,0", ":1:1: line has 3 numbers; expected x, y, z, r [m]"},
      {"0,0,0,0.1,1", ":1:1: line has 5 numbers"},
      {"0,0,0,0.1,1,2,3,4,5,6,7", ":1:1: line has 11 numbers"},
      {"# only a comment\n\n", ": contains no grains"},
      {"", ": contains no grains"}};
  for (const auto& [text, place] : wrong) EXPECT_NE(refusal(text).find(place), std::string::npos) << refusal(text);
}

TEST_F(GrainFile, HeaderIsCheckedForNamesUnitsAndItsNumberOfColumns) {
  const std::pair<const char*, const char*> wrong[] = {
      {"x [m],y [m],z [m],r [mm]\n0,0,0,10\n", ":1:19: column 4 of the header has unit [mm], expected [m]; convert"},
      {"x,y,z,diameter\n0,0,0,1\n", ":1:7: column 4 of the header is \"diameter\", expected \"r [m]\""},
      {"x,y,r,z\n0,0,1,0\n", ":1:5: column 3 of the header is \"r\""},
      {"r,x,y,z\n1,0,0,0\n", ":1:1: column 1 of the header is \"r\""},
      {"x [cm] y z r\n0 0 0 1\n", "column 1 of the header has unit [cm]"},
      {"x,y,z\n0,0,0,1\n", ":1:1: the header has 3 columns"},
      {"x,y,z,r,vx,vy,vz,wx,wy,wz,id\n", "column 11 of the header is \"id\""},
      {"x,y,z,r,vx,vy,vz\n0,0,0,0.1\n", ":2:1: line has 4 numbers, but the header has 7 columns"},
      {"x,y,z,r\nx,y,z,r\n0,0,0,0.1\n", ":2:1: column 1, x = x [m] is not a number"},
      {"0,0,0,0.1\nx,y,z,r\n", ":2:1: column 1, x = x [m] is not a number"},
      {"x,y,z,r\n", ": contains no grains"}};
  for (const auto& [text, place] : wrong) EXPECT_NE(refusal(text).find(place), std::string::npos) << refusal(text);
}

TEST_F(GrainFile, WhatIsNoTextIsRefused) {
  for (const std::string& text : {std::string("\xFF\xFE"
                                              "0\0,\0",
                                              6),
                                  std::string("\xFE\xFF\0"
                                              "0",
                                              4),
                                  std::string("0,0,0\0,1", 8)})
    EXPECT_NE(refusal(text).find("not plain text"), std::string::npos) << refusal(text);
  EXPECT_THROW(readGrainFile(folder_.string(), {}), base::InputError) << "a folder";
  EXPECT_THROW(readGrainFile(file() + "x", {}), base::InputError) << "nothing";
}

} // namespace
} // namespace grouser::scene
