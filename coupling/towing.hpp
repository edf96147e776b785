// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/ledger.hpp"
#include "multibody/state.hpp"
#include "vehicle/assembly.hpp"
#include "vehicle/driver.hpp"
#include "vehicle/hitch.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace grouser::coupling {

/// Output values of a hitch. Means are over the time since restartMeans(); they are 0 before the first step after it.
struct HitchObservation {
  base::Vec3d force;   ///< mean force on the vehicle [N]: forward along the heading, left, up
  double pull{};       ///< mean pull of the vehicle, forward along the heading [N]; Observation::drawbarPull is
                       ///< along the direction of motion
  double speed{};      ///< mean speed of the hitch point along the heading [m/s]
  double power{};      ///< mean power absorbed from the vehicle [W]
  double work{};       ///< work done on the vehicle since the start [J]; negative if the hitch resists it
  double towedWay{};   ///< distance travelled by sled or carriage [m]
  double towedSpeed{}; ///< [m/s]
};

/// Two sets of means: for output rows, and for callers that step the simulation.
enum class Means { rows, watch };

/// Force and work of a vehicle's hitch, computed on the host from the state of the bodies.
class Towing {
public:
  explicit Towing(const vehicle::HitchOptions& options) : hitch_(options) {}

  /// Sets the force [N] or speed [m/s]; see vehicle::Hitch::command().
  void command(std::optional<double> value) { hitch_.command(value); }
  vehicle::HitchKind kind() const { return hitch_.options().kind; }
  /// Adds the hitch's force to the hull's loads, for a step of `dt` [s] that begins at `state`.
  void pull(const vehicle::Assembly& vehicle, const multibody::State& state, const vehicle::Driver& driver, double dt,
            const base::Vec3d& gravity, multibody::Loads& loads);
  /// Adds the work of that step, using the mean of the velocities before and after it, as in the bodies' ledger.
  void accountWork(const vehicle::Assembly& vehicle, const multibody::State& state, double dt);

  HitchObservation observe(Means of = Means::rows) const;
  void restartMeans(Means of = Means::rows) { sumsOf(of) = {}; }
  double work() const { return work_; } ///< work on the vehicle since the start [J]

  std::vector<double> save() const { return hitch_.save(); } ///< state required by later steps
  std::vector<double> saveSums() const;                      ///< sums required by later rows
  static double workOf(const std::vector<double>& sums);     ///< work() of saveSums() [J]
  void restore(const std::vector<double>& state, const std::vector<double>& sums);

private:
  vehicle::Hitch hitch_;
  multibody::Wrench wrench_; ///< load of the current step on the hull's centre of mass
  multibody::Twist before_;  ///< twist of the hull at the start of the step
  base::Vec3d ahead_;        ///< horizontal heading of the hull at that time
  base::Vec3d lever_;        ///< lever arm of the hitch point
  /// Sums over steps.
  struct Sums {
    base::Vec3d forces;           ///< [N]
    double speeds = 0, taken = 0; ///< sum of speeds [m/s], and of power absorbed from the vehicle [W]
    std::int64_t steps = 0;
  };
  Sums& sumsOf(Means of) { return of == Means::rows ? rows_ : watch_; }

  multibody::CompensatedSum work_;
  Sums rows_, watch_;
};

} // namespace grouser::coupling
