// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.hpp"

#include <functional>
#include <string>

namespace grouser::test {

/// The message of the InputError that `act` throws; empty if it throws none.
inline std::string messageOf(const std::function<void()>& act) {
  try {
    act();
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

} // namespace grouser::test
