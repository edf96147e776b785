// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace grouser::terrain {

/// Distribution of the radii of a bed's grains.
enum class RadiusLaw {
  single,    ///< all alike
  uniform,   ///< by number, between 1 - spread and 1 + spread of the radius
  lognormal, ///< by number, the radius is the median and `spread` the standard deviation of ln r; within two of those
  sieve      ///< by mass, as a sieve analysis gives it
};

/// Radii of grains, by number. A sieve curve is taken to rise evenly over the logarithm of the size between two sieves.
struct RadiusDistribution {
  RadiusLaw law = RadiusLaw::single;
  double radius{};                   ///< [m] the middle of the distribution; not of sieves
  double spread{};                   ///< [-] as RadiusLaw says; uniform: in (0, 1), lognormal: in (0, 1]
  std::vector<double> sieveDiameter; ///< [m] openings, ascending, at least two
  std::vector<double> passing;       ///< [-] share of the mass that passes each, from 0 to 1, ascending

  /// The radius [m] of one grain, from numbers that are uniform in [0, 1): uniform(k), k = 0, 1, ...
  template <class Uniform> double draw(const Uniform& uniform) const;

  double smallest() const; ///< [m]
  double largest() const;  ///< [m]
  /// The mean over the grains of r^power [m^power], power 1, 2, 3 or 4.
  double meanPower(int power) const;
  /// The radius that grading counts from [m]: the middle of the distribution; of sieves, medianByMass().
  double medianRadius() const { return law == RadiusLaw::sieve ? medianByMass() : radius; }
  /// Half the size that half of the mass is finer than [m].
  double medianByMass() const;
  /// Standard deviation over mean [-], and the skewness of the radii [-]: what random close packing depends on.
  double deviation() const;
  double skewness() const;

private:
  static constexpr double kMostDeviations = 2; ///< of the logarithm [-]

  static double normalOf(double x, double square); ///< by the polar method
  double fromNormal(double z) const;               ///< [m]
  double ofSieves(double which, double within) const;
};

/// Solid fraction of random close packing of spheres without friction [-]: 0.634 + 0.0658 deviation + 0.0857 skewness
/// deviation^2 (Desmond and Weeks 2014, Phys. Rev. E 90, 022204). Denser packings have crystallised.
double randomClosePacking(const RadiusDistribution& radii);

/// Growth of the radii with depth: fine grains near the surface, coarse ones below.
struct DepthGrading {
  double fineDepth{};      ///< [m] down to which the radii are as distributed
  double coarsening{};     ///< [-] growth of the median radius per metre below that; 0: none
  double coarsestRadius{}; ///< [m] upper limit
  bool any() const { return coarsening > 0; }
  /// Factor of the radii at `depth` [m] below the surface over those at the surface [-], with the middle of the
  /// distribution at `radius` [m].
  double scaleAt(double depth, double radius) const;
  /// Mean over the grains of a bed of this depth [m], by number, of the fourth power of their scale [-]: factor of m g
  /// radius of a mean grain over that of one at the surface.
  double meanFourthPower(double depth, double radius) const;
};

template <class Uniform> double RadiusDistribution::draw(const Uniform& uniform) const {
  switch (law) {
  case RadiusLaw::uniform:
    return radius * (1 + spread * (2 * uniform(0) - 1));
  case RadiusLaw::lognormal:
    // Polar method of Marsaglia: two numbers in the unit circle make one from the normal distribution.
    for (std::uint64_t k = 0;; k += 2) {
      const double x = 2 * uniform(k) - 1, y = 2 * uniform(k + 1) - 1, square = x * x + y * y;
      if (square >= 1 || square == 0) continue;
      const double z = normalOf(x, square);
      if (z >= -kMostDeviations && z <= kMostDeviations) return fromNormal(z);
    }
  case RadiusLaw::sieve:
    return ofSieves(uniform(0), uniform(1));
  default:
    return radius;
  }
}

} // namespace grouser::terrain
