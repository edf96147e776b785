// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grains.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace grouser::coupling {

/// One [[source]]: boxes of grains that enter while the run goes.
struct SourceSetup {
  std::string place;                     ///< in messages: "scene.toml:14: source.0"
  base::Vec3d low, high;                 ///< corners of the box that their centres start in [m]
  base::Vec3d velocity, spin;            ///< [m/s], [rad/s]
  double radius{};                       ///< [m]
  int material{};                        ///< among those of the scene's grains
  std::int64_t number{}, total{};        ///< that enter together; in all
  std::int64_t every{}, first{}, last{}; ///< [steps]
  std::uint64_t seed{};
};

/// The [[source]]s of a scene: which grains enter at which step. A pure function of the scene and the step's number, so
/// that there is nothing to save in a checkpoint.
class Sources {
public:
  Sources() = default;
  Sources(std::vector<SourceSetup> sources, const terrain::PeriodicBoundaries& sides)
      : sources_(std::move(sources)), sides_(sides) {}

  /// Grains that enter at the beginning of this step (the first is step 0).
  std::vector<terrain::GrainSpec> enteringAt(std::int64_t step) const;
  bool empty() const { return sources_.empty(); }
  std::int64_t total() const; ///< grains that enter in all
  const SourceSetup& source(std::size_t i) const { return sources_[i]; }

  /// What one source sets at a step.
  struct Batch {
    std::size_t source{}; ///< among the scene's
    std::vector<terrain::GrainSpec> grains;
  };
  std::vector<Batch> batchesAt(std::int64_t step) const; ///< in the order of enteringAt()
  /// The first step, not before `step`, at which grains enter.
  std::optional<std::int64_t> nextEntry(std::int64_t step) const;

private:
  std::vector<terrain::GrainSpec> batch(const SourceSetup& source, std::int64_t number) const;

  std::vector<SourceSetup> sources_;
  terrain::PeriodicBoundaries sides_;
};

/// Of the places of a source's grains, from the seed of the run and the source's number in the scene.
std::uint64_t sourceSeed(std::uint64_t seed, std::uint64_t source);

} // namespace grouser::coupling
