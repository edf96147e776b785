// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "coupling/settled_beds.hpp"
#include "runs/support/kept_files.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

/// Settled beds, kept from run to run: settling often takes longer than the drive, and a sweep over the vehicle settles
/// the same bed again and again. A run that begins on a kept bed gives the same bits as one that settled it.
namespace grouser::storage {

/// A folder of settled beds, and where the last one came from.
class BedCache final : public coupling::SettledBeds {
public:
  /// `limit` [bytes] of the folder.
  explicit BedCache(const std::filesystem::path& folder, std::uint64_t limit = support::KeptFiles::kDefaultLimit)
      : BedCache(support::KeptFiles(folder, limit)) {}
  explicit BedCache(support::KeptFiles files) : files_(std::move(files)) {}

  /// Where the user keeps such files; see KeptFiles::ofUser().
  static std::optional<BedCache> ofUser(const base::Comm& comm = {});

  /// The ground with its bed at rest: the kept bed of this scene, for which nothing is laid, tried or settled; where
  /// there is none, lets it settle as coupling::settledGround() does and keeps the result. While another run settles
  /// the same bed it is waited for. What is wrong with the folder or with a file in it is a warning, never the end of
  /// the run. On several ranks all of them call it; the folder must be seen by all, or nothing is reused. Throws what
  /// `progress` throws, and SimulationError as coupling::settle() does.
  coupling::SettledGround settle(const coupling::GroundSetup& setup, const base::Exec& exec,
                                 const coupling::SettleProgress& progress, const base::Comm& comm) override;

  /// How the bed of this origin (coupling::BedSetup) settled, where it is kept; empty where it is not, or is damaged.
  std::optional<coupling::SettleReport> find(const std::string& origin) const;

  /// One line: where the bed came from and how long that took. Empty before settle().
  const std::string& summary() const { return summary_; }

private:
  std::optional<coupling::SettledGround> reuse(const std::filesystem::path& file, const coupling::GroundSetup& setup,
                                               const base::Exec& exec, const base::Comm& comm) const;
  bool keep(const std::filesystem::path& file, const std::string& origin, const terrain::Grains& grains,
            const coupling::SettleReport& report, const base::Comm& comm) const;

  support::KeptFiles files_;
  std::string summary_;
};

} // namespace grouser::storage
