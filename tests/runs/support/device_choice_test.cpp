// SPDX-License-Identifier: BSD-3-Clause
// Selection of a machine's GPU by a process: without a GPU, only by its number.
#include "runs/support/device_choice.hpp"

#include "base/error.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace grouser::support {
namespace {

class FirstGpu : public test::FolderTest {
protected:
  void SetUp() override {
    test::FolderTest::SetUp();
    unsetenv(kFirstGpu);
  }
  void TearDown() override {
    unsetenv(kFirstGpu);
    test::FolderTest::TearDown();
  }
};

TEST_F(FirstGpu, RanksTakeThemInTurnFromTheFirstOn) {
  EXPECT_EQ(gpuOf(0, 4), 0);
  EXPECT_EQ(gpuOf(5, 4), 1);
  setenv(kFirstGpu, "3", 1);
  EXPECT_EQ(gpuOf(0, 4), 3);
  EXPECT_EQ(gpuOf(1, 4), 0);
  EXPECT_EQ(gpuOf(0, 1), 0) << "a machine with one GPU";
  setenv(kFirstGpu, "1048575", 1);
  EXPECT_EQ(gpuOf(3, 2), 0);
  setenv(kFirstGpu, "", 1);
  EXPECT_EQ(gpuOf(1, 2), 1);
}

TEST_F(FirstGpu, ThatIsNoNumberIsRefusedByName) {
  for (const char* wrong : {"-1", "1.5", "gpu", "0x1", " 1", "1048577", "99999999999"}) {
    setenv(kFirstGpu, wrong, 1);
    try {
      gpuOf(0, 2);
      ADD_FAILURE() << wrong;
    } catch (const base::InputError& e) {
      EXPECT_NE(std::string(e.what()).find("GROUSER_GPU = '" + std::string(wrong) + "'"), std::string::npos)
          << e.what();
    }
  }
}

TEST_F(FirstGpu, ProcessesOfOneCallGoOnFromItsOwn) {
  EXPECT_EQ(firstGpuOf(0), "0");
  EXPECT_EQ(firstGpuOf(5), "5");
  setenv(kFirstGpu, "1", 1);
  EXPECT_EQ(firstGpuOf(2), "3");
  EXPECT_STREQ(std::getenv(kFirstGpu), "1") << "this process is unchanged";
}

} // namespace
} // namespace grouser::support
