// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"
#include "terrain/grains.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace grouser::setup {

/// The [[source]]s of a scene: which grains enter at which step. A pure function of the scene and the step's number, so
/// that there is nothing to save in a checkpoint.
class Sources {
public:
  Sources(const scene::Scene& scene, double timeStep);

  /// Grains that enter at the beginning of this step (the first is step 0).
  std::vector<terrain::GrainSpec> enteringAt(std::int64_t step) const;
  bool empty() const { return sources_.empty(); }

  /// What one source sets at a step.
  struct Batch {
    std::size_t source{}; ///< among the scene's
    std::vector<terrain::GrainSpec> grains;
  };
  std::vector<Batch> batchesAt(std::int64_t step) const; ///< in the order of enteringAt()
  /// The first step, not before `step`, at which grains enter.
  std::optional<std::int64_t> nextEntry(std::int64_t step) const;

private:
  struct Stream {
    scene::Source source;
    std::size_t index{};                   ///< among the scene's sources
    std::string place;                     ///< "scene.toml:14: source.0"
    int material{};                        ///< among those of the scene's grains
    std::int64_t every{}, first{}, last{}; ///< [steps]
    std::uint64_t seed{};
  };
  std::vector<terrain::GrainSpec> batch(const Stream& stream, std::int64_t number) const;

  std::vector<Stream> sources_;
  terrain::PeriodicBoundaries sides_;
};

/// Throws base::InputError naming the source whose grains do not fit into its box beside each other.
void checkSources(const scene::Scene& scene);

} // namespace grouser::setup
