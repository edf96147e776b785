// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace grouser::terrain {

/// Distribution of the radii of a bed's grains.
enum class RadiusLaw {
  single,    ///< all equal
  uniform,   ///< uniform by number, between 1 - spread and 1 + spread times the radius
  lognormal, ///< lognormal by number: `radius`: median; `spread`: standard deviation of ln r; truncated at 2 spreads
  sieve      ///< by mass, from a sieve analysis
};

/// Distribution of grain radii. Between two sieves the passing mass increases linearly with the logarithm of size.
struct RadiusDistribution {
  RadiusLaw law = RadiusLaw::single;
  double radius{};                   ///< [m] middle of the distribution; unused with sieves
  double spread{};                   ///< [-] see RadiusLaw; uniform: in (0, 1), lognormal: in (0, 1]
  std::vector<double> sieveDiameter; ///< [m] openings, ascending, at least two
  std::vector<double> passing;       ///< [-] mass fraction passing each sieve, from 0 to 1, ascending

  /// Returns a random radius [m], from numbers uniform in [0, 1): uniform(k), k = 0, 1, ...
  template <class Uniform> double draw(const Uniform& uniform) const;

  double smallest() const; ///< [m]
  double largest() const;  ///< [m]
  /// Mean of r^power over the grains by number [m^power], power 1, 2, 3 or 4.
  double meanPower(int power) const;
  /// Reference radius of the depth grading [m]: the middle of the distribution; with sieves, medianByMass().
  double medianRadius() const { return law == RadiusLaw::sieve ? medianByMass() : radius; }
  /// Median radius by mass [m], i.e. d50 / 2.
  double medianByMass() const;
  /// Standard deviation / mean [-], and skewness of the radii [-]; they determine random close packing.
  double deviation() const;
  double skewness() const;

private:
  static constexpr double kMaxDeviations = 2; ///< largest deviation of ln r from its mean / `spread` [-]

  static double normalOf(double x, double square); ///< by the polar method
  double fromNormal(double z) const;               ///< [m]
  double ofSieves(double which, double within) const;
};

/// Solid fraction of random close packing of frictionless spheres [-]: 0.634 + 0.0658 deviation + 0.0857 skewness
/// deviation^2 (Desmond and Weeks 2014, Phys. Rev. E 90, 022204). Denser packings are crystalline.
double randomClosePacking(const RadiusDistribution& radii);

/// Increase of the radii with depth: fine grains near the surface, coarse ones below.
struct DepthGrading {
  double fineDepth{};      ///< [m] depth down to which the radii are unscaled
  double coarsening{};     ///< [-] relative growth of the median radius per metre below that; 0: none
  double coarsestRadius{}; ///< [m] upper limit
  bool any() const { return coarsening > 0; }
  /// Factor of the radii at `depth` [m] below the surface [-], with the middle of the distribution at `radius` [m].
  /// It is 1 at the surface.
  double scaleAt(double depth, double radius) const;
  /// Mean fourth power of the scale factor over the grains of a bed of this depth [m], by number [-]: m g radius of a
  /// mean grain relative to one at the surface.
  double meanFourthPower(double depth, double radius) const;
};

template <class Uniform> double RadiusDistribution::draw(const Uniform& uniform) const {
  switch (law) {
  case RadiusLaw::uniform:
    return radius * (1 + spread * (2 * uniform(0) - 1));
  case RadiusLaw::lognormal:
    // Polar method of Marsaglia: two numbers in the unit circle yield one normally distributed number.
    for (std::uint64_t k = 0;; k += 2) {
      const double x = 2 * uniform(k) - 1, y = 2 * uniform(k + 1) - 1, square = x * x + y * y;
      if (square >= 1 || square == 0) continue;
      const double z = normalOf(x, square);
      if (z >= -kMaxDeviations && z <= kMaxDeviations) return fromNormal(z);
    }
  case RadiusLaw::sieve:
    return ofSieves(uniform(0), uniform(1));
  default:
    return radius;
  }
}

} // namespace grouser::terrain
