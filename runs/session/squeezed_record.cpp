// SPDX-License-Identifier: BSD-3-Clause
#include "runs/session/squeezed_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace grouser::session {

SqueezedRecord::SqueezedRecord(const std::vector<output::Channel>& channels, std::vector<std::string> parts)
    : parts_(std::move(parts)) {
  std::size_t at = 0;
  for (const output::Channel& c : channels) {
    if (c.path == "terrain/squeezed") pairsAt_ = at;
    if (c.path == "terrain/squeezed_at_boundaries") boundariesAt_ = at;
    if (c.path == "terrain/squeezed_by_parts") partsAt_ = at;
    if (c.path == "terrain/max_overlap") overlapAt_ = at;
    if (c.path == "terrain/part_overlap") shareAt_ = at;
    if (c.path == "terrain/part_overlap_by") byAt_ = at;
    at += static_cast<std::size_t>(c.width);
  }
}

void SqueezedRecord::add(const output::Row& row) {
  const auto most = [&row](double& of, const std::optional<std::size_t>& at) {
    if (at) of = std::max(of, row.values[*at]);
  };
  most(pairs, pairsAt_), most(atBoundaries, boundariesAt_), most(byParts, partsAt_), most(overlap, overlapAt_);
  if (!shareAt_ || !byAt_ || !(row.values[*shareAt_] > share)) return; // NaN without parts
  share = row.values[*shareAt_], time = row.time;
  const auto part = static_cast<std::size_t>(row.values[*byAt_]);
  by = part < parts_.size() ? parts_[part] : fmt::format("part {}", part);
}

std::string SqueezedRecord::deepest() const {
  return share > 0 ? fmt::format("{:.3g} radii by {} at {:.6g} s", share, by, time) : "";
}

std::string SqueezedRecord::text() const {
  if (pairs + atBoundaries + byParts == 0 && share == 0) return {};
  std::string line = fmt::format("overlaps  > 0.2 radius (maximum at any output): {:g} between grains, {:g} with "
                                 "planes, floor and surfaces, {:g} with parts\n",
                                 pairs, atBoundaries, byParts);
  if (share > 0) line += fmt::format("          largest overlap with a part: {}\n", deepest());
  return line;
}

} // namespace grouser::session
