// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/gpu_sharing.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

namespace grouser::support {
namespace {

namespace fs = std::filesystem;
using test::contents;

/// With a program in place of NVIDIA's, which writes down how it is called.
class GpuSharingTest : public test::FolderTest {
protected:
  void SetUp() override {
    FolderTest::SetUp();
    path_ = std::getenv("PATH");
    unsetenv("CUDA_MPS_PIPE_DIRECTORY"), unsetenv("GROUSER_MPS");
    setenv("PATH", (folder_.string() + ":" + path_).c_str(), 1);
  }
  void TearDown() override {
    setenv("PATH", path_.c_str(), 1);
    unsetenv("CUDA_MPS_PIPE_DIRECTORY"), unsetenv("GROUSER_MPS");
    FolderTest::TearDown();
  }
  fs::path calls() const { return folder_ / "calls"; }
  void install(const std::string& atStart) {
    const fs::path program = folder_ / "nvidia-cuda-mps-control";
    std::ofstream(program) << "#!/bin/sh\n"
                           << "if [ \"$1\" = -f ]; then echo start >> " << calls() << "; " << atStart << "; fi\n"
                           << "read -r word; echo \"$word\" >> " << calls() << '\n';
    fs::permissions(program, fs::perms::owner_all);
  }
  /// Comes up, and waits until it is ended.
  void install() { install("touch \"$CUDA_MPS_PIPE_DIRECTORY/control\"; exec sleep 60"); }

private:
  std::string path_;
};

TEST_F(GpuSharingTest, ServiceLivesAsLongAsTheObject) {
  install();
  fs::path pipes;
  {
    const GpuSharing sharing(true);
    ASSERT_TRUE(sharing.runs());
    const Environment environment = sharing.environment();
    ASSERT_EQ(environment.size(), 1u);
    EXPECT_EQ(environment[0].first, "CUDA_MPS_PIPE_DIRECTORY");
    pipes = environment[0].second;
    EXPECT_TRUE(fs::exists(pipes));
    EXPECT_EQ(contents(calls()), "start\n");
  }
  EXPECT_EQ(contents(calls()), "start\nquit\n");
  EXPECT_FALSE(fs::exists(pipes));
}

TEST_F(GpuSharingTest, NothingStartsWithoutNeed) {
  install();
  EXPECT_FALSE(GpuSharing(false).runs());
  setenv("GROUSER_MPS", "0", 1);
  EXPECT_FALSE(GpuSharing(true).runs());
  unsetenv("GROUSER_MPS");
  setenv("CUDA_MPS_PIPE_DIRECTORY", "/tmp/of_the_user", 1);
  EXPECT_FALSE(GpuSharing(true).runs()) << "the user's own service is used";
  EXPECT_FALSE(fs::exists(calls()));
}

TEST_F(GpuSharingTest, ProcessesTakeTurnsWhereTheServiceDoesNotComeUp) {
  install("exit 1");
  const GpuSharing sharing(true);
  EXPECT_FALSE(sharing.runs());
  EXPECT_TRUE(sharing.environment().empty());
}

TEST_F(GpuSharingTest, ProcessesTakeTurnsWithoutTheProgram) {
  setenv("PATH", folder_.c_str(), 1);
  EXPECT_FALSE(GpuSharing(true).runs());
}

} // namespace
} // namespace grouser::support
