// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/hdf5_file.hpp"

#include "base/comm.hpp"
#include "runs/support/not_written.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace grouser::support {
namespace {

using Hdf5Folder = test::FolderTest;

TEST_F(Hdf5Folder, TakenAwayWhileItsFileIsClosedIsSaidToBeGone) {
  const std::filesystem::path file = folder_ / "out" / "checkpoint.h5.part";
  std::filesystem::create_directory(file.parent_path());
  Hdf5File::create(file);
  EXPECT_NO_THROW(Hdf5File::openShared(file, base::Comm()));
  std::filesystem::remove_all(file.parent_path());
  try {
    Hdf5File::openShared(file, base::Comm());
    ADD_FAILURE() << "opened";
  } catch (const NotWritten& error) {
    EXPECT_EQ(error.what(), file.string() + ": HDF5 could not open the file again; its folder is gone");
  }
}

/// All contents of the file of the next test.
std::vector<std::string> contentsOf(const std::filesystem::path& path) {
  const Hdf5File file = Hdf5File::open(path);
  std::vector<std::string> all = file.texts("/rows/value", "labels");
  for (const char* name : {"scene", "creator"}) all.push_back(file.text("/", name));
  for (const double x : file.numbers("/rows/value")) all.push_back(std::to_string(x));
  for (const float x : file.read<float>("/constant")) all.push_back(std::to_string(x));
  all.push_back(std::to_string(file.number("/rows", "time")));
  return all;
}

TEST_F(Hdf5Folder, FlippedBitsAreErrorsAndDoNotChangeNumbersOrTexts) {
  const std::filesystem::path path = folder_ / "results.h5", damaged = folder_ / "damaged.h5";
  const std::string longText(70000, 's'); // longer than HDF5 protects
  {
    Hdf5File file = Hdf5File::create(path);
    file.attribute("/", "scene", longText);
    file.attribute("/", "creator", std::string("grouser"));
    GrowingDataset rows = file.growing("/rows/value", NumberType::Float64, 3, 64);
    for (int r = 0; r < 100; ++r) rows.append(std::vector<double>{1.0 * r, 2.0 * r, 3.0 * r}.data());
    file.attribute("/rows/value", "labels", std::vector<std::string>{"x", "y", "zz"});
    file.attribute("/rows", "time", 0.5);
    file.write("/constant", std::vector<float>(1000, 0.25f), {1000});
  }
  std::ifstream in(path, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(in), {}};
  const std::vector<std::string> expected = contentsOf(path);
  ASSERT_EQ(expected[3], longText);
  std::mt19937 random(1);
  int errors = 0;
  constexpr int kFlips = 300;
  for (int k = 0; k < kFlips; ++k) {
    const std::size_t bit = random() % (8 * whole.size());
    std::string flipped = whole;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ 1 << bit % 8);
    std::ofstream(damaged, std::ios::binary) << flipped;
    try {
      EXPECT_EQ(contentsOf(damaged), expected) << "byte " << bit / 8 << ", bit " << bit % 8;
    } catch (const base::InputError&) {
      ++errors;
    }
  }
  EXPECT_GT(errors, kFlips * 9 / 10);
}

} // namespace
} // namespace grouser::support
