// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/failure.hpp"

#include "base/error.hpp"
#include "runs/support/not_written.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <new>
#include <stdexcept>

namespace grouser::support {

Failure failureOf(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const base::InputError& e) {
    return {FailureKind::input, e.what()};
  } catch (const base::SimulationError& e) {
    return {FailureKind::simulation, e.what()};
  } catch (const base::DeviceError& e) {
    return {FailureKind::device, e.what()};
  } catch (const std::bad_alloc&) {
    return {FailureKind::device, "out of host memory; use larger or fewer grains, or more ranks on several hosts "
                                 "(grouser plan prints the memory of a scene)"};
  } catch (const NotWritten& e) {
    return {FailureKind::notWritten, e.what()};
  } catch (const std::filesystem::filesystem_error& e) {
    return {FailureKind::notWritten, notWritten(e.path1(), e.code().message()).what()};
  } catch (const std::exception& e) {
    return {FailureKind::stray, e.what()};
  } catch (...) {
    return {FailureKind::stray, "exception without a message"};
  }
}

void rethrow(const Failure& failure) {
  switch (failure.kind) {
  case FailureKind::input:
    throw base::InputError(failure.message);
  case FailureKind::simulation:
    throw base::SimulationError(failure.message);
  case FailureKind::notWritten:
    throw NotWritten(failure.message);
  case FailureKind::device:
    throw base::DeviceError(failure.message);
  case FailureKind::stray:
    break;
  }
  throw std::runtime_error(failure.message);
}

int exitCode(FailureKind kind) {
  switch (kind) {
  case FailureKind::input:
    return 2;
  case FailureKind::simulation:
  case FailureKind::notWritten:
    return 3;
  case FailureKind::device:
    return 4;
  case FailureKind::stray:
    break;
  }
  return 1;
}

std::string textOf(const Failure& failure, const std::string& commandLine) {
  if (failure.kind != FailureKind::stray) return failure.message;
  return fmt::format("internal error: {}; this is a bug in grouser: report it with the command line: {}",
                     failure.message, commandLine);
}

} // namespace grouser::support
