// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/records.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grouser::session {

/// Maximum overlaps of grains, from the rows of a run.
class SqueezedRecord {
public:
  SqueezedRecord() = default;
  /// `parts`: names by the index that rows use.
  SqueezedRecord(const std::vector<output::Channel>& channels, std::vector<std::string> parts);
  void add(const output::Row& row);

  /// Maximum numbers of overlaps above 0.2 radius in a row: between grains; with planes, floor and surfaces; with
  /// parts.
  double pairs = 0, atBoundaries = 0, byParts = 0;
  /// Largest overlap between grains or with planes, floor and surfaces in a row, in radii.
  double overlap = 0;
  /// Largest overlap with a part, in radii; 0 without contact.
  double share = 0, time = 0;
  std::string by; ///< name of this part

  /// Lines to print; empty without such overlaps and without contacts of parts.
  std::string text() const;
  /// "0.31 radii by right road wheel 2 at 1.24 s"; empty without contacts of parts.
  std::string deepest() const;

private:
  std::optional<std::size_t> pairsAt_, boundariesAt_, partsAt_, overlapAt_, shareAt_,
      byAt_; ///< column indices in a row
  std::vector<std::string> parts_;
};

} // namespace grouser::session
