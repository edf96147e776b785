// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace grouser::fluid {

/// Wendland's C2 kernel with compact support (Wendland 1995; Dehnen and Aly 2012, Mon. Not. R. Astron. Soc. 425,
/// 1068-1082): W(q) = a h^-d (1 - q/2)^4 (1 + 2q) for q = r/h < 2, with a = 7/(4 pi) in two dimensions and 21/(16 pi)
/// in three. Its gradient is F(q) r, with F = -5 a h^-(d+2) (1 - q/2)^3, which needs no division by r.
class Wendland {
public:
  /// `length`: smoothing length h [m]; `dimensions`: 2 or 3.
  Wendland(double length, int dimensions);

  double length() const { return length_; }
  double support() const { return 2 * length_; } ///< radius of the support, W = 0 beyond [m]
  double value(double r) const;                  ///< W [1/m^d]
  double slope(double r) const;                  ///< F = (dW/dr)/r [1/m^(d+2)], <= 0
  double atCentre() const { return norm_; }      ///< W(0) [1/m^d]
  double slopeAtCentre() const;                  ///< F(0), the maximum of |F|
  double steepest() const;                       ///< maximum |dW/dr| [1/m^(d+1)], at q = 1/2

private:
  double length_, norm_;
};

} // namespace grouser::fluid
