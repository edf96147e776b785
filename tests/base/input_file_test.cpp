// SPDX-License-Identifier: BSD-3-Clause
#include "base/input_file.hpp"

#include "base/error.hpp"
#include "tests/message_of.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace grouser::base {

namespace fs = std::filesystem;

namespace {

class InputFileTest : public ::testing::Test {
protected:
  void SetUp() override {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "text") << "one\ntwo";
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_ = fs::temp_directory_path() / ("grouser_input_" + std::to_string(::getpid()));
};

TEST_F(InputFileTest, ReadsRegularFilesAndLinksToThem) {
  fs::create_symlink("text", folder_ / "link");
  fs::create_hard_link(folder_ / "text", folder_ / "second");
  for (const char* name : {"text", "link", "second"})
    EXPECT_EQ(readInput(folder_ / name, "check it"), "one\ntwo") << name;
  std::ofstream(folder_ / "empty").close();
  EXPECT_EQ(readInput(folder_ / "empty", "check it"), "");
}

TEST_F(InputFileTest, NamesWhatIsNoRegularFile) {
  ASSERT_EQ(::mkfifo((folder_ / "fifo").c_str(), 0600), 0);
  fs::create_symlink("fifo", folder_ / "to_fifo");
  fs::create_symlink("loop", folder_ / "loop");
  fs::create_symlink("nowhere", folder_ / "broken");
  const int listener = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string place = folder_ / "socket";
  ASSERT_LT(place.copy(address.sun_path, sizeof(address.sun_path) - 1), sizeof(address.sun_path) - 1);
  ASSERT_EQ(::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  ::close(listener);
  const std::pair<fs::path, std::string> cases[] = {
      {folder_ / "fifo", " is a FIFO (a regular file is required); check it"},
      {folder_ / "to_fifo", " is a FIFO (a regular file is required); check it"},
      {folder_ / "loop", " is a link that leads back to itself (a regular file is required); check it"},
      {folder_ / "broken", ": no such file; check it"},
      {folder_ / "socket", " is a socket (a regular file is required); check it"},
      {folder_, " is a folder (a regular file is required); check it"},
      {"/dev/null", " is a device (a regular file is required); check it"},
      {"/dev/zero", " is a device (a regular file is required); check it"},
      {"/proc/self/mem", " is a file of the kernel (a regular file is required); check it"},
      {"/proc/version", " is a file of the kernel (a regular file is required); check it"},
      {folder_ / "text" / "x", ": no such file; check it"},
      {folder_ / std::string(300, 'x'), ": cannot be read (File name too long); check it"}};
  for (const auto& [path, expected] : cases) {
    EXPECT_EQ(test::messageOf([&path = path] { requireInput(path, "check it"); }), path.string() + expected);
    EXPECT_EQ(test::messageOf([&path = path] { readInput(path, "check it"); }), path.string() + expected);
  }
}

} // namespace

} // namespace grouser::base
