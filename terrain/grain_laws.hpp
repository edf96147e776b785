// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "terrain/grain_constants.hpp"

#include <type_traits>

namespace grouser::terrain {

struct GrainKernelData;
template <class Real> struct ForceData;
template <class Real> struct BoundaryLoad;

/// Contact laws of grains and boundaries on the device, in the force precision.
class GrainLaws {
public:
  /// `boundaries`: as returned by boundaryLaws().
  GrainLaws(const base::Exec& exec, const GrainConstants& constants,
            const std::vector<contact::ContactLaw>& boundaries);

  /// Updates the laws between materials from the model.
  void replacePairs(const base::Exec& exec, const GrainConstants& constants);

  /// Kernel arguments without the boundary loads. `Real` must match the precision.
  template <class Real> ForceData<Real> forceData(const GrainConstants& constants) const;
  void describe(GrainKernelData& d) const;
  /// [materials] mass / radius^3 [kg/m3], on the device.
  const double* massPerCube() const { return massPerCube_.data(); }

private:
  template <class Real> struct Laws { base::Array<contact::BasicLaw<Real>> pairs, boundaries; };
  template <class Real> const Laws<Real>& laws() const {
    if constexpr (std::is_same_v<Real, float>)
      return single_;
    else
      return double_;
  }

  Laws<float> single_; ///< one of the two is empty
  Laws<double> double_;
  base::Array<double> massPerCube_; ///< [materials] mass / radius^3 [kg/m3]
  double first_{};                  ///< mass / radius^3 of the first material [kg/m3]
};

} // namespace grouser::terrain
