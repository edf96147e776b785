// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.hpp"

#include <string>
#include <utility>

namespace grouser::multibody {

/// Name of a part in messages, e.g. joint 'hip'.
struct PartName {
  std::string kind; ///< body, joint, spring, bushing, drive, coupling
  std::string name;
  std::string text() const { return name.empty() ? kind : kind + " '" + name + "'"; }
};

/// Error in one part of a mechanism, with a message like `joint 'hip': damping = -1 [N s/m] must be ...`; file readers
/// prepend the part's location in the file.
class PartError : public base::InputError {
public:
  /// `key`: the invalid member of the part's struct, or empty; `fault`: description of the error.
  PartError(PartName part, std::string key, std::string fault)
      : InputError(part.text() + ": " + withKey(key, fault)), part_(std::move(part)), key_(std::move(key)),
        fault_(std::move(fault)) {}
  const PartName& part() const { return part_; }
  const std::string& key() const { return key_; }
  const std::string& fault() const { return fault_; }
  /// Message without the part's name.
  std::string text() const { return withKey(key_, fault_); }

private:
  static std::string withKey(const std::string& key, const std::string& fault) {
    return key.empty() ? fault : key + " " + fault;
  }

  PartName part_;
  std::string key_, fault_;
};

} // namespace grouser::multibody
