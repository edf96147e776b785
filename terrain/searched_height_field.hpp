// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "terrain/height_field.hpp"

namespace grouser::terrain {

/// Height field on the device, with marks for FeetSearch at hollows tighter than the spheres.
class SearchedHeightField {
public:
  SearchedHeightField() = default;
  /// `radius`: radius of the largest sphere [m].
  SearchedHeightField(const base::Exec& exec, const HeightField& field, double radius);

  /// View for kernels; valid while this object exists and is not moved from.
  const HeightFieldView& view() const { return view_; }
  /// True if a sphere of this radius may have several contacts with the field.
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
