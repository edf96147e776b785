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

/// Cache of settled beds: settling often takes longer than the drive, and runs of a sweep share beds. A run on a cached
/// bed is bitwise identical to a run that settles the bed itself.
namespace grouser::storage {

/// A folder of settled beds, and the origin of the last one.
class BedCache final : public coupling::SettledBeds {
public:
  /// `limit` [bytes]: maximum size of the folder.
  explicit BedCache(const std::filesystem::path& folder, std::uint64_t limit = support::KeptFiles::kDefaultLimit)
      : BedCache(support::KeptFiles(folder, limit)) {}
  explicit BedCache(support::KeptFiles files) : files_(std::move(files)) {}

  /// The user's cache; see KeptFiles::ofUser().
  static std::optional<BedCache> ofUser(const base::Comm& comm = {});

  /// The ground with its settled bed, from the cache or settled as by coupling::settledGround() and then cached. Waits
  /// while another run settles the same bed. Errors of the folder or its files cause warnings and do not end the run.
  /// All ranks call it; the cache is used only if all ranks see the folder. Throws exceptions of `progress`, and
  /// SimulationError like coupling::settle().
  coupling::SettledGround settle(const coupling::GroundSetup& setup, const base::Exec& exec,
                                 const coupling::SettleProgress& progress, const base::Comm& comm) override;

  /// Settling data of the cached bed of this origin (coupling::BedSetup); empty if it is missing or damaged.
  std::optional<coupling::SettleReport> find(const std::string& origin) const;

  /// One line with the source of the bed (cache or settling) and the time. Empty before settle().
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
