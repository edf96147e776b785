// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace grouser::coupling {

/// Inputs that can be set during a simulation.
enum class InputKind : std::int32_t {
  sprocketSpeed,  ///< speed of one sprocket [rad/s], forward positive; with drive = "engine" the governor setpoint
  sprocketTorque, ///< torque on one sprocket [N m], forward positive
  throttle,       ///< throttle of one track's engine [-], -1 to 1: fraction of full load, or of the brake torque
  hitchForce,     ///< force of a hitch of kind "force" [N], backward positive
  hitchSpeed,     ///< carriage speed of a hitch of kind "speed" [m/s]
  gravity,        ///< [m/s2], x, y, z
  bodyLoad        ///< force on a body [N] and torque about its centre of mass [N m], in world axes
};

/// One setting, effective from the start of its step until the next setting of its kind and target.
struct Input {
  std::int64_t step{}; ///< first step in which it acts
  InputKind kind{};
  std::int32_t target{};              ///< track (0 left, 1 right) or body; 0 for other kinds
  bool released{};                    ///< true: restores the scene's value
  std::array<double, 6> value{};      ///< width(kind) values, then 0
  static constexpr int kNumbers = 10; ///< values per row of a file

  std::array<double, kNumbers> numbers() const;
  static Input of(const double* numbers);
  bool operator==(const Input&) const = default;
};

/// Number of values per input of this kind.
int width(InputKind kind);

/// All settings of a simulation so far, in order; they are not part of the scene. Stored in checkpoints and results;
/// the state hash includes the active ones.
class Inputs {
public:
  /// Adds a setting; it overrides earlier ones of the same kind, target and step. `input.step` must not decrease.
  void set(const Input& input);
  const std::vector<Input>& series() const { return series_; }
  /// Active value; empty if the scene's value applies.
  std::optional<std::array<double, 6>> now(InputKind kind, std::int32_t target = 0) const;
  /// All active settings, by kind and target.
  const std::vector<Input>& acting() const { return acting_; }

  /// Words of the state hash; empty without active settings.
  std::vector<std::uint64_t> words() const;
  std::vector<double> save() const; ///< Input::kNumbers values per setting
  /// Throws base::InputError if `saved` is not from save().
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
