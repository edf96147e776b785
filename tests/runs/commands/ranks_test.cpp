// SPDX-License-Identifier: BSD-3-Clause
// `mpirun -np N grouser run`: the same bits on any number of ranks, and one clear end when something breaks.
#include "tests/runs/ranks_fixture.hpp"
#include "tests/runs/shared_cache.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>
#include <tuple>
#include <vector>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

/// The last number of a column of a CSV file.
double lastOf(const std::string& csv, const std::string& column) {
  const auto cells = [](const std::string& line) {
    std::vector<std::string> out;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) out.push_back(cell);
    return out;
  };
  const std::vector<std::string> header = cells(csv.substr(0, csv.find('\n')));
  const std::vector<std::string> last = cells(csv.substr(csv.rfind('\n', csv.size() - 2) + 1));
  for (std::size_t i = 0; i < header.size() && i < last.size(); ++i)
    if (header[i] == column) return std::stod(last[i]);
  ADD_FAILURE() << "no column " << column;
  return 0;
}

TEST_F(OnRanks, PeriodicBoundariesMovingSurfacesSourcesAndRigsGiveTheBitsOfOneRank) {
  for (const char* scene : {"chute", "moving", "rain", "rigs", "soil_bodies"}) {
    const std::string words = "run '" GROUSER_SOURCE_DIR "/tests/scenes/" + std::string(scene) +
                              ".toml' --steps 2500 --hash --force --set output.frames=false --set output.picture=false "
                              "--set output.plots=false --out " +
                              scene;
    const std::string one = run(1, words).hash();
    EXPECT_EQ(one.find("state-hash"), 0u) << one;
    for (const int ranks : {2, 3}) EXPECT_EQ(run(ranks, words).hash(), one) << scene << " on " << ranks;
  }
}

TEST_F(OnRanks, VehicleDrivesAcrossBordersWithTheBitsOfOneRank) {
  // One rank settles the bed once; from 0.07 s the vehicle is down on the bed, which adheres to it.
  const auto drive = [this](int ranks, const std::string& words) {
    return shell("export GROUSER_CACHE=\"$PWD/beds\"; " +
                 (ranks > 1 ? "mpirun -np " + std::to_string(ranks) + " " : std::string()) + "\"$grouser\" run '" +
                 GROUSER_SOURCE_DIR +
                 "/tests/scenes/coupled.toml' --set vehicle.sphere_radius=0.03 --set vehicle.clearance=0 "
                 "--set material.soil.cohesion=20 --set material.soil.adhesion_radius=0.03 --set vehicle.adhesion=0.5 "
                 "--set run.checkpoint_interval=0 --steps 1000 --hash --threads 1 " +
                 words);
  };
  const Outcome one = drive(1, "--out one");
  const std::string expected = one.hash();
  EXPECT_EQ(expected.substr(0, 11), "state-hash ");
  EXPECT_NE(one.out.find("spheres   5 meshes converted to spheres in "), std::string::npos) << one.out;
  // Two ranks find no sets, share the conversion, and leave the sets for three ranks.
  EXPECT_EQ(shell("rm beds/spheres-*.bin").code, 0);
  const Outcome two = drive(2, "--out two --set 'parallel.subdomains=[2,1,1]'");
  EXPECT_EQ(two.hash(), expected);
  EXPECT_NE(two.out.find("spheres   5 meshes converted to spheres in "), std::string::npos) << two.out;
  const Outcome three = drive(3, "--out three --set 'parallel.subdomains=[1,3,1]' --set parallel.rebalance=false");
  EXPECT_EQ(three.hash(), expected);
  EXPECT_NE(three.out.find("spheres   5 sphere sets read from "), std::string::npos) << three.out;
  const std::string series = contents(folder_ / "one/timeseries.csv");
  EXPECT_EQ(series, contents(folder_ / "two/timeseries.csv"));
  EXPECT_NE(lastOf(series, "vehicle.drawbar_pull [N]"), 0) << "the vehicle does not touch the bed";
}

TEST_F(OnRanks, VehicleOnDeformableSoilHasTheBitsOfOneRankAndThread) {
  const std::string words = "run '" GROUSER_SOURCE_DIR "/runs/scenes/scm_drive.toml' --steps 700 --hash "
                            "--set output.frames=false --set output.picture=false --set output.plots=false ";
  const std::string one = run(1, words + "--threads 1 --out one", withSharedCache()).hash();
  EXPECT_EQ(one.find("state-hash"), 0u) << one;
  EXPECT_EQ(run(1, words + "--threads 2 --out threads", withSharedCache()).hash(), one);
  EXPECT_EQ(run(2, words + "--threads 1 --out ranks", withSharedCache()).hash(), one);
}

TEST_F(OnRanks, SurfacesAndMeshesMoveAndMeasureAsOnOneRank) {
  std::ofstream(folder_ / "wedge.obj") << "v 0 -0.2 0\nv 0.3 -0.2 0\nv 0.3 -0.2 0.1\nv 0 0.2 0\nv 0.3 0.2 0\n"
                                          "v 0.3 0.2 0.1\nf 1 2 3\nf 4 6 5\nf 1 4 5\nf 1 5 2\nf 2 5 6\nf 2 6 3\n"
                                          "f 1 3 6\nf 1 6 4\n";
  std::ofstream(folder_ / "moved.toml") << R"(version = 1
[run]
duration = 0.12
time_step = 1e-4
output_interval = 0.01
checkpoint_interval = 0.1
[material.soil]
stiffness = 1e5
[[grains]]
low = [-0.3, -0.2, 0.105]
high = [0.3, 0.2, 0.23]
radius = 0.02
jitter = 0.9
velocity = [0.3, 0, 0]
material = "soil"
[[plane]]
name = "belt"
velocity = [-0.5, 0, 0]
material = "soil"
[[box]]
position = [-0.35, 0, 0.1]
size = [0.02, 0.4, 0.2]
spin = [0, 1.5, 0]
material = "soil"
[[box]]
name = "lid"
position = [0, 0, 0.25]
size = [0.6, 0.4, 0.02]
free = "z"
mass = 3
load = -20
material = "soil"
[[mesh]]
file = "wedge.obj"
velocity = [-0.3, 0, 0]
sphere_radius = 0.01
material = "soil"
[output]
picture = false
plots = false
)";
  const Outcome one = run(1, "run moved.toml --hash --out one");
  EXPECT_EQ(one.hash().substr(0, 11), "state-hash ") << one.errors;
  EXPECT_EQ(run(2, "run moved.toml --hash --out two").hash(), one.hash());
  EXPECT_EQ(run(3, "run moved.toml --hash --steps 650 --out three").code, 0);
  EXPECT_EQ(run(2, "run moved.toml --hash --resume --out three").hash(), one.hash());
  EXPECT_EQ(contents(folder_ / "one/timeseries.csv"), contents(folder_ / "two/timeseries.csv"));
  EXPECT_EQ(contents(folder_ / "one/timeseries.csv"), contents(folder_ / "three/timeseries.csv"));
  const Outcome drawn = shell(R"(/usr/bin/python3 -c "
import h5py
f = h5py.File('two/frames.h5')
names = [n.decode() if isinstance(n, bytes) else n for n in f['parts/part'].attrs['names']]
assert names == ['belt', 'box0', 'lid', 'mesh0'], names
a, b = f['000000/parts/position'][:], f['000001/parts/position'][:]
assert abs((b - a)[-1, 0] + 0.3 * 0.1) < 1e-6, 'the mesh has moved with its velocity'
")");
  EXPECT_EQ(drawn.code, 0) << drawn.errors;
}

TEST_F(OnRanks, BedKeptByTwoRanksServesThreeAndOne) {
  const std::string words = "run bed.toml --steps 200 --hash --set terrain.settle_time_limit=5 "
                            "--set terrain.settle_kinetic_energy=0.05 ",
                    kept = "export GROUSER_CACHE=\"$PWD/beds\"; ";
  const Outcome anew = run(1, words + "--no-cache --out anew");
  EXPECT_EQ(anew.hash().substr(0, 11), "state-hash ") << anew.errors;
  EXPECT_EQ(anew.out.find("\nbed "), std::string::npos) << anew.out;
  const Outcome two = shell(kept + "mpirun -np 2 \"$grouser\" " + words + "--out two");
  EXPECT_NE(two.out.find("bed       settled in "), std::string::npos) << two.out << two.errors;
  const Outcome three = shell(kept + "mpirun -np 3 \"$grouser\" " + words + "--out three"),
                one = shell(kept + "\"$grouser\" " + words + "--out one");
  for (const Outcome& o : {two, three, one}) EXPECT_EQ(o.hash(), anew.hash());
  for (const Outcome& o : {three, one}) EXPECT_NE(o.out.find("bed       read from "), std::string::npos) << o.out;
  std::ofstream(folder_ / "damage.sh")
      << "for f in beds/*.h5; do printf x | dd of=$f bs=1 seek=2000 conv=notrunc; done";
  const Outcome damaged = shell(kept + "sh damage.sh; mpirun -np 2 \"$grouser\" " + words + "--out damaged");
  EXPECT_EQ(damaged.hash(), anew.hash());
  EXPECT_NE(damaged.errors.find("damaged"), std::string::npos) << damaged.errors;
}

TEST_F(OnRanks, CheckpointOfTwoRanksResumesOnThreeAndOnOne) {
  const Outcome straight = run(1, "run bed.toml --hash --out straight");
  ASSERT_EQ(straight.code, 0) << straight.errors;
  ASSERT_EQ(run(2, "run bed.toml --hash --steps 600 --out stopped").code, 0);
  fs::copy(folder_ / "stopped", folder_ / "again");
  EXPECT_EQ(run(3, "run bed.toml --hash --resume --out stopped").hash(), straight.hash());
  EXPECT_EQ(run(1, "run bed.toml --hash --resume --out again").hash(), straight.hash());
  // File contents do not depend on the number of ranks.
  EXPECT_EQ(run(1, "hash stopped/checkpoint.h5").hash(), run(1, "hash straight/checkpoint.h5").hash());
  for (const char* file : {"timeseries.csv", "frames.xdmf"})
    EXPECT_EQ(contents(folder_ / "stopped" / file), contents(folder_ / "straight" / file)) << file;
}

TEST_F(OnRanks, FramesHoldTheSameNumbers) {
  ASSERT_EQ(run(1, "run bed.toml --steps 500 --out one").code, 0);
  ASSERT_EQ(run(3, "run bed.toml --steps 500 --out three").code, 0);
  const Outcome same = shell(R"(/usr/bin/python3 -c "
import h5py
a, b = h5py.File('one/frames.h5'), h5py.File('three/frames.h5')
assert len(b['000001/partition']) >= 1 and 'partition' not in a['000001']
for frame in ('000000', '000001'):
    for name in ('position', 'radius', 'speed', 'id'):
        assert (a[frame]['grains'][name][:] == b[frame]['grains'][name][:]).all(), name
assert list(a['vertices']) == list(b['vertices']) and len(a['vertices']) == 1
")");
  EXPECT_EQ(same.code, 0) << same.errors;
}

TEST_F(OnRanks, FramesOfAResumedRunAreAllThatTheStraightOneHasAndNoMore) {
  // Grains enter between the frames: the last frame of the stopped run has a unique number of grains.
  put(folder_ / "drip.toml", R"(version = 1
[run]
duration = 0.09
time_step = 1e-4
frame_interval = 0.03
[material.glass]
stiffness = 1e5
[[source]]
low = [-0.2, -0.1, 1.0]
high = [0.2, 0.1, 1.1]
radius = 0.02
velocity = [0, 0, -5]
material = "glass"
number = 2
every = 0.01
start = 0.035
total = 12
[output]
picture = false
plots = false
)");
  for (const int ranks : {1, 2}) {
    const std::string at = " --out of" + std::to_string(ranks);
    ASSERT_EQ(run(ranks, "run drip.toml" + at + "straight").code, 0);
    for (const char* stop : {" --steps 200", " --resume --steps 500", " --resume"}) {
      const Outcome o = run(ranks, "run drip.toml" + at + "stopped" + stop);
      ASSERT_EQ(o.code, 0) << o.errors;
    }
    const Outcome same = shell("/usr/bin/python3 -c \"\nimport h5py\ndef content(name):\n"
                               "  found = {}\n"
                               "  def take(path, it):\n"
                               "    found[path] = it[:].tolist() if isinstance(it, h5py.Dataset) else dict(it.attrs)\n"
                               "  h5py.File(name + '/frames.h5').visititems(take)\n"
                               "  return {p: v for p, v in found.items() if 'partition' not in p}\n"
                               "a, b = [content('of" +
                               std::to_string(ranks) +
                               "' + how) for how in ('straight', 'stopped')]\n"
                               "assert len(a['vertices/12']) == 12\n"
                               "assert a == b, set(a) ^ set(b)\n\"");
    EXPECT_EQ(same.code, 0) << ranks << " ranks: " << same.errors;
  }
}

/// Grains on a plane, with soil fields in the frames.
constexpr const char* kFields = R"(version = 1
[run]
duration = 0.02
frame_interval = 0.005
[material.a]
stiffness = 1e5
[[plane]]
material = "a"
[[grains]]
low = [-0.04, -0.04, 0.001]
high = [0.04, 0.04, 0.02]
radius = 0.005
jitter = 0.5
material = "a"
[output]
plots = false
picture = false
fields_cell = 0.02
)";

TEST_F(OnRanks, AResumedRunKeepsTheGridOfItsFieldsOnEveryRank) {
  // The first rank opens the frames for writing as soon as it knows the grid; two thirds of such runs failed while all
  // ranks read the file, so five runs show the fault with a probability of 99.6 %.
  put(folder_ / "fields.toml", kFields);
  ASSERT_EQ(run(3, "run fields.toml --out straight").code, 0);
  ASSERT_EQ(run(3, "run fields.toml --steps 100 --out stopped").code, 0);
  for (int k = 0; k < 5; ++k) {
    const std::string out = "again" + std::to_string(k);
    fs::copy(folder_ / "stopped", folder_ / out);
    const Outcome o = run(3, "run fields.toml --resume --out " + out);
    ASSERT_EQ(o.code, 0) << o.errors;
  }
  const Outcome same = shell(R"(/usr/bin/python3 -c "
import h5py
a, b = h5py.File('straight/frames.h5'), h5py.File('again0/frames.h5')
frames = [f for f in a if f.isdigit()]
assert len(frames) > 2 and frames == [f for f in b if f.isdigit()]
for f in frames:
    for name in a[f]['fields']:
        x, y = a[f]['fields'][name][:], b[f]['fields'][name][:]
        assert x.tobytes() == y.tobytes(), (f, name)
")");
  EXPECT_EQ(same.code, 0) << same.errors;
}

TEST_F(OnRanks, DamagedFramesEndAllRanksWithOneErrorAndForceGoesOnWithoutThem) {
  put(folder_ / "fields.toml", kFields);
  ASSERT_EQ(run(3, "run fields.toml --steps 100 --out stopped").code, 0);
  put(folder_ / "stopped/frames.h5", "no HDF5 file");
  const Outcome refused = run(3, "run fields.toml --resume --out stopped");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.error().find("does not contain the"), std::string::npos) << refused.errors;
  EXPECT_LT(refused.seconds, 30);
  const Outcome forced = run(3, "run fields.toml --resume --force --out stopped");
  EXPECT_EQ(forced.code, 0) << forced.errors;
  EXPECT_NE(forced.errors.find("WARNING: "), std::string::npos);
}

TEST_F(OnRanks, PlanForetellsLatticeAndGhosts) {
  const Outcome plan = run(1, "plan bed.toml --ranks 3 --set 'terrain.size=[1.5,1]'"),
                done = run(3, "run bed.toml --steps 1 --out three --set 'terrain.size=[1.5,1]'");
  std::smatch planned, found;
  ASSERT_TRUE(std::regex_search(plan.out, planned,
                                std::regex("subdomains +([0-9]+ x [0-9]+ x [0-9]+)[^]*total ghosts +([0-9.]+) %")))
      << plan.out;
  ASSERT_TRUE(
      std::regex_search(done.out, found, std::regex("subdomains ([0-9]+ x [0-9]+ x [0-9]+),.* ([0-9.]+) % ghosts")))
      << done.out;
  EXPECT_EQ(planned[1], found[1]);
  // The plan distributes grains evenly: plus or minus one layer near two cuts through 25 layers.
  EXPECT_NEAR(std::stod(planned[2]), std::stod(found[2]), 2 * 100.0 * 2 / 25);
}

TEST_F(OnRanks, BenchOfAStepIsSharedAndWrittenOnce) {
  const Outcome o = run(2, "bench step bed.toml --steps 10 --batches 1 --threads 1 --device cpu --json /dev/stderr");
  EXPECT_EQ(o.code, 0) << o.errors;
  const std::string title = "\"bench\": \"step\"";
  const std::size_t at = o.errors.find(title);
  ASSERT_NE(at, std::string::npos) << o.errors;
  EXPECT_EQ(o.errors.find(title, at + 1), std::string::npos) << o.errors;
  EXPECT_NE(o.errors.find("\"ranks\": 2"), std::string::npos) << "each rank created the whole scene:\n" << o.errors;
}

TEST_F(OnRanks, WaitingIsAShareOfTheDriveAlone) {
  // One rank draws the picture while the other waits; drawing takes longer than these steps.
  const Outcome o =
      run(2, "run bed.toml --out o --verbose --steps 20 --set output.picture=true --set output.picture_width=4000");
  std::smatch waited;
  ASSERT_TRUE(std::regex_search(o.out, waited, std::regex("MPI wait time ([0-9.]+) to ([0-9.]+) % of the run")))
      << o.out << o.errors;
  EXPECT_LE(std::stod(waited[2]), 100);
}

TEST_F(OnRanks, AWrongSceneIsRefusedOnceWithCodeTwo) {
  std::ofstream(folder_ / "wrong.toml") << std::regex_replace(std::string(kBed), std::regex("layers = 2"),
                                                              "layers = -2");
  const Outcome o = run(3, "run wrong.toml --out wrong");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.errors.find("rank 0: wrong.toml:"), std::string::npos) << o.errors;
  EXPECT_EQ(o.errors.find("rank 1: wrong.toml:"), std::string::npos) << o.errors;
  EXPECT_FALSE(fs::exists(folder_ / "wrong"));
  EXPECT_LT(o.seconds, 60);
}

TEST_F(OnRanks, AnImpossibleLatticeIsRefused) {
  const Outcome o = run(2, "run bed.toml --out wrong --set 'parallel.subdomains=[3,1,1]'");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.errors.find("parallel.subdomains = [3, 1, 1] does not result in 2 subdomains"), std::string::npos)
      << o.errors;
}

TEST_F(OnRanks, RanksWithOtherScenesAreRefusedByName) {
  std::ofstream(folder_ / "other.toml") << std::regex_replace(std::string(kBed), std::regex("1e5"), "2e5");
  const Outcome o = shell("mpirun -np 1 \"$grouser\" run bed.toml --out a : -np 1 \"$grouser\" run other.toml --out a");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.errors.find("rank 1 has a different scene from rank 0"), std::string::npos) << o.errors;
  EXPECT_LT(o.seconds, 60);
}

TEST_F(OnRanks, RanksThatAreToldOtherCommandsAreRefusedByName) {
  const std::string plan = "-np 1 \"$grouser\" plan bed.toml", go = "-np 1 \"$grouser\" run bed.toml --out a",
                    bench = "-np 1 \"$grouser\" bench bed --grains 1000";
  for (const auto& [first, other, message] :
       {std::tuple{plan, go, "rank 1 was started with \"run\", rank 0 with \"plan\""},
        {go, plan, "rank 1 was started with \"plan\", rank 0 with \"run\""},
        {bench, go, "rank 1 was started with \"run\", rank 0 with \"bench bed\""}}) {
    const Outcome o = shell("timeout 60 mpirun " + first + " : " + other);
    EXPECT_EQ(o.code, 2) << message;
    EXPECT_NE(o.errors.find(message), std::string::npos) << o.errors;
    EXPECT_FALSE(fs::exists(folder_ / "a"));
  }
}

TEST_F(OnRanks, AKilledRankEndsAllAndLeavesTheLastCheckpointWhole) {
  // A run far longer than the test: one rank is killed once a checkpoint exists.
  const Outcome o = shell(R"(
mpirun -np 2 "$grouser" run bed.toml --out killed --set run.duration=1000 --set run.checkpoint_interval=0.02 &
launcher=$!
for i in $(seq 600); do [ -e killed/checkpoint.h5 ] && break; sleep 0.1; done
kill -9 $(pgrep -P $launcher | tail -n 1)
wait $launcher)");
  EXPECT_NE(o.code, 0);
  EXPECT_LT(o.seconds, 60);
  EXPECT_EQ(run(1, "hash killed/checkpoint.h5").code, 0);
  // The run can be resumed on another number of ranks.
  const Outcome on = run(3, "run bed.toml --resume --out killed --set run.duration=1e-3");
  EXPECT_EQ(on.code, 2) << "the checkpoint is past this end: the program has read it";
  EXPECT_NE(on.errors.find("this run ends at step 10"), std::string::npos) << on.errors;
}

TEST_F(OnRanks, ARankThatStandsStillForAWhileIsWaitedFor) {
  const std::string expected = run(1, "run bed.toml --steps 1500 --hash --out one").hash();
  const Outcome o = shell(R"(
mpirun -np 2 "$grouser" run bed.toml --steps 1500 --hash --out two &
launcher=$!
for i in $(seq 600); do [ -e two/manifest.json ] && break; sleep 0.02; done
slow=$(pgrep -P $launcher | tail -n 1)
kill -STOP $slow; sleep 2; kill -CONT $slow
wait $launcher)");
  EXPECT_EQ(o.code, 0) << o.errors;
  EXPECT_EQ(o.hash(), expected);
}

} // namespace
} // namespace grouser::commands
