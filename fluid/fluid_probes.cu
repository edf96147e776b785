// SPDX-License-Identifier: BSD-3-Clause
// Pressure at points and surface height on lines: each particle adds to nearby probes, in integers.
#include "fluid/fluid.hpp"
#include "fluid/fluid_kernels.cuh"

#include <algorithm>
#include <cmath>

namespace grouser::fluid {

namespace {

/// Adds the sums of the particles near a point, in the quanta of a marker's sums.
struct PointSums {
  std::int64_t weight, compression;
  base::Vec3l moment;
};

/// Pair of particle i with a point [units].
GROUSER_HD Pair pairWith(const FluidView& f, int i, const base::Vec3l& place) {
  return pairAt(f.constants, f.constants.period.apart(f.position[i], base::fromUnits(place)).as<float>());
}

struct AddToPoints {
  static constexpr double kNanoseconds = 30;
  FluidView f;
  const base::Vec3l* point; ///< [points] units
  int points;
  PointSums* sums; ///< [points]
  GROUSER_HD void operator()(int i) const {
    if (f.isGhost(i)) return;
    const FluidConstants& k = f.constants;
    for (int p = 0; p < points; ++p) {
      const Pair pair = pairWith(f, i, point[p]);
      if (pair.q >= 2) continue;
      const float w = pair.weight();
      const auto s = static_cast<float>(f.precise[i].compression);
      base::atomicAdd64(&sums[p].weight, rounded(w * static_cast<float>(k.weight.perUnit)));
      base::atomicAdd64(&sums[p].compression, rounded(w * s * static_cast<float>(k.compression.perUnit)));
      const base::Vec3l moment = roundedVector(pair.d * (w * (1 + s) * static_cast<float>(k.moment.perUnit)));
      for (int a = 0; a < 3; ++a) base::atomicAdd64(&sums[p].moment[a], moment[a]);
    }
  }
};

/// Sums of W/W(0) at places on vertical lines.
struct AddToLines {
  static constexpr double kNanoseconds = 30;
  FluidView f;
  const base::Vec3l* foot; ///< [lines] units
  int lines, places;       ///< sample points on each line
  std::int64_t gap;        ///< spacing of the sample points [units]
  std::int64_t* sums;      ///< [lines, places]
  GROUSER_HD void operator()(int i) const {
    if (f.isGhost(i)) return;
    const FluidConstants& k = f.constants;
    const std::int64_t z = base::toUnits(f.position[i]).z;
    const auto reach = static_cast<std::int64_t>(2 / (k.perLength * k.metresPerUnit));
    for (int n = 0; n < lines; ++n) {
      base::Vec3l place{foot[n].x, foot[n].y, z};
      if (pairWith(f, i, place).q >= 2) continue; // beside the line
      const std::int64_t first = (z - reach - foot[n].z) / gap, last = (z + reach - foot[n].z) / gap + 1;
      for (std::int64_t m = first < 0 ? 0 : first; m <= last && m < places; ++m) {
        place.z = foot[n].z + m * gap;
        const Pair pair = pairWith(f, i, place);
        if (pair.q < 2)
          base::atomicAdd64(&sums[n * places + m], rounded(pair.weight() * static_cast<float>(k.weight.perUnit)));
      }
    }
  }
};

base::Vec3l unitsOf(const FluidConstants& k, const base::Vec3d& p) {
  return k.period.wrapped(base::toUnits(k.scale.fromMetres(p)));
}

} // namespace

std::vector<double> Fluid::pressuresAt(const std::vector<base::Vec3d>& points) {
  std::vector<base::Vec3l> places;
  for (const base::Vec3d& p : points) places.push_back(unitsOf(constants_, p));
  const base::Array<base::Vec3l> place(exec_, places);
  base::Array<PointSums> sums(exec_, points.size());
  base::forEach(exec_, "pressure probes", static_cast<std::int64_t>(slots_),
                AddToPoints{view(), place.data(), static_cast<int>(points.size()), sums.data()});
  std::vector<double> pressures;
  const base::Vec3d pull = model_.gravity * (1 / (model_.soundSpeed * model_.soundSpeed));
  static_assert(sizeof(PointSums) == 5 * sizeof(std::int64_t));
  std::vector<PointSums> all = sums.toHost();
  if (!all.empty()) comm_.sum(&all.front().weight, 5 * all.size());
  for (const PointSums& s : all) {
    const double weight = constants_.weight.value(s.weight);
    const double rest = constants_.compression.value(s.compression) + dot(pull, constants_.moment.value(s.moment));
    pressures.push_back(weight > 0 ? pressureAt(model_, rest / weight) : 0.0);
  }
  return pressures;
}

std::vector<double> Fluid::levelsAt(const std::vector<base::Vec3d>& feet, double top) {
  const double share = model_.volume() * model_.kernel().atCentre();
  const auto gap = static_cast<std::int64_t>(0.5 * model_.spacing * constants_.scale.perMetre);
  const double step = static_cast<double>(gap) * constants_.scale.unit;
  double lowest = top;
  for (const base::Vec3d& p : feet) lowest = std::min(lowest, p.z);
  const int places = 1 + static_cast<int>(std::ceil((top - lowest) / step));
  std::vector<base::Vec3l> units;
  for (const base::Vec3d& p : feet) units.push_back(unitsOf(constants_, p));
  const base::Array<base::Vec3l> foot(exec_, units);
  base::Array<std::int64_t> sums(exec_, feet.size() * static_cast<std::size_t>(places));
  base::forEach(exec_, "level probes", static_cast<std::int64_t>(slots_),
                AddToLines{view(), foot.data(), static_cast<int>(feet.size()), places, gap, sums.data()});
  std::vector<std::int64_t> all = sums.toHost();
  comm_.sum(all.data(), all.size());
  std::vector<double> levels;
  for (std::size_t n = 0; n < feet.size(); ++n) {
    const std::int64_t* line = all.data() + n * static_cast<std::size_t>(places);
    const auto filled = [&](int m) { return share * constants_.weight.value(line[m]); };
    // Within a smoothing length of a floor the kernel support is truncated: sample points there appear less filled.
    int lowestWet = 0;
    while (lowestWet < places && filled(lowestWet) < 0.5) ++lowestWet;
    const int first = lowestWet * step <= model_.kernel().length() ? lowestWet : std::max(0, lowestWet - 1);
    double wet = first == lowestWet ? first : 0; // sample points
    for (int m = first; m + 1 < places; ++m) {
      const double high = std::max(filled(m), filled(m + 1)), low = std::min(filled(m), filled(m + 1));
      wet += low >= 0.5 ? 1 : high >= 0.5 ? (high - 0.5) / (high - low) : 0;
    }
    levels.push_back(feet[n].z + (lowestWet < places ? wet * step : 0.0));
  }
  return levels;
}

} // namespace grouser::fluid
