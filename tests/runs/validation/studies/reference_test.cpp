// SPDX-License-Identifier: BSD-3-Clause
// The script that pushes a plate in grouser and in LIGGGHTS, with a substitute for the latter.
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

#include <string>

namespace grouser::studies {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

class PlateReference : public ProgramTest {
protected:
  Outcome script(const std::string& words) const {
    return shell("/usr/bin/python3 " GROUSER_SOURCE_DIR
                 "/runs/validation/studies/reference/plate.py --grouser \"$grouser\" --out "
                 "results --seeds 2 --bin 6 --deep 3 --plate 3 --sinkage 0.3 --speed 0.3 --steps 10 " +
                 words);
  }
};

TEST_F(PlateReference, ComparesWhatBothProgramsHaveMeasured) {
  if (shell("/usr/bin/python3 -c 'import numpy, h5py'").code != 0)
    GTEST_SKIP() << "install python3-numpy, python3-h5py";
  const Outcome ours = script("--jobs 2 --only grouser");
  ASSERT_EQ(ours.code, 0) << ours.errors;
  const fs::path first = folder_ / "results" / "seed1";
  const std::string bed = contents(first / "bed.txt"), pushed = contents(first / "grouser.csv");
  EXPECT_GT(bed.size(), 1000u);
  EXPECT_FALSE(fs::exists(first / "liggghts.csv"));

  // A substitute that reads its script and returns forces larger than grouser's by a tenth.
  put(folder_ / "stand-in", "#!/bin/sh\nset -e\ngrep -q 'hooke/stiffness' in.plate\ngrep -q '^facet' plate.stl\n"
                            "grep -q 'atoms' bed.data\n"
                            "awk -F, '!/#/ { print NR, $1, 1.1 * $2 }' grouser.csv > liggghts.txt\n");
  fs::permissions(folder_ / "stand-in", fs::perms::owner_all);
  const Outcome both = script("--liggghts \"$PWD/stand-in\"");
  ASSERT_EQ(both.code, 0) << both.out << both.errors;
  // Results of grouser are kept.
  EXPECT_EQ(contents(first / "bed.txt"), bed);
  EXPECT_EQ(contents(first / "grouser.csv"), pushed);
  EXPECT_NE(both.out.find("force in LIGGGHTS / grouser 1.1000"), std::string::npos) << both.out;
  EXPECT_TRUE(fs::exists(folder_ / "results" / "plate_reference.csv"));
  // A mean difference of a tenth over two seeds with equal scatter: no agreement.
  EXPECT_EQ(both.out.find("equal"), std::string::npos) << both.out;

  const Outcome none = script("--liggghts no_such_program --seeds 3 --only grouser");
  EXPECT_EQ(none.code, 0) << "grouser's part does not require it\n" << none.errors;
}

} // namespace
} // namespace grouser::studies
