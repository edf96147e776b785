// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <string>

namespace grouser::support {

/// Why a call ends early.
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
/// Throws the exception of that kind; a stray one as std::runtime_error.
[[noreturn]] void rethrow(const Failure& failure);

/// Exit code of the program for this failure; docs/commands.md lists them.
int exitCode(FailureKind kind);
/// Message for the user. `commandLine`: added to the message for bugs.
std::string textOf(const Failure& failure, const std::string& commandLine);

} // namespace grouser::support
