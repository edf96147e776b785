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

/// Uses a program in place of NVIDIA's, which records its calls.
class GpuSharingTest : public test::FolderTest {
protected:
  void SetUp() override {
    FolderTest::SetUp();
    path_ = std::getenv("PATH");
    unsetenv("CUDA_MPS_PIPE_DIRECTORY"), unsetenv("CUDA_VISIBLE_DEVICES"), setenv("GROUSER_MPS", "1", 1);
    setenv("PATH", (folder_.string() + ":" + path_).c_str(), 1);
  }
  void TearDown() override {
    setenv("PATH", path_.c_str(), 1);
    for (const char* name : {"CUDA_MPS_PIPE_DIRECTORY", "CUDA_VISIBLE_DEVICES", "GROUSER_MPS"}) unsetenv(name);
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
  /// Starts, and waits until it is ended.
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
  unsetenv("GROUSER_MPS");
  EXPECT_FALSE(GpuSharing(true).runs()) << "not requested";
  setenv("GROUSER_MPS", "1", 1), setenv("CUDA_MPS_PIPE_DIRECTORY", "/tmp/of_the_user", 1);
  EXPECT_FALSE(GpuSharing(true).runs()) << "the user's own service is used";
  setenv("CUDA_MPS_PIPE_DIRECTORY", "", 1), setenv("CUDA_VISIBLE_DEVICES", "2,3", 1);
  EXPECT_FALSE(GpuSharing(true).runs()) << "the service would renumber these GPUs";
  EXPECT_FALSE(fs::exists(calls()));
  setenv("CUDA_VISIBLE_DEVICES", "GPU-1234", 1);
  EXPECT_TRUE(GpuSharing(true).runs());
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
