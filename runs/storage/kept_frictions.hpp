// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/settling.hpp"
#include "runs/support/kept_files.hpp"

namespace grouser::storage {

/// Cache of preparation frictions for beds of given porosity, in one small file each. Beds of one soil share a file,
/// independently of size and seed. If a file is damaged or the folder is read-only, the trials are repeated.
class KeptFrictions final : public coupling::FoundFrictions {
public:
  explicit KeptFrictions(support::KeptFiles files) : files_(std::move(files)) {}
  std::optional<double> find(const std::string& origin) const override;
  void keep(const std::string& origin, double friction) const override;

private:
  support::KeptFiles files_;
};

} // namespace grouser::storage
