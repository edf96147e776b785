// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace grouser::coupling {

/// What can be set from outside while a simulation runs.
enum class InputKind : std::int32_t {
  sprocketSpeed,  ///< of one track [rad/s], forward positive; with drive = "engine" the governor's set point
  sprocketTorque, ///< of one track [N m], forward positive
  throttle,       ///< of the engine of one track [-], -1 to 1: share of full load, or of the brake's torque
  hitchForce,     ///< backwards positive [N], of a hitch of kind "force"
  hitchSpeed,     ///< of the carriage [m/s], of a hitch of kind "speed"
  gravity,        ///< [m/s2], x, y, z
  bodyLoad        ///< force on a body [N] and torque about its centre of mass [N m], in world axes
};

/// One setting. It acts from the step at whose beginning it is made until the next of its kind and target.
struct Input {
  std::int64_t step{}; ///< before which it is made
  InputKind kind{};
  std::int32_t target{};              ///< track (0 left, 1 right) or body; 0 of the others
  bool released{};                    ///< back to what the scene says
  std::array<double, 6> value{};      ///< as many as the kind has, 0 behind them
  static constexpr int kNumbers = 10; ///< in a row of a file

  std::array<double, kNumbers> numbers() const;
  static Input of(const double* numbers);
  bool operator==(const Input&) const = default;
};

/// Numbers of a kind's value [-].
int width(InputKind kind);

/// All settings of a simulation so far, in their order: the part of the answer that no scene knows. Kept in checkpoints
/// and results; what acts now is in the state hash.
class Inputs {
public:
  /// Two settings of one kind and target before one step: the last counts. `input.step` does not fall.
  void set(const Input& input);
  const std::vector<Input>& series() const { return series_; }
  /// What acts now; empty where the scene does.
  std::optional<std::array<double, 6>> now(InputKind kind, std::int32_t target = 0) const;
  /// All that act now, by kind and target.
  const std::vector<Input>& acting() const { return acting_; }

  /// For the state hash; empty where nothing acts.
  std::vector<std::uint64_t> words() const;
  std::vector<double> save() const; ///< Input::kNumbers a setting
  /// Throws base::InputError where it is not what save() returned.
  void restore(const std::vector<double>& saved);

private:
  void act(const Input& input);

  std::vector<Input> series_, acting_;
};

} // namespace grouser::coupling

template <> struct grouser::base::EnumWords<grouser::coupling::InputKind> {
  using E = coupling::InputKind;
  static constexpr EnumWord<E> list[] = {{E::sprocketSpeed, "sprocket_speed"},
                                         {E::sprocketTorque, "sprocket_torque"},
                                         {E::throttle, "throttle"},
                                         {E::hitchForce, "hitch_force"},
                                         {E::hitchSpeed, "hitch_speed"},
                                         {E::gravity, "gravity"},
                                         {E::bodyLoad, "body_load"}};
};
