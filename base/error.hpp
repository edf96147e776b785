// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace grouser::base {

/// What the user gave is wrong: a scene, a file, an option. Exit code 2. Nothing has been written when it is thrown.
/// The message reads `file:line: key = value is ...; remedy`.
class InputError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// The simulation cannot go on soundly: NaN, overlap, a thrown track. Exit code 3.
/// The message names step, time, id, place and remedy.
class SimulationError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// A device call failed; carries the code it returned. Exit code 4.
class DeviceError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

} // namespace grouser::base
