// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace grouser::coupling {

/// Inputs that can be set while a simulation runs.
enum class InputKind : std::int32_t {
  sprocketSpeed,  ///< of one track [rad/s], forward positive; with drive = "engine" the governor's set point
  sprocketTorque, ///< of one track [N m], forward positive
  throttle,       ///< of the engine of one track [-], -1 to 1: share of full load, or of the brake's torque
  hitchForce,     ///< backwards positive [N], of a hitch of kind "force"
  hitchSpeed,     ///< of the carriage [m/s], of a hitch of kind "speed"
  gravity,        ///< [m/s2], x, y, z
  bodyLoad        ///< force on a body [N] and torque about its centre of mass [N m], in world axes
};

/// One setting. It acts from the start of its step until the next of its kind and target.
struct Input {
  std::int64_t step{}; ///< first step in which it acts
  InputKind kind{};
  std::int32_t target{};              ///< track (0 left, 1 right) or body; 0 of the others
  bool released{};                    ///< returns to the scene's value
  std::array<double, 6> value{};      ///< as many as the kind has, then 0
  static constexpr int kNumbers = 10; ///< in a row of a file

  std::array<double, kNumbers> numbers() const;
  static Input of(const double* numbers);
  bool operator==(const Input&) const = default;
};

/// Numbers of a kind's value [-].
int width(InputKind kind);

/// All settings of a simulation so far, in their order, which are not part of the scene. Stored in checkpoints and
/// results; acting ones are in the state hash.
class Inputs {
public:
  /// The last of several settings of one kind and target in a step counts. `input.step` must not decrease.
  void set(const Input& input);
  const std::vector<Input>& series() const { return series_; }
  /// The acting value; empty if the scene's value acts.
  std::optional<std::array<double, 6>> now(InputKind kind, std::int32_t target = 0) const;
  /// All acting settings, by kind and target.
  const std::vector<Input>& acting() const { return acting_; }

  /// For the state hash; empty if nothing acts.
  std::vector<std::uint64_t> words() const;
  std::vector<double> save() const; ///< Input::kNumbers a setting
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
