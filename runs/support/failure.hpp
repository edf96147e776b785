// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <string>

namespace grouser::support {

/// Reason for the early end of a call.
enum class FailureKind {
  stray,      ///< an unexpected exception: a bug, or a fault of the system
  input,      ///< base::InputError
  simulation, ///< base::SimulationError
  notWritten, ///< NotWritten, or any call of the file system that failed
  device      ///< base::DeviceError, or memory that ran out
};

struct Failure {
  FailureKind kind{};
  std::string message;
};

/// Classifies an exception.
Failure failureOf(const std::exception_ptr& error);
/// Throws an exception of this kind; for kind stray, std::runtime_error.
[[noreturn]] void rethrow(const Failure& failure);

/// Exit code of the program for this failure; docs/commands.md lists them.
int exitCode(FailureKind kind);
/// Message for the user. `commandLine`: added to the message for bugs.
std::string textOf(const Failure& failure, const std::string& commandLine);

} // namespace grouser::support
