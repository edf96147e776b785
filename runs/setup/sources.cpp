// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/sources.hpp"

#include "base/error.hpp"
#include "base/random.hpp"
#include "runs/setup/grain_kinds.hpp"
#include "runs/setup/periodic_boundaries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::setup {

namespace {

constexpr std::uint64_t kPurpose = base::purpose("source.place");
constexpr int kTries = 2000;    // of finding a free place for one grain
constexpr double kRoom = 2.002; // [radii] between centres that enter together

} // namespace

Sources::Sources(const scene::Scene& scene, double timeStep) : sides_(periodicBoundaries(scene)) {
  const GrainKinds kinds = grainKinds(scene);
  for (std::size_t k = 0; k < scene.sources.size(); ++k) {
    const scene::Source& s = scene.sources[k];
    Stream stream;
    stream.source = s, stream.index = k, stream.place = scene.placeOf("source", k);
    stream.material = kinds.indexOf(s.material);
    stream.every = std::max<std::int64_t>(1, std::llround(s.every / timeStep));
    stream.first = std::llround(s.start / timeStep);
    const std::int64_t batches = (s.total + s.number - 1) / s.number;
    stream.last = stream.first + (batches - 1) * stream.every;
    stream.seed = base::hash(static_cast<std::uint64_t>(scene.run.seed), kPurpose, static_cast<std::uint64_t>(k));
    sources_.push_back(stream);
  }
}

std::vector<Sources::Batch> Sources::batchesAt(std::int64_t step) const {
  std::vector<Batch> batches;
  for (const Stream& stream : sources_)
    if (step >= stream.first && step <= stream.last && (step - stream.first) % stream.every == 0)
      batches.push_back({stream.index, batch(stream, (step - stream.first) / stream.every)});
  return batches;
}

std::vector<terrain::GrainSpec> Sources::enteringAt(std::int64_t step) const {
  std::vector<terrain::GrainSpec> entering;
  for (const Batch& b : batchesAt(step)) entering.insert(entering.end(), b.grains.begin(), b.grains.end());
  return entering;
}

std::optional<std::int64_t> Sources::nextEntry(std::int64_t step) const {
  std::optional<std::int64_t> next;
  for (const Stream& s : sources_) {
    const std::int64_t behind = std::max<std::int64_t>(0, step - s.first);
    const std::int64_t own = s.first + (behind + s.every - 1) / s.every * s.every;
    if (own <= s.last && (!next || own < *next)) next = own;
  }
  return next;
}

/// Places of batch `number`: random in the box, not nearer to each other than the grains are thick.
std::vector<terrain::GrainSpec> Sources::batch(const Stream& stream, std::int64_t number) const {
  const scene::Source& s = stream.source;
  const std::int64_t count = std::min(s.number, s.total - number * s.number);
  std::vector<terrain::GrainSpec> grains;
  for (std::int64_t k = 0; k < count; ++k) {
    const auto id = static_cast<std::uint64_t>(number * s.number + k);
    for (int attempt = 0;; ++attempt) {
      if (attempt == kTries)
        throw base::InputError(
            fmt::format("{}: {} grains of radius {:g} m do not find room beside each other in its box; enlarge it "
                        "(low, high) or lower number",
                        stream.place, s.number, s.radius));
      base::Vec3d place;
      for (int a = 0; a < 3; ++a) {
        const double u = base::uniform(stream.seed, kPurpose, id, static_cast<std::uint64_t>(3 * attempt + a));
        place[a] = s.low[a] + u * (s.high[a] - s.low[a]);
      }
      const bool taken = std::any_of(grains.begin(), grains.end(), [&](const terrain::GrainSpec& g) {
        return norm(toNearestImage(sides_, g.position - place)) < kRoom * s.radius;
      });
      if (taken) continue;
      grains.push_back({place, s.velocity, s.spin, s.radius, stream.material});
      break;
    }
  }
  return grains;
}

void checkSources(const scene::Scene& scene) {
  constexpr double kAllAtOnce = 1e300; // a time step [s] in which all begin
  Sources(scene, kAllAtOnce).enteringAt(0);
}

} // namespace grouser::setup
