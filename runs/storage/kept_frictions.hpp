// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/settling.hpp"
#include "runs/support/kept_files.hpp"

namespace grouser::storage {

/// Frictions that prepare beds of a porosity, a small file for each: beds of one soil need the same one, however large
/// they are and whatever their seed. A damaged file, or a folder that cannot be written, costs the trials again.
class KeptFrictions final : public coupling::FoundFrictions {
public:
  explicit KeptFrictions(support::KeptFiles files) : files_(std::move(files)) {}
  std::optional<double> find(const std::string& origin) const override;
  void keep(const std::string& origin, double friction) const override;

private:
  support::KeptFiles files_;
};

} // namespace grouser::storage
