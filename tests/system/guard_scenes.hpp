// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

/// Components of small scenes for the tests of the guard.
namespace grouser::test {

const char* const kNoGravity = "gravity = [0, 0, 0]\n";

inline std::string run(double duration, const std::string& more = "") {
  return fmt::format("version = 1\n[run]\nduration = {:g}\noutput_interval = 0.01\ncheckpoint_interval = 0\n{}",
                     duration, more);
}

/// A material of linear springs, with the keys of `more`.
inline std::string soil(double restitution, double friction, const std::string& more = "",
                        const std::string& stiffness = "2e4", const std::string& name = "soil") {
  return fmt::format("[material.{}]\nstiffness = {}\nrestitution = {:g}\nfriction = {:g}\n{}", name, stiffness,
                     restitution, friction, more);
}

inline std::string hertz(double restitution, double friction, const std::string& young = "1e7") {
  return fmt::format("[material.soil]\nlaw = \"hertz\"\nyoung = {}\nrestitution = {:g}\nfriction = {:g}\n", young,
                     restitution, friction);
}

inline std::string plane(const std::string& point, const std::string& normal, const std::string& more = "") {
  return fmt::format("[[plane]]\npoint = {}\nnormal = {}\nmaterial = \"soil\"\n{}", point, normal, more);
}

inline std::string floor(const std::string& more = "") { return plane("[0, 0, 0]", "[0, 0, 1]", more); }

/// Four walls at `half` [m] from the z axis.
inline std::string walls(double half) {
  std::string text;
  for (const auto& [x, y] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
    text += plane(fmt::format("[{:g}, {:g}, 0]", -half * x, -half * y), fmt::format("[{}, {}, 0]", x, y));
  return text;
}

struct Fill {
  int number = 60;
  double half = 0.03, low = 0, high = 0.07; ///< block dimensions [m]
  const char* radius = "0.005";
  const char* more = ""; ///< velocity, radius_to
  const char* material = "soil";
};
inline std::string grains(const Fill& f) {
  return fmt::format("[[grains]]\nform = \"random\"\nlow = [{:g}, {:g}, {:g}]\nhigh = [{:g}, {:g}, {:g}]\nnumber = {}\n"
                     "radius = {}\nmaterial = \"{}\"\n{}",
                     -f.half, -f.half, f.low, f.half, f.half, f.high, f.number, f.radius, f.material, f.more);
}

inline std::string grain(const std::string& position, const std::string& more = "",
                         const std::string& radius = "0.005") {
  return fmt::format("[[grain]]\nposition = {}\nradius = {}\nmaterial = \"soil\"\n{}", position, radius, more);
}

inline std::string box(const std::string& position, const std::string& size, const std::string& more = "") {
  return fmt::format("[[box]]\nposition = {}\nsize = {}\nmaterial = \"soil\"\n{}", position, size, more);
}

/// Grains in a box of 6 cm.
inline std::string heap(double duration, const std::string& material, const Fill& fill = {},
                        const std::string& more = "") {
  return run(duration, more) + material + floor() + walls(0.03) + grains(fill);
}

inline std::string body(const std::string& name, const std::string& position, const std::string& more = "",
                        double mass = 1, const std::string& inertia = "[0.01, 0.01, 0.01]") {
  return fmt::format("[[body]]\nname = \"{}\"\nposition = {}\nmass = {:g}\ninertia = {}\n{}", name, position, mass,
                     inertia, more);
}

inline std::string joint(const std::string& name, const std::string& first, const std::string& second,
                         const std::string& point, const std::string& more = "axis = [0, 1, 0]\n") {
  return fmt::format("[[joint]]\nname = \"{}\"\nbodies = [\"{}\", \"{}\"]\npoint = {}\n{}", name, first, second, point,
                     more);
}

/// Connected links of 0.1 m, level at the start.
inline std::string chain(int links) {
  std::string text;
  for (int i = 0; i < links; ++i)
    text +=
        body(fmt::format("link {}", i), fmt::format("[{:g}, 0, 0]", 0.1 * i + 0.05), "", 0.1, "[1e-5, 1e-4, 1e-4]") +
        joint(fmt::format("pin {}", i), i == 0 ? "world" : fmt::format("link {}", i - 1), fmt::format("link {}", i),
              fmt::format("[{:g}, 0, 0]", 0.1 * i));
  return text;
}

/// 0.1 kg m2 about the z axis.
inline std::string rotor(const std::string& drive) {
  return body("rotor", "[0, 0, 0]", "", 1, "[0.1, 0.1, 0.1]") +
         joint("axle", "world", "rotor", "[0, 0, 0]", "axis = [0, 0, 1]\n") +
         "[[drive]]\nname = \"motor\"\njoint = \"axle\"\n" + drive;
}

inline std::string pendulum(const std::string& more = "") {
  return body("rod", "[0.5, 0, 0]") + joint("pin", "world", "rod", "[0, 0, 0]", "axis = [0, 1, 0]\n" + more);
}

} // namespace grouser::test
