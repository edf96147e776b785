// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/device_under_test.hpp"
#include "tests/runs/program_fixture.hpp"
#include "tests/runs/scene_fixture.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

/// Common input mistakes as scenes that are valid except for one line.
namespace grouser::test {

namespace fs = std::filesystem;

inline fs::path asset(const std::string& name) { return fs::path(sourceFolder()) / "assets" / name; }

/// A project picture with modified bytes: 16 to 19 width, 20 to 23 height, 24 bits, 25 colour type, 28 interlace.
inline std::string picture(std::size_t at = 0, const std::string& bytes = "") {
  std::string png = contents(asset("heightmaps/flat.png"));
  return png.replace(at, bytes.size(), bytes);
}

/// 50 grains on a floor of map.png.
inline const char* const kBed = R"(version = 1
[run]
duration = 0.01
time_step = 1e-4
[material.soil]
stiffness = 1e5
[terrain]
heightmap = "map.png"
size = [0.6, 0.4]
height_range = [0, 0.1]
material = "soil"
grain_radius = 0.03
layers = 1
arrangement = "lattice"
floor_grains = false
wall_friction = 0.5
settle_time_limit = 0.0
[output]
picture = false
plots = false
)";

/// Two grains on a plane.
inline const char* const kGrains = R"(version = 1
[run]
duration = 1e-3
time_step = 1e-5
[material.glass]
[[plane]]
material = "glass"
[[grain]]
position = [0, 0, 0.5]
radius = 0.01
material = "glass"
[[grain]]
position = [0.1, 0, 0.5]
radius = 0.01
material = "glass"
[output]
picture = false
plots = false
)";

/// A vehicle without ground.
inline const char* const kBench = R"(version = 1
[run]
duration = 0.1
[vehicle]
spec = "vehicles/light_tracked.toml"
sphere_radius = RADIUS
chassis = "fixed"
)";

struct Mistake {
  std::string name;
  std::function<void(const fs::path& folder)> make; ///< writes scene.toml and its files to the folder
  std::string words = "run scene.toml";
  std::vector<std::string> says; ///< required parts of the message: cause and remedy
  int code = 2;
  std::string before{}; ///< shell commands before the call
};

inline std::ostream& operator<<(std::ostream& out, const Mistake& m) { return out << m.name; }

inline Mistake badPicture(const std::string& name, const std::string& bytes, const std::vector<std::string>& says) {
  return {name,
          [bytes](const fs::path& f) {
            put(f / "scene.toml", kBed);
            put(f / "map.png", bytes);
          },
          "run scene.toml", says};
}

inline Mistake badScene(const std::string& name, const std::string& from, const std::string& to,
                        const std::vector<std::string>& says, const std::string& scene = kGrains, int code = 2) {
  return {name,
          [=](const fs::path& f) {
            put(f / "scene.toml", replaced(scene, from, to));
            put(f / "map.png", picture());
          },
          "run scene.toml", says, code};
}

/// A run stopped at step 40 whose checkpoint is then damaged; `words` resume it.
inline Mistake badCheckpoint(const std::string& name, const std::function<void(const fs::path& checkpoint)>& spoil,
                             const std::vector<std::string>& says,
                             const std::string& words = "run scene.toml --resume --out a") {
  return {name,
          [spoil](const fs::path& f) {
            put(f / "scene.toml", kGrains);
            ASSERT_EQ(shellIn(f, "\"$grouser\" run scene.toml --out a --steps 40").code, 0);
            spoil(f / "a/checkpoint.h5");
          },
          words, says};
}

/// A source at a single position beside the glass grains, before [output].
inline std::string source(const std::string& place, const std::string& more = "", const std::string& material = "glass",
                          const std::string& radius = "0.01") {
  return "[[source]]\nlow = " + place + "\nhigh = " + place + "\nradius = " + radius + "\nmaterial = \"" + material +
         "\"\nevery = 1\ntotal = 1\n" + more + "\n[output]";
}

/// A cube of 5 cm.
inline std::string cube(const std::string& place, const std::string& more = "") {
  return "[[box]]\nposition = " + place + "\nsize = [0.05, 0.05, 0.05]\nmaterial = \"glass\"\n" + more;
}

inline std::string manyPlanes(int count) {
  std::string text;
  for (int k = 0; k < count; ++k) text += "[[plane]]\nmaterial = \"glass\"\n";
  return text;
}

inline Mistake badMesh(const std::string& name, const std::string& line, const std::vector<std::string>& says,
                       const std::string& mesh = contents(asset("meshes/idler.obj"))) {
  return {name,
          [=](const fs::path& f) {
            put(f / "scene.toml", replaced(kGrains, "[[plane]]\n",
                                           "[[mesh]]\nfile = \"part.obj\"\nposition = [0, 0, -9]\n" + line + "\n"));
            put(f / "part.obj", mesh);
          },
          "run scene.toml", says};
}

inline Mistake badVehicle(const std::string& name, const std::function<void(const fs::path& spec)>& make,
                          const std::vector<std::string>& says) {
  return {name,
          [make](const fs::path& f) {
            put(f / "scene.toml", "version = 1\n[run]\nduration = 0.1\n[vehicle]\nspec = \"car.toml\"\nchassis = "
                                  "\"fixed\"\n");
            make(f / "car.toml");
          },
          "run scene.toml", says};
}

inline void nothing(const fs::path&) {}

} // namespace grouser::test
