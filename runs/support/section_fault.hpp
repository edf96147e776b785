// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.hpp"

#include <string>
#include <utility>

namespace grouser::support {

/// Error in one key of a section; the code that reads the file adds place and value of the key.
class SectionFault : public base::InputError {
public:
  SectionFault(std::string key, const std::string& message) : InputError(message), key_(std::move(key)) {}
  const std::string& key() const { return key_; }

private:
  std::string key_;
};

} // namespace grouser::support
