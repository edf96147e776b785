// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace grouser::scm {

/// Elastic energies now, and energies dissipated since the start [J].
struct SoilEnergy {
  double elastic{};      ///< of pressure
  double elasticShear{}; ///< of shear and of the sides of shoes
  double compaction{};   ///< plastic sinkage
  double shear{};        ///< plastic shear, and soil that sides of shoes push
  double slipSinkage{};  ///< sinkage by shear
  double damping{};
  double edges{}; ///< elastic energy of soil that leaves a body sideways or loses contact; negative where soil enters
  double coupling{}; ///< change of elastic shear energy with the pressure

  double held() const { return elastic + elasticShear; }
  double lost() const { return compaction + shear + slipSinkage + damping + edges + coupling; }
};

} // namespace grouser::scm
