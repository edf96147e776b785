// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace grouser::contact {

/// Coefficient of restitution [-] of the linear law at damping ratio zeta = gamma / (2 omega_0), zeta >= 0.
/// With attraction e = exp(-zeta pi / sqrt(1 - zeta^2)); without, the contact force ends when it reaches zero and
/// e = exp(-eta t_c) with the shortened duration t_c (Schwager and Poeschel 2007, Granular Matter 9:465).
double restitutionOf(double zeta, bool attraction);

/// Damping ratio [-] that gives `restitution`, in (0, 1]. Inverse of `restitutionOf`.
double dampingRatioFor(double restitution, bool attraction);

/// Contact duration [s] for omega_0 = sqrt(k / m_eff) [1/s].
double contactDuration(double omega0, double zeta, bool attraction);

/// Largest stable step [s] of one linear contact under the semi-implicit Euler step with the dashpot taken at the
/// current velocity: omega_0 dt < 2 (sqrt(1 + zeta^2) - zeta).
double stableStep(double omega0, double zeta);

} // namespace grouser::contact
