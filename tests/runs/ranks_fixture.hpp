// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace grouser::test {

/// A test that starts the program on several ranks, in its own folder with a small bed.
class OnRanks : public ProgramTest {
protected:
  void SetUp() override {
    ProgramTest::SetUp();
    if (std::system("mpirun --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no mpirun";
    put(folder_ / "bed.toml", kBed);
  }

  Outcome shell(const std::string& commands) const {
    // Launchers that start and end at the same time must not share a session folder: one fails if another removes it.
    return ProgramTest::shell(
        "export OMPI_MCA_orte_tmpdir_base=$(mktemp -d); trap 'rm -rf \"$OMPI_MCA_orte_tmpdir_base\"' EXIT; "
        "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
        "OMPI_MCA_rmaps_base_oversubscribe=1 PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe OMP_NUM_THREADS=1; " +
        commands);
  }
  /// `grouser WORDS`, without a launcher on 1 rank.
  Outcome run(int ranks, const std::string& words, const std::string& before = "") const {
    return shell(before + (ranks > 1 ? "mpirun -np " + std::to_string(ranks) + " " : "") + "\"$grouser\" " + words);
  }

  /// A loose bed of 450 grains that falls and slides on its floor.
  static constexpr const char* kBed = R"(version = 1
[run]
duration = 0.15
time_step = 1e-4
output_interval = 0.01
frame_interval = 0.05
checkpoint_interval = 0.05
[material.soil]
stiffness = 1e5
[terrain]
heightmap = "heightmaps/hills.png"
size = [1.0, 1.0]
height_range = [0, 0.05]
material = "soil"
grain_radius = 0.03
layers = 2
arrangement = "lattice"
floor_grains = false
wall_friction = 0.5
settle_time_limit = 0.0
[output]
picture = false
plots = false
)";
};

} // namespace grouser::test
