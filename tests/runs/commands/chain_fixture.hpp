// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <string>

namespace grouser::test {

/// Ten links of 1 kg, straight below a pin, with a weight at the end. `lean`: gravity along x [m/s2].
inline std::string chainScene(double weight, double lean = 0) {
  std::string text =
      fmt::format("version = 1\n[run]\nduration = 0.2\noutput_interval = 0.01\ngravity = [{}, 0, -9.81]\n", lean);
  for (int i = 0; i <= 10; ++i) {
    const bool tip = i == 10;
    const std::string name = tip ? "weight" : fmt::format("link {}", i);
    text += fmt::format("[[body]]\nname = \"{}\"\nmass = {}\nposition = [0, 0, {}]\n{}\n", name, tip ? weight : 1,
                        -0.15 * (tip ? i : i + 0.5), tip ? "point = true" : "inertia = [0.002, 0.002, 0.0002]");
    text += fmt::format("[[joint]]\nname = \"pin {}\"\nbodies = [\"{}\", \"{}\"]\npoint = [0, 0, {}]\n{}\n", i,
                        i == 0 ? "world" : fmt::format("link {}", i - 1), name, -0.15 * i,
                        tip ? "type = \"spherical\"" : "axis = [0, 1, 0]");
  }
  return text;
}

/// A winch on a rail that pulls the chain's weight; `pull`: its force law.
inline std::string winch(const std::string& pull) {
  return R"([[body]]
name = "block"
mass = 1
inertia = [0.01, 0.01, 0.01]
position = [0, 0, -1.5]
[[joint]]
name = "rail"
type = "prismatic"
bodies = ["world", "block"]
point = [0, 0, -1.5]
axis = [0, 0, 1]
[[joint]]
name = "hook"
type = "spherical"
bodies = ["weight", "block"]
point = [0, 0, -1.5]
[[drive]]
name = "winch"
joint = "rail"
imposes = "torque"
)" + pull +
         "\n";
}

} // namespace grouser::test
