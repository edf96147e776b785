// SPDX-License-Identifier: BSD-3-Clause
#include "runs/storage/kept_frictions.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <gtest/gtest.h>

namespace grouser::storage {
namespace {

namespace fs = std::filesystem;

class KeptFrictionsTest : public test::FolderTest {
protected:
  KeptFrictions frictions() const { return KeptFrictions(support::KeptFiles(folder_)); }
  fs::path fileOf(const std::string& origin) const {
    return support::KeptFiles(folder_).fileOf(support::KeptFiles::Kind::friction, origin);
  }
};

TEST_F(KeptFrictionsTest, WhatIsKeptIsFoundToTheLastBit) {
  EXPECT_FALSE(frictions().find("sand"));
  frictions().keep("sand", 1.0 / 3), frictions().keep("loam", 0x1.123456789abcdp-9);
  EXPECT_EQ(frictions().find("sand"), 1.0 / 3);
  EXPECT_EQ(frictions().find("loam"), 0x1.123456789abcdp-9);
  EXPECT_FALSE(frictions().find("clay"));
}

TEST_F(KeptFrictionsTest, DamagedFilesAreAsNone) {
  for (const char* text : {"", "{", "[]", "{\"of\": \"sand\"}", "{\"of\": \"sand\", \"friction\": \"much\"}",
                           "{\"of\": \"sand\", \"friction\": -1}", "{\"of\": \"clay\", \"friction\": 0.2}"}) {
    test::put(fileOf("sand"), text);
    EXPECT_FALSE(frictions().find("sand")) << text;
  }
  frictions().keep("sand", 0.2);
  EXPECT_EQ(frictions().find("sand"), 0.2);
}

TEST_F(KeptFrictionsTest, FolderThatCannotBeMadeIsNoError) {
  test::put(folder_ / "file", "");
  const KeptFrictions nowhere(support::KeptFiles(folder_ / "file"));
  nowhere.keep("sand", 0.2);
  EXPECT_FALSE(nowhere.find("sand"));
}

} // namespace
} // namespace grouser::storage
