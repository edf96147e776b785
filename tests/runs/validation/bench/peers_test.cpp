// SPDX-License-Identifier: BSD-3-Clause
// The script that compares the speed of grouser, LIGGGHTS and LAMMPS on one core, with a substitute for the latter two,
// and the bed files it exchanges.
#include "runs/validation/bench/bench.hpp"

#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace grouser::bench {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

class Peers : public ProgramTest {
protected:
  bool missing() const { return shell("/usr/bin/python3 -c 'import numpy, h5py'").code != 0; }
  /// A program that checks its input, works for as many steps, and returns grouser's final state, raised by `higher`
  /// [m].
  void putStandIn(const std::string& higher) const {
    put(folder_ / "stand-in",
        "#!/bin/sh\nset -e\n"
        "if [ \"$1\" = -h ]; then echo 'Large-scale Simulator - a stand-in'; exit; fi\n"
        "grep -q '^320 atoms' bed.data\ngrep -q '^pair_style gran' in.bed\ngrep -q '^timestep 5e-05' in.bed\n"
        "awk '$1 == \"run\" { for (i = 0; i < 1000 * $2; ++i) x += i }' in.bed\n"
        "grep -q '^write_dump' in.bed || exit 0\n"
        "{ echo ITEM: ATOMS id x y z radius vx vy vz omegax omegay omegaz\n"
        "awk '!/#/ { $3 += " +
            higher + "; print NR, $0 }' ../grouser/end.txt; } > end.dump\n");
    fs::permissions(folder_ / "stand-in", fs::perms::owner_all);
  }
  Outcome script(const std::string& words = "--liggghts \"$PWD/stand-in\" --lammps \"$PWD/stand-in\"") const {
    return shell("/usr/bin/python3 " GROUSER_SOURCE_DIR "/tests/peers --grouser \"$grouser\" --quick --out results " +
                 words);
  }
};

TEST_F(Peers, ScriptHandsOneStateAndOneLawToAllAndTimesThem) {
  if (missing()) GTEST_SKIP() << "install python3-numpy, python3-h5py";
  putStandIn("0");
  const Outcome all = script();
  ASSERT_EQ(all.code, 0) << all.out << all.errors;
  const std::string table = contents(folder_ / "results" / "peers.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + 2 * 4) << "two passes of four\n" << table;
  EXPECT_NE(all.out.find("LAMMPS a stand-in"), std::string::npos) << all.out;

  // gamma = 2 zeta sqrt(k / m_eff) of the bed's restitution of 0.5, and its root of one half for walls, to float
  // precision; 2/7 and 1/2 of them tangentially.
  const std::string lammps = contents(folder_ / "results" / "lammps" / "in.bed"),
                    liggghts = contents(folder_ / "results" / "liggghts" / "in.bed");
  const auto numbersAfter = [](const std::string& text, const std::string& word, int count) {
    std::istringstream from(text.substr(text.find(word) + word.size()));
    std::vector<double> numbers(static_cast<std::size_t>(count));
    for (double& number : numbers) from >> number;
    return numbers;
  };
  const std::vector<double> law = numbersAfter(lammps, "pair_style gran/hooke/history", 5);
  EXPECT_EQ(law[0], 1e6);
  EXPECT_NEAR(law[1], 2e6 / 7, 0.1);
  EXPECT_NEAR(law[3], 0.5 * law[2], 1e-6 * law[2]);
  EXPECT_EQ(law[4], 0.5);
  const std::vector<double> wall = numbersAfter(lammps, "wall/gran hooke/history", 4);
  EXPECT_NEAR(wall[2], law[2] / std::sqrt(2.0), 1e-6 * law[2]);
  const std::vector<double> theirs = numbersAfter(liggghts, "gamman peratomtypepair 2", 4);
  EXPECT_EQ(theirs[0], law[2]);
  EXPECT_EQ(theirs[1], wall[2]);
}

TEST_F(Peers, ScriptTellsOfAnotherBedAtTheEnd) {
  if (missing()) GTEST_SKIP() << "install python3-numpy, python3-h5py";
  putStandIn("0.001");
  const Outcome other = script();
  EXPECT_EQ(other.code, 1) << other.out << other.errors;
  EXPECT_NE(other.errors.find("LIGGGHTS, LAMMPS"), std::string::npos) << other.errors;
}

TEST_F(Peers, ScriptNamesThePackageOfAMissingProgram) {
  if (missing()) GTEST_SKIP() << "install python3-numpy, python3-h5py";
  putStandIn("0");
  const Outcome none = script("--liggghts \"$PWD/stand-in\" --lammps no_such_program");
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.errors.find("apt-get install lammps"), std::string::npos) << none.errors;
  EXPECT_FALSE(fs::exists(folder_ / "results"));
}

TEST_F(Peers, BedFileHoldsTheStateThatABenchBeginsWith) {
  const std::string bench = "\"$grouser\" bench bed --grains 320 --threads 1 --batches 1 --steps 1 ";
  ASSERT_EQ(shell(bench + "--settle 0.05 --save bed.txt").code, 0);
  const std::string bed = contents(folder_ / "bed.txt");
  EXPECT_EQ(std::count(bed.begin(), bed.end(), '\n'), 321) << "one line per grain, and a header";
  // The motion continues from there: 26 steps later the displacement of grains is within their speed.
  ASSERT_EQ(shell(bench + "--settle 0 --start bed.txt --save later.txt").code, 0);
  const std::string later = contents(folder_ / "later.txt");
  EXPECT_NE(later, bed);
  std::istringstream before(bed.substr(bed.find('\n'))), after(later.substr(later.find('\n')));
  const double seconds = 26 * 5e-5;
  for (int g = 0; g < 320; ++g) {
    double a[10], b[10];
    for (double& value : a) before >> value;
    for (double& value : b) after >> value;
    // Speeds change by at most 1 m/s in this time: the fall is at most from the lattice, sqrt(2 g 0.05 m).
    for (int k = 0; k < 3; ++k) EXPECT_LT(std::fabs(b[k] - a[k]), (std::fabs(a[4 + k]) + 1) * seconds) << "grain " << g;
  }
  const Outcome fewer = shell("\"$grouser\" bench bed --grains 300 --threads 1 --start bed.txt");
  EXPECT_EQ(fewer.code, 2);
  const Outcome larger = shell(bench + "--radius 0.03 --start bed.txt");
  EXPECT_EQ(larger.code, 2);
  EXPECT_NE(larger.errors.find("radius 0.027 m"), std::string::npos) << larger.errors;
}

} // namespace
} // namespace grouser::bench
