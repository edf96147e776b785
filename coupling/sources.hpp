// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grains.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace grouser::coupling {

/// One [[source]]: grains that enter inside a box during the run.
struct SourceSetup {
  std::string place;                     ///< location for messages: "scene.toml:14: source.0"
  base::Vec3d low, high;                 ///< corners of the box that contains their centres [m]
  base::Vec3d velocity, spin;            ///< [m/s], [rad/s]
  double radius{};                       ///< [m]
  int material{};                        ///< index in the scene's grain materials
  std::int64_t number{}, total{};        ///< per batch; in total
  std::int64_t every{}, first{}, last{}; ///< [steps]
  std::uint64_t seed{};
};

/// The [[source]]s of a scene: the grains that enter at each step. A pure function of the scene and the step number, so
/// it is not saved in checkpoints.
class Sources {
public:
  Sources() = default;
  Sources(std::vector<SourceSetup> sources, const terrain::PeriodicBoundaries& sides)
      : sources_(std::move(sources)), sides_(sides) {}

  /// Grains that enter at the beginning of this step (the first is step 0).
  std::vector<terrain::GrainSpec> enteringAt(std::int64_t step) const;
  bool empty() const { return sources_.empty(); }
  std::int64_t total() const; ///< total number of entering grains
  const SourceSetup& source(std::size_t i) const { return sources_[i]; }

  /// Grains of one source at one step.
  struct Batch {
    std::size_t source{}; ///< index in the scene
    std::vector<terrain::GrainSpec> grains;
  };
  std::vector<Batch> batchesAt(std::int64_t step) const; ///< in the order of enteringAt()
  /// First step, not before `step`, at which grains enter.
  std::optional<std::int64_t> nextEntry(std::int64_t step) const;

private:
  std::vector<terrain::GrainSpec> batch(const SourceSetup& source, std::int64_t number) const;

  std::vector<SourceSetup> sources_;
  terrain::PeriodicBoundaries sides_;
};

/// Seed for the grain positions of a source, from the seed of the run and the index of the source in the scene.
std::uint64_t sourceSeed(std::uint64_t seed, std::uint64_t source);

} // namespace grouser::coupling
