// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/bench/contact_spheres.hpp"

#include "base/for_each.cuh"
#include "base/random.hpp"

#include <cmath>
#include <numeric>

namespace grouser::bench {

namespace {

constexpr std::uint64_t kPurpose = base::purpose("bench.contacts");
constexpr std::uint64_t kBits = 21; ///< random bits per axis: one 64-bit number serves three axes

struct Place {
  std::uint64_t count, step, ny, nz, seed;
  std::int64_t spacing, jitter; ///< [units]
  base::Position* position;

  GROUSER_HD void operator()(int i) const {
    const std::uint64_t site = static_cast<std::uint64_t>(i) * step % count; // no overflow: i and step are below 2^31
    const std::uint64_t bits = base::hash(seed, kPurpose, site);
    const std::uint64_t cell[3] = {site / (ny * nz), site / nz % ny, site % nz};
    base::Vec3l u;
    for (int k = 0; k < 3; ++k) {
      const auto random = static_cast<std::int64_t>(bits >> (kBits * static_cast<std::uint64_t>(k)) &
                                                    ((std::uint64_t{1} << kBits) - 1));
      u[k] = static_cast<std::int64_t>(cell[k]) * spacing + (2 * jitter * random >> kBits) - jitter;
    }
    position[i] = base::fromUnits(u);
  }
};

} // namespace

base::Array<base::Position> ContactSpheres::make(const base::Exec& exec, std::int64_t count, std::uint64_t seed) {
  const auto n = static_cast<std::uint64_t>(count);
  std::uint64_t edge = 1;
  while (edge * edge * edge < n) ++edge;
  std::uint64_t step = n * 618 / 1000 + 1;
  while (std::gcd(step, n) != 1) ++step;
  base::Array<base::Position> positions(exec, static_cast<std::size_t>(count));
  base::forEach(exec, "place spheres", count,
                Place{n, step, edge, edge, seed, static_cast<std::int64_t>(kSpacing * double(kDiameter)),
                      static_cast<std::int64_t>(kJitter * double(kDiameter)), positions.data()});
  base::synchronize(exec);
  return positions;
}

} // namespace grouser::bench
