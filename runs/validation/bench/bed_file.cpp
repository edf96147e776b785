// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/bench/bed_file.hpp"

#include "base/error.hpp"
#include "runs/scene/scene.hpp"
#include "runs/support/text_file.hpp"

#include <cmath>
#include <fmt/format.h>

namespace grouser::bench {

namespace {

constexpr double kSameRadius = 1e-6; // relative tolerance [-]: radii in files may have single precision

std::string rowOf(const base::Vec3d& x, double radius, const base::Vec3f& v, const base::Vec3f& w) {
  return fmt::format("{:.17g} {:.17g} {:.17g} {:.17g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", x.x, x.y, x.z,
                     radius, v.x, v.y, v.z, w.x, w.y, w.z);
}

} // namespace

std::vector<terrain::GrainSpec> readBed(const BedBench& bench) {
  const std::vector<scene::Grain> rows = scene::readGrainFile(bench.start, {});
  if (static_cast<std::int64_t>(rows.size()) != bench.grains)
    throw base::InputError(fmt::format("bench bed: {} contains {} grains, but --grains is {}; use --grains {}",
                                       bench.start, rows.size(), bench.grains, rows.size()));
  std::vector<terrain::GrainSpec> grains;
  grains.reserve(rows.size());
  for (const scene::Grain& row : rows) {
    if (std::fabs(row.radius - bench.radius) > kSameRadius * bench.radius)
      throw base::InputError(fmt::format("bench bed: {} contains a grain of radius {:g} m, but --radius is {:g} m; set "
                                         "--radius to the radius of the grains, which must all be equal",
                                         bench.start, row.radius, bench.radius));
    grains.push_back({row.position, row.velocity, row.spin});
  }
  return grains;
}

void saveBed(const terrain::Grains& grains, const std::string& path) {
  const terrain::GrainSnapshot rows = grains.snapshot();
  std::string text = "# x, y, z, r [m], vx, vy, vz [m/s], wx, wy, wz [rad/s]\n";
  for (std::size_t k = 0; k < rows.id.size(); ++k)
    text += rowOf(rows.position[k], rows.radius.empty() ? grains.model().radius : rows.radius[k], rows.velocity[k],
                  rows.spin[k]);
  support::writeTextFile(path, text, "--save");
}

} // namespace grouser::bench
