// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.hpp"

#include <string>
#include <utility>

namespace grouser::multibody {

/// Name of a part in messages: joint 'hip'.
struct PartName {
  std::string kind; ///< body, joint, spring, bushing, drive, coupling
  std::string name;
  std::string text() const { return name.empty() ? kind : kind + " '" + name + "'"; }
};

/// Error in one part of a mechanism. The message reads `joint 'hip': damping = -1 [N s/m] must be ...`; file readers
/// prepend the place of the part.
class PartError : public base::InputError {
public:
  /// `key`: the wrong member of the part's struct; empty if there is no single one. `fault`: description.
  PartError(PartName part, std::string key, std::string fault)
      : InputError(part.text() + ": " + withKey(key, fault)), part_(std::move(part)), key_(std::move(key)),
        fault_(std::move(fault)) {}
  const PartName& part() const { return part_; }
  const std::string& key() const { return key_; }
  const std::string& fault() const { return fault_; }
  /// The message without the part's name.
  std::string text() const { return withKey(key_, fault_); }

private:
  static std::string withKey(const std::string& key, const std::string& fault) {
    return key.empty() ? fault : key + " " + fault;
  }

  PartName part_;
  std::string key_, fault_;
};

} // namespace grouser::multibody
