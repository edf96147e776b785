// SPDX-License-Identifier: BSD-3-Clause
// Mistakes with `mpirun` and failures of the machine: the run ends within a minute, with one message.
#include "tests/runs/ranks_fixture.hpp"

#include <gtest/gtest.h>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

/// A launcher that runs for a minute has hung: its code is then 124.
constexpr const char* kLaunch = "timeout 60 mpirun -np 1 ";

TEST_F(OnRanks, RanksStartedInDifferentFoldersAreRefusedAndLeaveNothing) {
  for (const char* place : {"a", "b"}) {
    fs::create_directory(folder_ / place);
    put(folder_ / place / "bed.toml", kBed);
  }
  const Outcome o = shell(kLaunch + std::string("-wdir \"$PWD/a\" \"$grouser\" run bed.toml --steps 10 --out o : "
                                                "-np 1 -wdir \"$PWD/b\" \"$grouser\" run bed.toml --steps 10 --out o"));
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.errors.find("rank 0: o: rank 1 cannot access this folder of rank 0"), std::string::npos) << o.errors;
  EXPECT_FALSE(fs::exists(folder_ / "a/o"));
  EXPECT_FALSE(fs::exists(folder_ / "b/o"));
}

TEST_F(OnRanks, RanksToldToDoDifferentThingsAreRefused) {
  const Outcome o = shell(kLaunch + std::string("\"$grouser\" run bed.toml --out o --steps 10 : -np 1 \"$grouser\" run "
                                                "bed.toml --out o --steps 20"));
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.errors.find("rank 1 has a different command line from rank 0"), std::string::npos) << o.errors;
  EXPECT_FALSE(fs::exists(folder_ / "o"));
}

TEST_F(OnRanks, BenchesToldToDoDifferentThingsAreRefused) {
  const std::string bed = "\"$grouser\" bench bed --threads 1 --batches 1 --settle 0 --hash --grains ";
  const Outcome grains = shell(kLaunch + bed + "100 --steps 10 : -np 1 " + bed + "200 --steps 10"),
                steps = shell(kLaunch + bed + "100 --steps 10 : -np 1 " + bed + "100 --steps 20"),
                friction = shell(kLaunch + bed + "100 --steps 10 : -np 1 " + bed + "100 --steps 10 --friction 0");
  for (const Outcome* o : {&grains, &steps, &friction}) {
    EXPECT_EQ(o->code, 2);
    EXPECT_NE(o->errors.find("bench bed: rank 1 has a different command line from rank 0"), std::string::npos)
        << o->errors;
    EXPECT_EQ(o->out.find("state-hash"), std::string::npos);
  }
  EXPECT_EQ(shell(kLaunch + bed + "100 --steps 10 : -np 1 " + bed + "100 --steps 10").code, 0);
}

TEST_F(OnRanks, TheFirstRankSaysWhereBedsAreKept) {
  const std::string words = " \"$grouser\" run bed.toml --steps 50 --hash --set terrain.settle_time_limit=5 "
                            "--set terrain.settle_kinetic_energy=0.05 --out ",
                    expected = run(1, words.substr(12) + "anew").hash();
  const auto twice = [&](const std::string& second, const std::string& out) {
    return shell(kLaunch + ("-x GROUSER_CACHE=\"$PWD/beds\"" + words + out + " : -np 1 " + second + words + out));
  };
  EXPECT_EQ(twice("-x GROUSER_CACHE=", "none").hash(), expected) << "one rank alone had no folder";
  EXPECT_EQ(twice("-x GROUSER_CACHE=\"$PWD/beds\" -x GROUSER_CACHE_GIB=0", "limit").hash(), expected);
}

TEST_F(OnRanks, SweepsAndStudiesAreRefused) {
  const Outcome sweep = run(2, "sweep bed.toml --set run.seed=1,2 --out sweep"),
                study = run(2, "study impact --quick --out study");
  for (const Outcome* o : {&sweep, &study}) {
    EXPECT_EQ(o->code, 2);
    EXPECT_NE(o->errors.find("does not support MPI (2 ranks); start it without mpirun"), std::string::npos)
        << o->errors;
  }
  EXPECT_FALSE(fs::exists(folder_ / "sweep"));
  EXPECT_FALSE(fs::exists(folder_ / "study"));
}

TEST_F(OnRanks, CutsThatMakeNoLatticeAreNamedWithTheirLine) {
  put(folder_ / "cut.toml", std::string(kBed) + "[parallel]\ncuts_x = [0.3, 0.6]\n");
  const Outcome o = run(2, "run cut.toml --out o");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.errors.find("cut.toml:25: parallel.cuts_x = [0.3, 0.6] [m] results in 3 subdomains along x"),
            std::string::npos)
      << o.errors;
  EXPECT_NE(run(1, "plan cut.toml --ranks 6").out.find("3 x 2 x 1"), std::string::npos) << "the plan matches the run";
  EXPECT_EQ(run(1, "plan cut.toml --ranks 4").code, 2);
}

TEST_F(OnRanks, CutsWhereNoGrainCanBeLeaveRanksEmptyAndStandAtTheEndOfAllPlaces) {
  const std::string words = "run bed.toml --steps 50 --hash ", expected = run(1, words + "--out one").hash();
  const Outcome o = run(3, words + "--out far --set 'parallel.cuts_y=[1e30, 1e31]' --set parallel.rebalance=false");
  EXPECT_EQ(o.hash(), expected) << o.errors;
  const Outcome ends = shell(R"(/usr/bin/python3 -c "
import h5py
y = h5py.File('far/frames.h5')['000000/partition/y'][:]
assert (y > 10).all() and (y < 1e6).all(), y
")");
  EXPECT_EQ(ends.code, 0) << ends.errors;
}

TEST_F(OnRanks, MoreRanksThanALatticeHoldsSayHowMany) {
  const Outcome o = run(1, "plan bed.toml --ranks 67");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.errors.find("67 ranks cannot be arranged in a lattice with at most 64 subdomains along each axis"),
            std::string::npos)
      << o.errors;
}

TEST_F(OnRanks, AFolderBelongsToOneRunAtATime) {
  const Outcome o = shell(R"(
"$grouser" run bed.toml --out o --set run.duration=1000 --set run.checkpoint_interval=0.02 >first.txt &
first=$!
for i in $(seq 600); do [ -e o/checkpoint.h5 ] && break; sleep 0.05; done
"$grouser" run bed.toml --out o --resume; code=$?
"$grouser" run bed.toml --out o --force --steps 1; echo "code $code $?"
kill $first; wait $first)");
  EXPECT_NE(o.out.find("code 2 2\n"), std::string::npos) << o.out << o.errors;
  EXPECT_NE(o.errors.find("o: in use by process"), std::string::npos) << o.errors;
  EXPECT_EQ(run(1, "hash o/checkpoint.h5").code, 0);
  EXPECT_EQ(run(1, "run bed.toml --out nowhere --resume").code, 2);
  EXPECT_FALSE(fs::exists(folder_ / "nowhere")) << "the lock must not create the folder";
}

TEST_F(OnRanks, WithoutMemoryTheRunIsRefusedAndSaysWhatToDo) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the sanitizer reserves all addresses";
#endif
  // 1.3 million grains need 460 MB, and as much again during initial placement.
  const Outcome o = shell("ulimit -v 500000; \"$grouser\" run bed.toml --out o --threads 1 --steps 1 "
                          "--set terrain.grain_radius=0.002 --set terrain.layers=24 --set 'run.time_step=\"auto\"'");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.errors.find("exceeds the resources of this machine"), std::string::npos) << o.errors;
  EXPECT_NE(o.errors.find("use fewer or larger grains"), std::string::npos) << o.errors;
  EXPECT_FALSE(fs::exists(folder_ / "o"));
}

} // namespace
} // namespace grouser::commands
