// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/cause.hpp"

#include <cstdint>
#include <stdexcept>
#include <string>

namespace grouser::base {

/// Returns the text as one line: control characters, which user files may contain, are escaped as \n or \x1B.
inline std::string oneLine(const std::string& text) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::string line;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '\n')
      line += "\\n";
    else if (code < 0x20 || code == 0x7F)
      line += std::string("\\x") + kDigits[code >> 4] + kDigits[code & 15];
    else
      line += c;
  }
  return line;
}

/// Invalid user input: a scene, file or option. Exit code 2. Thrown before any output is written. The message is one
/// line: `file:line: key = value is ...; remedy`.
class InputError : public std::runtime_error {
public:
  explicit InputError(const std::string& message) : std::runtime_error(oneLine(message)) {}
};

/// Failure of a running simulation: NaN, excessive overlap, a thrown track. Exit code 3. The message states the step,
/// time, id, position and remedy.
class SimulationError : public std::runtime_error {
public:
  explicit SimulationError(const std::string& message, Cause cause = Cause::unknown)
      : std::runtime_error(message), cause_(cause) {}
  Cause cause() const { return cause_; }

private:
  Cause cause_;
};

/// Failure of a device call, with the returned code. Exit code 4.
class DeviceError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

} // namespace grouser::base
