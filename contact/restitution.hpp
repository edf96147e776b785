// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace grouser::contact {

/// Coefficient of restitution [-] of the linear law at damping ratio zeta = gamma / (2 omega_0), zeta >= 0.
/// With attraction, e = exp(-zeta pi / sqrt(1 - zeta^2)). Without attraction, the contact ends when its force is zero:
/// e = exp(-eta t_c) with the shortened duration t_c (Schwager and Poeschel 2007, Granular Matter 9:465).
double restitutionOf(double zeta, bool attraction);

/// Restitution of the dashpot if 0 is requested without attraction. No dashpot reaches 0 (surfaces always separate at
/// some speed); complementarity contacts do, and use the dashpot only for lasting contacts.
inline constexpr double kMinDashpotRestitution = 0.01;

/// Damping ratio [-] for a given `restitution` in (0, 1]; inverse of `restitutionOf`. For restitution 0: critical
/// damping with attraction, and the damping ratio for `kMinDashpotRestitution` without it.
double dampingRatioFor(double restitution, bool attraction);

/// Contact duration [s] for omega_0 = sqrt(k / m_eff) [1/s].
double contactDuration(double omega0, double zeta, bool attraction);

/// Maximum stable step [s] of a mode x'' + damping x' + stiffness x = 0 [1/s, 1/s2], not both zero, for the
/// semi-implicit Euler step with the dashpot at the current velocity, v' = v - dt (stiffness x + damping v) and x' = x
/// + dt v'. Its characteristic polynomial l^2 - (2 - damping dt - stiffness dt^2) l + 1 - damping dt has no root
/// outside the unit circle while stiffness dt^2 + 2 damping dt < 4 (Jury conditions, 1962).
double stableStepOfMode(double stiffness, double damping);

/// Same for one linear contact: omega_0 dt < 2 (sqrt(1 + zeta^2) - zeta). A mode of many contacts has a different
/// zeta.
double stableStep(double omega0, double zeta);

/// Coefficient of restitution [-] of the Hertz law with the dashpot c_n = 2 beta sqrt(k_n m_eff), k_n = 2 E_eff a;
/// independent of speed. With attraction, e follows from beta / sqrt(5/6) as in the linear law (Antypov and Elliott
/// 2011, EPL 94:50004). Without it, the equation of motion is integrated to 1e-6. (The polynomial fit of Thornton,
/// Cummins and Cleary 2013, Powder Technol. 233:30, deviates by up to 0.008 near e = 1.)
double hertzRestitutionOf(double beta, bool attraction);

/// Damping ratio beta for a given `restitution` in (0, 1]; 0 as in dampingRatioFor(). Inverse of `hertzRestitutionOf`.
double hertzDampingRatioFor(double restitution, bool attraction);

/// Elastic Hertz impact at `speed` [m/s]: maximum overlap [m] and duration [s].
struct HertzImpact {
  double deepest, duration;
};
HertzImpact hertzImpact(double effectiveModulus, double effectiveRadius, double effectiveMass, double speed);

/// Maximum overlap of an impact with the Hertz dashpot `beta`, relative to an elastic impact [-]; independent of speed.
/// Integrated to 1e-6.
double hertzDepthShare(double beta);

/// Time in which a Rayleigh wave travels half the circumference of a sphere [s].
double rayleighTime(double radius, double density, double shearModulus, double poisson);

} // namespace grouser::contact
