// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/records.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grouser::session {

/// What the rows of a run say of squeezed grains, for the end of the run.
class SqueezedRecord {
public:
  SqueezedRecord() = default;
  /// `parts`: names of those that rows count.
  SqueezedRecord(const std::vector<output::Channel>& channels, std::vector<std::string> parts);
  void add(const output::Row& row);

  /// Deeper than a fifth of a radius, in the row that has most of them: pairs of grains; contacts with planes, floor
  /// and surfaces; with parts.
  double pairs = 0, atBoundaries = 0, byParts = 0;
  /// The deepest overlap with a part, in radii; 0 where none has touched any.
  double share = 0, time = 0;
  std::string by; ///< that part

  /// Lines for the user; empty where nothing was squeezed and no part has touched a grain.
  std::string text() const;
  /// "0.31 radii by right road wheel 2 at 1.24 s"; empty where no part has touched a grain.
  std::string deepest() const;

private:
  std::optional<std::size_t> pairsAt_, boundariesAt_, partsAt_, shareAt_, byAt_; ///< places in a row
  std::vector<std::string> parts_;
};

} // namespace grouser::session
