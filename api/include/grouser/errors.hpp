// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace grouser {

/// Base class of all exceptions. what() returns one line with place, value, valid range and remedy.
class Error : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// A scene, value or file is invalid; the failed call has no effect. Exit code 2 of the program.
class InputError : public Error {
public:
  using Error::Error;
};

/// The simulation became invalid, or results could not be written. The state of the simulation can still be read, but
/// step() throws. Exit code 3 of the program.
class SimulationError : public Error {
public:
  using Error::Error;
};

/// The device failed, or its memory ran out. Exit code 4 of the program.
class DeviceError : public Error {
public:
  using Error::Error;
};

} // namespace grouser
