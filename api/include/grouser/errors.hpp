// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace grouser {

/// What this library throws. Messages are for users: one line with place, value, range and remedy.
class Error : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// A scene, a value or a file is wrong: nothing has changed. Exit code 2 of the program.
class InputError : public Error {
public:
  using Error::Error;
};

/// The simulation has become unsound, or its results could not be written; it can be looked at, but not be stepped on.
/// Exit code 3 of the program.
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
