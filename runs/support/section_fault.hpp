// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.hpp"

#include <string>
#include <utility>

namespace grouser::support {

/// What is wrong with one key of a section; who reads the file adds its place and the key's value.
class SectionFault : public base::InputError {
public:
  SectionFault(std::string key, const std::string& message) : InputError(message), key_(std::move(key)) {}
  const std::string& key() const { return key_; }

private:
  std::string key_;
};

} // namespace grouser::support
