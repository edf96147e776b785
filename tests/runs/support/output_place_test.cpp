// SPDX-License-Identifier: BSD-3-Clause
// Unwritable output folders are detected before the work, with the reason.
#include "runs/support/output_place.hpp"

#include "base/error.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <string>

namespace grouser::support {
namespace {

namespace fs = std::filesystem;
using test::put;

class OutputPlace : public test::FolderTest {
protected:
  template <class Require> static std::string complaint(const Require& require) {
    try {
      require();
    } catch (const base::InputError& error) {
      return error.what();
    }
    return "";
  }
  static std::string ofFolder(const fs::path& folder) {
    return complaint([&] { requireFolder(folder); });
  }
  static std::string ofFile(const fs::path& file) {
    return complaint([&] { requireFile(file, "--json"); });
  }
  bool isEmpty() const { return fs::is_empty(folder_); }
};

TEST_F(OutputPlace, IsTriedAndLeftAsItWas) {
  EXPECT_EQ(ofFolder(folder_), "");
  EXPECT_EQ(ofFolder(folder_ / "a" / "b" / "c"), "");
  EXPECT_EQ(ofFolder(folder_ / "a/../b/"), "");
  EXPECT_EQ(ofFile(folder_ / "plan.json"), "");
  EXPECT_EQ(ofFile("/dev/null"), "");
  EXPECT_TRUE(isEmpty());
}

TEST_F(OutputPlace, ALinkToNothingIsNamed) {
  fs::create_symlink("gone/away", folder_ / "link");
  for (const char* place : {"link", "link/inside/it"}) {
    const std::string why = ofFolder(folder_ / place);
    EXPECT_NE(why.find("a link to gone/away, which does not exist"), std::string::npos) << why;
    EXPECT_NE(why.find("--out"), std::string::npos) << why;
  }
  fs::create_directory(folder_ / "there");
  fs::create_symlink("there", folder_ / "good");
  EXPECT_EQ(ofFolder(folder_ / "good"), "");
  EXPECT_EQ(ofFolder(folder_ / "good/new"), "");
}

TEST_F(OutputPlace, AFileInTheWayIsNamed) {
  put(folder_ / "file", "x");
  EXPECT_NE(ofFolder(folder_ / "file").find("is a file, not a folder"), std::string::npos);
  EXPECT_NE(ofFolder(folder_ / "file/below").find("file is a file, not a folder"), std::string::npos);
}

TEST_F(OutputPlace, NamesThatAreTooLongAreSaidSo) {
  const std::string name(300, 'n');
  EXPECT_NE(ofFolder(folder_ / name), "");
  EXPECT_NE(ofFolder(folder_ / "new" / name).find("a name in the path has 300 bytes"), std::string::npos)
      << ofFolder(folder_ / "new" / name);
  fs::path deep = folder_;
  for (int k = 0; k < 30; ++k) deep /= std::string(200, 'd');
  EXPECT_NE(ofFolder(deep), "");
  EXPECT_NE(ofFile(folder_ / name), "");
  EXPECT_TRUE(isEmpty());
}

TEST_F(OutputPlace, FoldersThatNobodyMayWriteInAreNamed) {
  // Folders that even root cannot create.
  EXPECT_NE(ofFolder("/proc/results").find("cannot be created: cannot write in /proc"), std::string::npos)
      << ofFolder("/proc/results");
  EXPECT_NE(ofFolder("/proc/self").find("cannot write in this folder"), std::string::npos);
  EXPECT_NE(ofFile("/proc/plan.json"), "");
  if (getuid() == 0) return;
  fs::create_directory(folder_ / "closed");
  fs::permissions(folder_ / "closed", fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_NE(ofFolder(folder_ / "closed/in"), "");
  EXPECT_NE(ofFolder(folder_ / "closed"), "");
  fs::permissions(folder_ / "closed", fs::perms::owner_all);
}

TEST_F(OutputPlace, AFullDiskIsMetBefore) {
  // Every write fails as on a full disk; a substitute if the machine has no small file system.
  EXPECT_NE(ofFolder("/dev/full"), "");
}

TEST_F(OutputPlace, FilesNeedTheirFolder) {
  EXPECT_NE(ofFile(folder_ / "none/plan.json").find("does not exist; create it"), std::string::npos);
  EXPECT_NE(ofFile(folder_).find("is a folder, not a file"), std::string::npos);
  put(folder_ / "file", "x");
  fs::create_symlink("gone", folder_ / "lost");
  fs::create_directory(folder_ / "there");
  fs::create_symlink("there", folder_ / "good");
  EXPECT_NE(ofFile(folder_ / "file/plan.json").find("file is a file, not a folder"), std::string::npos)
      << ofFile(folder_ / "file/plan.json");
  EXPECT_NE(ofFile(folder_ / "lost/plan.json").find("lost is a link to gone, which does not exist"), std::string::npos)
      << ofFile(folder_ / "lost/plan.json");
  for (const char* name : {"good/plan.json", "./there/../good/./plan.json"}) EXPECT_EQ(ofFile(folder_ / name), "");
  fs::create_symlink("none/plan.json", folder_ / "link.json");
  EXPECT_NE(ofFile(folder_ / "link.json"), "");
}

} // namespace
} // namespace grouser::support
