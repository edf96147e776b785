// SPDX-License-Identifier: BSD-3-Clause
// Runs the tests of this folder on every rank; one rank reports, and any rank's failure fails all.
#include "tests/ranks/ranks.hpp"

#include <gtest/gtest.h>

namespace grouser::test {

namespace {
const base::Comm* joined = nullptr;
}

const base::Comm& comm() { return *joined; }

} // namespace grouser::test

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  const grouser::base::Ranks ranks(argc, argv);
  grouser::test::joined = &ranks.comm();
  if (!ranks.comm().first())
    delete ::testing::UnitTest::GetInstance()->listeners().Release(
        ::testing::UnitTest::GetInstance()->listeners().default_result_printer());
  const int failed = RUN_ALL_TESTS();
  return static_cast<int>(ranks.comm().maximumOf(static_cast<std::uint64_t>(failed)));
}
