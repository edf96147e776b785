// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <string>

namespace grouser::support {

/// Why a call ends early.
enum class FailureKind {
  stray,      ///< an exception that nobody throws on purpose: a fault of the program, or of the system
  input,      ///< base::InputError
  simulation, ///< base::SimulationError
  notWritten, ///< NotWritten, or any call of the file system that failed
  device      ///< base::DeviceError, or memory that ran out
};

struct Failure {
  FailureKind kind{};
  std::string message;
};

/// What an exception means to the caller of the program.
Failure failureOf(const std::exception_ptr& error);
/// Throws the exception of that kind; a stray one as std::runtime_error.
[[noreturn]] void rethrow(const Failure& failure);

/// Of the program that ends with it; docs/commands.md lists them.
int exitCode(FailureKind kind);
/// What the user reads. `commandLine`: what to report besides, where the program is at fault.
std::string textOf(const Failure& failure, const std::string& commandLine);

} // namespace grouser::support
