// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace grouser::scm {

/// Current elastic energies, and cumulative dissipation by cause [J].
struct SoilEnergy {
  double elastic{};      ///< elastic energy under normal pressure
  double elasticShear{}; ///< elastic energy of shear, including the sides of shoes
  double compaction{};   ///< dissipated by plastic sinkage
  double shear{};        ///< dissipated by plastic shear, and by bulldozing at the sides of shoes
  double slipSinkage{};  ///< dissipated by slip sinkage
  double damping{};
  double edges{}; ///< elastic energy of soil that leaves a body sideways or loses contact; negative for entering soil
  double coupling{}; ///< change of elastic shear energy due to pressure changes

  double held() const { return elastic + elasticShear; }
  double lost() const { return compaction + shear + slipSinkage + damping + edges + coupling; }
};

} // namespace grouser::scm
