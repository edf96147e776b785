// SPDX-License-Identifier: BSD-3-Clause
// Exit code and message of the program for an exception.
#include "runs/support/failure.hpp"

#include "base/error.hpp"
#include "runs/support/not_written.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <new>
#include <stdexcept>
#include <vector>

namespace grouser::support {
namespace {

template <class Error> Failure of(const Error& error) { return failureOf(std::make_exception_ptr(error)); }

TEST(Failure, HasTheExitCodeOfItsKind) {
  EXPECT_EQ(exitCode(of(base::InputError("a")).kind), 2);
  EXPECT_EQ(exitCode(of(base::SimulationError("a")).kind), 3);
  EXPECT_EQ(exitCode(of(NotWritten("a")).kind), 3);
  EXPECT_EQ(exitCode(of(base::DeviceError("a")).kind), 4);
  EXPECT_EQ(exitCode(of(std::bad_alloc()).kind), 4);
  const Failure input = of(base::InputError("scene.toml:3: run.x is unknown"));
  EXPECT_EQ(textOf(input, "grouser run"), "scene.toml:3: run.x is unknown") << "unchanged";
}

TEST(Failure, OfAStrayExceptionIsAnInternalErrorToReport) {
  for (const Failure& failure : {of(std::runtime_error("lost")), of(std::logic_error("lost")), of(42)}) {
    EXPECT_EQ(exitCode(failure.kind), 1) << failure.message;
    const std::string text = textOf(failure, "grouser run 'a b.toml'");
    EXPECT_EQ(text.rfind("internal error: " + failure.message, 0), 0u) << text;
    EXPECT_NE(text.find("report it with the command line: grouser run 'a b.toml'"), std::string::npos) << text;
  }
  EXPECT_EQ(of(std::runtime_error("lost")).message, "lost");
}

TEST(Failure, OfTheFileSystemNamesTheFileAndIsNoInternalError) {
  const Failure failure = of(std::filesystem::filesystem_error(
      "cannot rename", "/nowhere/a.h5", std::make_error_code(std::errc::no_such_file_or_directory)));
  EXPECT_EQ(exitCode(failure.kind), 3);
  EXPECT_EQ(failure.message, "/nowhere/a.h5: No such file or directory; its folder is gone");
}

TEST(Failure, KeepsKindAndMessageWhenThrownAgain) {
  for (const FailureKind kind : {FailureKind::stray, FailureKind::input, FailureKind::simulation,
                                 FailureKind::notWritten, FailureKind::device}) {
    try {
      rethrow({kind, "why"});
    } catch (...) {
      const Failure again = failureOf(std::current_exception());
      EXPECT_EQ(again.kind, kind);
      EXPECT_EQ(again.message, "why");
    }
  }
}

} // namespace
} // namespace grouser::support
