// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/sources.hpp"

#include "base/error.hpp"
#include "base/random.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::coupling {

namespace {

constexpr std::uint64_t kSourcePurpose = base::purpose("source.place");
constexpr int kSourceTries = 2000; // attempts to find a free position for one grain
constexpr double kRoom = 2.002;    // [radii] minimum distance between the centres of grains that enter together

} // namespace

std::uint64_t sourceSeed(std::uint64_t seed, std::uint64_t source) { return base::hash(seed, kSourcePurpose, source); }

std::int64_t Sources::total() const {
  std::int64_t total = 0;
  for (const SourceSetup& s : sources_) total += s.total;
  return total;
}

std::vector<Sources::Batch> Sources::batchesAt(std::int64_t step) const {
  std::vector<Batch> batches;
  for (std::size_t k = 0; k < sources_.size(); ++k) {
    const SourceSetup& s = sources_[k];
    if (step >= s.first && step <= s.last && (step - s.first) % s.every == 0)
      batches.push_back({k, batch(s, (step - s.first) / s.every)});
  }
  return batches;
}

std::vector<terrain::GrainSpec> Sources::enteringAt(std::int64_t step) const {
  std::vector<terrain::GrainSpec> entering;
  for (const Batch& b : batchesAt(step)) entering.insert(entering.end(), b.grains.begin(), b.grains.end());
  return entering;
}

std::optional<std::int64_t> Sources::nextEntry(std::int64_t step) const {
  std::optional<std::int64_t> next;
  for (const SourceSetup& s : sources_) {
    const std::int64_t behind = std::max<std::int64_t>(0, step - s.first);
    const std::int64_t own = s.first + (behind + s.every - 1) / s.every * s.every;
    if (own <= s.last && (!next || own < *next)) next = own;
  }
  return next;
}

/// Grains of batch `number`: random positions in the box, without overlap.
std::vector<terrain::GrainSpec> Sources::batch(const SourceSetup& s, std::int64_t number) const {
  const std::int64_t count = std::min(s.number, s.total - number * s.number);
  std::vector<terrain::GrainSpec> grains;
  for (std::int64_t k = 0; k < count; ++k) {
    const auto id = static_cast<std::uint64_t>(number * s.number + k);
    for (int attempt = 0;; ++attempt) {
      if (attempt == kSourceTries)
        throw base::InputError(
            fmt::format("{}: {} grains of radius {:g} m do not fit in its box without overlap; enlarge it (low, high) "
                        "or lower number",
                        s.place, s.number, s.radius));
      base::Vec3d place;
      for (int a = 0; a < 3; ++a) {
        const double u = base::uniform(s.seed, kSourcePurpose, id,
                                       3 * static_cast<std::uint64_t>(attempt) + static_cast<std::uint64_t>(a));
        place[a] = s.low[a] + u * (s.high[a] - s.low[a]);
      }
      const bool taken = std::any_of(grains.begin(), grains.end(), [&](const terrain::GrainSpec& g) {
        return norm(terrain::toNearestImage(sides_, g.position - place)) < kRoom * s.radius;
      });
      if (taken) continue;
      grains.push_back({place, s.velocity, s.spin, s.radius, s.material});
      break;
    }
  }
  return grains;
}

} // namespace grouser::coupling
