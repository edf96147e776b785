// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/hdf5_file.hpp"

#include "base/comm.hpp"
#include "runs/support/not_written.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <gtest/gtest.h>
#include <string>

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

} // namespace
} // namespace grouser::support
