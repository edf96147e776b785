// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/ledger.hpp"
#include "multibody/state.hpp"
#include "vehicle/assembly.hpp"
#include "vehicle/driver.hpp"
#include "vehicle/hitch.hpp"

#include <cstdint>
#include <vector>

namespace grouser::coupling {

/// What a row says of a hitch. Means are since restartMeans(), and 0 before the first step behind it.
struct HitchObservation {
  base::Vec3d force;   ///< on the vehicle, mean [N]: forward along the heading, left, up
  double pull{};       ///< of the vehicle on it, mean, forward along the heading [N]; Observation::drawbarPull is along
                       ///< the direction of motion
  double speed{};      ///< of the hitch point along the heading, mean [m/s]
  double power{};      ///< that it takes from the vehicle, mean [W]
  double work{};       ///< done on the vehicle since the start [J]; negative where it holds it back
  double towedWay{};   ///< of sled or carriage [m]
  double towedSpeed{}; ///< [m/s]
};

/// The hitch of a vehicle in its step: what it pulls with, and what that is worth. All on the host, from the bodies'
/// state alone.
class Towing {
public:
  explicit Towing(const vehicle::HitchOptions& options) : hitch_(options) {}

  /// Adds the hitch's force to the hull's loads, for a step of `dt` [s] that begins at `state`.
  void pull(const vehicle::Assembly& vehicle, const multibody::State& state, const vehicle::Driver& driver, double dt,
            const base::Vec3d& gravity, multibody::Loads& loads);
  /// Books that step's work, with the means of the velocities before and behind it as the bodies' books do.
  void book(const vehicle::Assembly& vehicle, const multibody::State& state, double dt);

  HitchObservation observe() const;
  void restartMeans() { forces_ = {}, speeds_ = taken_ = 0, steps_ = 0; }
  double work() const { return work_; } ///< on the vehicle since the start [J]

  std::vector<double> save() const { return hitch_.save(); } ///< what later steps depend on
  std::vector<double> books() const;                         ///< what later rows depend on
  static double workOf(const std::vector<double>& books); ///< work() that books() has [J]
  void restore(const std::vector<double>& state, const std::vector<double>& books);

private:
  vehicle::Hitch hitch_;
  multibody::Wrench wrench_; ///< of the step that is being taken, on the hull's centre of mass
  multibody::Twist before_;  ///< of the hull, as it began
  base::Vec3d ahead_;        ///< its heading then, level
  base::Vec3d lever_;        ///< of the hitch point
  multibody::CompensatedSum work_;
  base::Vec3d forces_;            ///< summed over steps [N]
  double speeds_ = 0, taken_ = 0; ///< the same of the speed [m/s] and of the work taken from the vehicle [W]
  std::int64_t steps_ = 0;
};

} // namespace grouser::coupling
