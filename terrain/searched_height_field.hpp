// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "terrain/height_field.hpp"

namespace grouser::terrain {

/// A height field on the device, with marks for FeetSearch where it has hollows tighter than the spheres.
class SearchedHeightField {
public:
  SearchedHeightField() = default;
  /// `radius` [m]: of the largest sphere that searches.
  SearchedHeightField(const base::Exec& exec, const HeightField& field, double radius);

  /// For kernels; valid while this object lives and is not moved from.
  const HeightFieldView& view() const { return view_; }
  /// Whether a sphere of this radius may touch the field in several places.
  static bool hasHollows(const HeightField& field, double radius) {
    return field.bounds().valleyCurvature * radius >= 1;
  }

private:
  void mark(const base::Exec& exec, const HeightField& field, double radius);

  base::Array<double> heights_, tops_;
  base::Array<NodeSlopes> slopes_;
  base::Array<std::uint8_t> marks_;
  HeightFieldView view_;
};

} // namespace grouser::terrain
